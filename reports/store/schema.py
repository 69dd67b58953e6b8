"""The tables of a store, and what stands in their columns."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence

import numpy as np
import pyarrow as pa  # type: ignore[import-untyped]  # ships no stubs

TABLES = ("cells", "errors", "traces", "timings")
"""A part of ``cells`` is written last of its name: what has none was cut short, and is dropped."""
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
}
FLAGS = {"gated"}


def table(rows: Sequence[Mapping[str, object]]) -> pa.Table:
    """Rows, all with the same names, as a table whose types do not depend on what is missing.

    Columns are text, flags, lists of numbers (``values``), or numbers; what is not there is null.
    """
    names = list(rows[0])
    return pa.table(
        {name: pa.array([_plain(row[name]) for row in rows], type=_type(name)) for name in names}
    )


def _type(name: str) -> pa.DataType:
    if name in TEXT:
        return pa.string()
    if name in FLAGS:
        return pa.bool_()
    return pa.list_(pa.float64()) if name == "values" else pa.float64()


def _plain(value: object) -> object:
    """A value as Arrow takes it: settings become JSON."""
    if isinstance(value, Mapping):
        return json.dumps(value)
    if isinstance(value, bool | str | np.ndarray) or value is None:
        return value
    return float(value)  # type: ignore[arg-type]  # all that is left are numbers
