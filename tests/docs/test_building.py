"""Examples are run page by page, and figures stand where they are shown; formulas become MathML,
and what is none, or is code, stays; each kind of fault of a built site is seen."""

import sys
from pathlib import Path

import pytest
from markdown import Markdown

from docs.site import __main__ as command
from docs.site.examples import run_examples, with_figures
from docs.site.formulas import FormulaError, fault_of, mathml
from docs.site.inspection import faults_of_site
from docs.site.staging import sources

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


def test_a_page_that_shows_otherwise_or_needs_what_is_not_there_is_named(tmp_path: Path) -> None:
    ((place, fault),) = run_examples({"o.md": OTHERWISE}, tmp_path).items()
    assert place == "o.md"
    assert '$ python -c "print(1)"' in fault
    assert "the page says\n  2\nwhat is printed\n  1" in fault
    page = OTHERWISE.replace("$ python -c", "$ no-such-program")
    (fault,) = run_examples({"o.md": page}, tmp_path).values()
    assert "needs no-such-program, which this machine has not" in fault


def test_a_figure_that_no_command_draws_is_told_or_has_a_stand_in(tmp_path: Path) -> None:
    _, missing = with_figures("o.md", "![Nothing](none.svg)", tmp_path, tmp_path / "site")
    assert missing == ["none.svg"]
    text, missing = with_figures("o.md", "![Later](a/b.svg) `![](c.svg)`", None, tmp_path)
    assert (text, missing) == ("[![Later](o/a/b.svg)](o/a/b.svg) `![](c.svg)`", [])
    assert "drawn by" in (tmp_path / "o" / "a" / "b.svg").read_text()


def html(page: str) -> str:
    extensions = ["tables", "pymdownx.superfences", "docs.site.formulas"]
    return Markdown(extensions=extensions).convert(page)


def test_formulas_stand_in_lines_tables_and_by_themselves_and_what_is_none_stays() -> None:
    made = html("Of $\\omega_1 * 2$ *and*\n\n| $a_b$ | $c_d$ |\n|---|---|\n\n$$\nx = 1\n$$\n")
    assert made.count('display="inline"') == 3
    assert made.count('<span class="formula"><math') == made.count('display="block"') == 1
    assert "<em>and</em>" in made
    assert "$" not in made
    for page in ("`$x$`", "```text\n$x$\n```", "it costs $5 and $6", r"\$x\$"):
        assert "<math" not in html(page)
        assert "$" in html(page)


def test_equations_are_a_table_a_length_is_overlined_and_what_has_no_mathml_is_refused() -> None:
    made = mathml(r"\begin{aligned} a &= b \\ c_x &= d_y \end{aligned}")
    assert made.count("<mtr>") == 2
    assert "&</mi>" not in made
    made = mathml(r"\overline{pb} = k\,\overline{AB}")
    assert made.count('<mrow class="overlined"><mrow><mi>') == 2
    assert "mover" not in made
    for latex in (r"\nonsense x", r"\begin{gathered} a \\ b \end{gathered}", "a & b"):
        with pytest.raises(FormulaError, match="no MathML for"):
            mathml(latex)


def test_every_formula_of_every_page_has_mathml_and_one_without_is_named() -> None:
    faults = {path: fault_of(page) for path, page in sources().items()}
    assert not {path: fault for path, fault in faults.items() if fault}
    assert fault_of("# A\n\nso $x$ and\n\n$$\\nonsense$$\n").endswith(r"\nonsense in $\nonsense$")
    assert fault_of("# A\n\nso $x$ and `$\\nonsense$`\n") == ""


GOOD = """<h1 id="here">x</h1><a href="#here"></a><a href="b/two.html#there"></a><a href="b/"></a>
<img src="b/p%20q.svg"><img src="data:image/png;base64,"><a href="https://example.org">x</a>"""


@pytest.fixture
def site(tmp_path: Path) -> Path:
    (tmp_path / "b").mkdir()
    (tmp_path / "b" / "p q.svg").touch()
    (tmp_path / "b" / "index.html").touch()
    (tmp_path / "b" / "two.html").write_text('<p id="there"><a href="../one.html#here">y</a>')
    (tmp_path / "one.html").write_text(GOOD)
    return tmp_path


@pytest.mark.parametrize(
    ("tag", "fault"),
    [
        ('<a href="three.html">', "three.html: is not there"),
        ('<a href="../outside.html">', "../outside.html: is not there"),
        ('<a href="b/two.html#none">', "b/two.html#none: has no such anchor"),
        ('<img src="p.svg">', "p.svg: is not there"),
        ('<autoref identifier="analytic.none">', "#analytic.none: has no such anchor"),
        ('<script src="https://unpkg.com/x">', "https://unpkg.com/x: would be fetched"),
        ('<link href="//fonts.example/x.css">', "//fonts.example/x.css: would be fetched"),
    ],
)
def test_a_fault_is_told_with_its_page_and_line(site: Path, tag: str, fault: str) -> None:
    assert list(faults_of_site(site)) == []
    (site / "b" / "two.html").write_text(f'<p id="there">\n{tag.replace("../", "../../")}')
    (site / "one.html").write_text(f"{GOOD}\n{tag}")
    assert f"one.html:3: {fault}" in "\n".join(faults_of_site(site))


def test_faults_end_the_command_with_1(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """By a formula, which is looked at before all else."""
    monkeypatch.setattr("docs.site.building.pages", lambda: {"a.md": r"# A $\nonsense$"})
    monkeypatch.setattr(sys, "argv", ["site", "-o", str(tmp_path / "out")])
    assert command.main() == 1
    complaint = capsys.readouterr().err
    assert complaint.startswith("a.md\nno MathML for \\nonsense")
    assert not (tmp_path / "out").exists()
