"""The result of `crankcheck stability`: cases, graded runs, critical values, pictures."""

import json
import math
import os
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any, Literal, get_args

from pydantic import TypeAdapter

from models.errors import CrankcheckError
from models.files.inputs import UnreadableError, regular_bytes
from reports.output.numbers import finite

Outcome = Literal[
    "ok",
    "degraded",
    "drifts",
    "branch-changed",
    "locked",
    "silently-open",
    "diverged",
    "crashed",
    "unsupported",
]
OUTCOMES: tuple[Outcome, ...] = get_args(Outcome)
FORMAT = 1
PLACE = "place, rad or over the longest link"
FILE = "stability.json"
MOST_BYTES = 200_000_000
"""Most bytes of the file: the whole catalogue takes a hundredth of it."""
BAD = (UnreadableError, ValueError, RecursionError, LookupError, TypeError, AttributeError)
"""Errors from a file that is not as it was written."""


def label(value: float) -> str:
    """Return a value of a parameter in few characters: three digits, whole numbers up to five."""
    if value == round(value) and abs(value) < 1e5:
        return str(round(value))
    text = f"{value:.3g}"
    if "e" not in text and abs(value) >= 1e-3:
        return text
    mantissa, _, power = f"{value:.2e}".partition("e")
    mantissa = mantissa.rstrip("0").rstrip(".")
    return f"{mantissa}e{int(power)}"


@dataclass(frozen=True, kw_only=True)
class CaseFacts:
    """Facts of a case for a reader: the parameter that is made hard, and the right result.

    ``values`` of the parameter go from easy to hard; ``labels`` are their texts of a few
    characters, from `label` if not given. ``good`` are the outcomes of an engine that holds;
    ``within`` is the class: the error, as a pure number, that counts as held; ``error_of`` names
    the quantity of that error; ``driver_unit`` is rad, or m where a slider is driven.
    """

    name: str
    group: str
    title: str
    source: str
    truth: str
    expected: str
    parameter: str
    unit: str
    values: tuple[float, ...]
    labels: tuple[str, ...] = ()
    good: tuple[Outcome, ...]
    within: float
    error_of: str = PLACE
    driver_unit: str = "rad"

    def __post_init__(self) -> None:
        if not self.labels:
            object.__setattr__(self, "labels", tuple(label(value) for value in self.values))
        if not self.values or len(self.labels) != len(self.values):
            raise ValueError(f"{self.name}: {len(self.labels)} labels, {len(self.values)} values")

    @property
    def meaning(self) -> tuple[object, ...]:
        """Facts on which the outcomes depend."""
        return self.parameter, self.unit, self.good, self.within, self.error_of


Line = tuple[str, str, str]


@dataclass(frozen=True)
class OfLine:
    """Part of a line: a case in an engine with a profile."""

    case: str
    engine: str
    profile: str

    @property
    def line(self) -> Line:
        return self.case, self.engine, self.profile


@dataclass(frozen=True)
class Graded(OfLine):
    """One run of a case at one value, graded.

    ``error`` is the worst error of place, ``gap`` the widest open pin, ``drive`` the error of the
    crank: pure numbers (rad, or lengths over the longest link), NaN where there is none. ``sine``
    is how far the scene stays from its nearest singular position (1 best, 0 singular). ``at_s`` [s]
    and ``at_driver_rad`` [rad, or m of a slider] give the place of the outcome, if any. ``grid`` is
    False for the values of a bisection. ``force`` is the worst error of forces, a share of the
    largest of their kind, NaN where none were requested; it is shown, and does not grade.
    """

    value: float
    label: str
    outcome: Outcome
    reason: str
    error: float = math.nan
    gap: float = math.nan
    drive: float = math.nan
    sine: float = math.nan
    at_s: float = math.nan
    at_driver_rad: float = math.nan
    steps: int = 0
    dt_s: float = math.nan
    wall_s: float = math.nan
    grid: bool = True
    force: float = math.nan


@dataclass(frozen=True)
class Critical(OfLine):
    """Hardest value up to which one engine with one profile holds a case.

    ``holds`` is the hardest value, from the easy end on, up to which every run was good, ``fails``
    the easiest beyond it that was not; NaN where there is none. ``outcome`` is the outcome there,
    ``words`` is a line on all of it, ``command`` reproduces the run at ``fails`` (or at ``holds``
    where nothing fails).
    """

    holds: float
    fails: float
    outcome: Outcome
    words: str
    command: str


@dataclass(frozen=True)
class Picture(OfLine):
    """A run that failed, to be seen moving beside the reference.

    ``drawing`` is the result of `reports.drawing.moving.drawing`, and ``rows`` the run's
    displacements from it; ``title`` describes the picture. Its line and ``value`` identify the run.
    """

    value: float
    label: str
    title: str
    drawing: Mapping[str, object]
    rows: object


@dataclass(frozen=True)
class Matrix:
    """The whole result; ``facts`` are versions, processor and settings."""

    facts: Mapping[str, str]
    cases: tuple[CaseFacts, ...]
    runs: tuple[Graded, ...]
    critical: tuple[Critical, ...]
    pictures: tuple[Picture, ...] = field(default=())

    def case(self, name: str) -> CaseFacts:
        """Return the case of that name."""
        return next(case for case in self.cases if case.name == name)

    @property
    def lines(self) -> dict[Line, Critical]:
        """How far each line holds."""
        return {each.line: each for each in self.critical}

    def runs_of(self, line: Line) -> dict[float, Graded]:
        """Return the runs of a line by their values."""
        return {run.value: run for run in self.runs if run.line == line}


def with_forces(matrix: Matrix) -> bool:
    """True if forces of any run are known."""
    return any(not math.isnan(run.force) for run in matrix.runs)


def run_rows(matrix: Matrix) -> list[dict[str, Any]]:
    """Return the runs as flat rows; with forces where they were requested."""
    rows = [asdict(run) for run in matrix.runs]
    return rows if with_forces(matrix) else [_without(row, "force") for row in rows]


def _without(row: Mapping[str, Any], name: str) -> dict[str, Any]:
    return {key: value for key, value in row.items() if key != name}


def to_json(matrix: Matrix) -> str:
    """Return the matrix as text; numbers that are not finite as null."""
    content = {"format": FORMAT, **asdict(matrix), "runs": run_rows(matrix)}
    return json.dumps(finite(content), indent=1, ensure_ascii=False) + "\n"


def read_matrix(folder: Path) -> Matrix:
    """Return the matrix stored in a folder, or in a JSON file that is named itself.

    Raises
    ------
    CrankcheckError
        No such file, one that is damaged or too large, or one of another format.
    """
    path = folder if folder.suffix == ".json" or folder.is_file() else folder / FILE
    folder = path.parent
    if not os.path.lexists(path):
        raise CrankcheckError(
            f"{folder}: no {FILE} in it; `crankcheck stability -o {folder}` makes one"
        )
    try:
        content = json.loads(regular_bytes(path, MOST_BYTES))
        if "format" not in content:
            raise CrankcheckError(
                f"{path}: no file of hard cases; name {FILE}, or its folder, or run `crankcheck "
                f"stability -o {folder}` again"
            )
        if content["format"] != FORMAT:
            raise CrankcheckError(
                f"{path}: format {content['format']}; this crankcheck reads format {FORMAT}: run "
                f"`crankcheck stability -o {folder}` again"
            )
        rows = {key: [_numbers(row) for row in content[key]] for key in ("runs", "critical")}
        parts = {key: content[key] for key in ("facts", "cases", "pictures")}
        matrix = TypeAdapter(Matrix).validate_python(parts | rows)
        names = {case.name for case in matrix.cases}
        for each in (*matrix.runs, *matrix.critical):
            if each.case not in names:
                raise ValueError(f"{each.case!r} is not among its cases")
        return matrix
    except BAD as error:
        why = str(error).partition("\n")[0]
        raise CrankcheckError(
            f"{path}: can not be read ({why}); run `crankcheck stability -o {folder}` again"
        ) from None


def _numbers(row: Mapping[str, Any]) -> dict[str, Any]:
    """Return a row with NaN where the file has null."""
    return {key: math.nan if value is None else value for key, value in row.items()}
