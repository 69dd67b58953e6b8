"""The four-bar in MuJoCo and in pymunk as a user would write it, with a place for a snippet."""

from __future__ import annotations

import math
import re
from collections.abc import Callable

import mujoco
import numpy as np
import pymunk

from models.array import Array
from tests.worlds.bare_exudyn import exudyn_error
from tests.worlds.fourbar import (
    COUPLER,
    CRANK,
    GROUND,
    ROCKER,
    START,
    TURNS,
    angles,
    rates,
    worst,
)

Fourbar = tuple[tuple[pymunk.Body, ...], tuple[pymunk.Constraint, ...]]
"""Crank, coupler and rocker, and their joints."""


BODIES = """
    <body euler="0 0 {crank!r}">
      <joint name="A" axis="0 0 1" armature="{flywheel!r}"/>
      <inertial pos="0.05 0 0" mass="0.1" diaginertia="8.333333333333e-5 8.333333333333e-5 8.333333333333e-5"/>
      <body pos="0.1 0 0" euler="0 0 {coupler_in_crank!r}">
        <joint axis="0 0 1"/>
        <inertial pos="0.125 0 0" mass="0.25" diaginertia="1.302083333333e-3 1.302083333333e-3 1.302083333333e-3"/>
        <site name="C of the coupler" pos="0.25 0 0"/>
      </body>
    </body>
    <body pos="0.3 0 0" euler="0 0 {rocker!r}">
      <joint axis="0 0 1"/>
      <inertial pos="0.1 0 0" mass="0.2" diaginertia="6.666666666667e-4 6.666666666667e-4 6.666666666667e-4"/>
      <site name="C of the rocker" pos="0.2 0 0"/>
    </body>
"""  # noqa: E501
CONNECT = '<connect site1="C of the coupler" site2="C of the rocker"/>'
MJCF = f"""
<mujoco>
  <compiler angle="radian" inertiafromgeom="false"/>
  <worldbody>{BODIES}</worldbody>
  <equality>{CONNECT}</equality>
</mujoco>
"""
CLASS = 'class="crankcheck-loop"'


def measured_as_we_did(snippet: str) -> str:
    """The snippet with the settings that stand in its comments in force, too."""
    elements = re.findall(r"^ {5,}(</?(?:option|flag).*?>)(?: -->)?$", snippet, re.MULTILINE)
    return re.sub(r"^#   (?=space\.)", "", snippet, flags=re.MULTILINE) + "\n".join(elements)


def fourbar_bodies(text: str, flywheel: float) -> str:
    """MJCF text with the four-bar's places filled in."""
    coupler, rocker = (float(each[0]) for each in angles(np.array([START])))
    return text.format(
        crank=START, coupler_in_crank=coupler - START, rocker=rocker, flywheel=flywheel
    )


def pasted(text: str, snippet: str) -> str:
    """MJCF text with the snippet done to it: at its end, and on the connect of the loop."""
    if CLASS in snippet:
        text = text.replace(CONNECT, CONNECT.replace("<connect", f"<connect {CLASS}"))
    return text.replace("</mujoco>", f"{snippet}</mujoco>")


def mujoco_error(snippet: str, steps: int, speed: float) -> float:
    """The largest error of coupler and rocker [rad] over two turns of the MJCF with a snippet."""
    # The snippet's rule: 1e12 times the sum of mass L^2 + inertia, L = 0.3 m.
    flywheel = 1e12 * (0.55 * 0.3**2 + (0.1**3 + 0.25**3 + 0.2**3) / 12)
    text = fourbar_bodies(MJCF, flywheel)
    model = mujoco.MjModel.from_xml_string(pasted(text, measured_as_we_did(snippet)))
    return _turned(model, steps, speed, lambda turned: START + speed * _times(model, len(turned)))


def mujoco_error_of_geometry(snippet: str, steps: int, speed: float) -> float:
    """As `mujoco_error`, at the angle that the crank has, driven by a motor of a user's own, with
    nothing in force but what is."""
    motor = f'<actuator><velocity joint="A" kv="{0.5 / speed}"/></actuator></mujoco>'
    text = fourbar_bodies(MJCF, 0.0).replace("</mujoco>", motor)
    model = mujoco.MjModel.from_xml_string(pasted(text, snippet))
    return _turned(model, steps, speed, lambda turned: START + turned[:, 0])


def _times(model: mujoco.MjModel, samples: int) -> Array:
    times: Array = model.opt.timestep * np.arange(samples)
    return times


def _turned(
    model: mujoco.MjModel, steps: int, speed: float, crank: Callable[[Array], Array]
) -> float:
    """The error over two turns, where the true angle of the crank follows from the angles."""
    coupler, rocker = (float(each[0]) for each in angles(np.array([START])))
    start = mujoco.MjData(model)
    of_coupler, of_rocker = rates(START, speed)
    start.qvel[:] = speed, of_coupler - speed, of_rocker
    start.ctrl[:] = speed
    turned = np.empty((TURNS * steps + 1, 3))
    for row in turned:
        row[:] = start.qpos
        mujoco.mj_step(model, start)
    exact = angles(crank(turned))
    found = (START + turned[:, 0] + coupler - START + turned[:, 1], rocker + turned[:, 2])
    return worst(found, exact)


def pymunk_fourbar(space: pymunk.Space, speed: float) -> Fourbar:
    """The four-bar added to a space."""
    at_start = tuple(float(each[0]) for each in angles(np.array([START])))
    b = CRANK * math.cos(START), CRANK * math.sin(START)
    c = GROUND + ROCKER * math.cos(at_start[1]), ROCKER * math.sin(at_start[1])
    of_coupler, of_rocker = rates(START, speed)
    crank = pymunk.Body(body_type=pymunk.Body.KINEMATIC)
    crank.angle, crank.angular_velocity = START, speed
    coupler = pymunk.Body(0.25, 0.25 * 0.25**2 / 12)
    coupler.position = (b[0] + c[0]) / 2, (b[1] + c[1]) / 2
    coupler.angle, coupler.angular_velocity = at_start[0], of_coupler
    rocker = pymunk.Body(0.2, 0.2 * 0.2**2 / 12)
    rocker.position = (GROUND + c[0]) / 2, c[1] / 2
    rocker.angle, rocker.angular_velocity = at_start[1], of_rocker
    of_c = -of_rocker * c[1], of_rocker * (c[0] - GROUND)
    of_b = -speed * b[1], speed * b[0]
    rocker.velocity = of_c[0] / 2, of_c[1] / 2
    coupler.velocity = (of_b[0] + of_c[0]) / 2, (of_b[1] + of_c[1]) / 2
    joints = (
        pymunk.PivotJoint(crank, coupler, (CRANK, 0.0), (-COUPLER / 2, 0.0)),
        pymunk.PivotJoint(coupler, rocker, (COUPLER / 2, 0.0), (ROCKER / 2, 0.0)),
        pymunk.PivotJoint(space.static_body, rocker, (GROUND, 0.0), (-ROCKER / 2, 0.0)),
    )
    space.add(crank, coupler, rocker, *joints)
    return (crank, coupler, rocker), joints


class Clocked(pymunk.Space):
    """A space that knows how long it was stepped."""

    time_s = 0.0

    def step(self, dt: float) -> None:
        super().step(dt)
        self.time_s += dt


def pymunk_error(snippet: str, steps: int, speed: float) -> float:
    """The largest error of coupler and rocker [rad] over two turns of a space with a snippet, which
    is run so many ``steps`` times in a turn, and may step the space several times."""
    space = Clocked()
    (crank, coupler, rocker), joints = pymunk_fourbar(space, speed)
    names: dict[str, object] = {"space": space, "joints": joints}
    turned, times = [(crank.angle, coupler.angle, rocker.angle)], [0.0]
    run = compile(measured_as_we_did(snippet), "snippet", "exec")
    for _ in range(TURNS * steps):
        exec(run, names)
        turned.append((crank.angle, coupler.angle, rocker.angle))
        times.append(space.time_s)
    exact = angles(START + speed * np.array(times))
    _, *found = np.array(turned).T
    return worst(tuple(found), exact)


BARE: dict[str, Callable[[str, int, float], float]] = {
    "mujoco": mujoco_error,
    "pymunk": pymunk_error,
    "exudyn": exudyn_error,
}
"""By engine, the error [rad] with a snippet, at steps a turn and a speed of the crank [rad/s]."""
