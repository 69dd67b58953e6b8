"""Options that several requests share."""

import dataclasses
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal, TypeVar, get_type_hints

import typer

from models.errors import CrankcheckError, shown
from reports.figures.layout import Layout

Number = TypeVar("Number", int, float)


def seconds(text: str) -> float:
    """Parse a number of seconds, such as 0.02 or 1/60. Raises typer.BadParameter for other text."""
    number, slash, parts = text.partition("/")
    try:
        return float(number) / float(parts) if slash else float(number)
    except (ValueError, ZeroDivisionError):
        raise typer.BadParameter(
            f"{shown(text)} is not a number of seconds; write it like 0.02, or 1/60"
        ) from None


def argument(metavar: str, help: str) -> Any:
    """Annotation of a field that is a positional argument of the command line."""
    return typer.Argument(metavar=metavar, help=help)


def option(help: str, usage: str = "", **more: Any) -> Any:
    """Annotation of a field that is an option. ``usage`` has names other than the field's, and the
    name of the value: ``--dt SECONDS``. A field that needs neither is annotated with its help."""
    names = [word for word in usage.split() if word.startswith("-")]
    value = next((word for word in usage.split() if not word.startswith("-")), None)
    return typer.Option(*names, help=help, metavar=value, **more)


def output_option(help: str) -> Any:
    """Annotation of an output file."""
    return option(help, "-o --output")


def note_of(field: str, kind: object, note: object, default: object) -> Any:
    """The annotation of a field for typer; a flag that is False by default has no denial."""
    if not isinstance(note, str):
        return note
    return option(note, name_of(field) * (kind is bool and not default))


def numbers(
    option: str, text: str | None, kind: Callable[[str], Number], noun: str, such_as: str
) -> list[Number]:
    """Parse numbers with commas between, none for no text. Raises CrankcheckError."""
    parts = [] if text is None else text.split(",")
    try:
        return [kind(part) for part in parts]
    except ValueError:
        raise CrankcheckError(
            f"{option} {shown(text)}: write {noun} with commas between, such as {such_as}"
        ) from None


def name_of(field: str) -> str:
    """The option named as a field."""
    return f"--{field.replace('_', '-')}"


SceneName = Annotated[str, argument("SCENE", "A shipped name, or a scene file.")]
Engines = Annotated[Sequence[str], option("Engine, or all; may be repeated.", "--engine")]
StepS = Annotated[float | None, option("Time step, such as 1/60.", "--dt SECONDS", parser=seconds)]
StepsPerTurn = Annotated[float | None, "Steps in a turn, in place of --dt (default 720)."]
Duration = Annotated[
    float | None, option("Duration of free motion; default: the scene's.", "--duration SECONDS")
]
Forces = Annotated[bool, option("Also compare reactions, moments and driving torque.", "--forces")]
SegmentCount = Annotated[
    int | None, option("Segments of each elastic link in an engine (default 16).", "--segments N")
]
SpringKind = Annotated[
    str | None,
    option(
        "Springs between segments: plain (default), corrected for the sag; beam: the engine's own.",
        "--springs",
    ),
]
Facets = Annotated[
    int | None, option("Cams by contact, with so many facets; default: the scene's.", "N")
]
KnownPath = Annotated[
    Path | None, option("Known failures, as TOML; default: the shipped ones.", "FILE")
]
WriteKnown = Annotated[Path | None, "Write the failures of this run as known ones, as TOML."]
StrictKnown = Annotated[bool, "Exit 1 if a known failure passes now."]
Jobs = Annotated[int, option("Processes; 0: one per processor.", min=0, max=1024)]
TextFormat = Annotated[Literal["text", "md"], option("Format of the printed text.", "text|md")]
PaperSize = Annotated[str, option("A5, A4, A3, A2, or WIDTHxHEIGHT in mm.", "SIZE")]


def option_of(request: type, field: str) -> str:
    """The name of a request's field on the command line."""
    note = get_type_hints(request, include_extras=True)[field].__metadata__[0]
    if isinstance(note, typer.models.ArgumentInfo):
        return str(note.metavar)
    # typer takes the first name of an option for a default, until it sees the annotation.
    names = [] if isinstance(note, str) else [str(note.default), *(note.param_decls or ())]
    return next((each for each in names if each == "-o" or each[:2] == "--"), name_of(field))


def given(request: Any, *fields: str) -> Iterator[str]:
    """The options of the ``fields`` that do not have their default."""
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
    """The object at ``room.module:name``, in a room beside this; loaded now."""
    module, _, name = place.partition(":")
    return getattr(import_module(f"..{module}", __package__), name)


@dataclass(frozen=True)
class SolveOptions(Layout):
    """Options of `solve` for scenes of any kind."""

    answered_by: ClassVar[str] = "requests.solve:SolveRequest"
    scene: SceneName
    at_deg: Annotated[float | None, option("One position: the driver's angle.", "DEG")] = None
    at_m: Annotated[
        float | None, option("One position: the displacement of a driving slider.", "M")
    ] = None
    turns: Annotated[float | None, "A motion over so many turns (default 1)."] = None
    steps_per_turn: Annotated[int | None, "Samples in a turn (default 12, in a file 360)."] = None
    output: Annotated[
        Path | None, output_option("Write .csv, .parquet or .xlsx, or a page, .html.")
    ] = None
    duration: Annotated[
        float | None, option("Free motion: duration (default the scene's).", "S")
    ] = None
    steps: Annotated[
        int | None, option("Free motion: samples (default 12, in a file 1000).", "N")
    ] = None
    clockwise: Annotated[bool, "With --at-deg: the driver turning clockwise there."] = False
    along: Annotated[
        Sequence[str], option("Stroke of a point along a direction; may be repeated.", "POINT:DEG")
    ] = ()
    forces: Annotated[bool, "Also print the reactions, and the torque of a driver."] = False
    figures: Annotated[
        Path | None,
        option(
            "Draw as SVG and PDF: with --forces the forces over a turn; a free motion (with "
            "--forces its reactions too); or elastic links.",
            "DIR",
        ),
    ] = None
    modes: Annotated[int | None, option("Elastic links: sines across each.", "N")] = None
    axial_modes: Annotated[int | None, option("Elastic links: sines along each.", "N")] = None
    elements: Annotated[int | None, option("Elastic links: beam elements of each.", "N")] = None
    shape: Annotated[
        str | None,
        "Elastic links start periodic, quasi-static or straight (default the scene's).",
    ] = None
    linear: Annotated[bool, "Elastic links: without the shortening of bent links."] = False
    family: Annotated[
        str | None,
        option(
            "With -o FILE.xlsx, .html, .svg or .pdf: variants of the mechanism that differ in a "
            "number, such as a length.",
            "NAME=A,B,...",
        ),
    ] = None

    @property
    def at_place(self) -> str:
        """The option that requests one position; "" for a motion."""
        if self.at_deg is None and self.at_m is None:
            return ""
        return f"--at-m {self.at_m:g}" if self.at_deg is None else f"--at-deg {self.at_deg:g}"


PRESCRIBED = "prescribed"
of_model = partial(option, rich_help_panel="A model of your own")


@dataclass(frozen=True)
class VerifyOptions:
    """Options of `verify`, for scenes and for a model of the user's own; ``baseline`` is the folder
    of an earlier run, whose errors may grow by ``factor``."""

    answered_by: ClassVar[str] = "requests.verify:VerifyRequest"
    scenes: Annotated[
        Sequence[str], argument("SCENE", "Shipped names or scene files; default: all.")
    ] = ()
    engines: Engines = ()
    profiles: Annotated[
        Sequence[str],
        option("Profile to gate; default: tuned, with as-shipped shown beside it.", "--profile"),
    ] = ()
    dt_s: StepS = None
    steps_per_turn: StepsPerTurn = None
    turns: Annotated[float | None, "Turns (periods) of the driver (default 2)."] = None
    tolerance: Annotated[
        Sequence[str],
        option("Tolerance as a pure number, such as angle=1e-4.", "--tol NAME=NUMBER"),
    ] = ()
    drive: Annotated[str, "prescribed or servo; with --mjcf: the joint that is driven."] = (
        PRESCRIBED
    )
    converge: Annotated[
        bool,
        option(
            "Run at half and quarter step too, and print the trend of the error.",
            "--convergence/--no-convergence",
        ),
    ] = True
    jobs: Jobs = 0
    junit: Annotated[Path | None, "Write JUnit XML."] = None
    csv: Annotated[Path | None, "Write the cells as CSV."] = None
    json: Annotated[Path | None, "Write cells and findings as JSON."] = None
    folder: Annotated[
        Path | None, output_option("Write all of these into a folder, or a page, .html.")
    ] = None
    baseline: Annotated[
        Path | None, option("Folder of an earlier run; exit 1 when worse than it.", "DIR")
    ] = None
    factor: Annotated[float, "Largest growth over the baseline that passes, as a factor."] = 1.1
    forces: Forces = False
    free: Annotated[bool, "Free motion; default: all free scenes."] = False
    duration_s: Duration = None
    segments: SegmentCount = None
    springs: SpringKind = None
    facets: Facets = None
    worlds: Annotated[
        str | None,
        option("Run a batch of so many worlds, their cranks spread over a turn.", "N,N,..."),
    ] = None
    known: KnownPath = None
    write_known: WriteKnown = None
    strict_known: StrictKnown = False
    format: TextFormat = "text"
    mjcf: Annotated[
        Path | None,
        of_model("A MuJoCo model, run as it is; needs --drive JOINT and --speed.", "FILE"),
    ] = None
    speed_rad_s: Annotated[
        float | None,
        of_model("Speed of the driven joint; may be below 0.", "--speed RAD/S"),
    ] = None
    key: Annotated[
        str | None, of_model("Keyframe to start from; default: the pose as drawn.", "NAME")
    ] = None
    start_deg: Annotated[
        float | None, of_model("Coordinate of the driven joint at the start.", "--start DEG")
    ] = None
    branch: Annotated[
        Sequence[str],
        of_model("Branch, if the pose fits two; default: the nearest.", "NAME=1|-1"),
    ] = ()
    write_scene: Annotated[
        Path | None, of_model("Write the scene read from the model, as TOML.", "FILE")
    ] = None
    limit_s: Annotated[float, of_model("Time limit of each line.", "SECONDS")] = 60.0
    memory_gb: Annotated[float, of_model("Memory limit of each line.", "GB")] = 2.0

    @property
    def files(self) -> dict[str, Path | None]:
        """The named files, by option."""
        files = {"--junit": self.junit, "--csv": self.csv, "--json": self.json}
        return files | {"--write-known": self.write_known}


OF_MODELS = ["speed_rad_s", "key", "start_deg", "branch", "write_scene", "limit_s", "memory_gb"]
"""Fields for a model of the user's own alone."""


def refuse_of_models(request: VerifyOptions) -> None:
    """Refuse options that do not apply to scenes. Raises CrankcheckError."""
    for given_option in given(request, *OF_MODELS):
        raise CrankcheckError(
            f"{given_option}: for a model of your own; name it with --mjcf FILE, or leave "
            f"{given_option} out"
        )
