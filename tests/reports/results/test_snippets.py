"""What the recommendation table promises holds in models that know nothing of crankcheck."""

import json
import math
from collections.abc import Mapping, Sequence
from xml.etree import ElementTree as Xml

import pytest
from rich.console import Console

from models.files.reading import load_scene
from reports.judge.cell import Cell
from reports.plan.study import Variant, load_study
from reports.protocol.way import TARGETS
from reports.requests.sweep import SweepRequest
from reports.results.recommend import Recommendation, recommendations
from reports.store.reader import Stored, read_store
from sim.engine import Drive
from sim.engine.settings import profile_of, resolved
from sim.mujoco.settings import writing
from sim.registry import engine as adapter
from sim.registry.offers import snippet
from tests.sim.registry.test_snippets import other
from tests.worlds import bare
from tests.worlds.bare import BARE
from tests.worlds.in_process import in_this_process

STUDY = """
scenes: [fourbar-lecture-1]
turns: 1
steps_per_turn: [90, 360, 1440, 5760]
variants:
  - {engine: mujoco, profile: as-shipped}
  - name: stiff
    engine: mujoco
    profile: as-shipped
    settings: {integrator: implicitfast, solref_timeconst_steps: 2.0,
               solimp_dmin: 0.9999, solimp_dmax: 0.9999}
  - {engine: mujoco, profile: tuned}
  - {engine: pymunk, profile: as-shipped}
  - {engine: pymunk, profile: tuned}
  - {engine: exudyn, profile: as-shipped}
  - {name: trapezoidal, engine: exudyn, profile: tuned, settings: {integrator: TrapezoidalIndex2}}
  - {engine: exudyn, profile: tuned}
"""
SETTINGS = {engine: profile_of(adapter(engine), "as-shipped").settings for engine in BARE}
Found = Mapping[tuple[str, float], Recommendation]
ROUNDING = 1e-10
"""rad: below this two runs of the same settings need not agree."""


def timed(_: object, cells: Sequence[tuple[Cell, float]], *__: object) -> list[object]:
    """In place of a clock [microseconds]."""
    us = {"mujoco": 2.5, "pymunk": 1.0, "exudyn": 9.0}
    return [((us[cell.engine],), (us[cell.engine],)) for cell, _ in cells]


@pytest.fixture(scope="module")
def store(tmp_path_factory: pytest.TempPathFactory) -> Stored:
    folder = tmp_path_factory.mktemp("store")
    study = folder.with_suffix(".yaml")
    study.write_text(STUDY, encoding="utf-8")
    quiet = Console(quiet=True)
    with in_this_process() as patch:
        patch.setattr("reports.sweep.measured.timed_in_turns", timed)
        assert SweepRequest(folder / "sweep", study=study, jobs=1).run(quiet, quiet) == 0
    return read_store(folder / "sweep")


@pytest.fixture(scope="module")
def recommended(store: Stored) -> Found:
    """By engine and target: every target is reached on the four-bar."""
    found = {(one.best.engine, one.target): one for one in recommendations(store) if not one.reason}
    assert found.keys() == {(engine, target) for engine in BARE for target in TARGETS}
    return found


@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize("engine", BARE)
def test_a_pasted_snippet_keeps_its_promise(engine: str, target: float, recommended: Found) -> None:
    one = recommended[engine, target]
    found = BARE[engine](one.snippet(), round(one.best.steps_per_turn), 10.0)
    assert found <= target
    # Not by being better than what was measured, either: these are the settings of the cell.
    assert found == pytest.approx(one.best.worst_error, rel=0.01, abs=ROUNDING)


@pytest.mark.parametrize("engine", BARE)
def test_a_snippet_for_another_speed_keeps_it_too(engine: str, recommended: Found) -> None:
    one = recommended[engine, 1e-4]
    text = one.snippet(period_s=2.0 * math.pi)
    found = BARE[engine](text, round(one.best.steps_per_turn), 1.0)
    assert found == pytest.approx(one.best.worst_error, rel=0.01, abs=ROUNDING)


def test_snippets_of_all_settings_give_the_measured_errors(store: Stored) -> None:
    """As-shipped ones too, which have settings in seconds."""
    cells = store.cells[store.cells["steps_per_turn"] == 360.0]
    assert len(cells) == 8
    for row in cells.itertuples():
        text = snippet(str(row.engine), json.loads(str(row.asked)), 360.0)
        found = BARE[str(row.engine)](text, 360, 10.0)
        assert found == pytest.approx(row.angle_error_rad, rel=0.01, abs=ROUNDING), row.variant


SHIPPED = [one for each in load_study(None).variants for one in each.each()]
OF_MUJOCO = [one for one in SHIPPED if one.engine == "mujoco"]


@pytest.mark.parametrize("drive", ["prescribed", "servo"])
@pytest.mark.parametrize("variant", OF_MUJOCO, ids=lambda v: v.name)
def test_mjcf_says_what_the_adapter_gives_mujoco(variant: Variant, drive: Drive) -> None:
    """Every attribute that differs from MuJoCo's default, as the text of a run has it."""
    scene = load_scene("fourbar-lecture-1")
    settings = resolved(profile_of(adapter("mujoco"), variant.profile), variant.chosen)
    text = snippet("mujoco", settings, 500, scene.driver.law.period_s, drive=drive)
    dt_s = scene.driver.law.period_s / 500
    run = writing(scene, settings, dt_s, drive)
    whole = Xml.fromstring(f"<mujoco>{bare.measured_as_we_did(text)}</mujoco>")
    connect = whole.find("default/default[@class='crankcheck-loop']/equality")
    held = {"integrator": "Euler", "solver": "Newton", "iterations": "100", "tolerance": "1e-8"}
    assert same(held | attributes(whole, "option"), run.option)
    held = {"island": "enable", "contact": "enable"}
    assert same(held | attributes(whole, "option/flag"), run.flag)
    held = {"solref": "0.02 1", "solimp": "0.9 0.95 0.001 0.5 2"}
    assert same(held | ({} if connect is None else connect.attrib), run.connect)


def attributes(model: Xml.Element, path: str) -> dict[str, str]:
    """Those of all elements there, of which MuJoCo takes the later ones."""
    return {name: value for each in model.findall(path) for name, value in each.attrib.items()}


def same(text: dict[str, str], values: object) -> bool:
    assert isinstance(values, dict)
    assert text.keys() == values.keys()
    for name, value in values.items():
        parts = value if isinstance(value, tuple) else (value,)
        for part, found in zip(parts, text[name].split(), strict=True):
            if found != part and float(found) != pytest.approx(float(part), rel=1e-12):
                return False
    return True


@pytest.mark.parametrize(
    ("engine", "name"), [(engine, name) for engine in BARE for name in SETTINGS[engine]]
)
def test_no_setting_is_left_out(engine: str, name: str) -> None:
    """Another value of any setting makes another snippet, with one drive or another."""
    default = {n: setting.value for n, setting in SETTINGS[engine].items()}
    changed = default | {name: other(name, default[name])}
    drives: tuple[Drive, ...] = ("prescribed", "servo", "free")
    before, after = (
        [snippet(engine, each, 90, drive=drive) for drive in drives] for each in (default, changed)
    )
    assert before != after


def test_defaults_are_not_repeated() -> None:
    """But for the integrators of MuJoCo and exudyn, which a user's model may have otherwise."""
    lines = {engine: snippet(engine, {}, 100, 1.0).splitlines() for engine in BARE}
    assert [line for line in lines["mujoco"] if line.startswith("<") and line[1] != "!"] == [
        '<option timestep="0.01" integrator="Euler"/>'
    ]
    code = [line for line in lines["pymunk"] if not line.startswith("#")]
    assert [line.partition("#")[0].strip() for line in code] == ["dt = 0.01", "space.step(dt)"]
    code = [line for line in lines["exudyn"] if not line.startswith("#")]
    assert code[1] == "dt = 0.01"
    assert code[3:] == ["stepping.solverType = exu.DynamicSolverType.GeneralizedAlpha"]


def test_a_mark_of_comment_in_a_name_does_no_harm() -> None:
    text = snippet("mujoco", {}, 100, head=["a -- b ---> <c>"])
    assert Xml.fromstring(f"<mujoco>{text}</mujoco>").find("option") is not None
    code = snippet("pymunk", {}, 100, head=["a\nspace.step(1)"])
    assert code.count("\nspace.step(") == 1
