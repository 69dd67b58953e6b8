"""MuJoCo settings as MJCF."""

from collections.abc import Mapping, Sequence

from sim.engine import Drive, Settings, SettingValue
from sim.mujoco.settings import AS_SHIPPED, holds
from sim.registry.offers import SnippetWriter, Stepping, alone, comment

CONNECT = ("solref_timeconst_s", "solref_dampratio", "solimp_dmin", "solimp_dmax", "solimp_width")
LOOP_CLASS = "crankcheck-loop"
"""Default class of the connects that close the mechanism, and of nothing else."""
DRIVES: Mapping[Drive, tuple[str, ...]] = {
    "prescribed": (
        "Drive: the crank's hinge has armature = {ratio} (sum over all bodies of mass L^2 + "
        "inertia), L the longest link: a flywheel that keeps the speed it starts with (qvel). "
        "The other hinges start with the matching speeds.",
        "tolerance is {stop} / {ratio}: MuJoCo scales it by the inertia of the model, "
        "flywheel included, and would stop too early. A drive of your own needs neither.",
    ),
    "servo": (
        "Drive: <velocity joint=... kv=.../> on the crank's hinge, kv = {servo_gain:g} speed (sum "
        "over all bodies of mass L^2 + inertia), L the longest link.",
    ),
    "free": (
        "Drive: none. All hinges start with the angles and speeds of the start.",
        "Once compiled, model.body_invweight0[:] *= {share}, in a model with nothing else in "
        "it; else for the bodies of the mechanism alone: without it loops give way more, and "
        "with so soft a solref by far more.",
    ),
}
"""Drive of the crank in the measured runs."""


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
    where = "Paste at the end of the mujoco element."
    if connect:
        where += f' Write class="{LOOP_CLASS}" on each connect that closes the mechanism.'
    if complete["close"]:
        where += f" Close the loops at {complete['close']}."
    of_step = [
        "Step and integrator apply to the whole model.",
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
    ratio, stop = _short(asked["flywheel_ratio"]), _short(asked["tolerance"])
    share = _short(asked["free_inverse_weight_share"])
    driven = [text.format(ratio=ratio, stop=stop, share=share, **asked) for text in DRIVES[drive]]
    if drive == "free" and share == "1":  # nothing to scale
        driven.pop()
    return [
        *comment(*head, where, xml=True),
        *connect,
        *comment(*of_step, xml=True),
        f"<option{_attributes(timestep=repr(dt_s), integrator=complete['integrator'])}/>",
        *comment(*_alone(complete, defaults), *driven, xml=True),
    ]


def _connect(complete: Settings, defaults: Settings) -> list[str]:
    """Write the class of the connects, if any: complete, as the model's defaults fill the rest."""
    if all(complete[name] == defaults[name] for name in CONNECT):
        return []
    timeconst, damping, *impedance = (float(complete[name]) for name in CONNECT)
    solimp = " ".join([*(f"{value:g}" for value in impedance), "0.5", "2"])
    return [
        "<default>",
        f'  <default class="{LOOP_CLASS}">',
        f"    <equality{_attributes(solref=f'{timeconst!r} {damping:g}', solimp=solimp)}/>",
        "  </default>",
        "</default>",
    ]


def _how_to_scale(complete: Settings, stepping: Stepping, drive: Drive) -> str:
    """Say how to scale the step for another crank speed, or for free motion."""
    number = stepping.substeps
    how = {
        "nothing": f"Free motion: timestep = {stepping.dt_s:g} s",
        "turns": stepping.scaled_by_speed("timestep"),
        "frames": f"A frame of {stepping.frame} is {number} of these steps: mj_step(model, data, "
        f"nstep={number}). {stepping.scaled_in_frames('them')}: timestep = frame / their number",
    }
    steps = float(complete["solref_timeconst_steps"])
    stiff = f", and solref = {steps:g} timestep." if steps else "."
    return how[stepping.counted_in(drive)] + stiff


def _alone(complete: Settings, defaults: Settings) -> list[str]:
    """Write the option element for a model of the mechanism alone."""
    other = {name: value for name, value in complete.items() if defaults.get(name, value) != value}
    if "tolerance" in other:
        other["tolerance"] = _short(other["tolerance"])
    row = {name: other[name] for name in ("solver", "iterations", "tolerance") if name in other}
    named = {"islands": "island", "contact": "contact"}
    flags = {flag: other[name] for name, flag in named.items() if name in other}
    lines = [f"<option{_attributes(**row)}/>"] if row else []
    if flags:
        lines = [f"<option{_attributes(**row)}>", f"  <flag{_attributes(**flags)}/>", "</option>"]
    harm = "Without contacts bodies fall through each other; with them the numbers are the same."
    return alone("model", lines) + [harm] * ("contact" in flags)


def _short(value: SettingValue) -> str:
    """Format a number without a sign and zeros in its exponent."""
    return f"{float(value):g}".replace("e+", "e").replace("e-0", "e-")


def _attributes(**row: SettingValue) -> str:
    return "".join(f' {name}="{value}"' for name, value in row.items())


SNIPPET = SnippetWriter("xml", AS_SHIPPED, mujoco_snippet)
