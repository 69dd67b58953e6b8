"""`crankcheck export`, of what is free or bends as well: a model that runs as it is; `view`,
`scenes` and `engines`; and `run`, the log of a run, with `recipe`."""

import re
import shlex
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pandas as pd
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from PIL import Image

from analytic.elastic.discretisation import Modes
from analytic.elastic.elastic_motion import DrivenElasticMotion
from analytic.free.release import release
from analytic.kinematics import solve
from models.files.assemble import scene_text
from models.files.reading import kinds, load_scene, shipped
from models.motion import Motion
from reports.figures import gif
from reports.requests import engines
from sim.registry import Availability
from sim.run import run
from tests.worlds.command_line import crank, refused, told
from tests.worlds.loading import massless
from tests.worlds.tiers import slow, slowly


def exported(name: str) -> tuple[mujoco.MjModel, mujoco.MjData]:
    model = mujoco.MjModel.from_xml_string(told(f"export {name}"))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    return model, data


def off_rad(data: mujoco.MjData, link: str, truth: Motion) -> float:
    """How far a link is turned from the truth of one instant [rad]."""
    rotation = data.body(link).xmat.reshape(3, 3)
    turn = np.arctan2(rotation[1, 0], rotation[0, 0]) - truth.links[link].theta[0]
    return float(abs(np.remainder(turn + np.pi, 2.0 * np.pi) - np.pi))


@pytest.mark.parametrize(
    "name", ["fourbar-swing", slowly("double-pendulum", reason="a second: two freedoms")]
)
def test_a_model_that_is_let_go_moves_as_its_masses_say(name: str) -> None:
    model, data = exported(name)
    while data.time < 0.2:
        mujoco.mj_step(model, data)
    truth = release(load_scene(name), 0.21).at(np.array([data.time]))
    assert max(off_rad(data, link, truth) for link in truth.links) < 1e-4


def test_an_elastic_link_is_exported_as_the_segments_that_bend() -> None:
    model, data = exported("fourbar-elastic")
    assert model.nbody == 1 + 2 + 16  # the world, crank and rocker, segments
    while data.time < 0.02:
        mujoco.mj_step(model, data)
    by = DrivenElasticMotion(load_scene("fourbar-elastic"), 0.05, Modes(3), "periodic", True)
    assert off_rad(data, "rocker", by.at(np.array([data.time]))) < 1e-5


def test_a_model_may_be_written_and_its_loop_closed_where_it_is_told(tmp_path: Path) -> None:
    told("export fourbar-lecture-1 -o", tmp_path / "scene.xml")
    model = (tmp_path / "scene.xml").read_text(encoding="utf-8")
    assert model == told("export fourbar-lecture-1")
    assert 'site1="coupler.C"' in model
    other = told("export fourbar-lecture-1 --close B")
    assert 'site1="crank.B"' in other
    assert 'site1="coupler.C"' not in other


def test_scenes_lists_every_shipped_scene_under_its_kind_with_its_groups() -> None:
    output = told("scenes")
    places = [output.index(f"{kind}: ") for kind in kinds()]
    for kind, start, end in zip(kinds(), places, [*places[1:], None], strict=True):
        assert all(f"\n{name} " in output[start:end] for name in shipped(kind))
    assert "RPR + RRP" in output


def test_engines_lists_versions_profiles_settings_and_gaps(monkeypatch: pytest.MonkeyPatch) -> None:
    plain, full = told("engines"), told("engines --settings")
    assert [word for word in ("mujoco", "tuned", "as-shipped") if word not in plain] == []
    assert len(full.splitlines()) > len(plain.splitlines()) + 5
    missing = (Availability("mujoco", None, "pip install mujoco"),)
    monkeypatch.setattr(engines, "available", lambda: missing)
    assert "not installed: pip install mujoco" in told("engines")


def test_view_with_a_screen_opens_the_assembled_model(monkeypatch: pytest.MonkeyPatch) -> None:
    viewer = pytest.importorskip("sim.mujoco.viewer")
    shown: list[int] = []
    monkeypatch.setattr(viewer.mujoco.viewer, "launch", lambda model, _: shown.append(model.nkey))
    monkeypatch.setattr("reports.requests.export.has_screen", lambda: True)
    told("view tangent")
    assert shown == [1]


def test_view_without_a_screen_animates_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    monkeypatch.setattr("reports.requests.export.sys.platform", "linux")
    monkeypatch.setattr(gif, "FRAMES", 4)
    assert "scotch-yoke.gif" in told("view scotch-yoke")
    frames = []
    with Image.open(tmp_path / "scotch-yoke.gif") as film:
        assert film.n_frames == 4
        for index in range(4):
            film.seek(index)
            frames.append(film.convert("RGB").tobytes())
    assert len(set(frames)) > 1


@slow("a second: six frames; strips are drawn above")
def test_a_strip_of_a_swinging_driver_shows_both_its_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    titles: list[str] = []
    monkeypatch.setattr(Axes, "set_title", lambda _, text, **__: titles.append(text))
    gif.strip(load_scene("tangent"))
    assert {-40, 40} <= {round(float(title.split()[-2])) for title in titles}


def test_a_run_is_drawn_beside_the_reference_with_its_error_magnified(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """The dashed corner at C is where the closed form and a run of our own put it, the error times
    the factor that the picture names: as many times as is seen, and a round number."""
    dashed: list[np.ndarray] = []
    labels: list[str] = []
    legend, plot = Figure.legend, Axes.plot

    def plotted(axes: Axes, *places: np.ndarray, **look: Any) -> object:
        if look.get("linestyle") == gif.RUN["linestyle"]:
            dashed.append(np.array(places))
        return plot(axes, *places, **look)

    def shown(figure: Figure, handles: list[Line2D], **more: Any) -> object:
        labels.extend(str(each.get_label()) for each in handles)
        return legend(figure, handles=handles, **more)

    monkeypatch.setattr(Axes, "plot", plotted)
    monkeypatch.setattr(Figure, "legend", shown)
    monkeypatch.setattr(gif.FigureCanvasAgg, "print_png", lambda *_, **__: None)
    view = "view fourbar-lecture-1 --engine pymunk -o"
    told(view, tmp_path / "a.png")
    words = r"pymunk [\d.]+ as-shipped, step 873 µs, error magnified (\d+) times"
    named = re.fullmatch(words, labels[1])
    assert named
    factor = float(named[1])
    assert factor in (20.0, 50.0)
    scene = load_scene("fourbar-lecture-1")
    period = scene.driver.law.period_s
    start = solve(scene, np.zeros(1)).state()
    done = run(scene, start, "pymunk", "as-shipped", dt_s=period / 720, steps=1440)
    assert done.motion is not None
    at = [720 + 120 * k for k in range(6)]
    off = done.motion.points["C"].position[at]
    exact = solve(scene, period + np.array(range(6)) * period / 6).points["C"].position
    rockers = [line.T for line in dashed][2::3]  # crank, coupler, rocker
    corners = np.array([line[0] if abs(line[0, 1]) > 1e-6 else line[1] for line in rockers])
    np.testing.assert_allclose(corners, exact + factor * (off - exact), atol=1e-7)
    size = np.ptp(np.vstack([exact, [[-0.1, -0.1], [0.3, 0.2]]]), axis=0).max()
    assert 0.02 < factor * np.linalg.norm(off - exact, axis=1).max() / size < 0.07
    told(view, tmp_path / "b.png", "--magnify", "7")
    assert labels[-1].endswith("error magnified 7 times")


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ("--engine pymunk --magnify often", "--magnify: found 'often'; give a number above 0"),
        ("--engine pymunk --magnify nan", "--magnify: found 'nan'"),
        ("--engine pymonk", "did you mean pymunk"),
        ("--engine pymunk --forces", "--forces with --engine"),
    ],
)
def test_a_run_that_can_not_be_drawn_is_refused(options: str, words: str, tmp_path: Path) -> None:
    refused(crank(*f"view fourbar-lecture-1 -o {tmp_path / 'a.png'} {options}".split()), words)
    assert not (tmp_path / "a.png").exists()


COARSE = "--steps-per-turn 90 --turns 1"
ONCE = f"run fourbar-lecture-1 {COARSE}"


def test_the_log_holds_every_digit_of_the_run(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    told(f"run slotted-lever --engine pymunk {COARSE} -o", path)
    frame = pd.read_csv(path)
    scene = load_scene("slotted-lever")
    state = solve(scene, np.zeros(1)).state()
    done = run(scene, state, "pymunk", dt_s=scene.driver.law.period_s / 90, steps=90)
    assert done.motion is not None
    for name, series in {
        "time_s": done.motion.time_s,
        "velocity_time_s": done.velocity_time_s,
        "lever_theta_rad": done.motion.links["lever"].theta,
        "E_vy_m_s": done.motion.points["E"].velocity[:, 1],
        "B_slider_displacement_m": done.motion.sliders["B"].displacement,
        "B_gap_m": done.gaps["B"],
    }.items():
        np.testing.assert_array_equal(frame[name], series, err_msg=name)
    assert not [name for name in frame if "alpha" in name]


def judged(output: str) -> str:
    """What comes of the command that a run tells to do next: its log is within."""
    (command,) = re.findall(r"next: crankcheck (.*)", output)
    result = crank(*shlex.split(command))
    assert result.exit_code == 0, result.output
    assert "WITHIN TOLERANCE" in result.output
    return str(command)


def test_what_it_tells_to_do_next_judges_the_log(tmp_path: Path) -> None:
    path = tmp_path / "my log.csv"
    told(f"{ONCE} --every 90 -o", path)
    output = told(f"{ONCE} --every 2 -o", path)
    assert output.startswith(f"{path}: 46 samples of fourbar-lecture-1 in mujoco ")
    assert "ended ok at t = 0.628319 s; pins open by at most " in output
    judged(output)


def test_what_is_let_go_has_its_length_in_seconds_and_is_judged_as_such(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    judged(told("run fourbar-swing --duration 0.2 -o", path))
    free = "run slider-crank-central --drive free --duration 0.2"
    assert judged(told(f"{free} -o", path)).endswith("--free")
    shown = told(free)
    assert "dt 0.001 s, 200 steps, 0.2 s" in shown
    assert "turn" not in shown


def test_what_came_apart_is_written_so_far(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sim.run.RUNAWAY", 0.5)
    path = tmp_path / "log.csv"
    assert "ended diverged at t = " in told(f"{ONCE} -o", path, code=1)
    assert 1 <= len(pd.read_csv(path)) < 91


def test_what_an_engine_can_not_hold_is_told_and_nothing_written(tmp_path: Path) -> None:
    scene, log = tmp_path / "bare.toml", tmp_path / "log.csv"
    scene.write_text(scene_text(massless(load_scene("fourbar-lecture-1"))), encoding="utf-8")
    output = told(f"run {COARSE}", scene, "-o", log, code=2)
    assert "fourbar-lecture-1, mujoco: unsupported: " in output
    assert not log.exists()


def test_the_program_of_a_recipe_is_shown_or_written(tmp_path: Path) -> None:
    shown = told("recipe forces --engine mujoco")
    compile(shown, "shown", "exec")
    path = tmp_path / "forces.py"
    told("recipe forces --engine mujoco -o", path)
    assert path.read_text(encoding="utf-8") == shown
