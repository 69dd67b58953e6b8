"""What the verification of one version found: every cell with its largest errors."""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from packaging.version import InvalidVersion, Version

from models.errors import CrankcheckError
from reports.history.environments import Wanted
from reports.history.verification import RESULT

FACTS = "verify.json"


@dataclass(frozen=True)
class Quantity:
    """An error that is followed over versions: the largest of some columns of verify.csv, pure.

    ``rate`` marks those that come of the others: where places are wrong, rates are too.
    """

    name: str
    unit: str
    columns: tuple[str, ...]
    rate: bool = False


QUANTITIES = (
    Quantity("angle", "rad", ("angle_pure",)),
    Quantity("place", "of L", ("displacement_pure", "position_pure")),
    Quantity("pin gap", "of L", ("pin_gap_pure",)),
    Quantity("slider gap", "of L", ("slider_gap_pure",)),
    Quantity("velocity", "of w", ("velocity_pure",), rate=True),
    Quantity("acceleration", "of w^2", ("acceleration_pure",), rate=True),
)


@dataclass(frozen=True)
class Found:
    """One cell: how it ended, what it was judged, its errors by quantity, and the settings that
    the engine held."""

    scene: str
    profile: str
    verdict: str
    status: str
    reason: str
    errors: Mapping[str, float]
    settings: Mapping[str, object] = field(default_factory=dict)


@dataclass(frozen=True)
class Outcome:
    """A version with its cells, or with the reason why there are none.

    ``folder`` holds the files of the verification; ``kept`` says that an earlier call made them.
    ``calls_itself`` is the version that the engine told, which need not be that of its package.
    """

    one: Wanted
    cells: tuple[Found, ...] = ()
    reason: str = ""
    folder: Path | None = None
    kept: bool = False
    calls_itself: str = ""

    @property
    def version(self) -> str:
        return str(self.one.version)

    @property
    def misnamed(self) -> bool:
        """Whether the engine gives itself another number than its package has."""
        try:
            told = Version(self.calls_itself)
        except InvalidVersion:
            return bool(self.calls_itself)
        # Post and local parts belong to the package; the engine does not know them.
        return Version(told.base_version) != Version(self.one.version.base_version)


def read(folder: Path) -> tuple[Found, ...]:
    """The cells of a folder that `crankcheck verify -o` wrote.

    Raises
    ------
    CrankcheckError
        The file is not there, or lacks a column.
    """
    path = folder / RESULT
    try:
        with path.open(encoding="utf-8", newline="") as lines:
            return tuple(_found(row) for row in csv.DictReader(lines))
    except (OSError, KeyError, ValueError) as error:
        raise CrankcheckError(
            f"{path}: not the result of a verification ({error}); run again with --again"
        ) from None


def told_version(folder: Path, engine: str) -> str:
    """The version that the engine told of itself in a verification; "" where none is known."""
    try:
        facts = json.loads((folder / FACTS).read_text(encoding="utf-8"))["provenance"]
        return str(facts.get(engine, ""))
    except (OSError, KeyError, ValueError):
        return ""


def _found(row: Mapping[str, str]) -> Found:
    """One line of the file."""
    numbers = {name: _number(row[name]) for name in _columns() if row[name]}
    gap, pin, slider = (_number(row[name]) for name in ("gap_pure", "pin_gap_m", "slider_gap_m"))
    numbers |= _gaps(gap, pin, slider)
    errors = {}
    for quantity in QUANTITIES:
        known = [numbers[name] for name in quantity.columns if name in numbers]
        if known:
            errors[quantity.name] = math.inf if any(map(math.isnan, known)) else max(known)
    return Found(
        scene=row["scene"],
        profile=row["profile"],
        verdict=row["verdict"],
        status=row["status"],
        reason=" ".join(row["reason"].split()),
        errors=errors,
        settings=json.loads(row["settings"] or "{}"),
    )


def _columns() -> list[str]:
    named = [name for quantity in QUANTITIES for name in quantity.columns]
    return [name for name in named if not name.endswith("_gap_pure")]


def _number(text: str) -> float:
    return float(text) if text else math.nan


def _gaps(gap_pure: float, pin_m: float, slider_m: float) -> dict[str, float]:
    """The gaps of pins and of sliders over the longest link, which the largest of both tells."""
    largest = max((gap for gap in (pin_m, slider_m) if not math.isnan(gap)), default=math.nan)
    parts = {"pin_gap_pure": pin_m, "slider_gap_pure": slider_m}
    share = gap_pure / largest if largest else 0.0
    return {name: gap * share for name, gap in parts.items() if not math.isnan(gap)}
