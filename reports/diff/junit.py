"""A diff as JUnit XML."""

from __future__ import annotations

from collections.abc import Sequence
from xml.etree.ElementTree import Element

from reports.diff.words import ratio, size, told
from reports.output.junit import case_of, remark, suite_of
from reports.results.changes.changes import CellPair, Diff
from reports.results.changes.runs import CellName, StoredCell


def suite(diff: Diff, strict: bool = False) -> Element:
    """One test case per cell of either run: a failure where it is worse, skipped where there is
    nothing to compare it with; ``strict`` makes failures of those but the new ones."""
    lost = "failure" if strict else "skipped"
    cases = [
        *map(_compared, diff.pairs),
        *_uncompared(diff.missing, lost, "missing: only the old run has it"),
        *_uncompared(diff.other_scene, lost, "the scene changed in between"),
        *_uncompared(diff.added, "skipped", "new: only the new run has it"),
    ]
    facts = {
        f"{side} {name}": value
        for side, run in (("old", diff.old), ("new", diff.new))
        for name, value in {"run": run.label, **run.facts}.items()
    }
    return suite_of("diff", cases, facts)


def _compared(pair: CellPair) -> Element:
    """A cell of both runs."""
    case = _case(pair.name)
    if pair.word == "worse":
        versions = f"{pair.name.engine} {pair.old.version} -> {pair.new.version}"
        rows = [
            f"{change.quantity}: {size(change.old)} -> {size(change.new)}, ratio {ratio(change)}"
            f" ({change.word(pair.factor)})"
            for change in pair.changes
        ]
        kind = "status" if pair.turned else "error"
        message = f"{pair.name.label}: {told(pair)}"
        remark(case, "failure", "\n".join([versions, *rows]), message=message, type=kind)
    elif pair.word == "better":
        remark(case, "system-out", f"better: {told(pair)}")
    return case


def _uncompared(cells: Sequence[StoredCell], tag: str, why: str) -> list[Element]:
    """Cells that there is nothing to compare with."""
    cases = [_case(cell.name) for cell in cells]
    for case in cases:
        remark(case, tag, message=why)
    return cases


def _case(name: CellName) -> Element:
    return case_of(f"diff.{name.engine}.{name.variant}", name.label)
