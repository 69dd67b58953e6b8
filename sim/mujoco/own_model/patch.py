"""The recommended settings as a diff of the user's own file."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable, Mapping
from pathlib import Path

from models.errors import EngineError
from models.mjcf_options import STIFF_DAMPING, STIFF_IMPEDANCE, STIFF_STEPS
from sim.mujoco.own_model.variants import TOLERANCE

EQUALITIES = ("connect", "weld", "joint", "tendon", "flex", "flexvert", "flexstrain", "distance")
"""Elements of <equality>, which MuJoCo numbers in the order of the file."""
COMMENT = re.compile(r"<!--.*?-->|<!\[CDATA\[.*?\]\]>", re.DOTALL)
BLOCK = re.compile(r"<equality\b[^>]*?(?<!/)>.*?</equality\s*>", re.DOTALL)


def attributes(dt_s: float) -> tuple[dict[str, str], dict[str, str]]:
    """The recommended attributes of <option>, and of each element that closes a loop."""
    impedance = f"{STIFF_IMPEDANCE:g}"
    return (
        {"timestep": f"{dt_s:.9g}", "integrator": "RK4", "tolerance": f"{TOLERANCE:g}"},
        {
            "solref": f"{STIFF_STEPS * dt_s:.9g} {STIFF_DAMPING:g}",
            "solimp": f"{impedance} {impedance} 0.001 0.5 2",
        },
    )


def in_words(dt_s: float, *, touching: bool) -> str:
    """The same as attributes to set."""
    option, loop = (
        " ".join(f'{name}="{value}"' for name, value in each.items()) for each in attributes(dt_s)
    )
    flag = ', <flag contact="disable"/>' if touching else ""
    return f"set in <option>: {option}{flag}; in each element that closes a loop: {loop}"


def patched(text: str, loops: Iterable[int], count: int, dt_s: float, *, touching: bool) -> str:
    """The text of a model with the recommended attributes in it.

    ``loops`` are the numbers of its ``count`` equalities that close loops. Where ``touching`` links
    would push one another contacts are disabled.

    Raises
    ------
    EngineError
        The equalities do not all stand in this text, one by one.
    """
    option, loop = attributes(dt_s)
    bare = COMMENT.sub(lambda found: re.sub(r"[^\n]", " ", found.group()), text)
    element = re.compile(rf"<({'|'.join(EQUALITIES)})\b[^>]*>")
    tags = [
        (block.start() + tag.start(), block.start() + tag.end())
        for block in BLOCK.finditer(bare)
        for tag in element.finditer(block.group())
    ]
    if len(tags) != count:
        raise EngineError(f"{len(tags)} of its {count} equalities stand in the file itself")
    edits = [(*tags[number], _with(text[slice(*tags[number])], loop)) for number in loops]
    edits += _option(text, bare, option, touching=touching)
    for start, end, new in sorted(edits, reverse=True):
        text = text[:start] + new + text[end:]
    return text


def diff(path: Path, text: str, new: str) -> str:
    """Both texts as a unified diff, which `patch` takes."""
    lines = difflib.unified_diff(
        text.splitlines(keepends=True),
        new.splitlines(keepends=True),
        path.name,
        path.name,
        n=0,
    )
    return "".join(line if line.endswith("\n") else f"{line}\n" for line in lines)


def _option(
    text: str, bare: str, option: Mapping[str, str], *, touching: bool
) -> list[tuple[int, int, str]]:
    """Where <option> and its <flag> change; elements that are not there are put in."""
    edits = []
    found = re.search(r"<option\b[^>]*>", bare)
    flag = re.search(r"<flag\b[^>]*>", bare)
    own = '<flag contact="disable"/>' if touching else ""
    if found is None:
        root = re.search(r"<mujoco\b[^>]*>", bare)
        if root is None:
            raise EngineError("no <mujoco> stands in the file itself")
        tag = _with("<option/>", option)
        new = f"{tag[:-2]}>{own}</option>" if own else tag
        return [(root.end(), root.end(), f"\n  {new}")]
    tag = _with(text[found.start() : found.end()], option)
    if own and flag is not None:
        edits.append((flag.start(), flag.end(), _with(flag.group(), {"contact": "disable"})))
    elif own and tag.endswith("/>"):
        tag = f"{tag[:-2].rstrip()}>{own}</option>"
    elif own:
        tag += own
    return [*edits, (found.start(), found.end(), tag)]


def _with(tag: str, attributes: Mapping[str, str]) -> str:
    """A start tag with some attributes set: what is there is replaced, the rest added."""
    for name, value in attributes.items():
        own = re.compile(rf"""(\s{name}\s*=\s*)("[^"]*"|'[^']*')""")
        if own.search(tag):
            tag = own.sub(lambda found, value=value: f'{found.group(1)}"{value}"', tag)  # type: ignore[misc]
        else:
            end = "/>" if tag.endswith("/>") else ">"
            tag = f'{tag[: -len(end)].rstrip()} {name}="{value}"{end}'
    return tag
