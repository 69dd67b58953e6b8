"""An MJCF file, read and compiled with its included files; and its equality constraints."""

import itertools
import re
from collections.abc import Container, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal
from xml.parsers import expat

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np

from models.array import Array
from models.errors import EngineError, cut
from models.files.inputs import UnreadableError, regular_bytes
from sim.mujoco.stepped import compiled


class ModelError(EngineError):
    """A model that cannot be read, or that is no planar mechanism with one driver."""


MOST = 40
SEPARATORS = "./:"
"""Separators between the names of a body and of a thing on it."""
REMARK = ": "


def scene_name(name: str, otherwise: str, taken: Container[str]) -> str:
    """Return an unused name for a scene: the model's own as far as possible."""
    plain = re.sub(r"[^A-Za-z0-9_-]+", "-", name).strip("-_")[:MOST]
    if not plain or not plain[0].isalpha():
        plain = f"{otherwise}{'-' if plain else ''}{plain}"[:MOST]
    unused, count = plain, 1
    while unused in taken:
        count += 1
        tail = f"-{count}"
        unused = plain[: MOST - len(tail)] + tail
    return unused


def point_of(name: str, bodies: Container[str]) -> str:
    """Return the point of a name: ``crank.B`` on body ``crank`` is ``B``, and a remark after a
    colon is left out."""
    point = name.partition(REMARK)[0] or name
    for at, sign in enumerate(point):
        if sign in SEPARATORS and point[:at] in bodies and point[at + 1 :]:
            return point[at + 1 :]
    return point


SITE = mujoco.mjtObj.mjOBJ_SITE.value
IDLE = int(mujoco.mjtDisableBit.mjDSBL_EQUALITY) | int(mujoco.mjtDisableBit.mjDSBL_CONSTRAINT)
"""Flags of a model without active constraints."""
KINDS = {
    kind.value: kind.name.removeprefix("mjEQ_").lower()
    for kind in mujoco.mjtEq.__members__.values()
}


@dataclass(frozen=True, eq=False)
class ModelClosure:
    """A `connect` or `weld` between two bodies.

    ``anchors`` are the two copies of its point in space (3,) [m] as the model is drawn;
    ``rotation`` (3, 3) is the second body's when the weld holds, for the first as drawn. A weld of
    no torque is a ``connect`` here: it leaves the angle free.
    """

    index: int
    name: str
    kind: Literal["connect", "weld"]
    bodies: tuple[int, int]
    anchors: tuple[Array, Array]
    rotation: Array


@dataclass(frozen=True)
class Coupling:
    """Any other equality, with the bodies of its one or two sides; it closes no loop."""

    index: int
    name: str
    kind: str
    sides: tuple[tuple[int, ...], ...]


def name_of(model: Any, kind: str, index: int) -> str:
    """Return the name in the file of a ``joint``, a ``body`` and the like; empty without one."""
    own = getattr(mujoco.mjtObj, f"mjOBJ_{kind.upper()}")
    return mujoco.mj_id2name(model, own.value, index) or ""


def body_name(model: Any, body: int) -> str:
    """Return the name of a body, or its number."""
    return name_of(model, "body", body) or f"body{body}"


def equalities(model: Any, data: Any) -> tuple[list[ModelClosure], list[Coupling]]:
    """Return the active equalities of the model, at the pose of ``data``."""
    closures, couplings = [], []
    if int(model.opt.disableflags) & IDLE:
        return [], []
    for index in map(int, np.flatnonzero(model.eq_active0)):
        kind = KINDS[int(model.eq_type[index])]
        name = name_of(model, "equality", index)
        if kind in ("connect", "weld"):
            closures.append(_closure(model, data, index, name, kind))
        else:
            couplings.append(
                Coupling(index, name or f"equality {index}", kind, _coupled(model, index, kind))
            )
    return closures, couplings


def _closure(model: Any, data: Any, index: int, name: str, kind: str) -> ModelClosure:
    ends = (int(model.eq_obj1id[index]), int(model.eq_obj2id[index]))
    own = model.eq_data[index]
    if int(model.eq_objtype[index]) == SITE:
        first, second = (int(model.site_bodyid[site]) for site in ends)
        anchors = tuple(data.site_xpos[site].copy() for site in ends)
        frames = [data.site_xmat[site].reshape(3, 3) for site in ends]
        rotation = frames[0] @ frames[1].T @ _rotation(data, second)
        sites = [name_of(model, "site", site) for site in ends]
        name = name or REMARK.join(filter(None, sites))
    else:
        first, second = ends
        # In a weld the anchors are the other way round.
        locals_ = (own[0:3], own[3:6]) if kind == "connect" else (own[3:6], own[0:3])
        anchors = tuple(
            data.xpos[body] + _rotation(data, body) @ local
            for body, local in zip(ends, locals_, strict=True)
        )
        relative = np.empty(9)
        mujoco.mju_quat2Mat(relative, own[6:10] if kind == "weld" else np.array([1.0, 0, 0, 0]))
        rotation = _rotation(data, first) @ relative.reshape(3, 3)
    if not name:
        name = " to ".join(body_name(model, body) for body in (first, second))
    if not np.isfinite([*anchors, *rotation]).all():
        raise ModelError(f"<{kind}> {name}: its anchor or pose is not finite")
    turns = kind == "connect" or float(own[10]) == 0.0
    return ModelClosure(
        index,
        name,
        "connect" if turns else "weld",
        (first, second),
        (anchors[0], anchors[1]),
        rotation,
    )


def _rotation(data: Any, body: int) -> Array:
    return np.array(data.xmat[body]).reshape(3, 3)


def _coupled(model: Any, index: int, kind: str) -> tuple[tuple[int, ...], ...]:
    """Return the bodies whose coordinates an equality couples, on each of its sides."""
    ends = [int(model.eq_obj1id[index]), int(model.eq_obj2id[index])]
    if kind == "joint":
        return tuple((int(model.jnt_bodyid[joint]),) for joint in ends if joint >= 0)
    if kind == "tendon":
        return tuple(tendon_bodies(model, tendon) for tendon in ends if tendon >= 0)
    return ()


def tendon_bodies(model: Any, tendon: int) -> tuple[int, ...]:
    """Return the bodies that a tendon goes over."""
    first = int(model.tendon_adr[tendon])
    bodies = []
    for wrap in range(first, first + int(model.tendon_num[tendon])):
        kind, index = int(model.wrap_type[wrap]), int(model.wrap_objid[wrap])
        if kind == mujoco.mjtWrap.mjWRAP_JOINT.value:
            bodies.append(int(model.jnt_bodyid[index]))
        elif kind == mujoco.mjtWrap.mjWRAP_SITE.value:
            bodies.append(int(model.site_bodyid[index]))
        elif kind in (mujoco.mjtWrap.mjWRAP_SPHERE.value, mujoco.mjtWrap.mjWRAP_CYLINDER.value):
            bodies.append(int(model.geom_bodyid[index]))
    return tuple(bodies)


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
        model = compiled(path=path)
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
