"""`python -m docs.site.engine_numbers DIR`: write what was measured into the pages of the engines.

DIR is the folder of `make engines`. Each page in docs/engines has a place for it between two
comments; the page of all engines gets their table.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

from docs.site.staging import ROOT
from reports.output.formats import table
from reports.page.sections.engines import COLUMNS, JUDGED, complete, in_markdown
from reports.page.sections.section import PageReport
from reports.results.engine_table import EngineRow
from reports.results.overview import made, versions
from reports.stability.matrix import Matrix, read_matrix
from reports.store.reader import read_store
from sim.registry import engine

BEGIN, END = "<!-- measured -->", "<!-- /measured -->"
ROOM = 20_000


def main(folder: Path) -> None:
    """Write all pages that have a place."""
    report = PageReport(read_store(folder), read_matrix(folder))
    origin = (
        f"Written by `make engines` and `python -m docs.site.engine_numbers`: "
        f"{versions(report, report.lines)}; {made(report, True)}."
    )
    texts = {"index": "\n\n".join([*in_markdown(report, ROOM), origin])}
    for row in complete(report):
        texts[row.engine] = "\n\n".join([*_of_engine(row, report.matrix), origin])
    for name, text in texts.items():
        page = ROOT / "docs" / "engines" / f"{name}.md"
        if page.is_file():
            head, _, rest = page.read_text(encoding="utf-8").partition(BEGIN)
            tail = rest.partition(END)[2]
            page.write_text(f"{head}{BEGIN}\n\n{text}\n\n{END}{tail}", encoding="utf-8")


def _of_engine(row: EngineRow, matrix: Matrix | None) -> Iterator[str]:
    """Yield the scores of an engine, the hard cases that it loses, and its settings."""
    scores = [
        (f"{group}: {head}", row.scores[name].number, row.scores[name].remark)
        for group, own in COLUMNS.items()
        for name, head in own.items()
    ]
    yield table(("profile tuned", row.version, ""), scores, ROOM, "numbers")
    lost = [
        (one.case, one.words)
        for one in (matrix.critical if matrix else ())
        if one.engine == row.engine and one.profile == JUDGED and one.fails == one.fails
    ]
    if lost:
        yield "Hard cases that it does not hold throughout (`crankcheck stability CASE`):"
        yield table(("case", "result"), lost, ROOM, "cases")
    profiles = engine(row.engine).profiles
    settings = [
        (name, *(str(one.settings[name].value) for one in profiles.values()), own.reason)
        for name, own in profiles[JUDGED].settings.items()
    ]
    yield "Settings, with the reason of profile tuned:"
    yield table(("setting", *profiles, "reason"), settings, ROOM, "settings")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
