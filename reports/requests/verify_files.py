"""The files of a verification: tables, numbers and findings, a case per cell."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING
from xml.etree.ElementTree import Element

from reports.judge.cell import Checked
from reports.judge.frames import cell_frame, error_frame
from reports.judge.rows import cell_row
from reports.output.frame_file import csv, parquet
from reports.output.junit import junit
from reports.output.numbers import finite
from reports.verify.junit import suite

if TYPE_CHECKING:  # half a second to import: where there is a run to compare with
    from reports.results.changes.changes import Diff

IN_FOLDER = {
    "verify.csv": "--csv",
    "verify.json": "--json",
    "verify.junit.xml": "--junit",
    "errors.parquet": "",
}


def contents(
    checked: Sequence[Checked],
    facts: Mapping[str, str],
    digests: Mapping[str, str],
    diff: Diff | None,
) -> dict[str, Callable[[], bytes | str]]:
    """What there is to write: of cells, where they come from, the digests of the texts of their
    scenes, and what changed since the baseline."""
    return {
        "verify.csv": lambda: csv(cell_frame(checked)),
        "verify.json": lambda: _json(checked, facts, digests),
        "verify.junit.xml": lambda: junit(suite(checked, facts), *_changes(diff)),
        "errors.parquet": lambda: parquet(error_frame(checked)),
    }


def _changes(diff: Diff | None) -> Iterator[Element]:
    """The suite of what changed, if that is known."""
    if diff is not None:
        from reports.diff.junit import suite as diff_suite

        yield diff_suite(diff)


def _json(checked: Sequence[Checked], facts: Mapping[str, str], digests: Mapping[str, str]) -> str:
    """Facts, digests of scenes, and cells with their findings; what is not finite is null."""
    cells = [
        cell_row(one)
        | {
            "settings": dict(one.settings),
            "not_reported": list(one.errors.not_reported) if one.errors else [],
            "notes": list(one.errors.notes) if one.errors else [],
            "findings": [vars(finding) for finding in one.findings],
        }
        for one in checked
    ]
    content = {
        "provenance": dict(facts),
        "scenes": dict(digests),
        "cells": cells,
    }
    return json.dumps(finite(content), indent=1) + "\n"
