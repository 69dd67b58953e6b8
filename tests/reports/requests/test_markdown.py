"""Answers as Markdown, for a pull request and the summary of a job, and as a page."""

import re
from io import StringIO
from pathlib import Path

import pandas as pd
import pytest
from rich.console import Console
from rich.text import Text

from reports.output.console import grid, hanging
from reports.output.printed import COMMENT, as_markdown, present
from tests.worlds.command_line import crank, crank_alone, flat

VERIFY = ("verify", "fourbar-lecture-1", "--no-convergence", "--turns", 0.5, "--jobs", 1)
SUMMARY = "GITHUB_STEP_SUMMARY"


def rows(markdown: str) -> list[list[str]]:
    """The cells of all rows of tables, without heads and rules."""
    lines = [line for line in markdown.splitlines() if re.match(r"\| [^-]", line)]
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
    return [each for each in cells if each[0] in ("ok", "OUT")]


def test_verify_writes_its_cells_as_markdown_and_as_a_page(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(SUMMARY, str(tmp_path / "summary.md"))
    made = crank_alone(*VERIFY, "--format", "md", "-o", tmp_path / "out")
    assert made.exit_code == 0, made.output
    assert made.stdout.startswith("## crankcheck verify: WITHIN TOLERANCE: all 2 cells")
    cells = pd.read_csv(tmp_path / "out" / "verify.csv")
    marks = {"within": "ok", "out": "OUT"}
    expected = [
        [marks[cell["verdict"]], cell["scene"], cell["engine"], f"{cell['angle_pure']:.1e}"]
        for _, cell in cells.iterrows()
    ]
    assert len(expected) == 4
    assert sorted(row[:4] for row in rows(made.stdout)) == sorted(expected)
    page = (tmp_path / "out" / "verify.html").read_text(encoding="utf-8")
    assert "WITHIN TOLERANCE: all 2 cells (1 scene x 2 engines)" in page
    assert all(f">{number}<" in page for *_, number in expected)
    assert page.count("<svg") == 1
    alone = crank_alone(*VERIFY, "--baseline", tmp_path / "out", "-o", tmp_path / "page.html")
    assert alone.exit_code == 0, alone.output
    assert alone.stdout.startswith("profile tuned")
    assert (tmp_path / "page.html").read_text(encoding="utf-8").startswith("<!doctype html>")
    diff = crank("diff", tmp_path / "out", tmp_path / "out")
    assert diff.exit_code == 0
    heads = re.findall("^## .*", (tmp_path / "summary.md").read_text(encoding="utf-8"), re.M)
    assert [head.split(":")[0] for head in heads] == ["## crankcheck verify"] * 2 + [
        "## crankcheck diff"
    ]


def test_a_summary_that_can_not_be_written_costs_a_line_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv(SUMMARY, str(tmp_path))
    console = Console(file=StringIO())
    present(console, "text", "run", lambda to: to.print("text"))
    assert isinstance(console.file, StringIO)
    assert console.file.getvalue() == "text\n"
    assert "nothing is added to it" in flat(capsys.readouterr().err)


def test_another_format_is_refused_with_those_that_there_are() -> None:
    for command in (VERIFY, ("stability",), ("diff", "a", "b")):
        refusal = crank(*command, "--format", "pdf")
        assert refusal.exit_code == 2
        assert "'pdf' is not one of 'text', 'md'" in flat(refusal.stderr)


def test_printed_parts_mean_themselves_and_those_without_room_are_counted() -> None:
    def show(to: Console) -> None:
        to.print(Text("a *star* and [a link](b)\nnext"), "")
        hanging(to, "  CC1 ", "@all of it")
        to.print(grid(("name", "number:"), [("a|b", "1")], "Title"))

    assert as_markdown("run", show).splitlines() == [
        "## crankcheck run",
        "",
        r"a \*star\* and \[a link\](b)  ",
        "next",
        "",
        "- CC1 @\N{WORD JOINER}all of it",
        "",
        "**Title**",
        "",
        "| name | number |",
        "| --- | --: |",
        r"| a\|b | 1 |",
    ]
    long = as_markdown("run", *[lambda to: to.print(Text("x" * 500))] * 200)
    assert len(long.encode()) < COMMENT + 100
    assert re.search(r"and \d+ more parts", long)
