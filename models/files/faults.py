"""Tables of a user's file as a pydantic model, and all their faults in the words of a message."""

from collections.abc import Mapping
from pathlib import Path
from typing import TypeVar, get_args

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from models.errors import SceneError, cut, shown, suggestion
from models.files.inputs import UnreadableError, regular_text, tables

M = TypeVar("M", bound=BaseModel)
OF_PYDANTIC = ("[key]", "list[", "constrained-str")
"""Parts of a place that the file has not: a key itself, and kinds of values."""


def read_table(path: Path, model: type[M], place: str = "") -> M:
    """Read the tables of a file, named ``place`` in messages. Raises SceneError with all faults."""
    try:
        raw = tables(regular_text(path))
    except UnreadableError as error:
        raise SceneError(place or str(path), [str(error)]) from None
    return table_of(raw, model, place or str(path))


def table_of(raw: Mapping[str, object], model: type[M], place: str) -> M:
    """Validate tables as a model; ``place`` names them in messages. Raises SceneError."""
    faults: list[str] = []
    found = validated(model, raw, "", faults)
    if found is None:
        raise SceneError(place, faults)
    return found


def validated(
    model: type[M], raw: Mapping[str, object], prefix: str, faults: list[str]
) -> M | None:
    """Validate ``raw`` as ``model``; None with its faults appended."""
    try:
        return model.model_validate(raw)
    except ValidationError as error:
        found = error.errors()
        if isinstance(raw.get("driver"), list):  # `reading.parse_scene` says it better
            found = [fault for fault in found if fault["loc"][:1] != ("driver",)]
        faults += dict.fromkeys(_line(model, prefix, fault) for fault in found)
        return None


def _line(model: type[BaseModel], prefix: str, fault: ErrorDetails) -> str:
    kind, message = fault["type"], fault["msg"]
    loc = fault["loc"]
    if kind == "invalid_key":  # a number here is no place in a list
        loc = (*loc[:-1], str(loc[-1]))
    places = (part + 1 if isinstance(part, int) else part for part in loc)
    parts = [part for part in map(str, places) if not part.startswith(OF_PYDANTIC)]
    key = (prefix + ".".join(map(cut, parts))).removesuffix(".")
    if kind == "missing":
        return f"{key}: missing; add it"
    if kind == "extra_forbidden":
        keys = _keys_at(model, fault["loc"])
        cure = suggestion(parts[-1], keys, "known:", 1, 0.6) if keys else "leave it out"
        return f"{key}: unknown key; {cure}"
    if kind == "value_error":
        return f"{key}: {message.removeprefix('Value error, ')}".removeprefix(": ")
    if kind == "string_pattern_mismatch":
        text = parts[-1] in ("source", "note")
        message = (
            "text without control characters (of a terminal, of lines, of direction)"
            if text
            else "a name is a letter, then up to 39 letters, digits, - or _"
        )
    for side, limit in fault.get("ctx", {}).items():
        words = {"ge": "at least", "le": "at most"}
        if side in words and isinstance(limit, float):
            message = f"use a number of {words[side]} {limit:g}"
    return f"{key}: found {shown(fault['input'])}; {message[0].lower()}{message[1:]}"


def _keys_at(model: type[BaseModel], loc: tuple[int | str, ...]) -> list[str]:
    """List the valid keys of the table that holds the unknown key ``loc``, where they are known."""
    if len(loc) > 1:  # in a table of the file, in one of a list, or in one by name
        kind = model.model_fields[str(loc[0])].annotation
        kinds = (each for each in (*get_args(kind), kind) if hasattr(each, "model_fields"))
        model = next(kinds, BaseModel)
    return list(model.model_fields)
