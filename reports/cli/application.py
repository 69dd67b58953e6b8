"""The command itself: how it begins, and every way in which it may end."""

from __future__ import annotations

import contextlib
import dataclasses
import inspect
import os
import sys
import traceback
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Annotated, Any, NoReturn, TypeVar, get_args, get_type_hints

import typer

from models.errors import CrankcheckError, harmless, shown
from reports.cli.broken_package import broken_package
from reports.output.console import (
    UNWRITABLE,
    forget_odd_sizes,
    give_up_output,
    readable_everywhere,
)
from reports.workers.signals import Stopped, broken_pipe_ends, finish, install, seen

app = typer.Typer(
    name="crankcheck",
    help="Hold physics engines to the closed form of planar closed-loop mechanisms.",
    epilog="Exit codes: 0 all within tolerance, 1 out of tolerance or worse than before, 2 bad "
    "input or usage, 70 a fault of crankcheck itself, 130 interrupted, 141 nobody reads the "
    "output, 143 terminated.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
BAD_INPUT, INTERNAL, INTERRUPTED, BROKEN_PIPE = 2, 70, 130, 141
TRACEBACK = "CRANKCHECK_TRACEBACK"
Request = TypeVar("Request")


def seconds(text: str) -> float:
    """A number of seconds, such as 0.02 or 1/60. Raises typer.BadParameter for what is none."""
    number, slash, parts = text.partition("/")
    try:
        return float(number) / float(parts) if slash else float(number)
    except (ValueError, ZeroDivisionError):
        raise typer.BadParameter(
            f"{shown(text)} is no number of seconds; write it like 0.02, or 1/60"
        ) from None


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
"""Options that several commands have."""


def main() -> None:
    """The entry of the command `crankcheck`."""
    try:
        try:
            with guarded():
                install()
                broken_pipe_ends(at_once=True)
                if sys.stdout is None:
                    raise CrankcheckError(
                        "standard output is closed; send it to a file, or to /dev/null"
                    )
                forget_odd_sizes()
                readable_everywhere()
                try:
                    app()
                finally:
                    sys.stdout.flush()
        finally:
            finish()
    except Stopped as stopped:  # it came while another end was told, or before all was finished
        _end(stopped.code, stopped.word)


@contextmanager
def guarded() -> Iterator[None]:
    """Every end but a verdict: one line, and an exit code that tells whose fault it is."""
    try:
        yield
    except CrankcheckError as error:
        _end(BAD_INPUT, str(error))
    except Stopped as stopped:
        _end(stopped.code, stopped.word)
    except KeyboardInterrupt:
        _end(INTERRUPTED, "interrupted")
    except BrokenPipeError:
        give_up_output()
        raise SystemExit(BROKEN_PIPE) from None
    except Exception as error:
        if isinstance(error, OSError) and error.errno in UNWRITABLE and error.filename is None:
            give_up_output()
            _end(
                BAD_INPUT, f"standard output can not be written: {error.strerror}; free some space"
            )
        if os.environ.get(TRACEBACK):
            traceback.print_exc()
        why = f"{type(error).__name__}: {str(error).partition(chr(10))[0][:300]}"
        if package := broken_package(error):
            _end(
                BAD_INPUT,
                f"{package} can not be imported here: {why}; look at the environment variables "
                "that it reads, or install it again",
            )
        _end(
            INTERNAL,
            f"internal error: {why}; please report it; "
            f"--traceback or {TRACEBACK}=1 shows where it is",
        )


def command(run: Callable[[Request], int], of: typer.Typer = app) -> Callable[[Request], int]:
    """Make a command of a function: its name, its docstring as help, and of its request, a frozen
    dataclass, an argument or option for each field; what it returns is the exit code. It is a
    command ``of`` crankcheck, or of one of its commands.

    A field is annotated with its `typer.Argument` or `typer.Option`. What is not given keeps the
    field's default.
    """
    hints = get_type_hints(run)
    request = hints[next(iter(inspect.signature(run).parameters))]

    def typed(**options: object) -> None:
        given = {name: value for name, value in options.items() if value is not None}
        with guarded():
            code = run(request(**given))
        raise typer.Exit(code)

    notes = get_type_hints(request, include_extras=True)
    parameters = [_parameter(field, notes[field.name]) for field in dataclasses.fields(request)]
    typed.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]  # read by typer
    of.command(run.__name__, help=run.__doc__)(typed)
    return run


def _parameter(field: dataclasses.Field[Any], note: object) -> inspect.Parameter:
    """A field as typer takes it: several texts as a list, None where none is given."""
    kind, option = get_args(note)
    default = inspect.Parameter.empty if field.default is dataclasses.MISSING else field.default
    if kind == Sequence[str]:
        kind, default = list[str], default or None
    note = Annotated[kind, option]
    return inspect.Parameter(
        field.name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=note
    )


def _end(code: int, text: str) -> NoReturn:
    """The last line, where it can be written, and the exit code; a signal goes before all else."""
    if stopped := seen():
        code, text = stopped.code, stopped.word
    with contextlib.suppress(OSError):
        typer.echo(f"crankcheck: {harmless(text)}", err=True)
    raise SystemExit(code) from None


def _version(wanted: bool) -> None:
    if wanted:
        from reports.output.provenance import crankcheck_version

        typer.echo(f"crankcheck {crankcheck_version()}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Show the version.")
    ] = False,
    show_traceback: Annotated[
        bool, typer.Option("--traceback", help="Show where an internal error is.")
    ] = False,
) -> None:
    """Options of the command itself."""
    broken_pipe_ends(at_once=False)
    if show_traceback:
        os.environ[TRACEBACK] = "1"
