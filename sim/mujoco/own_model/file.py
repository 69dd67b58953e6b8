"""Read and compile an MJCF file, and what it includes from its own folder."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from models.errors import EngineError, cut
from sim.mujoco.own_model.fault import ModelError
from sim.mujoco.stepped import compiled_file

MOST_BYTES = 20_000_000
DEEPEST = 20
"""Files that include one another."""
NESTED = 300
"""Elements within each other; MuJoCo's own reader calls itself for each."""
INCLUDING = ("include", "model")
"""Elements that read another MJCF file."""


def load(path: Path) -> Any:
    """The compiled model.

    Raises
    ------
    ModelError
        No such file, no MJCF, an included file that is missing or outside the folder of the model,
        or what MuJoCo refuses, in its own words.
    """
    for file in files(path):
        if file.stat().st_size > MOST_BYTES:
            raise ModelError(f"{file}: over {MOST_BYTES // 1_000_000} MB; MJCF text is shorter")
    try:
        return compiled_file(path)
    except EngineError as error:
        raise ModelError(f"{path}: {cut(' '.join(str(error).split()), 600)}") from None


def files(path: Path) -> list[Path]:
    """The file and all that it includes. Raises ModelError for what can not be included."""
    return list(dict.fromkeys(_files(path, path.resolve().parent, 0)))


def _files(path: Path, folder: Path, depth: int) -> Iterator[Path]:
    """As `files`, some of them several times."""
    root = _root(path)
    if depth == 0 and root.tag != "mujoco":
        raise ModelError(f"{path}: its root is <{cut(root.tag)}>; an MJCF file has <mujoco>")
    yield path
    for element in root.iter():
        name = element.get("file")
        if element.tag not in INCLUDING or name is None:
            continue
        # MuJoCo takes names as seen from the folder of the main file.
        inner = folder / name
        if not inner.resolve().is_relative_to(folder):
            raise ModelError(
                f"{path}: <{element.tag} file={name!r}> is outside the folder of the model; copy "
                f"it into {folder}, or a folder below"
            )
        if depth == DEEPEST:
            raise ModelError(f"{path}: more than {DEEPEST} files that include one another")
        if inner.suffix.lower() in ("", ".xml", ".mjcf"):
            yield from _files(inner, folder, depth + 1)


def _root(path: Path) -> ElementTree.Element:
    """The root element of a file."""
    try:
        depth = 0
        root: ElementTree.Element | None = None
        for event, element in ElementTree.iterparse(path, events=("start", "end")):
            depth += 1 if event == "start" else -1
            root = element if root is None else root
            if depth > NESTED:
                raise ModelError(f"{path}: more than {NESTED} elements within each other")
    except OSError as error:
        what = error.strerror or type(error).__name__
        raise ModelError(f"{path}: {what}; give an MJCF file, such as model.xml") from None
    except (ElementTree.ParseError, ValueError, LookupError) as error:
        raise ModelError(f"{path}: no XML: {error}; give an MJCF file") from None
    if root is None:
        raise ModelError(f"{path}: empty; give an MJCF file")
    return root
