"""The driven hinge keeps its speed, however the model around it is made."""

from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np
import pytest

from analytic.kinematics import solve
from models.errors import EngineError
from models.motion import State
from reports.own_model.assembly import assembled
from reports.own_model.request import ModelRequest
from sim.mujoco.own_model import session
from sim.mujoco.own_model.read import read_model
from sim.mujoco.own_model.session import OwnModelSession
from sim.mujoco.settings import INTEGRATORS
from sim.own_models import Advised

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
HEAVY = '<body pos="0 0 9"><freejoint/><geom size="9" density="1e9"/></body>'
CUT = """<body name="half"><joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 1 0"/>
      <joint axis="0 0 1"/><geom type="capsule" fromto="0 0 0 0.1 0 0" size="0.01"/></body>"""
CRANKS = {
    "a bar": {"crank": '<geom type="capsule" fromto="0 0 0 0.1 0 0" size="0.01"/>'},
    "a disc": {"crank": DISC},
    "balanced": {"crank": '<geom type="box" size="0.1 0.01 0.01"/>'},
    "cut off by a weld": {
        "crank": '<geom size="0.02"/>', "beside": CUT, "weld": '<weld body1="half" body2="crank"/>',
        "crank_end": "half"},
    "no mean inertia": {"crank": DISC, "more": '<statistic meaninertia="1e-30"/>'},
    "much mean inertia": {"crank": DISC, "more": '<statistic meaninertia="1e30"/>'},
    "a heavy body beside": {"crank": DISC, "beside": HEAVY},
}  # fmt: skip
BARE = {"beside": "", "weld": "", "more": "", "crank_end": "crank"}


def started(
    path: Path, crank: str, integrator: str = "as-written"
) -> tuple[OwnModelSession, State]:
    """A model with one of the cranks at its start, as written."""
    path.write_text(MODEL.format(rocker=ROCKER, **BARE | CRANKS[crank]), encoding="utf-8")
    own = read_model(path, "motor")
    scene = assembled(own, ModelRequest(path, "motor", 10.0)).scene
    start = solve(scene, np.zeros(1), bound=False).state()
    profile = own.engine(Advised()).profiles["as-written"]
    settings = {name: each.value for name, each in profile.settings.items()}
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
        EngineError, match=r"the driven joint is off by .* says nothing of the loops"
    ):
        run.record(315, 1)
