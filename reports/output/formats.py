"""Formats of results: tables as CSV, Parquet or workbook, JUnit XML, and Markdown that fits into a
comment."""

from __future__ import annotations

import io
import json
import math
import re
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree as Xml

from reports.output.numbers import finite
from reports.output.write import clean, crankcheck_version, write

if TYPE_CHECKING:
    import pandas as pd  # a third of a second: for files alone


def junit(*suites: Xml.Element) -> str:
    """Return the text of a file of these suites."""
    root = Xml.Element("testsuites")
    root.extend(suites)
    Xml.indent(root)
    return f'<?xml version="1.0" encoding="utf-8"?>\n{Xml.tostring(root, "unicode")}\n'


def suite_of(
    name: str,
    cases: Sequence[Xml.Element],
    facts: Mapping[str, str],
    time: str = "0",
    **attributes: str,
) -> Xml.Element:
    """Return cases with their counts, and their provenance."""
    count = Counter(told.tag for case in cases for told in case)
    heads = {
        "name": f"crankcheck {name}",
        "tests": str(len(cases)),
        "failures": str(count["failure"]),
        "errors": str(count["error"]),
        "time": time,
        "skipped": str(count["skipped"]),
    }
    suite = Xml.Element("testsuite", heads | attributes)
    properties = Xml.SubElement(suite, "properties")
    for fact, value in facts.items():
        Xml.SubElement(properties, "property", name=clean(fact), value=clean(value))
    suite.extend(cases)
    return suite


def case_of(group: str, name: str, time: str = "0") -> Xml.Element:
    """Return a cell; `remark` adds its outcome, and nothing for a good one."""
    heads = {"classname": f"crankcheck.{group}", "name": name, "time": time}
    return Xml.Element("testcase", {head: clean(value) for head, value in heads.items()})


def remark(case: Xml.Element, tag: str, text: str = "", **attributes: str) -> None:
    """Add a ``failure``, ``error``, ``skipped`` or ``system-out`` to a case."""
    cleaned = {name: clean(value) for name, value in attributes.items()}
    Xml.SubElement(case, tag, cleaned).text = clean(text)


SPECIAL = re.compile(r"([\\`*_\[\]<>|~#&$])")
"""Characters that would start a cell, tag, link, reference, entity, formula or emphasis."""
JOINER = "\N{WORD JOINER}"
LONGEST = 600
"""Characters of a cell: a reason may hold the whole output of an engine."""


def plain(text: object) -> str:
    """Return a text that means itself, on one line; it notifies nobody either."""
    words = " ".join(str(text).split())
    words = words if len(words) <= LONGEST else words[: LONGEST - 1] + "…"
    return SPECIAL.sub(r"\\\1", words).replace("@", f"@{JOINER}")


def table(
    heads: Sequence[str],
    rows: Iterable[Sequence[object]],
    room: float = math.inf,
    what: str = "",
) -> str:
    """Return a table whose cells mean themselves, in ``room`` bytes; rows beyond are counted below.

    A head that ends in a colon is over numbers, on the right. ``what`` names the counted rows.
    """
    rules = ["--:" if head.endswith(":") else "---" for head in heads]
    lines = [_row(head.removesuffix(":").replace("\n", " ") for head in heads), _row(rules)]
    body = (_row(plain(cell) for cell in row) for row in rows)
    return "\n".join([*lines, *counted(body, room - 200, what)])


def counted(texts: Iterable[str], room: float, what: str = "") -> list[str]:
    """Return the first texts that fit ``room`` bytes together, then the number of the others."""
    kept, left = fitted(texts, room)
    return [*kept, f"\nand {left} more {what}".rstrip()] if left else kept


def fitted(texts: Iterable[str], room: float) -> tuple[list[str], int]:
    """Return the first texts that fit ``room`` bytes together, and the number of the others."""
    kept: list[str] = []
    left = 0
    for text in texts:
        room -= len(text.encode()) + 1
        if room >= 0 and not left:
            kept.append(text)
        else:
            left += 1
    return kept, left


def folded(title: str, body: str) -> str:
    """Return a body that is shown on a click; the empty lines make it Markdown inside of HTML."""
    return f"<details><summary>{_inside_html(title)}</summary>\n\n{body}\n\n</details>"


def code(text: str, language: str) -> str:
    """Return a block of code; its fence is longer than any in it."""
    runs = [len(run) for run in re.findall("`+", text)]
    fence = "`" * max(3, 1 + max(runs, default=0))
    return f"{fence}{language}\n{text.rstrip()}\n{fence}"


def _row(cells: Iterable[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _inside_html(text: str) -> str:
    return escape(" ".join(text.split()), quote=False).replace("@", f"@{JOINER}")


ENDINGS = (".csv", ".parquet", ".xlsx")
SHEET_ROWS = 1_048_575
"""Rows of a sheet below its head."""


def write_frame(
    path: Path,
    frame: pd.DataFrame,
    sheet: str,
    origin: Mapping[str, str],
    more: Callable[[Any], None] | None = None,
) -> None:
    """Write a table whole, or not at all.

    A workbook has it in ``sheet``, beside it its origin, and the additions of ``more`` to the
    openpyxl workbook; the other kinds have no room. Raises CrankcheckError where the system
    refuses.
    """
    ending = path.suffix.lower()
    if ending == ".csv":
        write(path, csv(frame))
    elif ending == ".parquet":
        write(path, parquet(frame))
    else:
        write(path, workbook(frame, sheet, origin, more))


def json_text(content: Mapping[str, object]) -> str:
    """Return the text of a JSON file; numbers that are not finite are null."""
    return json.dumps(finite(content), indent=1) + "\n"


def csv(frame: pd.DataFrame) -> str:
    """Return the text of a CSV file that holds the frame, without its index."""
    return frame.to_csv(index=False, lineterminator="\n")


def parquet(frame: pd.DataFrame) -> bytes:
    """Return the content of a Parquet file that holds the frame, without its index."""
    buffer = io.BytesIO()
    frame.attrs |= {"written by": "crankcheck"}  # as its metadata
    frame.to_parquet(buffer, index=False)
    return buffer.getvalue()


def workbook(
    frame: pd.DataFrame,
    sheet: str,
    origin: Mapping[str, str],
    more: Callable[[Any], None] | None = None,
) -> bytes:
    """Return the content of a workbook: the frame, its origin, and the additions of ``more``."""
    facts = {**origin, "crankcheck": crankcheck_version()}
    buffer = io.BytesIO()
    import pandas as pd

    with pd.ExcelWriter(buffer, engine="openpyxl") as book:
        book.book.properties.creator = "crankcheck"
        shown = frame.rename(columns=clean)
        shown.to_excel(book, sheet_name=sheet, index=False, freeze_panes=(1, 1))
        about = pd.DataFrame({"what": list(facts), "value": [clean(v) for v in facts.values()]})
        about.to_excel(book, sheet_name="source", index=False)
        for row in book.sheets[sheet].iter_rows(min_row=2):
            for cell in row:
                if isinstance(cell.value, float):
                    # openpyxl would leave out the 17th digit; the kind stays that of a number.
                    cell._value = repr(float(cell.value))
        for row in book.sheets["source"].iter_rows():
            for cell in row:
                cell.data_type = "s"  # a text that begins with "=" is no formula
        if more is not None:
            more(book.book)
    return buffer.getvalue()
