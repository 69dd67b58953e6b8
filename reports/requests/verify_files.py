"""The files of a verification: tables, numbers and findings, a case per cell."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from reports.judge.cell import Checked
from reports.judge.rows import cell_frame, cell_row, error_frame
from reports.output.frame_file import csv, parquet
from reports.output.junit import junit
from reports.output.numbers import finite
from reports.output.write import write
from reports.requests.verify_options import VerifyOptions
from reports.verify.table import suite

if TYPE_CHECKING:  # half a second to import: where there is a run to compare with
    from reports.results.changes.changes import Diff

IN_FOLDER = ("verify.csv", "verify.json", "verify.junit.xml", "errors.parquet")


@dataclass(frozen=True)
class Results:
    """What there is to write: cells, where they come from, the digests of the texts of their
    scenes, and what changed since the baseline."""

    checked: Sequence[Checked]
    facts: Mapping[str, str]
    digests: Mapping[str, str]
    diff: Diff | None = None


def write_results(request: VerifyOptions, results: Results) -> None:
    """Write every output that was asked for, each whole or not at all."""
    folder = request.folder
    *texts, table = IN_FOLDER
    for name, path in zip(texts, (request.csv, request.json, request.junit), strict=True):
        for target in filter(None, (path, folder and folder / name)):
            write(target, _content(name, results))
    if folder:
        write(folder / table, parquet(error_frame(results.checked)))


def _content(name: str, results: Results) -> str:
    """The text of one output."""
    if name.endswith(".csv"):
        return csv(cell_frame(results.checked))
    if name.endswith(".xml"):
        verification = suite(results.checked, results.facts)
        if results.diff is None:
            return junit(verification)
        from reports.diff.junit import suite as diff_suite

        return junit(verification, diff_suite(results.diff))
    return _json(results)


def _json(results: Results) -> str:
    """Facts, digests of scenes, and cells with their findings; what is not finite is null."""
    cells = [
        cell_row(one)
        | {
            "settings": dict(one.settings),
            "not_reported": list(one.errors.not_reported) if one.errors else [],
            "notes": list(one.errors.notes) if one.errors else [],
            "findings": [vars(finding) for finding in one.findings],
        }
        for one in results.checked
    ]
    content = {
        "provenance": dict(results.facts),
        "scenes": dict(results.digests),
        "cells": cells,
    }
    return json.dumps(finite(content), indent=1) + "\n"
