"""Options that several requests have."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Sequence
from importlib import import_module
from typing import Annotated, Any, get_type_hints

import typer

from models.errors import shown


def seconds(text: str) -> float:
    """A number of seconds, such as 0.02 or 1/60. Raises typer.BadParameter for what is none."""
    number, slash, parts = text.partition("/")
    try:
        return float(number) / float(parts) if slash else float(number)
    except (ValueError, ZeroDivisionError):
        raise typer.BadParameter(
            f"{shown(text)} is no number of seconds; write it like 0.02, or 1/60"
        ) from None


def argument(metavar: str, help: str) -> Any:
    """The note of a field that the command line takes by its place."""
    return typer.Argument(metavar=metavar, help=help)


def option(help: str, usage: str = "", **more: Any) -> Any:
    """The note of a field that is an option, whose ``usage`` has the names that are not its own,
    and how the value is called: ``--dt SECONDS``. Of one that needs none, the note is its help."""
    names = [word for word in usage.split() if word.startswith("-")]
    value = next((word for word in usage.split() if not word.startswith("-")), None)
    return typer.Option(*names, help=help, metavar=value, **more)


def output_option(help: str) -> Any:
    """The note of what is written."""
    return option(help, "-o --output")


def note_of(field: str, kind: object, note: object, default: object) -> Any:
    """The note of a field as typer takes it; a truth that is not usual has no option that denies
    it."""
    if not isinstance(note, str):
        return note
    return option(note, name_of(field) * (kind is bool and not default))


def name_of(field: str) -> str:
    """The option that has the name of a field."""
    return f"--{field.replace('_', '-')}"


SceneName = Annotated[str, argument("SCENE", "A shipped name, or a scene file.")]
Engines = Annotated[Sequence[str], option("Engine; may be repeated.", "--engine")]
StepS = Annotated[float | None, option("Time step, such as 1/60.", "--dt SECONDS", parser=seconds)]
StepsPerTurn = Annotated[float | None, "Steps in a turn, in place of --dt (default 720)."]
Duration = Annotated[
    float | None, option("Of free motion; default: the scene's.", "--duration SECONDS")
]
Forces = Annotated[bool, option("Reactions, moments and driving torque as well.", "--forces")]
SegmentCount = Annotated[
    int | None, option("Of each elastic link in an engine (default 16).", "--segments N")
]
SpringKind = Annotated[
    str | None,
    option(
        "Between segments: plain (default), corrected for the sag; beam: an engine's own.",
        "--springs",
    ),
]
Jobs = Annotated[int, option("Processes; 0: one per processor.", min=0, max=1024)]
PaperSize = Annotated[str, option("A5, A4, A3, A2, or WIDTHxHEIGHT in mm.", "SIZE")]


def option_of(request: type, field: str) -> str:
    """What the command line calls a field of a request."""
    note = get_type_hints(request, include_extras=True)[field].__metadata__[0]
    if isinstance(note, typer.models.ArgumentInfo):
        return str(note.metavar)
    # typer takes the first name of an option for a default, until it sees the annotation.
    names = [] if isinstance(note, str) else [str(note.default), *(note.param_decls or ())]
    return next((each for each in names if each.startswith("--")), name_of(field))


def given(request: Any, *fields: str) -> Iterator[str]:
    """The options of those of some fields that do not keep their default."""
    defaults = {each.name: each.default for each in dataclasses.fields(request)}
    for field in fields:
        value, default = getattr(request, field), defaults[field]
        if not isinstance(value, type(default)) or value != default:
            yield option_of(type(request), field)


FAMILY = "lectures.drawing.workbook.solve_family:run_family"
"""`solve --family`."""
LIVE_SHEET = "lectures.drawing.workbook.live_workbook:live_sheet"
"""Formulas and charts beside the values of `solve -o FILE.xlsx`."""


def named(place: str) -> Any:
    """What has that place, ``room.module:name``, in a room beside this one; loaded now."""
    module, _, name = place.partition(":")
    return getattr(import_module(f"..{module}", __package__), name)
