"""What stands in a scene file, or is its name, stays text wherever it is shown or written."""

import os
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree as Xml

import openpyxl
import pandas as pd
import pytest
from rich.console import Console

from models.errors import CrankcheckError, harmless
from models.files.reading import parse_scene, shipped
from reports.page.build import page as built
from reports.requests.figures import FiguresRequest
from reports.store.reader import read_store
from tests.reports.page.hostile import Outline
from tests.worlds.command_line import crank
from tests.worlds.fuzzing import COMMANDS, attempt
from tests.worlds.scene_files import toml
from tests.worlds.tiers import few

NASTY = (
    "=1+cmd|' /C calc'!A0 </script><script>window.hacked = 1</script><!-- --> -- ]]> <b>&amp; \" ' "
    "[bold red]x[/b] [/] | `code` \\ $\\frac{1}{$ $x^{2}_{ {{ 7 * 7 }} {% if %} %s {0} $HOME @team "
    "javascript:alert(1) \u0645\u0631\u062d\u0628\u0627 \u96e8 \U0001f980 \ue000 a\u0300 --"
)
WORST = (
    "<script>alert(1)<!--", "[bold]", "-o", "\u202egnp", "a\nb", "a\x1b[2Jb",
    os.fsdecode(b"\xff\xfe"), "x" * 240,
)  # fmt: skip
"""Names of files, without the ending: tags, styles, options, and what a terminal obeys."""
NAME = "fourbar-lecture-1"


def nasty_text() -> str:
    lines = shipped()[NAME].read_text(encoding="utf-8").splitlines()
    kept = [line for line in lines if not line.startswith(("source", "note"))]
    return toml({"source": NASTY, "note": f"{NASTY}\n\t{NASTY}"}) + "\n".join(kept)


@pytest.fixture(scope="module")
def scene(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("nasty") / "[bold]<script>&.toml"
    path.write_text(nasty_text(), encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def store(scene: Path) -> Path:
    """A sweep of the nasty scene, into a folder with a nasty name."""
    folder = scene.parent / "[" / "x] <b>"  # reads as the end of a style: [/x]
    steps = ("--steps-per-turn", "90,180", "--turns", 1, "--engine", "mujoco")
    result = crank("sweep", scene, "-o", folder, *steps, "--jobs", 1, "--no-timing")
    assert result.exit_code == 0, result.output
    assert f"stored in {folder}" in result.output.replace("\n", "")
    return folder


@pytest.fixture(scope="module")
def page(store: Path) -> Path:
    path = store.parent / "report.html"
    assert crank("report", store, "-o", path).exit_code == 0
    return path


def test_the_model_is_xml_that_compiles_and_tells_the_source(scene: Path) -> None:
    mujoco = pytest.importorskip("mujoco")
    text = crank("export", scene).output
    root = Xml.fromstring(text, Xml.XMLParser(target=Xml.TreeBuilder(insert_comments=True)))
    source = next(child.text for child in root if child.tag is Xml.Comment)
    assert source.strip().replace("- -", "--") == NASTY
    names = {element.tag for element in root.iter() if isinstance(element.tag, str)}
    assert not names & {"script", "b"}
    mujoco.MjModel.from_xml_string(text)


def test_a_verification_says_and_writes_text(scene: Path, tmp_path: Path) -> None:
    limit = ("--tol", "angle=1e-12")
    assert crank("verify", scene, "--turns", "0.2", "-o", tmp_path, *limit).exit_code == 1
    Xml.parse(tmp_path / "verify.junit.xml")
    cells = pd.read_csv(tmp_path / "verify.csv", dtype=str, keep_default_na=False)
    numbers = pd.to_numeric(cells.stack(), errors="coerce")
    for cell in cells.stack()[numbers.isna()]:
        assert not cell.startswith(("=", "+", "-", "@", "\t", "\r"))


def test_a_workbook_of_the_motion_holds_no_formula_of_the_file(scene: Path, tmp_path: Path) -> None:
    (tmp_path / "[").mkdir()
    path = tmp_path / "[" / "b].xlsx"
    result = crank("solve", scene, "--steps-per-turn", 36, "-o", path)
    assert f"{path}: 37 samples" in result.output.replace("\n", "")
    book = openpyxl.load_workbook(path)
    rows = (row for name in ("motion", "source") for row in book[name])
    assert {cell.data_type for row in rows for cell in row} == {"s", "n"}
    own = [cell.value for row in book["live"] for cell in row if cell.data_type == "f"]
    assert own
    assert not any(NASTY in formula for formula in own)
    assert NASTY in [cell.value for cell in book["source"]["B"]]


def test_every_output_shows_the_source_as_text(scene: Path, store: Path, page: Path) -> None:
    assert "".join(NASTY.split()) in "".join(crank("solve", scene).output.split())
    found = Outline(page.read_text(encoding="utf-8"))
    assert " ".join(NASTY.split()) in " ".join(found.text.split())
    assert "49" not in found.text.partition("{{ 7")[2][:20]
    assert not [name for _, each in found.elements for name in each if name.startswith("on")]
    stored = read_store(store)
    scenes = {NAME: shipped()[NAME].read_text(encoding="utf-8")}
    plain = Outline(built(replace(stored, manifest=replace(stored.manifest, scenes=scenes))))
    assert [tag for tag, _ in found.elements] == [tag for tag, _ in plain.elements]
    summary = crank("report", store, "--format", "md").output
    assert "<script" not in summary
    assert "hacked" not in summary  # only names and reasons are told


def test_figures_are_drawn_with_the_source_as_text(store: Path, tmp_path: Path) -> None:
    FiguresRequest(store, tmp_path, only=["mechanism"], format="svg").run(
        Console(quiet=True), Console()
    )
    root = Xml.parse(tmp_path / f"mechanism-{NAME}.svg").getroot()
    assert not [each for each in root.iter() if str(each.tag).endswith("script")]
    shown = " ".join("".join(text.itertext()) for text in root.iter() if text.text)
    assert "</script><script>window.hacked" in shown.replace("\n", "")


def test_a_name_in_a_store_does_not_leave_the_folder_of_figures(
    store: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    stored = read_store(store)
    away = replace(stored, cells=stored.cells.assign(scene="../../escaped"))
    monkeypatch.setattr("reports.requests.figures.read_store", lambda _: away)
    with pytest.raises(
        CrankcheckError, match=r"'\.\./\.\./escaped' of the store: not a valid name"
    ):
        FiguresRequest(store, tmp_path / "a" / "figs").run(Console(quiet=True), Console())
    assert list(tmp_path.rglob("*escaped*")) == []


@pytest.mark.parametrize("name", few(WORST, WORST[::2], "other text that acts"), ids=ascii)
def test_the_name_of_a_file_is_text(name: str) -> None:
    good, bad = nasty_text().encode(), b"[links\n"
    for command in dict.fromkeys(COMMANDS):
        if command.startswith(("export", "solve FILE --at-deg 90")):
            ended = attempt(good, *command.split(), name=f"{name}.toml")
            assert (ended.code, ended.faults) == (0, []), ended.errors
    ended = attempt(bad, "verify", "FILE", name=f"{name}.toml")
    assert (ended.code, ended.faults) == (2, [])
    first = f"crankcheck: ../{harmless(name)}.toml: not valid TOML".replace("\n", "\\n")
    assert ended.errors.startswith(first)


@pytest.mark.parametrize("name", WORST, ids=ascii)
def test_a_missing_name_is_text(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    result = crank("solve", f"./no/{name}.toml")
    assert result.exit_code == 2
    assert result.stderr.isascii() or result.stderr.replace("\n", "").isprintable()
    assert len(result.stderr.splitlines()) == 1


@pytest.mark.parametrize("acting", ["\u202e", "\u2066", "\x1b", "\x9b", "\x07", "\u2028", "\uffff"])
@pytest.mark.parametrize("key", ["source", "note"])
def test_text_that_acts_is_refused(key: str, acting: str) -> None:
    text = nasty_text().replace(f'{key} = "=1', f'{key} = "\\u{ord(acting):04x}=1', 1)
    with pytest.raises(CrankcheckError, match=f"{key}: found .*; text without control characters"):
        parse_scene(text, "file.toml")
