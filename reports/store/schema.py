"""The tables of a store, and what stands in their columns."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from functools import cache

import numpy as np
import pyarrow as pa  # type: ignore[import-untyped]  # ships no stubs

FORMAT = 1
"""Raised when a store is laid out in a way that an older reader would take for something else."""
TABLES = ("cells", "errors", "traces", "timings")
"""A part of ``cells`` is written last of its name: what has none was cut short."""
PART = re.compile(r"part-\d{20}-\d+-\d+\.parquet")
"""The name of a part, by which it is told from what others put there: time [ns], process, count."""
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
TEXTS = ("string", "large_string")
FLAGS = {"gated"}
NEEDED: Mapping[str, tuple[str, ...]] = {
    "cells": (
        *("key", "line", "variant", "asked", "scene", "engine", "version", "profile", "drive"),
        *("dt_s", "steps_per_turn", "turns", "gated", "verdict", "status", "reason"),
        *("failed_rules", "settings", "stopped_at_s", "logged_us_per_step"),
        *("place_pure", "drive_pure", "gap_pure", "velocity_pure"),
    ),
    "errors": ("key", "quantity", "body_kind", "body", "source", "kind", "maximum_pure"),
    "traces": ("key", "series", "values"),
    "timings": ("key", "us_per_step"),
}
"""The columns that readers take for granted: a table without them is another table."""


def table(rows: Sequence[Mapping[str, object]]) -> pa.Table:
    """Rows, all with the same names, as a table whose types do not depend on what is missing.

    Columns are text, flags, lists of numbers (``values``), or numbers; what is not there is null.
    """
    names = list(rows[0])
    return pa.table(
        {name: pa.array([_plain(row[name]) for row in rows], type=_type(name)) for name in names}
    )


def typed(found: pa.Table, name: str) -> pa.Table:
    """A table that was read, with the types of its columns as they are written.

    Raises
    ------
    ValueError
        Not the table ``name``: a needed column is not there, or holds something else.
    """
    wanted = _wanted(tuple((one.name, str(one.type)) for one in found.schema), name)
    if not found.schema.equals(wanted):
        found = found.cast(wanted)
    if found.column("key").null_count:
        raise ValueError("rows without a key")
    return found


@cache
def _wanted(found: tuple[tuple[str, str], ...], table: str) -> pa.Schema:
    """The types that the columns of a table that was read should have, by name and found type."""
    lacking = [column for column in NEEDED[table] if column not in dict(found)]
    if lacking:
        raise ValueError(f"no column {lacking[0]}")
    # What another version of crankcheck adds may be text, and hurts nobody.
    more = {name for name, kind in found if kind in TEXTS and name not in NEEDED[table]}
    return pa.schema([(name, pa.string() if name in more else _type(name)) for name, _ in found])


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
