"""A manifest that is lost, as far as the cells tell what stood in it."""

from __future__ import annotations

from collections.abc import Mapping

import pyarrow as pa  # type: ignore[import-untyped]  # ships no stubs

from models.files import read_text, shipped
from reports.plan.key import digest
from reports.store.manifest import Manifest

NOTE = (
    "the manifest was lost; names, versions and the texts of shipped scenes were taken from the "
    "cells, and the command and the study are not known"
)


def rebuilt(cells: pa.Table | None, timings: pa.Table | None) -> Manifest:
    """One run that knows what the cells know: how their lines are called, and the versions.

    The text of a scene is found again where it is a shipped one, unchanged since.
    """
    rows = _rows(cells, ("line", "variant", "profile", "gated"))
    facts = {str(row["engine"]): str(row["version"]) for row in _rows(cells, ("engine", "version"))}
    for table, column in ((cells, "crankcheck"), (timings, "processor"), (timings, "made")):
        known = [str(row[column]) for row in _rows(table, (column,)) if row[column]]
        if known:
            facts[column] = known[-1]
    run = {
        "command": [],
        "started": facts.get("made", ""),
        "study": {},
        "provenance": {**facts, "note": NOTE},
        "lines": {row["line"]: [row["variant"], row["profile"], row["gated"]] for row in rows},
    }
    return Manifest(_texts(digests(cells)), (run,))


def digests(cells: pa.Table | None) -> dict[str, set[str]]:
    """The hashes of the texts of the scenes that there are cells of, by name."""
    found: dict[str, set[str]] = {}
    for row in _rows(cells, ("scene", "scene_digest")):
        if row["scene_digest"]:
            found.setdefault(str(row["scene"]), set()).add(str(row["scene_digest"]))
    return found


def _texts(known: Mapping[str, set[str]]) -> dict[str, str]:
    """The texts of shipped scenes that the cells are of."""
    paths = shipped()
    texts = {name: read_text(paths[name]) for name in known if name in paths}
    return {name: text for name, text in texts.items() if digest(text) in known[name]}


def _rows(table: pa.Table | None, columns: tuple[str, ...]) -> list[dict[str, object]]:
    """Some columns of a table; none of a table that lacks one of them."""
    if table is None or not set(columns) <= set(table.column_names):
        return []
    return list(table.select(columns).to_pylist())
