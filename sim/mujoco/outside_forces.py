"""What `mj_rnePostConstraint` counts as a force from outside depends on MuJoCo's version."""

from __future__ import annotations

from functools import lru_cache

import mujoco  # type: ignore[import-untyped]  # ships no stubs

PROBE = """<mujoco>
  <worldbody>
    <site name="still" pos="0 1 0"/>
    <body>
      <joint axis="0 0 1"/>
      <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
      <site name="moving" pos="1 0 0"/>
    </body>
  </worldbody>
  <tendon>
    <spatial stiffness="1" springlength="0">
      <site site="still"/>
      <site site="moving"/>
    </spatial>
  </tendon>
</mujoco>"""


@lru_cache
def springs_between_points_are_outside() -> bool:
    """Whether the springs of spatial tendons are among them, as in 4.0.0, or seem to come through
    the joints, as those of fixed tendons do; asked of the MuJoCo that is installed."""
    model = mujoco.MjModel.from_xml_string(PROBE)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    mujoco.mj_rnePostConstraint(model, data)
    return bool(data.cfrc_ext[1].any())
