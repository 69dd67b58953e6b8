"""Reading and compiling of an MJCF file, and of its included files in its own folder."""

import itertools
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from xml.parsers import expat

import numpy as np

from models.errors import EngineError, cut
from models.files.inputs import UnreadableError, regular_bytes
from sim.mujoco.own_model.closures import ModelError, name_of
from sim.mujoco.stepped import compiled_file

NESTED = 300
"""Largest number of nested elements; MuJoCo's own reader is recursive."""
TAG = re.compile(rb"""<(?:[^<>"']|"[^"]*"|'[^']*')*>""")


class XmlError(Exception):
    """A text that is no XML, or exceeds a limit; its text gives the reason."""


@dataclass(frozen=True)
class Tag:
    """A start tag: the names of its enclosing elements and its own, outermost first, its
    attributes, and its place in the text [byte]."""

    path: tuple[str, ...]
    attributes: Mapping[str, str]
    start: int
    end: int


def tags(raw: bytes) -> list[Tag]:
    """Parse the start tags in the order of the text; comments and the like have none.

    Raises
    ------
    XmlError
        No XML; entities, or elements nested deeper than `NESTED`.
    """
    parser, path, found = expat.ParserCreate(), [], []

    def begin(name: str, attributes: dict[str, str]) -> None:
        path.append(name)
        if len(path) > NESTED:
            raise XmlError(f"more than {NESTED} elements within each other")
        at = parser.CurrentByteIndex
        tag = TAG.match(raw, at)
        found.append(Tag(tuple(path), attributes, at, tag.end() if tag else at))

    def entity(*_: object) -> None:
        raise XmlError("it declares entities, which MJCF has none of")

    parser.StartElementHandler = begin
    parser.EndElementHandler = lambda _: path.pop()
    parser.EntityDeclHandler = entity
    try:
        parser.Parse(raw, True)
    except (expat.ExpatError, ValueError, LookupError) as error:
        raise XmlError(f"no XML: {error}") from None
    return found


MOST_BYTES = 20_000_000
"""Largest size of MJCF text [byte]; meshes are in files of their own."""
DEEPEST = 20
"""Largest depth of files that include one another."""
MOST_FILES = 1000
NUMBERS = (
    *(("body", f"body_{name}") for name in ("pos", "quat", "ipos", "iquat", "mass", "inertia")),
    *(("jnt", f"jnt_{name}") for name in ("pos", "axis", "range", "stiffness")),
    *(("site", f"site_{name}") for name in ("pos", "quat")),
)
"""Numbers of a model that MuJoCo accepts even if not finite."""
INCLUDING = ("include", "model")
"""Elements that read another MJCF file."""
CURE = "give an MJCF file, such as model.xml"


def load(path: Path) -> Any:
    """Compile the model of a file.

    Raises
    ------
    ModelError
        No such file, no MJCF, an included file that is missing or outside the folder of the model,
        or a model that MuJoCo refuses, in its own words.
    """
    files(path)
    try:
        model = compiled_file(path)
    except EngineError as error:
        raise ModelError(f"{path}: {cut(' '.join(str(error).split()), 600)}") from None
    for kind, name in NUMBERS:
        if len(wrong := np.argwhere(~np.isfinite(getattr(model, name)))):
            index = int(wrong[0][0])
            at = name_of(model, "joint" if kind == "jnt" else kind, index) or f"{kind} {index}"
            raise ModelError(f"{path}: {name} of {at} is not finite")
    return model


def text_of(path: Path) -> bytes:
    """Read the file. Raises ModelError for no plain file, and for a larger one."""
    try:
        return regular_bytes(path, MOST_BYTES)
    except UnreadableError as error:
        raise ModelError(f"{path}: {error}; {CURE}") from None


def files(path: Path) -> list[Path]:
    """List the file and all that it includes. Raises ModelError for a faulty inclusion."""
    found = list(itertools.islice(_files(path, path.resolve().parent, 0), MOST_FILES + 1))
    if len(found) > MOST_FILES:
        raise ModelError(f"{path}: it includes more than {MOST_FILES} files")
    return list(dict.fromkeys(found))


def _files(path: Path, folder: Path, depth: int) -> Iterator[Path]:
    """Yield `files`, some of them several times."""
    try:
        found = tags(text_of(path))
    except XmlError as error:
        raise ModelError(f"{path}: {error}; {CURE}") from None
    root = found[0].path[0]
    if depth == 0 and root != "mujoco":
        raise ModelError(f"{path}: its root is <{cut(root)}>, that of MJCF is <mujoco>; {CURE}")
    yield path
    for tag in found:
        kind, name = tag.path[-1], tag.attributes.get("file")
        if kind not in INCLUDING or name is None:
            continue
        inner = _included(path, folder, name)
        if not inner.resolve().is_relative_to(folder):
            raise ModelError(
                f"{path}: <{kind} file={name!r}> is outside the folder of the model; copy "
                f"it into {folder}, or a folder below"
            )
        if depth == DEEPEST:
            raise ModelError(f"{path}: more than {DEEPEST} files that include one another")
        if kind == "include" or inner.suffix.lower() in ("", ".xml", ".mjcf"):
            yield from _files(inner, folder, depth + 1)


def _included(path: Path, folder: Path, name: str) -> Path:
    """Return the file that MuJoCo takes: relative to the main file, else to the including one."""
    nearer = path.parent / name
    return nearer if nearer.exists() and not (folder / name).exists() else folder / name
