"""The files of `crankcheck figures`: whole, labelled, and the same on any day."""

from __future__ import annotations

import io
import re
import xml.etree.ElementTree as ET
from collections.abc import Callable
from pathlib import Path

import pytest
from rich.console import Console

from models.errors import CrankcheckError
from reports.cli.commands.figures import run_figures
from tests.worlds.small_store import SCENES
from tests.worlds.tiers import slow

OF_SCENES = ("work-precision", "convergence", "split", "mechanism")
EACH = {f"{name}-{scene}" for name in OF_SCENES for scene in SCENES}
ALL = EACH | {"work-precision", "convergence", "profile"}
LABELS = {
    "work-precision": ("time per simulated turn [s]", "largest error: angle [rad], place / L [-]"),
    "convergence": ("steps per turn", "largest error: angle [rad], place / L [-]"),
    "convergence-": ("time step [s]", ": order 1.0"),
    "split": ("angle of crank [deg]", "[10⁻³ rad]", "drive", "closure", "floor", "discretisation"),
    "mechanism": ("x [m]", "y [m]", "A", "crank"),
    "profile": ("time over that of the fastest [-]", "share of the scenes [%]", "error up to 10⁻²"),
}


@pytest.fixture(scope="module")
def drawn(store: Path, as_svg: Callable[[Path], Path]) -> Path:
    return as_svg(store)


@pytest.fixture(scope="module")
def chosen(store: Path, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    """The figure of one scene, as SVG and PDF, and what is said of it."""
    folder, said = tmp_path_factory.mktemp("chosen"), io.StringIO()
    run_figures(store, folder, Console(file=said), [SCENES[1]], ["mechanism"])
    return folder, said.getvalue()


def texts(path: Path) -> str:
    """What can be read in an SVG."""
    root = ET.fromstring(path.read_bytes())
    return "\n".join("".join(t.itertext()) for t in root.iter("{http://www.w3.org/2000/svg}text"))


def test_there_is_an_svg_of_each(drawn: Path) -> None:
    assert {path.name for path in drawn.iterdir()} == {f"{name}.svg" for name in ALL}


@slow("a PDF takes a third of a second: one of them is read by the other tests")
def test_there_is_a_pdf_of_each_with_its_fonts(store: Path, tmp_path: Path) -> None:
    run_figures(store, tmp_path, Console(file=io.StringIO()))
    names = {path.name for path in tmp_path.iterdir()}
    assert names == {f"{name}.{kind}" for name in ALL for kind in ("svg", "pdf")}
    for path in tmp_path.glob("*.pdf"):
        has_fonts(path)


@pytest.mark.parametrize("name", LABELS)
def test_axes_are_labelled_with_units_and_words_can_be_read(drawn: Path, name: str) -> None:
    for path in drawn.glob(f"{name}*.svg"):
        found = texts(path)
        for label in LABELS[name]:
            assert label in found.replace("\n", " "), path.name


def test_versions_processor_study_and_settings_stand_under_a_result(drawn: Path) -> None:
    found = texts(drawn / "work-precision-slotted-lever.svg").replace("\n", " ")
    for words in ("crankcheck 0.0.0, mujoco", "pymunk 7", "abacus", "2026-01-01T00:00:00"):
        assert words in found
    assert "slotted-lever, 4 variants, 90 to 720 steps per turn, 2 turns" in found
    assert "error_bias 0" in found


def test_a_failed_run_is_told_and_drawn(drawn: Path) -> None:
    assert "pymunk no bias: 1 of 4 diverged" in texts(drawn / "convergence-slotted-lever.svg")
    assert "failed" in texts(drawn / "convergence-slotted-lever.svg")
    assert "failed" not in texts(drawn / "convergence-fourbar-lecture-1.svg")
    assert "pymunk no bias (1 of 4 diverged)" in texts(drawn / "work-precision-slotted-lever.svg")


def test_an_svg_brings_its_font_and_a_pdf_fonts_with_words(
    drawn: Path, chosen: tuple[Path, str]
) -> None:
    for path in drawn.glob("*.svg"):
        assert "@font-face{font-family:'DejaVu Sans'" in path.read_text(), path.name
    has_fonts(chosen[0] / "mechanism-slotted-lever.pdf")


def has_fonts(path: Path) -> None:
    raw = path.read_bytes()
    assert raw.startswith(b"%PDF-1."), path.name
    assert raw.rstrip().endswith(b"%%EOF"), path.name
    assert b"/FontFile2" in raw, path.name  # TrueType
    assert b"/Type3" not in raw, path.name


def test_paper_widths(drawn: Path) -> None:
    for path in drawn.glob("*.svg"):
        width = float(re.match(r"([\d.]+)pt", ET.parse(path).getroot().attrib["width"])[1])  # type: ignore[index]
        wide = path.stem in ("work-precision", "convergence", "profile") or "split" in path.stem
        assert width / 72 == pytest.approx(7.0 if wide else 3.4), path.name


def test_a_second_run_gives_the_same_bytes(
    drawn: Path, chosen: tuple[Path, str], store: Path, tmp_path: Path
) -> None:
    run_figures(store, tmp_path, Console(file=io.StringIO()), [SCENES[1]], ["mechanism"])
    made = sorted(tmp_path.iterdir())
    assert len(made) == 2
    for path in made:
        assert path.read_bytes() == (chosen[0] / path.name).read_bytes(), path.name
        assert b"CreationDate" not in path.read_bytes()
        assert b"dc:date" not in path.read_bytes()
    name = "mechanism-slotted-lever.svg"
    assert (tmp_path / name).read_bytes() == (drawn / name).read_bytes()


@slow("two seconds: a diagram has marks, legends and clipping that a mechanism has not")
def test_a_second_run_gives_the_same_bytes_of_a_diagram_too(store: Path, tmp_path: Path) -> None:
    for folder in ("one", "other"):
        only = ["work-precision", "mechanism"]
        run_figures(store, tmp_path / folder, Console(file=io.StringIO()), SCENES[:1], only)
    made = sorted((tmp_path / "one").iterdir())
    assert len(made) == 4
    for path in made:
        assert path.read_bytes() == (tmp_path / "other" / path.name).read_bytes(), path.name
        assert b"CreationDate" not in path.read_bytes()
        assert b"dc:date" not in path.read_bytes()


def test_scene_and_only_choose(chosen: tuple[Path, str]) -> None:
    folder, said = chosen
    assert {path.name for path in folder.iterdir()} == {
        "mechanism-slotted-lever.svg",
        "mechanism-slotted-lever.pdf",
    }
    assert "1 figure, each as .svg and .pdf" in said


@pytest.mark.parametrize(
    ("scenes", "only", "words"),
    [
        (["slotted-levr"], [], "--scene slotted-levr: no such scene here; did you mean slotted"),
        ([], ["profil"], "--only profil: no such figure here; did you mean profile"),
        ([SCENES[0]], ["profile"], "leave out --scene"),
    ],
)
def test_what_there_is_not_is_refused(
    store: Path, tmp_path: Path, scenes: list[str], only: list[str], words: str
) -> None:
    with pytest.raises(CrankcheckError, match=words):
        run_figures(store, tmp_path / "figs", Console(file=io.StringIO()), scenes, only)
    assert not (tmp_path / "figs").exists()


def test_a_folder_that_is_a_file_is_refused(store: Path, tmp_path: Path) -> None:
    (tmp_path / "figs").write_text("mine")
    with pytest.raises(CrankcheckError, match="is a file"):
        run_figures(store, tmp_path / "figs", Console(file=io.StringIO()))
