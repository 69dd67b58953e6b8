"""Examples are run page by page, and the figures that they draw stand where they are shown."""

from __future__ import annotations

from pathlib import Path

from docs.site.examples import run_examples, with_figures

DRAWS = """```console
$ python -c "import pathlib; pathlib.Path('a.svg').write_text('{}')"
```

![What is drawn](a.svg)
"""
OTHERWISE = """```console
$ python -c "print(1)"
2
```
"""


def test_pages_that_draw_one_name_show_each_its_own(tmp_path: Path) -> None:
    pages = {"t/one.md": DRAWS.format("first"), "t/two.md": DRAWS.format("second"), "x.md": "# X"}
    runs, site = tmp_path / "runs", tmp_path / "site"
    assert run_examples(pages, runs) == {}
    for place, page in pages.items():
        text, missing = with_figures(place, page, runs, site)
        stem = Path(place).stem
        assert missing == []
        shown = f"[![What is drawn]({stem}/a.svg)]({stem}/a.svg)"
        assert text == page.replace("![What is drawn](a.svg)", shown)
    assert (site / "t" / "one" / "a.svg").read_text() == "first"
    assert (site / "t" / "two" / "a.svg").read_text() == "second"


def test_a_page_that_shows_otherwise_is_named_with_the_command(tmp_path: Path) -> None:
    (place, fault), *rest = run_examples({"o.md": OTHERWISE}, tmp_path).items()
    assert (place, rest) == ("o.md", [])
    assert '$ python -c "print(1)"' in fault
    assert "the page says\n  2\nwhat is printed\n  1" in fault


def test_a_program_that_is_not_there_is_named(tmp_path: Path) -> None:
    page = OTHERWISE.replace("$ python -c", "$ no-such-program")
    (fault,) = run_examples({"o.md": page}, tmp_path).values()
    assert "needs no-such-program, which this machine has not" in fault


def test_a_figure_that_no_command_draws_is_told(tmp_path: Path) -> None:
    _, missing = with_figures("o.md", "![Nothing](none.svg)", tmp_path, tmp_path / "site")
    assert missing == ["none.svg"]


def test_without_examples_something_stands_in_for_figures(tmp_path: Path) -> None:
    text, missing = with_figures("o.md", "![Later](a/b.svg) `![](c.svg)`", None, tmp_path)
    assert (text, missing) == ("[![Later](o/a/b.svg)](o/a/b.svg) `![](c.svg)`", [])
    assert "drawn by" in (tmp_path / "o" / "a" / "b.svg").read_text()
