"""Variants of a model at run time that show the effect of a part: something off, or the recommended
settings. Its profiles name them."""

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from difflib import unified_diff
from pathlib import Path
from typing import Any

import mujoco  # type: ignore[import-untyped]  # ships no stubs

from models.errors import EngineError
from models.mjcf.options import STIFF_DAMPING, STIFF_IMPEDANCE, STIFF_STEPS
from sim.engine import Profile, Setting, Settings, SettingValue
from sim.engine.settings import SettingError, check_choices
from sim.mujoco.own_model.file import Tag, tags
from sim.mujoco.settings import INTEGRATORS
from sim.registry.own_models import Advised

AS_WRITTEN, RECOMMENDED = "as-written", "recommended"
KEPT, STIFF = "as-written", "stiff"
INTEGRATOR = "RK4"
TOLERANCE = 1e-16
"""Recommended tolerance of the solver: below it no error falls any more, and it costs no iteration
where the only constraints are pins, which Newton solves in one."""
STIFF_SOLIMP = (STIFF_IMPEDANCE, STIFF_IMPEDANCE, 0.001, 0.5, 2.0)
OFF: Mapping[str, Any] = {
    "contacts": mujoco.mjtDisableBit.mjDSBL_CONTACT,
    "springs": mujoco.mjtDisableBit.mjDSBL_SPRING,
    "damping": mujoco.mjtDisableBit.mjDSBL_DAMPER,
    "friction": mujoco.mjtDisableBit.mjDSBL_FRICTIONLOSS,
    "limits": mujoco.mjtDisableBit.mjDSBL_LIMIT,
    "actuators": mujoco.mjtDisableBit.mjDSBL_ACTUATION,
    "gravity": mujoco.mjtDisableBit.mjDSBL_GRAVITY,
}
"""Parts that can be off, and MuJoCo's flags for them."""
SOLVERS = ("PGS", "CG", "Newton")
SOLVER = "Newton"
LEAST: Mapping[str, int] = {"iterations": 100, "ls_iterations": 50}
"""Recommended iterations of the solver: MuJoCo's own; a model that allows more keeps them."""
CHOICES = {"integrator": (KEPT, *INTEGRATORS), "loops": (KEPT, STIFF)}


def profiles(present: Iterable[str], advised: Advised) -> dict[str, Profile]:
    """Return the profiles: as written, without each part that is ``present``, recommended."""
    lines = [
        _profile(AS_WRITTEN, "the file as it is"),
        *(
            _profile(f"{what}-off", f"as written, without {what}", off=what)
            for what in dict.fromkeys(("contacts", *present))
        ),
        _profile(
            RECOMMENDED,
            f"{'fourth-order steps, and ' * advised.integrator}loops as stiff as the step allows",
            integrator=INTEGRATOR if advised.integrator else KEPT,
            loops=STIFF,
            off="contacts" if advised.contacts_off else "",
        ),
    ]
    return {line.name: line for line in lines}


def _profile(
    name: str, summary: str, integrator: str = KEPT, loops: str = KEPT, off: str = ""
) -> Profile:
    return Profile(
        name,
        "mujoco",
        summary,
        {
            "integrator": Setting(integrator, "the file's own, or the recommended one"),
            "loops": Setting(loops, "solref and solimp of the loops, and the solver"),
            "off": Setting(off, "parts that are switched off, with + between"),
        },
    )


def stiff_solref(dt_s: float) -> tuple[float, float]:
    """Return the recommended time constant [s] and damping ratio of a loop at a step; in six
    digits, for pasting."""
    return float(f"{STIFF_STEPS * dt_s:.6g}"), STIFF_DAMPING


def checked(settings: Settings) -> None:
    """Refuse meaningless values. Raises SettingError."""
    check_choices(settings, CHOICES)
    for name in _names(settings):
        if name not in OFF:
            raise SettingError(f"setting off: found {name!r}; it takes {', '.join(OFF)}")


def applied(model: Any, loops: Iterable[int], settings: Settings, dt_s: float) -> None:
    """Set a model, whose loops are these equalities, to the settings and the step."""
    checked(settings)
    model.opt.timestep = dt_s
    if settings["integrator"] != KEPT:
        model.opt.integrator = INTEGRATORS.index(str(settings["integrator"]))
    for name in _names(settings):
        model.opt.disableflags |= int(OFF[name])
    if settings["loops"] == STIFF:
        model.opt.tolerance = min(TOLERANCE, float(model.opt.tolerance))
        model.opt.solver = SOLVERS.index(SOLVER)
        for name, least in LEAST.items():
            setattr(model.opt, name, max(least, int(getattr(model.opt, name))))
        for loop in loops:
            model.eq_solref[loop] = stiff_solref(dt_s)
            model.eq_solimp[loop] = STIFF_SOLIMP


def held(model: Any, loops: Iterable[int], settings: Settings) -> dict[str, SettingValue]:
    """Return the settings, and MuJoCo's values of all that decides accuracy."""
    opt = model.opt
    told: dict[str, SettingValue] = {
        **settings,
        "timestep_s": float(opt.timestep),
        "integrator_held": INTEGRATORS[int(opt.integrator)],
        "solver": SOLVERS[int(opt.solver)],
        **{name: int(getattr(opt, name)) for name in LEAST},
        "tolerance": float(opt.tolerance),
        "disableflags": int(opt.disableflags),
    }
    rows = [
        " ".join(f"{number:g}" for number in (*model.eq_solref[loop], *model.eq_solimp[loop]))
        for loop in loops
    ]
    return told | {"loops_solref_solimp": "; ".join(dict.fromkeys(rows))}


def _names(settings: Settings) -> list[str]:
    return [name for name in str(settings["off"]).split("+") if name]


ATTRIBUTE = re.compile(rb"""([\w:.-]+)(\s*=\s*)("[^"]*"|'[^']*')""")
LINE = re.compile(r"[^\n]*\n|[^\n]+")
"""A line with its end; Windows ends stay."""


@dataclass(frozen=True)
class RecommendedAttributes:
    """Attributes to set: of <option>, of its <flag>, and of each element that closes a loop."""

    option: Mapping[str, str]
    flag: Mapping[str, str]
    loop: Mapping[str, str]

    def words(self) -> str:
        """Describe the attributes and their places in words."""
        parts = []
        for place, attributes in (
            ("in <option>", self.option),
            ("in its <flag>", self.flag),
            ("in each element that closes a loop", self.loop),
        ):
            if attributes:
                each = " ".join(f'{name}="{value}"' for name, value in attributes.items())
                parts.append(f"{place}: {each}")
        return "set " + "; ".join(parts)


def advice(model: Any, dt_s: float, advised: Advised) -> RecommendedAttributes:
    """Return the recommendations at a step that the model does not have yet."""
    option = {}
    if float(model.opt.timestep) != dt_s:
        option["timestep"] = repr(dt_s)
    if advised.integrator and INTEGRATORS[int(model.opt.integrator)] != INTEGRATOR:
        option["integrator"] = INTEGRATOR
    if SOLVERS[int(model.opt.solver)] != SOLVER:
        option["solver"] = SOLVER
    for name, least in LEAST.items():
        if int(getattr(model.opt, name)) < least:
            option[name] = str(least)
    if float(model.opt.tolerance) > TOLERANCE:
        option["tolerance"] = f"{TOLERANCE:g}"
    off = int(model.opt.disableflags) & int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
    return RecommendedAttributes(
        option,
        {"contact": "disable"} if advised.contacts_off and not off else {},
        {
            "solref": " ".join(repr(number) for number in stiff_solref(dt_s)),
            "solimp": " ".join(f"{number:g}" for number in STIFF_SOLIMP),
        },
    )


def patched(raw: bytes, loops: Iterable[int], count: int, advised: RecommendedAttributes) -> bytes:
    """Return the text of a model with the recommended attributes in it.

    ``loops`` are the numbers of its ``count`` equalities that close loops.

    Raises
    ------
    EngineError
        The equalities are not all in this text, one by one.
    """
    found = tags(raw)
    own = [tag for tag in found if len(tag.path) == 3 and tag.path[1] == "equality"]
    if len(own) != count:
        raise EngineError(f"{len(own)} of its {count} equalities stand in the file itself")
    edits = [
        (tag.start, tag.end, _with(raw, tag, advised.loop)) for tag in map(own.__getitem__, loops)
    ]
    edits += _options(raw, found, advised)
    for start, end, new in sorted(edits, reverse=True):
        raw = raw[:start] + new + raw[end:]
    return raw


def diff(path: Path, raw: bytes, new: bytes) -> str:
    """Return both texts as a unified diff. Without the lines around a change `git apply` refuses
    it, and `patch` changes any other file. Raises EngineError for text that is not UTF-8."""
    try:
        before, after = (LINE.findall(text.decode()) for text in (raw, new))
        lines = list(unified_diff(before, after, path.name, path.name, n=3))
    except UnicodeDecodeError:
        raise EngineError("the file is not UTF-8") from None
    # A last line without an end has a remark.
    return "".join(
        line if line.endswith("\n") else f"{line}\n\\ No newline at end of file\n" for line in lines
    )


def _options(
    raw: bytes, found: list[Tag], advised: RecommendedAttributes
) -> Iterator[tuple[int, int, bytes]]:
    """Yield the changes of <option> and its <flag>, the last of each, as it overrides the ones
    before; missing elements are added."""
    if not advised.option and not advised.flag:
        return
    flag_tag = _tag(b"flag", advised.flag) if advised.flag else b""
    options = [tag for tag in found if tag.path[1:] == ("option",)]
    flags = [tag for tag in found if tag.path[1:] == ("option", "flag")]
    if not options:
        root = found[0]
        inner = _tag(b"option", advised.option)
        if flag_tag:
            inner = inner[:-2] + b">" + flag_tag + b"</option>"
        newline = b"\r\n" if b"\r\n" in raw else b"\n"
        yield root.end, root.end, newline + b"  " + inner
        return
    option = options[-1]
    tag = _with(raw, option, advised.option)
    if flag_tag and flags:
        yield flags[-1].start, flags[-1].end, _with(raw, flags[-1], advised.flag)
    elif flag_tag and tag.endswith(b"/>"):
        tag = tag[:-2].rstrip() + b">" + flag_tag + b"</option>"
    elif flag_tag:
        tag += flag_tag
    yield option.start, option.end, tag


def _tag(name: bytes, attributes: Mapping[str, str]) -> bytes:
    return _set(b"<" + name + b"/>", attributes)


def _with(raw: bytes, tag: Tag, attributes: Mapping[str, str]) -> bytes:
    return _set(raw[tag.start : tag.end], attributes)


def _set(tag: bytes, attributes: Mapping[str, str]) -> bytes:
    """Return a start tag with some attributes set: existing ones are replaced, the rest added."""
    left = dict(attributes)

    def replaced(found: re.Match[bytes]) -> bytes:
        value = left.pop(found.group(1).decode(errors="replace"), None)
        if value is None:
            return found.group()
        return found.group(1) + found.group(2) + f'"{value}"'.encode()

    tag = ATTRIBUTE.sub(replaced, tag)
    end = b"/>" if tag.endswith(b"/>") else b">"
    more = "".join(f' {name}="{value}"' for name, value in left.items()).encode()
    return tag[: -len(end)].rstrip() + more + end if more else tag
