"""MuJoCo settings as MJCF."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Mapping, Sequence

from sim.engine import Drive, Settings, SettingValue
from sim.mujoco.settings import AS_SHIPPED
from sim.snippets import SnippetWriter

SECTION = "Paste into the mujoco element: of sections that are there twice the later one adds."
WIDTH = 96


def mujoco_snippet(
    settings: Settings, steps_per_turn: float, period_s: float, drive: Drive, head: Sequence[str]
) -> str:
    """Sections to paste into ``<mujoco>``, which merges those that it has twice.

    Only what differs from MuJoCo's defaults; see `sim.snippets.snippet`.
    """
    defaults = {name: setting.value for name, setting in AS_SHIPPED.settings.items()}
    complete = defaults | dict(settings)
    dt_s = period_s / steps_per_turn
    lines = _comment([*head, SECTION])
    lines += _option(complete, defaults, dt_s, drive)
    lines += _equality(complete, defaults, dt_s)
    lines += _comment(
        [
            _how_to_scale(complete, steps_per_turn, period_s),
            *_absolute(complete),
            *(_servo(complete) if drive == "servo" else _flywheel(complete)),
            *_flags(complete, defaults),
            *([f"Close the loops at {complete['close']}."] if complete["close"] else []),
        ]
    )
    return "\n".join(lines) + "\n"


def _option(complete: Settings, defaults: Settings, dt_s: float, drive: Drive) -> list[str]:
    """The option element."""
    servo = drive == "servo"
    row = {"timestep": repr(dt_s)}
    integrator = complete["servo_integrator" if servo else "integrator"]
    if integrator != defaults["integrator"]:
        row["integrator"] = str(integrator)
    for name in ("solver", "iterations"):
        if complete[name] != defaults[name]:
            row[name] = str(complete[name])
    tolerance = float(complete["tolerance"]) / (1.0 if servo else float(complete["flywheel_ratio"]))
    if tolerance != defaults["tolerance"]:
        row["tolerance"] = _short(tolerance)
    flags = {
        flag: str(complete[name])
        for name, flag in (("islands", "island"), ("contact", "contact"))
        if complete[name] != defaults[name]
    }
    if not flags:
        return [f"<option{_attributes(row)}/>"]
    return [f"<option{_attributes(row)}>", f"  <flag{_attributes(flags)}/>", "</option>"]


def _equality(complete: Settings, defaults: Settings, dt_s: float) -> list[str]:
    """Defaults of the connects, where they are not MuJoCo's own."""
    row = {}
    solref = (_timeconst(complete, dt_s), float(complete["solref_dampratio"]))
    if solref != (defaults["solref_timeconst_s"], defaults["solref_dampratio"]):
        row["solref"] = f"{solref[0]!r} {solref[1]:g}"
    impedance = ("solimp_dmin", "solimp_dmax", "solimp_width")
    if any(complete[name] != defaults[name] for name in impedance):
        row["solimp"] = " ".join([*(f"{complete[name]:g}" for name in impedance), "0.5", "2"])
    return ["<default>", f"  <equality{_attributes(row)}/>", "</default>"] if row else []


def _timeconst(complete: Settings, dt_s: float) -> float:
    """Of the loop closures [s]."""
    steps = float(complete["solref_timeconst_steps"])
    return steps * dt_s if steps else float(complete["solref_timeconst_s"])


def _how_to_scale(complete: Settings, steps_per_turn: float, period_s: float) -> str:
    """What to write for another crank speed."""
    speed = 2.0 * math.pi / period_s
    text = (
        f"{steps_per_turn:g} steps a turn of a crank at {speed:.6g} rad/s. At another speed: "
        f"timestep = 2 pi / ({steps_per_turn:g} speed)"
    )
    steps = float(complete["solref_timeconst_steps"])
    return text + (f", and solref = {steps:g} timestep." if steps else ".")


def _absolute(complete: Settings) -> list[str]:
    """What does not scale with speed or size, and so limits what was measured."""
    if float(complete["solref_timeconst_steps"]):
        return []
    return [
        f"solref stays {float(complete['solref_timeconst_s']):g} s whatever the speed: errors are "
        "those of the speeds at which they were measured."
    ]


def _flywheel(complete: Settings) -> list[str]:
    """How the crank is driven, and what that asks of the solver."""
    ratio, tolerance = _short(complete["flywheel_ratio"]), _short(complete["tolerance"])
    return [
        f"Drive: the crank's hinge has armature = {ratio} (sum over all bodies of mass L^2 + "
        "inertia), L the longest link: a flywheel that keeps the speed it starts with (qvel). The "
        "other hinges start with the speeds that go with it.",
        f"tolerance is {tolerance} / {ratio}: MuJoCo scales it by the inertia of the model, "
        f"flywheel included. Without a flywheel write {tolerance}.",
    ]


def _servo(complete: Settings) -> list[str]:
    """The drive by a servo."""
    return [
        "Drive: <velocity joint=... kv=.../> on the crank's hinge, kv = "
        f"{complete['servo_gain']:g} speed (sum over all bodies of mass L^2 + inertia), L the "
        "longest link."
    ]


def _flags(complete: Settings, defaults: Settings) -> list[str]:
    """When the flags are to be left out."""
    if complete["contact"] == defaults["contact"]:
        return []
    return ["Leave out contact where bodies touch: without contacts it only saves time."]


def _short(value: SettingValue) -> str:
    """A number without a sign and zeros in its exponent."""
    return f"{float(value):g}".replace("e+", "e").replace("e-0", "e-")


def _attributes(row: Mapping[str, str]) -> str:
    return "".join(f' {name}="{value}"' for name, value in row.items())


def _comment(paragraphs: Sequence[str]) -> list[str]:
    """Paragraphs as an XML comment, in which two hyphens may not stand together."""
    lines: list[str] = []
    for paragraph in paragraphs:
        text = paragraph.replace("--", "- -").replace("--", "- -")
        lines += textwrap.wrap(text, WIDTH - 5, break_on_hyphens=False)
    return [("<!-- " if i == 0 else "     ") + line for i, line in enumerate(lines[:-1])] + [
        ("<!-- " if len(lines) == 1 else "     ") + f"{lines[-1]} -->"
    ]


SNIPPET = SnippetWriter("xml", mujoco_snippet)
