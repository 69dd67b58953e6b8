"""MuJoCo settings as MJCF."""

import textwrap
from collections.abc import Callable, Mapping, Sequence

from sim.engine import Drive, Settings, SettingValue
from sim.mujoco.settings import AS_SHIPPED, holds
from sim.registry.offers import ALONE, WIDTH, SnippetWriter, Stepping

IMPEDANCE = ("solimp_dmin", "solimp_dmax", "solimp_width")
INSET = "  "
"""Indent of an element within a comment: it keeps its own line."""
LOOP_CLASS = "crankcheck-loop"
"""Default class of the connects that close the mechanism, and of nothing else."""


def mujoco_snippet(
    asked: Settings, defaults: Settings, stepping: Stepping, drive: Drive, head: Sequence[str]
) -> list[str]:
    """Write sections to paste into ``<mujoco>``, which merges sections that it has twice.

    A class for the loop's own connects, and the step and integrator, which can only be the whole
    model's. Other differences from MuJoCo's defaults would change the rest of a user's model and
    are in a comment; see `sim.registry.offers.snippet`.
    """
    dt_s = stepping.dt_s
    complete = {**asked, **holds(asked, dt_s, drive)}
    connect = _connect(complete, defaults)
    whole = {"timestep": repr(dt_s), "integrator": str(complete["integrator"])}
    of_step = [
        "Step and integrator are the whole model's: all that it holds is stepped so.",
        _how_to_scale(complete, stepping, drive),
    ]
    if not float(complete["solref_timeconst_steps"]):
        of_step.append(
            f"solref stays {float(complete['solref_timeconst_s']):g} s whatever the speed: errors "
            "are those of the speeds at which they were measured."
        )
    usual = float(defaults["solref_timeconst_s"])
    if 2.0 * dt_s > usual:
        of_step.append(
            f"So long a step makes contacts softer: for their solref of {usual:g} s MuJoCo takes 2 "
            "timestep."
        )
    return [
        *_comment([*head, _where(complete, paired=bool(connect))]),
        *connect,
        *_comment(of_step),
        f"<option{_attributes(whole)}/>",
        *_comment(_alone(complete, defaults) + DRIVES[drive](asked)),
    ]


def _where(complete: Settings, *, paired: bool) -> str:
    """Say where to paste, and how the loop gets its own settings."""
    text = "Paste at the end of the mujoco element."
    if paired:
        text += f' Write class="{LOOP_CLASS}" on each connect that closes the mechanism.'
    if complete["close"]:
        text += f" Close the loops at {complete['close']}."
    return text


def _connect(complete: Settings, defaults: Settings) -> list[str]:
    """Write the class of the connects, unless it is MuJoCo's own; complete, as the model's own
    defaults would fill the rest."""
    timeconst = float(complete["solref_timeconst_s"])
    damping = float(complete["solref_dampratio"])
    impedance = tuple(complete[name] for name in IMPEDANCE)
    own = (defaults["solref_timeconst_s"], defaults["solref_dampratio"])
    if (timeconst, damping) == own and impedance == tuple(defaults[name] for name in IMPEDANCE):
        return []
    row = {
        "solref": f"{timeconst!r} {damping:g}",
        "solimp": " ".join([*(f"{value:g}" for value in impedance), "0.5", "2"]),
    }
    return [
        "<default>",
        f'  <default class="{LOOP_CLASS}">',
        f"    <equality{_attributes(row)}/>",
        "  </default>",
        "</default>",
    ]


def _how_to_scale(complete: Settings, stepping: Stepping, drive: Drive) -> str:
    """Say how to scale the step for another crank speed, or for free motion."""
    steps = float(complete["solref_timeconst_steps"])
    stiff = f", and solref = {steps:g} timestep." if steps else "."
    counted = stepping.counted_in(drive)
    if counted == "nothing":
        return f"Let go: timestep = {stepping.dt_s:g} s{stiff}"
    if counted == "turns":
        return stepping.scaled_by_speed("timestep") + stiff
    number, more = stepping.substeps, stepping.scaled_in_frames("them")
    return (
        f"A frame of {stepping.frame} is {number} of these steps: mj_step(model, data, "
        f"nstep={number}). {more}: timestep = frame / their number{stiff}"
    )


def _alone(complete: Settings, defaults: Settings) -> list[str]:
    """Write the option element for a model of the mechanism alone."""
    row = {
        name: str(complete[name])
        for name in ("solver", "iterations")
        if complete[name] != defaults[name]
    }
    if complete["tolerance"] != defaults["tolerance"]:
        row["tolerance"] = _short(complete["tolerance"])
    flags = {
        flag: str(complete[name])
        for name, flag in (("islands", "island"), ("contact", "contact"))
        if complete[name] != defaults[name]
    }
    if not row and not flags:
        return []
    lines = [f"<option{_attributes(row)}/>"]
    if flags:
        lines = [f"<option{_attributes(row)}>", f"  <flag{_attributes(flags)}/>", "</option>"]
    harm = "Without contacts bodies fall through each other; with them the numbers are the same."
    return [
        ALONE.format("model"),
        *(INSET + line for line in lines),
        *([harm] if "contact" in flags else []),
    ]


def _flywheel(complete: Settings) -> list[str]:
    ratio, tolerance = _short(complete["flywheel_ratio"]), _short(complete["tolerance"])
    return [
        f"Drive: the crank's hinge has armature = {ratio} (sum over all bodies of mass L^2 + "
        "inertia), L the longest link: a flywheel that keeps the speed it starts with (qvel). The "
        "other hinges start with the speeds that go with it.",
        f"tolerance is {tolerance} / {ratio}: MuJoCo scales it by the inertia of the model, "
        "flywheel included, and would stop too early. A drive of your own needs neither.",
    ]


def _servo(complete: Settings) -> list[str]:
    return [
        "Drive: <velocity joint=... kv=.../> on the crank's hinge, kv = "
        f"{complete['servo_gain']:g} speed (sum over all bodies of mass L^2 + inertia), L the "
        "longest link."
    ]


def _free(complete: Settings) -> list[str]:
    """Describe the start of free motion, and its settings outside MJCF."""
    share = _short(complete["free_inverse_weight_share"])
    scaled = (
        f"Once compiled, model.body_invweight0[:] *= {share}, in a model with nothing else in it; "
        "else for the bodies of the mechanism alone: without it loops give way more, and with so "
        "gentle a solref by far more."
    )
    start = "Drive: none. All hinges start with the angles and speeds of the start."
    return [start, *([scaled] if share != "1" else [])]


DRIVES: Mapping[Drive, Callable[[Settings], list[str]]] = {
    "prescribed": _flywheel,
    "servo": _servo,
    "free": _free,
}
"""Description of the drive in the measured runs."""


def _short(value: SettingValue) -> str:
    """Format a number without a sign and zeros in its exponent."""
    return f"{float(value):g}".replace("e+", "e").replace("e-0", "e-")


def _attributes(row: Mapping[str, str]) -> str:
    return "".join(f' {name}="{value}"' for name, value in row.items())


def _comment(paragraphs: Sequence[str]) -> list[str]:
    """Write paragraphs as an XML comment, in which two hyphens may not stand together."""
    lines: list[str] = []
    for paragraph in paragraphs:
        text = paragraph.replace("--", "- -").replace("--", "- -")
        whole = text.startswith(INSET)
        lines += [text] if whole else textwrap.wrap(text, WIDTH - 5, break_on_hyphens=False)
    if not lines:
        return []
    lines = [("<!-- " if i == 0 else "     ") + line for i, line in enumerate(lines)]
    return [*lines[:-1], f"{lines[-1]} -->"]


SNIPPET = SnippetWriter("xml", AS_SHIPPED, mujoco_snippet)
