"""`crankcheck solve`, `export`, `scenes`, `engines`, `view`: the reference alone, and its model."""

from __future__ import annotations

import io
import math
import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from matplotlib.axes import Axes
from PIL import Image
from rich.console import Console

from analytic.kinematics import solve
from models.files import kinds, load_scene, shipped
from models.laws import Oscillating
from models.scene import Scene
from tests.worlds.command_line import crank
from tests.worlds.tiers import few


def test_the_lecture_example_at_90_degrees_shows_the_lectures_numbers() -> None:
    result = crank("solve", "fourbar-lecture-1", "--at-deg", "90")
    assert result.exit_code == 0
    rows = {line.split()[0]: line.split() for line in result.output.splitlines() if line.strip()}
    assert rows["coupler"][3:5] == ["-1.3257269", "20.297811"]
    assert rows["rocker"][3:5] == ["4.6761490", "19.396967"]
    points = [line.split() for line in result.output.splitlines() if line.startswith("C ")]
    assert [row[-1] for row in points] == ["0.93522980", "5.8459573"]
    (place, _) = [line.split() for line in result.output.splitlines() if line.startswith("B ")]
    assert place[1] == "0.0000000", "0 within its bound"


@pytest.mark.parametrize(
    ("name", "parts"),
    [
        ("fourbar-lecture-1", ["crank-rocker", "transmission angle", "rocker: swing"]),
        ("fourbar-double-crank", ["double-crank"]),
        ("fourbar-double-rocker", ["double-rocker", "18.1949 to 65.3757 deg"]),
        ("slider-crank-central", ["C: stroke 0.2 m, time ratio 1"]),
    ],
)
def test_the_heading_says_what_kind_of_mechanism_it_is(name: str, parts: list[str]) -> None:
    output = crank("solve", name).output
    assert all(part in output for part in parts), output


def test_a_four_bar_driven_at_its_rocker_is_called_that(fourbar: Scene) -> None:
    from analytic.structure.mobility import analyse
    from reports.describe.facts import facts

    def scene(driver: float, rocker: float) -> Scene:
        links = dict(fourbar.links)
        for name, tip, length in (("crank", "B", driver), ("rocker", "C", rocker)):
            bar = links[name]
            (held,) = (point for point in bar.points if point != tip)
            links[name] = replace(bar, points={held: (0.0, 0.0), tip: (length, 0.0)})
        return replace(fourbar, links=links)

    assert facts(scene(0.2, 0.1), analyse(fourbar))[0].startswith(
        "crank-rocker driven at its rocker (s + l"
    )
    assert facts(scene(0.1, 0.2), analyse(fourbar))[0].startswith("crank-rocker (s + l")


SOME = ["fourbar-lecture-1", "slider-crank-offset", "shaper", "scotch-yoke", "tangent", "whitworth"]


@pytest.mark.parametrize("name", few(shipped(), SOME, "the other scenes are of the same joints"))
def test_every_shipped_scene_is_solved_and_drawn_as_a_table(name: str) -> None:
    result = crank("solve", name)
    assert result.exit_code == 0
    assert "mobility 1" in result.output
    assert "nan" not in result.output.lower().split()
    assert max(len(line.rstrip()) for line in result.output.splitlines()) <= 100


READERS = {
    ".csv": pd.read_csv,
    ".parquet": pd.read_parquet,
    ".xlsx": lambda path: pd.read_excel(path, sheet_name="motion"),
}


@pytest.mark.parametrize("ending", list(READERS))
def test_a_motion_written_to_a_file_is_read_back_to_the_last_bit(
    tmp_path: Path, ending: str
) -> None:
    path = tmp_path / f"out{ending}"
    long = ("--turns", 2, "--steps-per-turn", 40)
    result = crank("solve", "slider-crank-offset", *long, "-o", path)
    assert result.exit_code == 0
    frame = READERS[ending](path)
    scene = load_scene("slider-crank-offset")
    motion = solve(scene, frame["time_s"].to_numpy())
    assert len(frame) == 81
    np.testing.assert_array_equal(frame["rod_omega_rad_s"], motion.links["rod"].omega)
    np.testing.assert_array_equal(frame["C_ax_m_s2"], motion.points["C"].acceleration[:, 0])
    np.testing.assert_array_equal(frame["C_slider_speed_m_s"], motion.sliders["C"].speed)
    assert frame["time_s"].iloc[-1] == pytest.approx(2 * scene.driver.law.period_s)


def test_the_workbook_says_where_its_numbers_come_from(tmp_path: Path) -> None:
    path = tmp_path / "out.xlsx"
    crank("solve", "tangent", "-o", str(path))
    origin = pd.read_excel(path, sheet_name="source")
    assert load_scene("tangent").source in origin["value"].tolist()


def test_a_workbook_holds_a_name_that_a_workbook_can_not_hold(
    tmp_path: Path, fourbar: Scene
) -> None:
    from reports.cli.commands.solve import run_solve
    from reports.cli.showing import SolveRequest

    path = tmp_path / "out.xlsx"
    ringing = replace(fourbar, source="bell \x07")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("reports.cli.commands.solve.load_scene", lambda _: ringing)
        run_solve(SolveRequest(fourbar.name, output=path), Console())
    assert "bell \ufffd" in pd.read_excel(path, sheet_name="source")["value"].tolist()


@pytest.mark.parametrize(
    ("angle", "way", "sense"), [("0", (), 1.0), ("20", (), 1.0), ("20", ("--clockwise",), -1.0)]
)
def test_a_swinging_driver_is_taken_on_its_way_up_or_back(
    angle: str, way: Sequence[str], sense: float
) -> None:
    """It oscillates by 40 degrees at 10 rad/s, and is drawn back to its centre."""
    lever = links(crank("solve", "tangent", "--at-deg", angle, *way).output)["lever"]
    theta = math.radians(float(angle))
    speed = sense * 10.0 * math.sqrt(math.radians(40.0) ** 2 - theta**2)
    assert float(lever[3]) == pytest.approx(speed, rel=1e-7)
    assert float(lever[4]) == pytest.approx(-100.0 * theta, rel=1e-7, abs=0.0)


def links(output: str) -> dict[str, list[str]]:
    """The rows of the table of links, by name."""
    rows = (line.split() for line in output.split("link ")[-1].split("point")[0].splitlines())
    return {row[0]: row for row in rows if len(row) == 5 and row[0] != "x"}


def test_a_crank_may_be_asked_for_turning_clockwise() -> None:
    """Velocities are turned round, accelerations are not."""
    forth = links(crank("solve", "fourbar-lecture-1", "--at-deg", "30").output)
    back = links(crank("solve", "fourbar-lecture-1", "--at-deg", "30", "--clockwise").output)
    assert list(forth) == list(back) == ["crank", "coupler", "rocker"]
    for one, other in zip(forth.values(), back.values(), strict=True):
        assert float(other[3]) == -float(one[3])
        assert (other[2], other[4]) == (one[2], one[4])


def test_a_crank_of_steady_acceleration_has_the_speed_of_the_angle(tmp_path: Path) -> None:
    path = tmp_path / "faster.toml"
    text = shipped()["fourbar-lecture-1"].read_text(encoding="utf-8")
    law = 'law = "accelerating"\nspeed_rad_s = 10.0\nacceleration_rad_s2 = 5.0'
    path.write_text(text.replace("speed_rad_s = 10.0", law), encoding="utf-8")
    output = crank("solve", str(path), "--at-deg", "180").output
    assert "driver crank, 10 rad/s and 5 rad/s^2 from 90 deg" in output
    row = links(output)["crank"]
    assert float(row[3]) == pytest.approx(math.sqrt(100.0 + 2 * 5.0 * math.pi / 2), rel=1e-7)
    assert float(row[4]) == 5.0
    result = crank("solve", str(path), "--at-deg", "80")
    assert result.exit_code == 2
    assert "never comes there; it comes to the same driver angle at 440 deg" in result.stderr


def test_stroke_time_ratio_and_extreme_speeds_are_shown() -> None:
    output = crank("solve", "slotted-lever", "--along", "E:0").output
    assert "lever: swing 38.9424 deg, time ratio 1.55215" in output
    assert re.search(r"E along 0 deg: stroke 0\.\d+ m, time ratio 1\.55215", output)
    assert re.search(r"lever +2\.5 rad/s at 90 deg, -5 rad/s at 270 deg", output)
    assert re.search(r"E along 0 deg +-?\d.* m/s at \d", output)


def test_extreme_speeds_are_of_the_way_the_driver_turns() -> None:
    output = crank("solve", "whitworth", "--at-deg", "90", "--clockwise").output
    assert "extreme speeds, driver at -10 rad/s" in output
    assert re.search(r"lever +-6\.66667 rad/s at 90 deg, -20 rad/s at 270 deg", output)
    assert float(links(output)["lever"][3]) == pytest.approx(-20.0 / 3.0, rel=1e-7)
    output = crank("solve", "tangent", "--at-deg", "20", "--clockwise").output
    forth = crank("solve", "tangent", "--at-deg", "20").output
    assert re.findall(".* at .* deg", output) == re.findall(".* at .* deg", forth)  # it does both


def test_a_point_without_a_stroke_says_why(tmp_path: Path) -> None:
    output = crank("solve", "whitworth", "--along", "A:30").output
    assert output.count("A along 30 deg") == 1
    assert "\nA along 30 deg: does not move\n" in output
    output = crank("solve", "slider-crank-central", "--along", "C:90").output
    assert "\nC along 90 deg: does not move\n" in output  # it slides along 0 deg
    text = shipped()["fourbar-double-rocker"].read_text(encoding="utf-8")
    path = tmp_path / "turns.toml"
    turns = re.sub(r"law = (.+\n)+", "speed_rad_s = 10.0\n", text)
    path.write_text(turns, encoding="utf-8")
    output = crank("solve", str(path), "--at-deg", "40", "--along", "C:30").output
    assert "\nC along 30 deg: no stroke: the driver goes through no whole cycle, or" in output


def test_the_coriolis_component_is_shown_of_blocks_on_moving_guides() -> None:
    output = crank("solve", "shaper", "--at-deg", "30").output
    lever = float(links(output)["lever"][3])
    sliders = output.split("Coriolis")[-1].splitlines()
    found = {row[0]: row for row in map(str.split, sliders) if len(row) == 5}
    assert float(found["F"][4]) == 0.0
    assert float(found["B"][4]) == pytest.approx(2.0 * lever * float(found["B"][2]), rel=1e-7)
    assert "Coriolis" not in crank("solve", "slider-crank-central", "--at-deg", "30").output


def test_two_links_that_stand_still_are_solved_and_called_nothing(tmp_path: Path) -> None:
    path = tmp_path / "still.toml"
    text = shipped()["fourbar-lecture-1"].read_text(encoding="utf-8")
    path.write_text(text.replace('bar = ["B", "C"]', 'bar = ["A", "C"]'), encoding="utf-8")
    result = crank("solve", str(path), "--at-deg", "90")
    assert result.exit_code == 0, result.stderr
    assert "groups in solving order: RRR" in result.output
    assert "rocker (s + l" not in result.output


STRIP = "half a second for the same drawing of other links"


@pytest.mark.parametrize("name", few(shipped(), SOME, "the other scenes are of the same joints"))
def test_the_exported_model_compiles_alone_and_its_keyframe_closes_the_loops(
    tmp_path: Path, name: str
) -> None:
    mujoco = pytest.importorskip("mujoco")
    path = tmp_path / "scene.xml"
    assert crank("export", name, "-o", str(path)).exit_code == 0
    model = mujoco.MjModel.from_xml_path(str(path))
    state = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, state, 0)
    mujoco.mj_forward(model, state)
    assert np.max(np.abs(state.efc_pos[: state.ne]), initial=0.0) < 1e-12


def test_export_without_a_file_prints_the_model() -> None:
    result = crank("export", "tangent")
    assert result.output.startswith("<mujoco")
    assert result.output.rstrip().endswith("</mujoco>")


def test_scenes_lists_every_shipped_scene_under_its_kind_with_its_groups() -> None:
    output = crank("scenes").output
    places = [output.index(f"{kind}: ") for kind in kinds()]
    for kind, start, end in zip(kinds(), places, [*places[1:], None], strict=True):
        assert all(f"\n{name} " in output[start:end] for name in shipped(kind))
    assert "RPR + RRP" in output


def test_engines_lists_versions_profiles_and_settings_with_reasons() -> None:
    plain, full = crank("engines").output, crank("engines", "--settings").output
    assert "mujoco" in plain
    assert "tuned" in plain
    assert "as-shipped" in plain
    assert len(full.splitlines()) > len(plain.splitlines()) + 5


def test_an_engine_that_is_missing_shows_the_command_that_installs_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    from reports.cli.commands import listing
    from sim.registry import Availability

    missing = (Availability("mujoco", None, "pip install mujoco"),)
    monkeypatch.setattr(listing, "available", lambda: missing)
    assert "not installed: pip install mujoco" in crank("engines").output


def test_view_with_a_screen_opens_the_assembled_model(monkeypatch: pytest.MonkeyPatch) -> None:
    viewer = pytest.importorskip("sim.mujoco.viewer")
    shown: list[int] = []
    monkeypatch.setattr(viewer.mujoco.viewer, "launch", lambda model, _: shown.append(model.nkey))
    monkeypatch.setattr("reports.cli.commands.view.has_screen", lambda: True)
    assert crank("view", "tangent").exit_code == 0
    assert shown == [1]


def test_export_closes_the_loop_where_it_is_told() -> None:
    assert 'site1="coupler.C"' in crank("export", "fourbar-lecture-1").output
    told = crank("export", "fourbar-lecture-1", "--close", "B").output
    assert 'site1="crank.B"' in told
    assert 'site1="coupler.C"' not in told


def moves(frames: list[np.ndarray[tuple[int, ...], np.dtype[np.uint8]]]) -> bool:
    return any(not np.array_equal(frames[0], frame) for frame in frames[1:])


def test_view_without_a_screen_draws_an_animation_that_moves(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from reports.drawing import gif as picture

    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    monkeypatch.setattr("reports.cli.commands.view.sys.platform", "linux")
    monkeypatch.setattr(picture, "FRAMES", 4)
    result = crank("view", "scotch-yoke")
    assert result.exit_code == 0
    assert "scotch-yoke.gif" in result.output
    with Image.open(tmp_path / "scotch-yoke.gif") as film:
        assert film.n_frames == 4
        frames = []
        for index in range(4):
            film.seek(index)
            frames.append(np.asarray(film.convert("RGB")))
    assert moves(frames)


@pytest.mark.parametrize("name", few(["shaper", "tangent", "sixbar-stephenson"], ["shaper"], STRIP))
def test_a_strip_shows_every_link_in_its_colour(name: str) -> None:
    from reports.drawing import gif as picture
    from reports.drawing.shape import COLOURS

    scene = load_scene(name)
    with Image.open(io.BytesIO(picture.strip(scene))) as image:
        pixels = np.asarray(image.convert("RGB")).reshape(-1, 3)
    for colour in COLOURS[: len(scene.links)]:
        rgb = np.array([int(colour[k : k + 2], 16) for k in (1, 3, 5)])
        assert np.any(np.all(pixels == rgb, axis=1)), colour


@pytest.mark.parametrize("name", few(["tangent", "fourbar-double-rocker"], ["tangent"], STRIP))
def test_a_strip_of_a_swinging_driver_shows_both_ends_of_its_swing(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    from reports.drawing import gif as picture

    titles: list[str] = []
    monkeypatch.setattr(Axes, "set_title", lambda _, text, **__: titles.append(text))
    scene = load_scene(name)
    law = scene.driver.law
    assert isinstance(law, Oscillating)
    picture.strip(scene)
    shown = [float(title.split()[-2]) for title in titles]
    for side in (-1.0, 1.0):
        end = math.degrees(law.centre_rad + side * law.amplitude_rad)
        assert min(abs(angle - end) for angle in shown) <= 0.5
