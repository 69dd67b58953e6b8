"""The tables of a store, and what stands in their columns."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence

import numpy as np
import pyarrow as pa  # type: ignore[import-untyped]  # ships no stubs
import pyarrow.compute as pc  # type: ignore[import-untyped]  # as above

FORMAT = 2
"""Raised when a store is laid out in a way that another reader would take for something else."""
TABLES = ("cells", "timings")
"""A row of ``cells`` is a whole cell; ``timings`` are taken later, and belong to it by key."""
TRAJECTORIES, DAMAGED, LOCK = "trajectories", "damaged", ".lock"
TEXT = {
    "key",
    "line",
    "scene",
    "scene_digest",
    "engine",
    "version",
    "crankcheck",
    "profile",
    "variant",
    "drive",
    "verdict",
    "status",
    "reason",
    "failed_rules",
    "trend",
    "force_trend",
    "convergence_of",
    "settings",
    "asked",
    "warnings",
    "run_on",
    "quantity",
    "body_kind",
    "body",
    "source",
    "kind",
    "unit",
    "series",
    "processor",
    "made",
    "precision",
    "springs",
}
FLAGS = {"gated"}
NESTED: Mapping[str, tuple[str, ...]] = {
    "errors": (
        *("quantity", "body_kind", "body", "source", "kind", "unit"),
        *("maximum", "rms", "final", "maximum_pure", "limit_pure"),
        *("time_of_maximum_s", "driver_at_maximum_rad", "reference_bound", "samples"),
    ),
    "trace": ("series", "values"),
}
"""The columns of a cell that hold rows of their own, and the names in these."""


def table(rows: Sequence[Mapping[str, object]]) -> pa.Table:
    """Rows as a table whose types do not depend on what is missing; what a row has not, as one of
    rigid links beside one of elastic ones, is null.

    Columns are text, flags, lists of numbers (``values``), lists of rows, or numbers; what is not
    there is null.
    """
    names = dict.fromkeys(name for row in rows for name in row)
    return pa.table(
        {
            name: pa.array([_plain(row.get(name)) for row in rows], type=_type(name))
            for name in names
        }
    )


def unnested(cells: pa.Table, name: str) -> pa.Table:
    """The rows that a column of some cells holds, each with the key of its cell."""
    nested = cells.column(name).combine_chunks()
    keys = cells.column("key").take(pc.list_parent_indices(nested))
    return pa.Table.from_struct_array(pc.list_flatten(nested)).add_column(0, "key", keys)


def _type(name: str) -> pa.DataType:
    if name in NESTED:
        return pa.list_(pa.struct([(field, _type(field)) for field in NESTED[name]]))
    if name in TEXT:
        return pa.string()
    if name in FLAGS:
        return pa.bool_()
    return pa.list_(pa.float64()) if name == "values" else pa.float64()


def _plain(value: object) -> object:
    """A value as Arrow takes it: settings become JSON."""
    if isinstance(value, Mapping):
        return json.dumps(value)
    if isinstance(value, list):
        return [{name: _plain(each) for name, each in row.items()} for row in value]
    if isinstance(value, bool | str | np.ndarray) or value is None:
        return value
    return float(value)  # type: ignore[arg-type]  # all that is left are numbers
