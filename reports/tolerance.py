"""Tolerances: one per quantity, for every engine alike, as pure numbers, each with its reason.

A default is `coefficient * step^order * curvature^power / conditioning^weakness`, where `step` is
the driver's turn in one time step [rad], `curvature` the largest pure acceleration of the
reference and `conditioning` its smallest sine of a transmission angle. A number given by the scene
or on the command line is taken as it stands.
"""

from __future__ import annotations

import difflib
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from models.errors import CrankcheckError
from models.scene import Scene
from reports.errors import Errors


@dataclass(frozen=True)
class Tolerance:
    """A default limit, a pure number, and why it is what it is."""

    coefficient: float
    order: int
    power: float
    weakness: float
    unit: str
    reason: str

    def limit(self, errors: Errors) -> float:
        """The limit for a run with this step and this scene."""
        return (
            self.coefficient
            * errors.step_rad**self.order
            * errors.curvature**self.power
            / max(errors.conditioning, 1e-12) ** self.weakness
        )


DEFAULTS: dict[str, Tolerance] = {
    n: Tolerance(1.0, 2, 1, 0, "", "provisional")
    for n in (
        "drive",
        "angle",
        "displacement",
        "position",
        "gap",
        "velocity",
        "velocity-differenced",
        "acceleration",
        "acceleration-differenced",
    )
}


@dataclass(frozen=True)
class Limit:
    """The limit in force for one quantity, and where it comes from."""

    number: float
    origin: str


def limits(scene: Scene, errors: Errors, overrides: Mapping[str, float]) -> dict[str, Limit]:
    """The limit per tolerance name: command line before scene before default."""
    chosen = {}
    for name, default in DEFAULTS.items():
        if name in overrides:
            chosen[name] = Limit(overrides[name], "--tol")
        elif name in scene.tolerance:
            chosen[name] = Limit(scene.tolerance[name], "scene")
        else:
            chosen[name] = Limit(default.limit(errors), "default")
    return chosen


def parse(texts: Iterable[str]) -> dict[str, float]:
    """`angle=1e-4` and the like, also several in one text with commas between.

    Raises
    ------
    CrankcheckError
        A text that is not NAME=NUMBER, a name that is no quantity, a number that is not positive.
    """
    found: dict[str, float] = {}
    for text in (part.strip() for whole in texts for part in whole.split(",")):
        name, equals, number = text.partition("=")
        if not equals:
            raise CrankcheckError(f"--tol {text!r}: no `=` in it; write it like --tol angle=1e-4")
        found[_known(name.strip(), f"--tol {text!r}")] = _positive(number, text)
    return found


def check_names(scene: Scene) -> None:
    """Refuse a scene whose [tolerance] names something that is no quantity."""
    for name in scene.tolerance:
        _known(name, f"scene {scene.name}, [tolerance] {name}")


def _known(name: str, place: str) -> str:
    """The name, or a CrankcheckError that suggests the near ones."""
    if name in DEFAULTS:
        return name
    near = difflib.get_close_matches(name, DEFAULTS, n=2)
    hint = f"did you mean {' or '.join(near)}?" if near else f"use one of {', '.join(DEFAULTS)}"
    raise CrankcheckError(f"{place}: {name!r} is no quantity; {hint}")


def _positive(number: str, text: str) -> float:
    """A finite number above 0."""
    try:
        value = float(number)
    except ValueError:
        value = math.nan
    if not (math.isfinite(value) and value > 0.0):
        raise CrankcheckError(
            f"--tol {text!r}: {number.strip()!r} is not a number above 0; write it like angle=1e-4"
        )
    return value
