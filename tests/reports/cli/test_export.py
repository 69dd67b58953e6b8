"""`crankcheck export`, of what is let go or bends as well: a model that runs as it is; and `view`,
`scenes` and `engines`."""

import math
from pathlib import Path

import mujoco
import numpy as np
import pytest
from matplotlib.axes import Axes
from PIL import Image

from analytic.elastic.discretisation import Modes
from analytic.elastic.elastic_motion import DrivenElasticMotion
from analytic.free.release import release
from models.files.reading import kinds, load_scene, shipped
from models.motion import Motion
from models.scene.laws import Oscillating
from reports.drawing import gif
from reports.requests import export
from sim.registry import Availability
from tests.worlds.command_line import told


def exported(name: str) -> tuple[mujoco.MjModel, mujoco.MjData]:
    """The model that is printed, as its keyframe has it."""
    model = mujoco.MjModel.from_xml_string(told(f"export {name}"))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    return model, data


def off_rad(data: mujoco.MjData, link: str, truth: Motion) -> float:
    """How far a link is turned from the truth of one instant [rad]."""
    rotation = data.body(link).xmat.reshape(3, 3)
    turn = np.arctan2(rotation[1, 0], rotation[0, 0]) - truth.links[link].theta[0]
    return float(abs(np.remainder(turn + np.pi, 2.0 * np.pi) - np.pi))


@pytest.mark.parametrize("name", ["fourbar-swing", "double-pendulum"])
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
    by = DrivenElasticMotion(load_scene("fourbar-elastic"), 1.0, Modes(3), "periodic", True)
    assert off_rad(data, "rocker", by.at(np.array([data.time]))) < 1e-5


def test_elastic_links_that_are_let_go_are_exported_as_segments_at_rest() -> None:
    """What acts comes from outside, as the file says; without it the machine stays where it is."""
    model, data = exported("fourbar-elastic-pulse")
    assert model.nbody == 1 + 2 + 16
    mujoco.mj_step(model, data, 20)
    assert np.abs(data.qvel).max() < 1e-9


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


def test_engines_lists_versions_profiles_and_settings_with_reasons_and_what_is_missing(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    plain, full = told("engines"), told("engines --settings")
    assert [word for word in ("mujoco", "tuned", "as-shipped") if word not in plain] == []
    assert len(full.splitlines()) > len(plain.splitlines()) + 5
    missing = (Availability("mujoco", None, "pip install mujoco"),)
    monkeypatch.setattr(export, "available", lambda: missing)
    assert "not installed: pip install mujoco" in told("engines")


def test_view_with_a_screen_opens_the_assembled_model(monkeypatch: pytest.MonkeyPatch) -> None:
    viewer = pytest.importorskip("sim.mujoco.viewer")
    shown: list[int] = []
    monkeypatch.setattr(viewer.mujoco.viewer, "launch", lambda model, _: shown.append(model.nkey))
    monkeypatch.setattr("reports.requests.export.has_screen", lambda: True)
    told("view tangent")
    assert shown == [1]


def test_view_without_a_screen_draws_an_animation_that_moves(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
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


def test_what_a_slider_drives_is_drawn_with_its_forces(tmp_path: Path) -> None:
    told("view slider-crank-by-piston --forces -o", tmp_path / "motion.png")


def test_a_strip_of_a_swinging_driver_shows_both_ends_of_its_swing(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    titles: list[str] = []
    monkeypatch.setattr(Axes, "set_title", lambda _, text, **__: titles.append(text))
    scene = load_scene("tangent")
    law = scene.driver.law
    assert isinstance(law, Oscillating)
    gif.strip(scene)
    shown = [float(title.split()[-2]) for title in titles]
    for side in (-1.0, 1.0):
        end = math.degrees(law.centre_rad + side * law.amplitude_rad)
        assert min(abs(angle - end) for angle in shown) <= 0.5
