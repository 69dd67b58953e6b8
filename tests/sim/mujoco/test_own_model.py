"""A user's own model: held in the poses of its closed form it is what was read, its driven hinge
keeps its speed, and the recommended settings come as a diff that applies to its very file.
"""

import itertools
import shutil
import subprocess
from dataclasses import replace
from functools import partial
from pathlib import Path

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np
import pytest

from analytic.kinematics import solve
from models.errors import EngineError
from models.motion import State
from models.scene import Scene
from reports.own_model.assembly import ModelRequest, assembled
from sim.mujoco.own_model import session
from sim.mujoco.own_model.file import ModelError
from sim.mujoco.own_model.read_model import ReadModel, read_model
from sim.mujoco.own_model.session import OwnModelSession
from sim.mujoco.own_model.variants import (
    RECOMMENDED,
    RecommendedAttributes,
    advice,
    applied,
    patched,
    profiles,
)
from sim.mujoco.settings import INTEGRATORS
from sim.registry.own_models import Advised, Tour
from tests.worlds.own_four_bar import CLOSED, HEALTHY, planted, rocker


def held(own: ReadModel, scene: Scene) -> Tour:
    motion = solve(scene, np.linspace(0.0, 6.28, 9), bound=False)
    return own.tour(scene, [motion.state(index) for index in range(9)])


def test_a_model_that_was_misread_is_not_run(tmp_path: Path) -> None:
    path = tmp_path / "model.xml"
    path.write_text(HEALTHY, encoding="utf-8")
    own = read_model(path, "A")
    assert held(own, own.scene) == Tour({}, [])
    coupler = own.scene.links["coupler"]
    (x, y) = coupler.points["C"]
    longer = replace(coupler, points={**coupler.points, "C": (x + 1e-5, y)})
    other = replace(own.scene, links={**own.scene.links, "coupler": longer})
    with pytest.raises(ModelError, match=r"model.xml: loop C: closed in the .* misread"):
        held(own, other)


def test_a_limit_is_passed_beyond_rounding_alone(tmp_path: Path) -> None:
    (tmp_path / "model.xml").write_text(planted(*rocker('limited="true" range="-1 1"')))
    own, end = read_model(tmp_path / "model.xml", "A").planar, np.ones(3)
    assert not session._passed(own, -end, end + 1e-12)
    assert session._passed(own, -end, end + 1e-6)


BALL = (
    '<geom name="floor" type="plane" size="5 5 0.1" pos="0 0 0.05" contype="1" conaffinity="1"/>'
    '<body name="ball" pos="3 3 0.25"><freejoint/>'
    '<geom name="ball" type="sphere" size="0.2" contype="1" conaffinity="1"/></body>'
)


def test_what_touches_beside_the_linkage_is_not_told(tmp_path: Path) -> None:
    path = tmp_path / "model.xml"
    path.write_text(
        planted(
            "<worldbody>", f"<worldbody>{BALL}",
            'conaffinity="0"/>\n    <joint', 'conaffinity="1"/>\n    <joint',
        )
    )  # fmt: skip
    own = read_model(path, "A")
    touching = held(own, own.scene).touching.keys()
    assert {("floor", "rocker-bar"), ("coupler-bar", "floor")} <= touching
    assert not any("ball" in pair for pair in touching)


BAR = '<geom type="capsule" fromto="0 0 0 0.3 0 0" size="0.01"/>'
ROCKER = f"""<body name="rocker" pos="0.4 0 0" euler="0 0 110"><joint axis="0 0 1"/>{BAR}
      <body name="rod" pos="0.3 0 0" euler="0 0 90"><joint axis="0 0 1"/>{BAR}</body></body>"""
MODEL = """<mujoco>
  <option timestep="0.002"/>{more}
  <default><geom contype="0" conaffinity="0"/></default>
  <worldbody>
    <body name="crank"><joint name="motor" axis="0 0 1"/>{crank}</body>{beside}
    {rocker}
  </worldbody>
  <equality>{weld}<connect body1="rod" body2="{crank_end}" anchor="0.3 0 0"/></equality>
</mujoco>
"""
DISC = '<geom type="cylinder" size="0.1 0.01"/>'
CUT = """<body name="half"><joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 1 0"/>
      <joint axis="0 0 1"/><geom type="capsule" fromto="0 0 0 0.1 0 0" size="0.01"/></body>"""
CRANKS = {
    "a bar": {"crank": '<geom type="capsule" fromto="0 0 0 0.1 0 0" size="0.01"/>'},
    "a disc": {"crank": DISC},
    "cut off by a weld": {
        "crank": '<geom size="0.02"/>', "beside": CUT, "weld": '<weld body1="half" body2="crank"/>',
        "crank_end": "half"},
    "no mean inertia": {"crank": DISC, "more": '<statistic meaninertia="1e-30"/>'},
}  # fmt: skip
BARE = {"beside": "", "weld": "", "more": "", "crank_end": "crank"}


def started(
    path: Path, crank: str, integrator: str = "as-written"
) -> tuple[OwnModelSession, State]:
    path.write_text(MODEL.format(rocker=ROCKER, **BARE | CRANKS[crank]), encoding="utf-8")
    own = read_model(path, "motor")
    scene = assembled(own, ModelRequest(path, "motor", 10.0))[0]
    start = solve(scene, np.zeros(1), bound=False).state()
    settings = own.engine(Advised()).profiles["as-written"].values
    settings["integrator"] = integrator
    return OwnModelSession(own.planar, scene, start, settings, 0.002, "prescribed"), start


@pytest.mark.parametrize(
    ("crank", "integrator"),
    [*itertools.product(CRANKS, ["as-written"]), *itertools.product(["a disc"], INTEGRATORS)],
)
def test_the_driven_hinge_keeps_its_speed(crank: str, integrator: str, tmp_path: Path) -> None:
    run, start = started(tmp_path / "model.xml", crank, integrator)
    run.step(315)
    turned = float(run.read().bodies["crank"].theta[0]) - start.theta["crank"]
    assert turned == pytest.approx(6.3, abs=1e-9)


def test_a_drive_that_is_lost_is_no_verdict_on_the_model(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(session, "FLYWHEEL_RATIO", 1e3)
    run, _ = started(tmp_path / "model.xml", "a bar")
    with pytest.raises(
        EngineError, match=r"the driven joint is off by .* shows nothing of the loops"
    ):
        run.record(315, 1)


PLAIN = planted(
    ' integrator="RK4"', "", ' tolerance="1e-16"', "",
    '<equality solref="0.005 0.6" solimp="0.9999 0.9999 0.001 0.5 2"/>', "",
)  # fmt: skip
"""As most models are: MuJoCo's own settings."""
BOUND = '<equality><connect body1="coupler" body2="rocker" anchor="0 0 0"/></equality>'
FORMS = {
    "plain": PLAIN,
    "windows": PLAIN.replace("\n", "\r\n"),
    "mark": "\ufeff" + PLAIN,
    "no final newline": PLAIN.rstrip("\n"),
    "one line": PLAIN.replace("\n", " "),
    "single quotes": PLAIN.replace('"', "'"),
    "no option": PLAIN.replace('<option timestep="0.001" gravity="0 0 0"/>', ""),
    "comments": PLAIN.replace("<worldbody>", f"<!-- {BOUND}<option/> --><worldbody>"),
    "larger than": PLAIN.replace('name="C"', 'name="C > > />"'),
    "two options": PLAIN.replace("<worldbody>", '<option integrator="Euler"/><worldbody>'),
    "a flag": PLAIN.replace(
        'gravity="0 0 0"/>', 'gravity="0 0 0"><flag energy="enable"/></option>'),
    "two equalities": PLAIN.replace(
        "<equality>", '<equality><connect body1="crank" anchor="0 0 0"/></equality><equality>'),
    "settings": PLAIN.replace('name="C"', 'name="C" solref = "0.03 1" solimp=\'0.9 0.95 0.001\''),
    "a class": PLAIN.replace(
        "</default>",
        '<default class="soft"><equality solref="0.1 1"></equality></default></default>',
    ).replace('name="C"', 'name="C" class="soft"'),
    "broken tag": PLAIN.replace('body1="coupler"', '\n   body1="coupler"\n'),
    "letters": PLAIN.replace('model="four-bar"', 'model="vierg\u00e9lenk \u2028 \x85"'),
    "recommended already": planted(),
}  # fmt: skip


def read(path: Path, text: str) -> ReadModel:
    path.write_bytes(text.encode())
    return read_model(path, "A")


def wanted(own: ReadModel, dt_s: float, advised: Advised) -> mujoco.MjModel:
    """The model with what the line `recommended` sets."""
    settings = profiles((), advised)[RECOMMENDED].values
    model = mujoco.MjModel.from_xml_path(str(own.path))
    applied(model, own.planar.loops, settings, dt_s)
    return model


def assert_alike(found: mujoco.MjModel, model: mujoco.MjModel) -> None:
    for name in ("timestep", "integrator", "tolerance", "disableflags", "enableflags", "solver"):
        assert getattr(found.opt, name) == getattr(model.opt, name), name
    np.testing.assert_array_equal(found.eq_solref, model.eq_solref)
    np.testing.assert_array_equal(found.eq_solimp, model.eq_solimp)
    np.testing.assert_array_equal(found.body_pos, model.body_pos)


@pytest.mark.skipif(shutil.which("patch") is None, reason="the program patch is not there")
@pytest.mark.parametrize(
    ("form", "off"),
    [*((form, False) for form in FORMS), ("no option", True), ("a flag", True)],
)
def test_the_program_patch_takes_it(form: str, off: bool, tmp_path: Path) -> None:
    own = read(tmp_path / "model.xml", FORMS[form])
    text = own.patch(0.001, Advised(contacts_off=off))
    expected = wanted(own, 0.001, Advised(contacts_off=off))
    assert text.startswith("--- model.xml\n+++ model.xml\n@@ ")
    command = ["patch", "--binary", "model.xml"]
    assert b"fuzz" not in subprocess.check_output(command, input=text.encode(), cwd=tmp_path)
    assert_alike(mujoco.MjModel.from_xml_path(str(own.path)), expected)
    assert ("\r\n" in FORMS[form]) == (b"\r\n" in own.path.read_bytes())


@pytest.mark.skipif(shutil.which("git") is None, reason="git is not there")
def test_git_takes_it_and_another_file_is_refused(tmp_path: Path) -> None:
    """And nothing else of the file changes."""
    own = read(tmp_path / "model.xml", PLAIN)
    text = own.patch(0.001, Advised())
    removed = [line[1:].strip() for line in text.splitlines()[2:] if line.startswith("-")]
    assert removed == ['<option timestep="0.001" gravity="0 0 0"/>', CLOSED]
    assert "timestep" not in advice(own.planar.model, 0.001, Advised()).option
    expected = wanted(own, 0.001, Advised())
    apply = partial(subprocess.run, ["git", "apply", "-"], input=text.encode(), cwd=tmp_path)
    assert apply(capture_output=True).returncode == 0
    assert_alike(mujoco.MjModel.from_xml_path(str(own.path)), expected)
    assert apply(capture_output=True).returncode != 0


def test_a_finer_tolerance_of_the_user_stays(tmp_path: Path) -> None:
    fine = PLAIN.replace('timestep="0.001"', 'timestep="0.001" tolerance="1e-20"')
    own = read(tmp_path / "model.xml", fine)
    assert "tolerance" not in advice(own.planar.model, 0.001, Advised()).option
    assert float(wanted(own, 0.001, Advised()).opt.tolerance) == 1e-20


@pytest.mark.parametrize("place", ["before", "after"])
def test_what_an_include_overrides_is_said_in_words(place: str, tmp_path: Path) -> None:
    (tmp_path / "more.xml").write_text('<mujoco><option integrator="Euler"/></mujoco>')
    mark = "<default>" if place == "before" else "<worldbody>"
    text = PLAIN.replace(mark, '<include file="more.xml"/>' + mark)
    said = read(tmp_path / "model.xml", text).patch(0.001, Advised())
    assert said.startswith("its includes override the file itself: set in <option>: integr")


def test_equalities_of_another_file_are_said_in_words(tmp_path: Path) -> None:
    (tmp_path / "more.xml").write_text(f"<mujoco><equality>{CLOSED}</equality></mujoco>")
    text = PLAIN.replace(CLOSED, "").replace("</mujoco>", '<include file="more.xml"/></mujoco>')
    said = read(tmp_path / "model.xml", text).patch(0.001, Advised(contacts_off=True))
    assert said.startswith("0 of its 1 equalities stand in the file itself: set in <option>:")
    assert 'in its <flag>: contact="disable"' in said
    assert 'solref="0.005 0.6"' in said


def test_a_file_in_another_encoding_is_said_in_words(tmp_path: Path) -> None:
    path = tmp_path / "model.xml"
    head = '<?xml version="1.0" encoding="ISO-8859-1"?>'
    path.write_bytes((head + PLAIN.replace('"four-bar"', '"viergl\u00e9"')).encode("latin-1"))
    said = read_model(path, "A").patch(0.001, Advised())
    assert said.startswith("the file is not UTF-8: set in <option>")


def test_more_equalities_than_the_text_has_are_an_error() -> None:
    with pytest.raises(EngineError, match="1 of its 2 equalities"):
        patched(PLAIN.encode(), [0], 2, RecommendedAttributes({}, {}, {}))


def test_the_numbers_to_paste_are_those_that_are_run(tmp_path: Path) -> None:
    own, dt_s = read(tmp_path / "model.xml", PLAIN), 1.0 / 3000.0
    text = own.patch(dt_s, Advised())
    assert 'solref="0.00166667 0.6"' in text
    assert f'timestep="{dt_s!r}"' in text
    assert tuple(wanted(own, dt_s, Advised()).eq_solref[0]) == (0.00166667, 0.6)
