"""Options that several requests have."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Sequence
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


SceneName = Annotated[str, typer.Argument(metavar="SCENE", help="A shipped name, or a scene file.")]
Engines = Annotated[Sequence[str], typer.Option("--engine", help="Engine; may be repeated.")]
StepS = Annotated[
    float | None,
    typer.Option("--dt", metavar="SECONDS", parser=seconds, help="Time step, such as 1/60."),
]
StepsPerTurn = Annotated[
    float | None, typer.Option(help="Steps in a turn, in place of --dt (default 720).")
]
Duration = Annotated[
    float | None,
    typer.Option("--duration", metavar="SECONDS", help="Of free motion; default: the scene's."),
]
Forces = Annotated[
    bool, typer.Option("--forces", help="Reactions, moments and driving torque as well.")
]
SegmentCount = Annotated[
    int | None,
    typer.Option("--segments", metavar="N", help="Of each elastic link in an engine (default 16)."),
]
SpringKind = Annotated[
    str | None,
    typer.Option(
        "--springs",
        help="Between segments: plain (default), corrected for the sag; beam: an engine's own.",
    ),
]
Jobs = Annotated[int, typer.Option(min=0, max=1024, help="Processes; 0: one per processor.")]
PaperSize = Annotated[
    str, typer.Option(metavar="SIZE", help="A5, A4, A3, A2, or WIDTHxHEIGHT in mm.")
]


def option_of(request: type, field: str) -> str:
    """What the command line calls a field of a request."""
    note = get_type_hints(request, include_extras=True)[field].__metadata__[0]
    if isinstance(note, typer.models.ArgumentInfo):
        return str(note.metavar)
    # typer takes the first name of an option for a default, until it sees the annotation.
    names = map(str, (note.default, *(note.param_decls or ())))
    written = [each for each in names if each.startswith("--")]
    return str((written or [f"--{field.replace('_', '-')}"])[0])


def given(request: Any, *fields: str) -> Iterator[str]:
    """The options of those of some fields that do not keep their default."""
    defaults = {each.name: each.default for each in dataclasses.fields(request)}
    for field in fields:
        value, default = getattr(request, field), defaults[field]
        if not isinstance(value, type(default)) or value != default:
            yield option_of(type(request), field)
