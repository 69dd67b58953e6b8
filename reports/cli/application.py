"""The command itself: its start, and all of its endings."""

import contextlib
import dataclasses
import gc
import inspect
import os
import sys
import traceback
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import cached_property
from pathlib import Path
from traceback import walk_tb
from typing import Annotated, Any, NoReturn, Protocol, cast, get_args, get_origin, get_type_hints

import typer
from rich.console import Console
from typer.core import TyperCommand, TyperGroup

from models.errors import CrankcheckError, harmless
from reports.cli.commands import COMMANDS, COMPARE, OWN
from reports.output import console
from reports.requests.options import named, note_of
from reports.workers.signals import Stopped, broken_pipe_ends, finish, install, may_print, seen

BAD_INPUT, INTERNAL, INTERRUPTED, BROKEN_PIPE = 2, 70, 130, 141
TRACEBACK = "CRANKCHECK_TRACEBACK"


class Request(Protocol):
    """A request of a command: a frozen dataclass, whose fields are annotated with the
    `typer.Argument` or `typer.Option` of each."""

    def run(self, console: Console, progress: Console) -> int:
        """Answer the request, and print the answer; return the exit code."""
        ...


class Late(TyperCommand):
    """A command whose request is loaded when it is called."""

    def __init__(self, words: str) -> None:
        self.words = words
        command = COMMANDS[words]
        super().__init__(words.split()[-1], help=command.help, rich_help_panel=command.panel)

    @cached_property
    def loaded(self) -> TyperCommand:
        """The command with its options."""
        alone = typer.Typer(add_completion=False)
        typed = _typed(named(COMMANDS[self.words].request))
        alone.command(self.name, help=self.help)(typed)
        return cast(TyperCommand, typer.main.get_command(alone))

    def make_context(self, info_name: str | None, args: list[str], *more: Any, **extra: Any) -> Any:
        """The context of the loaded command, with its options."""
        return self.loaded.make_context(info_name, args, *more, **extra)


class CommandGroup(TyperGroup):
    """The commands of the group, or of all, before its subgroups."""

    def __init__(self, **attributes: Any) -> None:
        super().__init__(**attributes)
        before = "" if self.name == NAME else f"{self.name} "
        late = {
            words.removeprefix(before): Late(words)
            for words in COMMANDS
            if words.startswith(before) and " " not in words.removeprefix(before)
        }
        groups = self.commands
        self.commands = {k: v for k, v in late.items() if k not in groups} | {**groups}


NAME = "crankcheck"
app = typer.Typer(
    name=NAME,
    cls=CommandGroup,
    help="Compare physics engines with the closed form of planar closed-loop mechanisms.",
    epilog="Exit codes: 0 all within tolerance, 1 out of tolerance or worse than before, 2 bad "
    "input or usage, 70 a fault of crankcheck itself, 130 interrupted, 141 nobody reads the "
    "output, 143 terminated.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
engines_app = typer.Typer(cls=CommandGroup, invoke_without_command=True)
app.add_typer(engines_app, name="engines", rich_help_panel=COMPARE)
app.add_typer(
    typer.Typer(cls=CommandGroup, no_args_is_help=True, callback=lambda: None),
    name="recipe",
    help="Print a program that reads something out of an engine.",
    rich_help_panel=OWN,
)


def main() -> None:
    """Entry of the command `crankcheck`."""
    try:
        try:
            with guarded():
                install()
                gc.set_threshold(20_000)  # a run makes many small objects and hardly any circles
                broken_pipe_ends(at_once=True)
                if sys.stdout is None:
                    raise CrankcheckError(
                        "standard output is closed; send it to a file, or to /dev/null"
                    )
                console.forget_odd_sizes()
                console.readable_everywhere()
                try:
                    app()
                finally:
                    sys.stdout.flush()
        finally:
            finish()
    except Stopped as stopped:  # during the message of another end, or before all was finished
        _end(stopped.code, stopped.word)


@contextmanager
def guarded() -> Iterator[None]:
    """Turn every end but a verdict into one line and an exit code that says whose fault it is."""
    try:
        yield
    except CrankcheckError as error:
        _end(BAD_INPUT, str(error))
    except Stopped as stopped:
        _end(stopped.code, stopped.word)
    except KeyboardInterrupt:
        _end(INTERRUPTED, "interrupted")
    except BrokenPipeError:
        console.give_up_output()
        raise SystemExit(BROKEN_PIPE) from None
    except Exception as error:
        if (
            isinstance(error, OSError)
            and error.errno in console.UNWRITABLE
            and error.filename is None
        ):
            console.give_up_output()
            _end(
                BAD_INPUT, f"standard output can not be written: {error.strerror}; free some space"
            )
        if os.environ.get(TRACEBACK):
            traceback.print_exc()
        why = f"{type(error).__name__}: {str(error).partition(chr(10))[0][:300]}"
        if package := broken_package(error):
            _end(
                BAD_INPUT,
                f"{package} can not be imported here: {why}; check the environment variables "
                "that it reads, or install it again",
            )
        _end(
            INTERNAL,
            f"internal error: {why}; please report it; "
            f"--traceback or {TRACEBACK}=1 shows where it is",
        )


def _typed(request: type[Request]) -> Callable[..., None]:
    """A function with an argument or option for each field of a request, as typer reads it, that
    ends with the exit code of the request. Fields that are not given keep their default."""

    def typed(**options: object) -> None:
        given = {name: value for name, value in options.items() if value is not None}
        with guarded():  # options of a request that is slow to import stand by themselves
            place = getattr(request, "answered_by", "")
            kind = named(place) if place else request
        _end_with(kind(**given))

    notes = get_type_hints(request, include_extras=True)
    fields = sorted(dataclasses.fields(cast(Any, request)), key=lambda each: bool(each.kw_only))
    parameters = [
        _parameter(field, notes[field.name])
        for field in fields
        if get_origin(notes[field.name]) is Annotated  # the others are for Python alone
    ]
    typed.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]  # read by typer
    return typed


def _end_with(request: Request) -> NoReturn:
    with guarded():
        code = request.run(console.terminal(), console.terminal(stderr=True))
    raise typer.Exit(code)


def _parameter(field: dataclasses.Field[Any], note: object) -> inspect.Parameter:
    """A field as typer takes it: several texts as a list, None where none is given."""
    kind, option = get_args(note)
    default = inspect.Parameter.empty if field.default is dataclasses.MISSING else field.default
    option = note_of(field.name, kind, option, default)
    if kind == Sequence[str]:
        kind, default = list[str], default or None
    note = Annotated[kind, option]
    return inspect.Parameter(
        field.name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=note
    )


def _end(code: int, text: str) -> NoReturn:
    """End with a last line, where it can be written, and an exit code; a signal comes first."""
    if stopped := seen():
        code, text = stopped.code, stopped.word
    if not stopped or may_print():
        with contextlib.suppress(OSError):
            typer.echo(f"crankcheck: {harmless(text)}", err=True)
    raise SystemExit(code) from None


def _version(wanted: bool) -> None:
    if wanted:
        from reports.output.write import crankcheck_version

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


@engines_app.callback(help=COMMANDS["engines"].help)
def _engines(
    context: typer.Context,
    settings: Annotated[
        bool, typer.Option("--settings", help="Show every setting with its reason.")
    ] = False,
) -> None:
    if context.invoked_subcommand is None:
        with guarded():
            request = named(COMMANDS["engines"].request)
        _end_with(request(settings))


HOME = Path(__file__).parents[2]
"""The folder of crankcheck's packages."""


def broken_package(error: Exception) -> str:
    """The foreign package in whose import an error was raised; empty for an error elsewhere, such
    as a fault in our use of it."""
    for frame, _ in walk_tb(error.__traceback__):
        place = Path(frame.f_code.co_filename)
        ours = place.is_relative_to(HOME) and "site-packages" not in place.relative_to(HOME).parts
        name = str(frame.f_globals.get("__name__", "__main__"))
        if frame.f_code.co_name == "<module>" and not ours and name != "__main__":
            return name.partition(".")[0]
    return ""
