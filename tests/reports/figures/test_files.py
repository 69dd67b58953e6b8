"""The files of `crankcheck figures`, of a driven store and of free runs: whole, labelled, and the
same on any day."""

import io
import re
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console

from models.errors import CrankcheckError
from reports.figures.free_figures import _over_one_turn
from reports.figures.free_runs import free_runs
from reports.figures.style import FORMATS
from reports.requests.figures import FiguresRequest
from reports.results.overview import Report
from reports.store.reader import read_store
from tests.worlds.free_store import SCENE as LET_GO
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
FREE_LABELS = {
    "let-go": ("angle of crank [deg]", "speed [rad/s]", "error of angle / G [rad]", "time [s]"),
    "energy": ("change of energy / largest kinetic energy", "drift", "means over windows"),
    "phase": ("angular velocity [rad/s]", "truth, integrated", "pymunk as-shipped"),
    "convergence": ("time step", "4 ms", "2 ms", "largest error / sensitivity"),
    "mechanism": ("integrated", "x [m]"),
}
FAULTS = {
    "--scene slotted-levr: no such scene here; did you mean slotted": (["slotted-levr"], []),
    "--only profil: no such figure here; did you mean profile": ([], ["profil"]),
    "leave out --scene": ([SCENES[0]], ["profile"]),
    "of what was let go": ([], ["let-go"]),
}


def as_svg(store: Path, folder: Path) -> Path:
    """All of a store, as SVG alone: fonts of a PDF take twice the time of all else."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("reports.requests.figures.FORMATS", ("svg",))
        figures(store, folder)
    return folder


@pytest.fixture(scope="module")
def drawn(store: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return as_svg(store, tmp_path_factory.mktemp("drawn") / "figs")


@pytest.fixture(scope="module")
def drawn_free(free_store: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return as_svg(free_store, tmp_path_factory.mktemp("drawn") / "figs")


def figures(*asked: object) -> str:
    said = io.StringIO()
    assert FiguresRequest(*asked).run(Console(file=said), Console()) == 0  # type: ignore[arg-type]
    return said.getvalue()


@pytest.fixture(scope="module")
def chosen(store: Path, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    """The figure of one scene, as SVG and PDF, and what is said of it."""
    folder = tmp_path_factory.mktemp("chosen")
    return folder, figures(store, folder, [SCENES[1]], ["mechanism"])


def texts(svg: bytes) -> str:
    root = ET.fromstring(svg)
    return "\n".join("".join(t.itertext()) for t in root.iter("{http://www.w3.org/2000/svg}text"))


def flat(path: Path) -> str:
    return texts(path.read_bytes()).replace("\n", " ")


def test_there_is_an_svg_of_each_figure_that_a_store_has(drawn: Path, drawn_free: Path) -> None:
    assert {path.name for path in drawn.iterdir()} == {f"{name}.svg" for name in ALL}
    assert {path.stem for path in drawn_free.iterdir()} == {f"{n}-{LET_GO}" for n in FREE_LABELS}


@slow("a PDF takes a third of a second: one of them is read by the other tests")
def test_there_is_a_pdf_of_each_with_its_fonts(store: Path, tmp_path: Path) -> None:
    figures(store, tmp_path)
    names = {path.name for path in tmp_path.iterdir()}
    assert names == {f"{name}.{kind}" for name in ALL for kind in ("svg", "pdf")}
    for path in tmp_path.glob("*.pdf"):
        has_fonts(path)


@pytest.mark.parametrize("name", LABELS)
def test_axes_are_labelled_with_units_and_words_can_be_read(drawn: Path, name: str) -> None:
    for path in drawn.glob(f"{name}*.svg"):
        for label in LABELS[name]:
            assert label in flat(path), path.name


@pytest.mark.parametrize("name", FREE_LABELS)
def test_a_free_figure_says_what_it_shows(drawn_free: Path, name: str) -> None:
    found = flat(drawn_free / f"{name}-{LET_GO}.svg")
    for label in (*FREE_LABELS[name], *(["mujoco"] if name != "mechanism" else [])):
        assert label in found
    assert "steps per turn" not in found


def test_what_was_run_and_what_failed_stand_under_a_result(drawn: Path) -> None:
    found = flat(drawn / "work-precision-slotted-lever.svg")
    for words in ("crankcheck 0.0.0, mujoco", "pymunk 7", "abacus", "2026-01-01T00:00:00"):
        assert words in found
    assert "slotted-lever, 4 variants, 90 to 720 steps per turn, 2 turns" in found
    assert "error_bias 0" in found
    assert "pymunk no bias (1 of 4 diverged)" in found
    lever = texts((drawn / "convergence-slotted-lever.svg").read_bytes())
    assert "pymunk no bias: 1 of 4 diverged" in lever
    assert "failed" in lever
    assert "failed" not in flat(drawn / "convergence-fourbar-lecture-1.svg")


def test_an_svg_and_a_pdf_bring_their_fonts(drawn: Path, chosen: tuple[Path, str]) -> None:
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


def same_and_undated(one: Path, other: Path, count: int) -> None:
    made = sorted(one.iterdir())
    assert len(made) == count
    for path in made:
        assert path.read_bytes() == (other / path.name).read_bytes(), path.name
        assert b"CreationDate" not in path.read_bytes()
        assert b"dc:date" not in path.read_bytes()


def test_a_second_run_gives_the_same_bytes(
    drawn: Path, chosen: tuple[Path, str], store: Path, tmp_path: Path
) -> None:
    figures(store, tmp_path, [SCENES[1]], ["mechanism"])
    same_and_undated(tmp_path, chosen[0], 2)
    name = "mechanism-slotted-lever.svg"
    assert (tmp_path / name).read_bytes() == (drawn / name).read_bytes()


@slow("two seconds: a diagram has marks, legends and clipping that a mechanism has not")
def test_a_second_run_gives_the_same_bytes_of_a_diagram_too(store: Path, tmp_path: Path) -> None:
    for folder in ("one", "other"):
        figures(store, tmp_path / folder, SCENES[:1], ["work-precision", "mechanism"])
    same_and_undated(tmp_path / "one", tmp_path / "other", 4)


def test_scene_and_only_choose(chosen: tuple[Path, str]) -> None:
    folder, said = chosen
    assert {p.name for p in folder.iterdir()} == {f"mechanism-slotted-lever.{k}" for k in FORMATS}
    assert "1 figure, each as .svg and .pdf" in said


def test_what_there_is_not_and_a_file_for_a_folder_are_refused(store: Path, tmp_path: Path) -> None:
    for words, asked in FAULTS.items():
        with pytest.raises(CrankcheckError, match=words):
            figures(store, tmp_path / "figs", *asked)
        assert not (tmp_path / "figs").exists()
    (tmp_path / "figs").write_text("mine")
    with pytest.raises(CrankcheckError, match="is a file"):
        figures(store, tmp_path / "figs")


def test_a_portrait_goes_through_its_samples_and_smoothly_between(free_store: Path) -> None:
    shown = free_runs(Report(read_store(free_store)), LET_GO)
    run = shown.runs[0]
    angle, speed = run.portrait()
    np.testing.assert_allclose(angle[::8], run.angle, rtol=0, atol=1e-12)
    np.testing.assert_allclose(speed[::8], run.trace["omega"], rtol=0, atol=1e-9)
    near = np.interp(np.linspace(0, shown.time_s[-1], angle.size), shown.time_s, shown.angle)
    assert np.max(np.abs(angle - near)) < 1e-2


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_a_phase_diagram_over_one_turn_goes_on_at_the_other_side(way: float) -> None:
    degrees = way * np.array([300.0, 340.0, 420.0, 500.0])
    within, speed = _over_one_turn(degrees, np.array([1.0, 2.0, 6.0, 7.0]))
    (cut,) = np.flatnonzero(np.isnan(within))
    assert (within[cut - 1], within[cut + 1]) == ((360.0, 0.0) if way > 0.0 else (0.0, 360.0))
    assert speed[cut - 1] == speed[cut + 1] == pytest.approx(3.0)
    assert np.isnan(speed[cut])
    assert within.size == 7
