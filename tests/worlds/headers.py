"""Headers of columns, mixed from the words, units and orders of twelve programs: ours, SolidWorks,
Adams, RecurDyn, Working Model, Simscape, MATLAB, ROS, Gazebo, Unity, MuJoCo, PMKS."""

import math
from dataclasses import dataclass
from random import Random

WORDS = {
    "theta": ("theta", "angle", "Angular Displacement", "Rz.q", "ROTATION", "Pos_RZ", "position",
              "θ", "rotation/z", "transform.eulerAngles.z", "qpos", "phi [2]"),
    "omega": ("omega", "Angular Velocity", "CM_Angular_Velocity.Z", "Vel_RZ", "Rz.w", "theta_dot",
              "velocity", "twist/angular/z", "angularVelocity.z", "qvel", "angVel", "ω"),
    "alpha": ("alpha", "Rz.b", "Angular Acceleration", "Acc_RZ", "acceleration", "thetaDDot",
              "accel/angular/z", "angularAcceleration.z", "angAccel", "qacc",
              "CM_Angular_Acceleration.Z"),
    "x": ("x", "X", "Pos_TX", "pos_x", "Linear Displacement - X", "Translational_Displacement.X",
          "pose/position/x", "xpos[0]", "transform.position.x", "p_x"),
    "vx": ("vx", "Vx_0", "Vel_TX", "vel_x", "Linear Velocity - X", "Translational_Velocity.X",
           "twist/linear/x", "velocity[0]", "v_x", "xdot", "x_dot"),
    "ax": ("ax", "Ax_0", "Acc_TX", "acc_x", "Linear Acceleration - X", "accel/linear/x",
           "Translational_Acceleration.X", "a_x", "acceleration[0]", "xDDot"),
    "v": ("v", "|V|", "Vel_TM", "Linear Velocity - Magnitude", "Translational_Velocity.Mag",
          "speed", "velocity_norm", "velMag"),
    "a": ("a", "|A|", "Acc_TM", "Linear Acceleration - Magnitude", "acceleration.mag", "accMag"),
}  # fmt: skip
_DEG, _MM = 180.0 / math.pi, 1e3
_PLAIN = {"theta": {"rad": 1.0, "radians": 1.0, "deg": _DEG, "°": _DEG, "Degrees": _DEG},
          "x": {"m": 1.0, "mm": _MM, "meters": 1.0, "in": 1.0 / 0.0254, "cm": 100.0}}  # fmt: skip
_OVER = {
    1: {"{}/s": 1.0, "{}/sec": 1.0, "{} s-1": 1.0, "{}·s⁻¹": 1.0, "{} per second": 1.0,
        "{}/min": 60.0, "{}_s": 1.0},
    2: {"{}/s^2": 1.0, "{}/sec**2": 1.0, "{}/s²": 1.0, "{} s-2": 1.0, "{}/(s*s)": 1.0,
        "{}/s/s": 1.0, "{} per second squared": 1.0, "{}*s^-2": 1.0, "{}/min^2": 3600.0},
}  # fmt: skip
_ROWS = ("theta x", "omega vx v", "alpha ax a")
ORDERS = ("{body}_{word} [{unit}]", "{word} {body} ({unit})", "{word}1-{body}-1 ({unit})",
          ".MODEL_1.{body}.{word} ({unit})", "/joint_states/{body}/{word} [{unit}]",
          "({unit}) {body} {word}", "{body} {word} in {unit}", "{word}({body}), {unit}",
          "{body}.{word}_{unit}", "{word} of {body} [ {unit} ]")  # fmt: skip
UNKNOWN = ("furlong/s", "rad/fortnight", "1/s", "Hz", "rad*s", "blip")
"""Units that are none of ours."""
FOREIGN = ("temperature_C", "current (A)", "seq", "status code", "cpu_load", "voltage_V",
           "motor current [A]", "Temp (°C)", "humidity [%]", "iteration", "pressure (bar)",
           "field.header.seq")  # fmt: skip
"""Names of no body and no quantity of a mechanism."""


@dataclass(frozen=True)
class Header:
    """A name of a column ``of`` a body, "" for none; ``what`` it is, and how many make one SI unit;
    whether its unit is ``known``."""

    text: str
    of: str
    what: str
    per: float
    known: bool


def header(random: Random) -> Header:
    """Return a header of a column of the four-bar: one of twenty has an unknown unit, another one
    names no body."""
    what = random.choice([*WORDS])
    turns = what in ("theta", "omega", "alpha")
    of = random.choice(("crank", "coupler", "rocker") if turns else ("B", "C"))
    rate = next(n for n, row in enumerate(_ROWS) if what in row.split())
    unit, per = random.choice([*_PLAIN["theta" if turns else "x"].items()])
    if rate:
        over, times = random.choice([*_OVER[rate].items()])
        unit, per = over.format(unit), per * times
    body, known = random.choice((of, of.capitalize(), of.upper())), True
    match random.randrange(20):
        case 0:
            unit, known = random.choice(UNKNOWN), False
        case 1:
            body = of = ""
    text = random.choice(ORDERS).format(body=body, word=random.choice(WORDS[what]), unit=unit)
    return Header(text, of, what, per, known)
