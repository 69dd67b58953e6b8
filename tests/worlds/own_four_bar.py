"""A healthy four-bar as somebody may have written it, and how to plant something in it."""

HEALTHY = """<mujoco model="four-bar">
  <compiler angle="radian"/>
  <option timestep="0.001" integrator="RK4" gravity="0 0 0" tolerance="1e-16"/>
  <default>
    <geom type="capsule" size="0.004" contype="0" conaffinity="0"/>
    <joint axis="0 -1 0"/>
    <equality solref="0.005 0.6" solimp="0.9999 0.9999 0.001 0.5 2"/>
  </default>
  <worldbody>
    <body name="crank">
      <joint name="A"/>
      <geom name="crank-bar" fromto="0 0 0 0 0 0.1"/>
      <body name="coupler" pos="0 0 0.1">
        <joint name="B"/>
        <geom name="coupler-bar" fromto="0 0 0 0.23373437 0 0.08870312"/>
        <site name="coupler-tip" pos="0.23373437 0 0.08870312"/>
      </body>
    </body>
    <body name="rocker" pos="0.3 0 0">
      <joint name="D"/>
      <geom name="rocker-bar" fromto="0 0 0 -0.06626563 0 0.18870312"/>
      <site name="rocker-tip" pos="-0.06626563 0 0.18870312"/>
    </body>
  </worldbody>
  <equality>
    <connect name="C" body1="coupler" body2="rocker" anchor="0.23373437 0 0.08870312"/>
  </equality>
</mujoco>
"""
CLOSED = '<connect name="C" body1="coupler" body2="rocker" anchor="0.23373437 0 0.08870312"/>'
BY_SITES = '<connect name="C" site1="coupler-tip" site2="rocker-tip"/>'
ROCKER_JOINT = '<joint name="D"/>'


def rocker(attributes: str) -> tuple[str, str]:
    """An edit that gives the hinge of the rocker some attributes."""
    return ROCKER_JOINT, f'<joint name="D" {attributes}/>'


def tied(equality: str) -> tuple[str, str]:
    """An edit that adds to the equalities."""
    return "</equality>", f"{equality}</equality>"


def planted(*edits: str) -> str:
    """The four-bar with old and new texts by turns."""
    text = HEALTHY
    for old, new in zip(edits[::2], edits[1::2], strict=True):
        assert old in text, old
        text = text.replace(old, new)
    return text
