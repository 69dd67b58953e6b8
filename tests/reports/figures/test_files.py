"""The files of `crankcheck figures`, of a driven store and of free runs: whole, labelled, and the
same on any day; nothing over something else, and curves told apart without colour."""

import io
import itertools
import re
import xml.etree.ElementTree as ET
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.font_manager import get_font_names
from matplotlib.lines import Line2D
from matplotlib.text import Text
from matplotlib.transforms import Bbox
from PIL import Image
from rich.console import Console

from models.errors import CrankcheckError
from models.files.reading import load_scene
from reports.figures.coinciding import count_coinciding
from reports.figures.drawing import marks
from reports.figures.force_figures import FORCE_FIGURES
from reports.figures.force_turn import force_turn
from reports.figures.free_figures import _over_one_turn
from reports.figures.free_runs import free_runs
from reports.figures.layout import LEAST_MM, Layout
from reports.figures.style import cut, styled, width_in
from reports.requests.figures import FIGURES, FiguresRequest
from reports.requests.solve import SolveRequest
from reports.results.lines import lines
from reports.results.overview import Report
from reports.store.reader import read_store
from sim.registry import ENGINES, declaration
from tests.reports.results.made import cell, stored
from tests.worlds.free_store import LASTS_S
from tests.worlds.free_store import SCENE as LET_GO
from tests.worlds.small_store import SCENES
from tests.worlds.tiers import few

OF_SCENES = ("work-precision", "convergence", "split", "mechanism")
EACH = {f"{name}-{scene}" for name in OF_SCENES for scene in SCENES}
ALL = EACH | {"work-precision", "convergence", "profile"}
LABELS = {
    "work-precision": ("time per simulated turn [s]",),
    "convergence": ("steps per turn", "largest error: angle [rad], place / L [-]"),
    "convergence-": ("time step [s]", ": order 1.0", "a floor below"),
    "split": ("angle of crank [deg]", "[10⁻³ rad]", "drive", "closure", "floor", "discretisation"),
    "mechanism": ("x [m]", "y [m]", "A", "crank"),
    "profile": ("time over that of the fastest [-]", "share of the scenes [%]", "error up to 10⁻²"),
}
FREE_LABELS = {
    "free-motion": (
        "angle of crank [deg]",
        "speed [rad/s]",
        "error of angle / G [rad]",
        "time [s]",
    ),
    "energy": ("change of energy / largest kinetic energy", "drift", "means over windows"),
    "phase": ("angular velocity [rad/s]", "truth, integrated", "pymunk as-shipped"),
    "convergence": ("time step", "4 ms", "2 ms", "largest error / sensitivity"),
    "mechanism": ("integrated", "x [m]"),
}
FAULTS = {
    "--scene slotted-levr: found no such scene; did you mean slotted": (["slotted-levr"], []),
    "--only profil: found no such figure; did you mean profile": ([], ["profil"]),
    "leave out --scene": ([SCENES[0]], ["profile"]),
    "for free scenes": ([], ["free-motion"]),
}


def as_svg(store: Path, folder: Path) -> Path:
    """All of a store, as SVG alone: fonts of a PDF take twice the time of all else."""
    figures(store, folder, format="svg")
    return folder


@pytest.fixture(scope="module")
def drawn(store: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return as_svg(store, tmp_path_factory.mktemp("drawn") / "figs")


@pytest.fixture(scope="module")
def drawn_free(free_store: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return as_svg(free_store, tmp_path_factory.mktemp("drawn") / "figs")


def figures(*asked: object, **layout: object) -> str:
    said = io.StringIO()
    assert FiguresRequest(*asked, **layout).run(Console(file=said), Console()) == 0  # type: ignore[arg-type]
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


def test_curves_within_a_line_s_width_are_counted_where_they_lie() -> None:
    axes = Figure().add_subplot()
    x = np.linspace(0.0, 1.0, 11)
    curves = [axes.plot(x, x + off)[0] for off in (0.0, 1e-3, 2e-3, 0.5)]
    curves += axes.plot(x[2:5], x[2:5] + 0.5)
    count_coinciding(axes, curves)
    assert [text.get_text() for text in axes.texts] == ["3 curves coincide", "2 curves coincide"]
    assert axes.texts[1].xy == (x[6], x[6] + 0.5)


def test_there_is_an_svg_of_each_figure_that_a_store_has(drawn: Path, drawn_free: Path) -> None:
    """With its fonts, as wide as a column or a page of a paper, and labels with units."""
    assert {path.name for path in drawn.iterdir()} == {f"{name}.svg" for name in ALL}
    assert {path.stem for path in drawn_free.iterdir()} == {f"{n}-{LET_GO}" for n in FREE_LABELS}
    for path in drawn.glob("*.svg"):
        assert "@font-face{font-family:'DejaVu Sans'" in path.read_text(), path.name
        width = float(re.match(r"([\d.]+)pt", ET.parse(path).getroot().attrib["width"])[1])  # type: ignore[index]
        wide = path.stem in ("work-precision", "convergence", "profile") or "split" in path.stem
        assert width / 72 == pytest.approx(7.0 if wide else 3.4), path.name
        for name in (each for each in LABELS if path.name.startswith(each)):
            for words in LABELS[name]:
                assert words in flat(path), path.name
    for name, labels in FREE_LABELS.items():
        found = flat(drawn_free / f"{name}-{LET_GO}.svg")
        assert {label for label in labels if label not in found} == set()
        assert "steps per turn" not in found


def test_what_was_run_and_what_failed_stand_under_a_result(drawn: Path) -> None:
    found = flat(drawn / "work-precision-slotted-lever.svg")
    for words in ("crankcheck 0.0.0, mujoco", "pymunk 7", "abacus", "2026-01-01T00:00:00"):
        assert words in found
    assert "slotted-lever, 4 variants, 90 to 720 steps per turn, 1 turn" in found
    assert "error_bias 0" in found
    assert "pymunk no bias (1 of 4 diverged)" in found
    lever = texts((drawn / "convergence-slotted-lever.svg").read_bytes())
    assert "pymunk no bias: 1 of 4 diverged" in lever
    assert "failed" in lever
    assert "failed" not in flat(drawn / "convergence-fourbar-lecture-1.svg")


def test_scene_and_only_choose_and_a_pdf_brings_its_fonts(chosen: tuple[Path, str]) -> None:
    folder, said = chosen
    assert {p.name for p in folder.iterdir()} == {
        f"mechanism-slotted-lever.{k}" for k in Layout().formats
    }
    assert "1 figure, each as .svg and .pdf" in said
    raw = (folder / "mechanism-slotted-lever.pdf").read_bytes()
    assert raw.startswith(b"%PDF-1.")
    assert raw.rstrip().endswith(b"%%EOF")
    assert b"/FontFile2" in raw  # TrueType
    assert b"/Type3" not in raw


def test_a_second_run_gives_the_same_bytes(
    drawn: Path, chosen: tuple[Path, str], store: Path, tmp_path: Path
) -> None:
    figures(store, tmp_path, [SCENES[1]], ["mechanism"])
    for path in tmp_path.iterdir():
        raw = path.read_bytes()
        assert raw == (chosen[0] / path.name).read_bytes(), path.name
        assert b"CreationDate" not in raw
        assert b"dc:date" not in raw
    name = "mechanism-slotted-lever.svg"
    assert (tmp_path / name).read_bytes() == (drawn / name).read_bytes()


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


DRIVEN = [name for name, drawing in FIGURES.items() if "driven" in drawing.drives]
SHOWN = [(name, scene) for name in DRIVEN for scene in (*SCENES, None)]
EMPTY = {("split", None), ("mechanism", None), *(("profile", scene) for scene in SCENES)}
QUICK = {(n, scene) for n in DRIVEN for scene in (SCENES[1], None)} - {("profile", SCENES[1])}
OF_FREE = [name for name, drawing in FIGURES.items() if "free" in drawing.drives]
OTHER = "what differs between figures is that one is of a scene, of all, or of what was let go"


def _undrawn(axes: Axes) -> Iterator[Text]:
    for axis in (axes.xaxis, axes.yaxis):
        low, high = sorted(axis.get_view_interval())
        for tick in axis.get_major_ticks():
            if not low <= tick.get_loc() <= high:
                yield from (tick.label1, tick.label2)


def has_room(draw: Callable[..., Figure | None], *arguments: object) -> None:
    """Every word on the sheet, and none on another."""
    with styled():
        figure = draw(*arguments)
        assert figure is not None
        canvas, page = FigureCanvasAgg(figure), figure.bbox
        canvas.draw()
        by, unseen = canvas.get_renderer(), {t for axes in figure.axes for t in _undrawn(axes)}
        seen = (t for t in figure.findobj(Text) if t.get_visible() and t not in unseen)
        found = [(t.get_text(), t.get_window_extent(by)) for t in seen if t.get_text().strip()]
    assert len(found) > 5
    for text, box in found:
        inside = box.x0 >= -1 and box.y0 >= -1 and box.x1 <= page.x1 + 1 and box.y1 <= page.y1 + 1
        assert inside, f"{text!r} leaves the sheet"
    for (a, first), (b, second) in itertools.combinations(found, 2):
        shared = Bbox.intersection(first, second)
        assert shared is None or min(shared.width, shared.height) < 2.0, f"{a!r} on {b!r}"


@pytest.fixture(scope="module")
def report(store: Path) -> Report:
    return Report(read_store(store))


def figure_of(report: Report, name: str, scene: str | None) -> Figure | None:
    drawing = FIGURES[name]
    if scene is None:
        return drawing.over_all(report) if drawing.over_all else None
    return drawing.of(report, scene) if drawing.of else None


@pytest.mark.usefixtures("any_width")
@pytest.mark.parametrize("shown", few(SHOWN, QUICK, OTHER), ids=str)
def test_words_keep_off_others_and_the_edge(report: Report, shown: tuple[str, str | None]) -> None:
    if shown in EMPTY:
        assert figure_of(report, *shown) is None
    else:
        has_room(figure_of, report, *shown)


@pytest.mark.usefixtures("any_width")
@pytest.mark.parametrize("name", few(OF_FREE, {"free-motion", "energy"}, OTHER))
def test_words_of_what_was_let_go_keep_off_each_other(free_store: Path, name: str) -> None:
    free = Report(read_store(free_store))
    has_room(figure_of, free, name, LET_GO)
    if name == "energy":
        ends = [axes.get_xlim() for axes in figure_of(free, name, LET_GO).axes]
        assert ends == [(0.0, pytest.approx(LASTS_S))] * len(ends)


def test_a_layout_is_kept_and_a_faulty_one_refused_in_a_line(store: Path, tmp_path: Path) -> None:
    """The width by the SVG's own attribute, the font by that of a PDF, the size of a picture by its
    pixels; words that are left out are those of the others."""
    layout = {"width_mm": 85.0, "font": "Liberation Serif", "format": "svg, PDF,png,svg"}
    if "Liberation Serif" not in get_font_names():
        layout["font"] = "STIXGeneral"  # matplotlib's own
    plain = figures(store, tmp_path / "a", [SCENES[0]], ["convergence"], **layout)
    bare = {"no_title": True, "no_notes": True, "format": "svg"}
    figures(store, tmp_path / "b", [SCENES[0]], ["convergence"], **layout | bare)
    assert "each as .svg and .pdf and .png" in plain
    name = f"convergence-{SCENES[0]}"
    svg, own = ((tmp_path / n / f"{name}.svg").read_bytes() for n in "ab")
    assert f'width="{85.0 / 25.4 * 72:.5g}'.encode() in svg
    assert f"font-family:'{layout['font']}'".encode() in svg
    assert layout["font"].replace(" ", "").encode() in (tmp_path / f"a/{name}.pdf").read_bytes()
    with Image.open(tmp_path / f"a/{name}.png") as picture:
        assert picture.width == pytest.approx(85.0 / 25.4 * 600, abs=1)
    lost = set(texts(svg).splitlines()) - set(texts(own).splitlines())
    assert any(words.startswith("Convergence") for words in lost)
    assert any(words.startswith("crankcheck 0.0.0") for words in lost)
    assert "time step [s]" in texts(own)
    faults: tuple[tuple[str, dict[str, object]], ...] = (
        ("--font: 'Helvetika' is not installed here", {"font": "Helvetika"}),
        ("--format: 'eps' is unknown; give svg, pdf or png", {"format": "svg,eps"}),
        ("--format: '' is unknown", {"format": ""}),
        (f"--width-mm: found 20; give {LEAST_MM:g} to 500", {"width_mm": 20.0}),
        ("--width-mm: found nan", {"width_mm": float("nan")}),
    )
    for words, fault in faults:
        with pytest.raises(CrankcheckError, match=words):
            figures(store, tmp_path / "c", **fault)
    assert not (tmp_path / "c").exists()
    with pytest.raises(CrankcheckError, match="--no-notes: no figure is drawn; give --figures DIR"):
        SolveRequest(SCENES[0], no_notes=True).run(Console(), Console())


def test_the_picture_of_the_readme_has_all_engines_and_is_small() -> None:
    """`make picture` draws it anew; its times are those of a run."""
    path = Path(__file__).parents[3] / "docs" / "images" / "work-precision-fourbar-lecture-1.svg"
    svg = path.read_bytes()
    assert len(svg) <= 60_000
    drawn = [name for name in ENGINES if not declaration(name).fewer]  # the others take minutes
    variants = {f"{name} {profile}" for name in drawn for profile in ("as-shipped", "tuned")}
    assert variants <= set(texts(svg).splitlines())


def test_panels_of_a_figure_have_one_scale(report: Report) -> None:
    limits = {axes.get_ylim() for axes in figure_of(report, "split", SCENES[0]).axes}
    assert len(limits) == 1
    reactions = FORCE_FIGURES.draws["reactions-polar"](force_turn(load_scene("shaper"))).axes
    assert len({round(np.ptp(axes.get_xlim()), 6) for axes in reactions}) == 1


def test_a_name_that_is_too_long_loses_its_middle() -> None:
    name = "a variant with a name that no column has room for, iterations=20"
    short = cut(name, 1.5)
    assert width_in(short) <= 1.5 < width_in(name)
    assert short.startswith("a variant")
    assert short.endswith("iterations=20")
    assert "…" in short
    assert cut("short", 1.5) == "short"


@pytest.mark.parametrize("number", [4, 30])
def test_no_two_variants_share_marker_and_dashes(number: int) -> None:
    named = itertools.product(("mujoco", "pymunk", "third"), range(number))
    rows = [cell("a", f"v{i}", 90, 1e-3, 1.0, engine=engine) for engine, i in named]
    found = marks(lines(stored(rows)))
    assert len(found) == 3 * number
    assert len({(mark.marker, mark.dashes) for mark in found.values()}) == 3 * number
    for mark in found.values():
        Line2D([], [], **mark.style)  # matplotlib knows the marker and takes the dashes
