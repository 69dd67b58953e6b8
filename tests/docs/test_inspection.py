"""Each kind of fault of a built site is seen."""

from __future__ import annotations

from pathlib import Path

import pytest

from docs.site.inspection import faults_of_site

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


def test_a_good_site_has_no_faults(site: Path) -> None:
    assert list(faults_of_site(site)) == []


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
    (site / "b" / "two.html").write_text(f'<p id="there">\n{tag.replace("../", "../../")}')
    (site / "one.html").write_text(f"{GOOD}\n{tag}")
    assert f"one.html:3: {fault}" in "\n".join(faults_of_site(site))
