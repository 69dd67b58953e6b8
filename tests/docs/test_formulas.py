"""Formulas become MathML; what is none, or is code, stays."""

from __future__ import annotations

import pytest
from markdown import Markdown

from docs.site.formulas import FormulaError, fault_of, mathml
from docs.site.staging import sources


def html(page: str) -> str:
    return Markdown(extensions=["tables", "pymdownx.superfences", "docs.site.formulas"]).convert(
        page
    )


def test_formulas_stand_in_lines_tables_and_by_themselves() -> None:
    made = html("Of $\\omega_1 * 2$ *and*\n\n| $a_b$ | $c_d$ |\n|---|---|\n\n$$\nx = 1\n$$\n")
    assert made.count('display="inline"') == 3
    assert made.count('<span class="formula"><math') == made.count('display="block"') == 1
    assert "<em>and</em>" in made
    assert "$" not in made


@pytest.mark.parametrize("page", ["`$x$`", "```text\n$x$\n```", "it costs $5 and $6", r"\$x\$"])
def test_what_is_no_formula_stays(page: str) -> None:
    made = html(page)
    assert "<math" not in made
    assert "$" in made


def test_aligned_equations_are_a_table() -> None:
    made = mathml(r"\begin{aligned} a &= b \\ c_x &= d_y \end{aligned}")
    assert made.count("<mtr>") == 2
    assert "&</mi>" not in made


def test_a_length_is_overlined_from_end_to_end() -> None:
    made = mathml(r"\overline{pb} = k\,\overline{AB}")
    assert made.count('<mrow class="overlined"><mrow><mi>') == 2
    assert "mover" not in made


@pytest.mark.parametrize(
    "latex", [r"\nonsense x", r"\begin{gathered} a \\ b \end{gathered}", "a & b"]
)
def test_what_there_is_no_mathml_for_is_refused(latex: str) -> None:
    with pytest.raises(FormulaError, match="no MathML for"):
        mathml(latex)


def test_every_formula_of_every_page_has_mathml() -> None:
    faults = {path: fault_of(page) for path, page in sources().text.items()}
    assert not {path: fault for path, fault in faults.items() if fault}


def test_a_formula_without_mathml_is_named() -> None:
    assert fault_of("# A\n\nso $x$ and\n\n$$\\nonsense$$\n").endswith(r"\nonsense in $\nonsense$")
    assert fault_of("# A\n\nso $x$ and `$\\nonsense$`\n") == ""
