"""Small files of tables besides scenes (schemes, contacts): find one, read it, say its faults."""

from pathlib import Path
from typing import TypeVar

from pydantic import BaseModel, ValidationError

from models.errors import CrankcheckError, SceneError, cut, nearest, shown
from models.files.inputs import UnreadableError, regular_text, tables
from models.files.reading import is_there

M = TypeVar("M", bound=BaseModel)


def shipped_in(folder: Path) -> dict[str, Path]:
    """The files of a folder by name, in alphabetical order."""
    return {path.stem: path for path in sorted(folder.glob("*.toml"))}


def find_table(name_or_path: str, folder: Path, what: str, lists: str) -> Path:
    """The file of a shipped name, or of a path. Raises CrankcheckError where neither is there.

    ``what`` says what is looked for, ``lists`` which command lists the names.
    """
    known = shipped_in(folder)
    if name_or_path in known:
        return known[name_or_path]
    path = Path(name_or_path)
    if is_there(name_or_path):
        return path
    near = nearest(path.stem, known, cutoff=0.5)
    hint = f"Did you mean {' or '.join(near)}?" if near else f"`{lists}` lists the names."
    raise CrankcheckError(
        f"{what} {cut(name_or_path, 80)!r}: neither a shipped name nor a file. {hint}"
    )


def read_table(path: Path, model: type[M]) -> M:
    """The tables of a file. Raises SceneError with every fault of it."""
    try:
        raw = tables(regular_text(path))
    except UnreadableError as error:
        raise SceneError(str(path), [str(error)]) from None
    return table_of(raw, model, str(path))


def table_of(raw: dict[str, object], model: type[M], place: str) -> M:
    """Tables as a model; ``place`` names them in messages. Raises SceneError with every fault."""
    try:
        return model.model_validate(raw)
    except ValidationError as error:
        lines = [
            _line(each["loc"], each["type"], each["msg"], each["input"]) for each in error.errors()
        ]
        raise SceneError(place, lines) from None


def _line(loc: tuple[int | str, ...], kind: str, message: str, found: object) -> str:
    """One fault in one line: key, what was found, what would work."""
    key = ".".join(cut(str(part)) for part in loc if part != "[key]")
    if kind == "missing":
        return f"{key}: missing; add it"
    if kind == "extra_forbidden":
        return f"{key}: unknown key; leave it out"
    if kind == "value_error":
        return f"{key}: {message.removeprefix('Value error, ')}".removeprefix(": ")
    if kind == "string_pattern_mismatch":
        message = "a name is a letter, then up to 39 letters, digits, - or _"
    return f"{key}: found {shown(found)}; {message[0].lower()}{message[1:]}"
