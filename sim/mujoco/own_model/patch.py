"""The recommended settings as a diff of the user's own file."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from difflib import unified_diff
from pathlib import Path
from typing import Any

import mujoco  # type: ignore[import-untyped]  # ships no stubs

from models.errors import EngineError
from sim.mujoco.own_model.variants import (
    INTEGRATOR,
    LEAST,
    SOLVER,
    SOLVERS,
    STIFF_SOLIMP,
    TOLERANCE,
    stiff_solref,
)
from sim.mujoco.own_model.xml_tags import Tag, tags
from sim.mujoco.settings import INTEGRATORS
from sim.own_models import Advised

ATTRIBUTE = re.compile(rb"""([\w:.-]+)(\s*=\s*)("[^"]*"|'[^']*')""")


@dataclass(frozen=True)
class RecommendedAttributes:
    """Attributes to set: of <option>, of its <flag>, and of each element that closes a loop."""

    option: Mapping[str, str]
    flag: Mapping[str, str]
    loop: Mapping[str, str]

    def words(self) -> str:
        """What to set where, in words."""
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
    """What is recommended at a step, where the model has not got it."""
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
    """The text of a model with the recommended attributes in it.

    ``loops`` are the numbers of its ``count`` equalities that close loops.

    Raises
    ------
    EngineError
        The equalities do not all stand in this text, one by one.
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
    """Both texts as a unified diff. Without the lines around a change `git apply` refuses it, and
    `patch` changes any other file. Raises EngineError for what is not UTF-8."""
    try:
        lines = list(unified_diff(_lines(raw), _lines(new), path.name, path.name, n=3))
    except UnicodeDecodeError:
        raise EngineError("the file is not UTF-8") from None
    # A last line without an end has to say so.
    return "".join(
        line if line.endswith("\n") else f"{line}\n\\ No newline at end of file\n" for line in lines
    )


def _lines(raw: bytes) -> list[str]:
    """Lines with their ends; those of Windows keep theirs."""
    return [line + "\n" for line in raw.decode().split("\n")[:-1]] + [
        line for line in raw.decode().split("\n")[-1:] if line
    ]


def _options(
    raw: bytes, found: list[Tag], advised: RecommendedAttributes
) -> Iterator[tuple[int, int, bytes]]:
    """Where <option> and its <flag> change, the last of each, as it overrides the ones before;
    elements that are not there are put in."""
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
    """An element without content."""
    return _set(b"<" + name + b"/>", attributes)


def _with(raw: bytes, tag: Tag, attributes: Mapping[str, str]) -> bytes:
    """A start tag of the text with some attributes set."""
    return _set(raw[tag.start : tag.end], attributes)


def _set(tag: bytes, attributes: Mapping[str, str]) -> bytes:
    """A start tag with some attributes set: what is there is replaced, the rest added."""
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
