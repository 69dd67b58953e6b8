"""Models that a user may have written, and their judgement in this process."""

import tempfile
from functools import cache
from pathlib import Path

from reports.judge.cell import Checked
from reports.own_model.account import ModelAccount, ModelLine, checked_line, read_here
from reports.own_model.assembly import ModelRequest
from reports.own_model.judged import JudgedModel, judged_lines

FACTS = {"crankcheck": "0.0.0", "made": "2026-01-02T03:04:05+00:00"}
SLIDER_CRANK = """<mujoco model="engine">
  <option timestep="0.002"/>
  <worldbody>
    <body name="crank" pos="0 0 1">
      <joint name="motor" type="hinge" axis="0 1 0"/>
      <geom type="capsule" fromto="0 0 0 0.1 0 0" size="0.01"/>
      <body name="rod" pos="0.1 0 0">
        <joint name="big_end" type="hinge" axis="0 1 0"/>
        <geom name="rod" type="capsule" fromto="0 0 0 0.3 0 0" size="0.01"/>
      </body>
    </body>
    <body name="piston" pos="0.4 0 1">
      <joint name="bore" type="slide" axis="1 0 0"/>
      <geom name="piston" type="box" size="0.03 0.02 0.02"/>
    </body>
  </worldbody>
  <equality><connect name="wrist" body1="rod" body2="piston" anchor="0.3 0 0"/></equality>
</mujoco>
"""
"""The rod runs inside the piston, which pushes it."""
ACTUATORS = 40
MOTORS = "".join(f'<motor name="motor{number}" joint="knee"/>' for number in range(ACTUATORS))
CROWDED = f"""<mujoco model="crowded">
  <option timestep="0.004"/>
  <default><geom type="capsule" size="0.01" contype="0" conaffinity="0"/></default>
  <worldbody>
    <body name="rig" quat="0.8 0.3 0.4 0.33166247903554">
      <body name="crank">
        <joint name="hip" axis="0 0 1" damping="0.01"/><geom fromto="0 0 0 0.1 0 0"/>
        <body name="coupler" pos="0.1 0 0">
          <joint name="knee" axis="0 0 1" limited="true" range="-10 10"/>
          <geom fromto="0 0 0 0.15 0.2 0"/><site name="tip" pos="0.15 0.2 0"/>
        </body>
      </body>
      <body name="rocker" pos="0.3 0.001 0">
        <joint name="ankle" axis="0 0 -1" stiffness="0.2"/><geom fromto="0 0 0 -0.05 0.2 0"/>
        <site name="shin" pos="-0.05 0.2 0"/>
      </body>
    </body>
  </worldbody>
  <equality><connect name="toe" site1="tip" site2="shin"/></equality>
  <actuator>{MOTORS}</actuator>
</mujoco>
"""
"""Tilted in space, drawn open by a millimetre, hit by a limit, with many actuators."""


@cache
def judged(text: str, joint: str, turns: float = 1.0, dt_s: float | None = None) -> JudgedModel:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "mine.xml"
        path.write_text(text)
        account = read_here(ModelRequest(path, joint, 10.0, turns=turns, dt_s=dt_s))
        return judged_lines(account, checked_line, lambda _: None)


def read_text(folder: Path, text: str | bytes, **asked: object) -> ModelAccount:
    """A model of this text; its joint A is driven at 10 rad/s where nothing else is asked."""
    path = folder / "model.xml"
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return read_here(ModelRequest(path, **{"joint": "A", "speed_rad_s": 10.0, **asked}))  # type: ignore[arg-type]


def line(account: ModelAccount, profile: str) -> Checked:
    return checked_line(ModelLine(account, profile))


def texts(account: ModelAccount) -> list[str]:
    return [each.text for each in account.disturbances]
