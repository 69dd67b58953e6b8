"""The assembly of a model as drawn: the scene read from it, with its branch and start."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from analytic.kinematics import in_assembly, reach, solve, solve_driven
from analytic.structure.mobility import analyse
from models.errors import CrankcheckError, ReachError, few
from models.files.body_table import MOST_ASSEMBLIES
from models.scene import Driver, Scene
from models.scene.joints import Frame, frames
from models.scene.laws import ConstantSpeed
from sim.engine import BodyPose
from sim.registry.own_models import FAR_PIN, MOST_TURNS, OwnModel

MOST_CHOICES = 8
"""Most choices that are tried, two to this power; beyond it the user chooses."""
SHUT = 1e-3
"""Largest distance of a pose from the assembly in which it is drawn shut."""
ALIKE = 0.1
"""A pose fits two assemblies if it is nearer to the best than the next by less than this share."""
SHOWN = 6


def assembled(own: OwnModel, request: ModelRequest) -> tuple[Scene, list[str]]:
    """Return the scene of a model, in the assembly as drawn, with notes on its choice.

    Raises CrankcheckError for a start many turns away; no closed form; a pose that two assemblies
    fit as well, or a driver angle that none reaches, with the range in the coordinate of the joint;
    too many choices to try; a branch that chooses nothing.
    """
    if request.start_deg is not None and abs(request.start_deg) > 360.0 * MOST_TURNS:
        raise CrankcheckError(
            f"--start {request.start_deg:g}: that is more than {MOST_TURNS} turns; give an angle "
            f"between {-360 * MOST_TURNS} and {360 * MOST_TURNS} deg"
        )
    law = ConstantSpeed(own.coordinate_rad(), request.speed_rad_s)
    bare = replace(own.scene, driver=Driver(own.scene.driver.link, law))
    try:
        structure = analyse(bare)
    except CrankcheckError as error:
        raise CrankcheckError(f"{request.path}: {error}{_why_mobile(own, request)}") from None
    dyads = (group.branch_key for group in structure.groups if group.assemblies == 2)
    choices: dict[str, Sequence[int]] = dict.fromkeys(dyads, (1, -1))
    choices |= {t.branch_key: range(1, MOST_ASSEMBLIES + 1) for t in structure.triads}
    unknown = [key for key in request.branch if key not in choices]
    if unknown:
        raise CrankcheckError(
            f"--branch {unknown[0]}: it separates no assemblies; use {', '.join(choices) or 'none'}"
        )
    left = [key for key in choices if key not in request.branch]
    if len(left) > MOST_CHOICES:
        raise CrankcheckError(
            f"{request.path}: {len(left)} choices between two assemblies, of which {MOST_CHOICES} "
            f"are found by trying; choose {len(left) - MOST_CHOICES} or more with --branch NAME=1 "
            f"or NAME=-1, of {', '.join(left)}"
        )
    ranked = sorted(_fits(own, request, bare, choices, request.branch), key=lambda fit: fit.far)
    if not ranked:
        why = f"{_why_not_assembled(own, bare, request)}{far_pins(own)}"
        raise CrankcheckError(f"{request.path}: {why}")
    # A pose that is shut says the assembly by itself, within the ranges or not.
    able = [fit for fit in ranked if not fit.outside or fit.far <= SHUT] or ranked
    best, scene = able[0], able[0].scene
    if _alike(able):
        two = " or ".join(_words(fit.scene.branch) for fit in able[:2])
        raise CrankcheckError(
            f"{request.path}: the pose fits two assemblies equally well, {two}; choose with "
            "--branch NAME=1 or NAME=-1, or start from another pose with --key"
        )
    how = "beside what --branch names " * bool(request.branch) + "nearest to the pose"
    how = how if left else "as --branch names it"
    notes = [f"assembly: {_words(scene.branch)}, {how}"] if choices else []
    if choices and (best is not ranked[0] or _alike(ranked)):
        notes[0] += " of those within all ranges"
        notes[0] += f"; nearer is {_broken(ranked[0])}" if best is not ranked[0] else ""
    if best.outside:
        others = _fits(own, request, bare, choices, {}) if len(choices) <= MOST_CHOICES else []
        within = [_words(fit.scene.branch) for fit in others if not fit.outside]
        cure = f"{within[0]} stays within all ranges" if within else "no assembly found is within"
        notes.append(f"start: {_broken(best)}; {cure}")
    return _started(scene, request), notes


class _Fit(NamedTuple):
    """An assembly: the largest distance of a body's drawn frame from it, over the longest link, or
    angle [rad]; and the joints that break their ranges where the run starts."""

    far: float
    scene: Scene
    outside: Sequence[str]


def _alike(fits: Sequence[_Fit]) -> bool:
    """True if a pose fits the first two assemblies as well."""
    return len(fits) > 1 and fits[1].far - fits[0].far < ALIKE * fits[1].far


def _broken(fit: _Fit) -> str:
    return f"{_words(fit.scene.branch) or 'the assembly'}, where {few(fit.outside, SHOWN)}"


def _started(scene: Scene, request: ModelRequest) -> Scene:
    """Return a scene at the start that the request names, in the assembly to which the driver leads
    from the pose: assemblies of class III groups are numbered where they start. Raises
    CrankcheckError."""
    if request.start_deg is None:
        return scene
    law = ConstantSpeed(math.radians(request.start_deg), request.speed_rad_s)
    elsewhere = replace(scene, driver=Driver(scene.driver.link, law))
    if not analyse(scene).triads:
        return elsewhere
    there = law.at(np.zeros(1))[0]
    motion = solve_driven(scene, there, np.ones(1), np.zeros(1), bound=False)
    found = in_assembly(elsewhere, motion)
    if found is None:
        raise CrankcheckError(
            f"{request.path}: --start {request.start_deg:g}: the assembly of the pose is not "
            "unique there; start nearer to the pose"
        )
    return found


def _words(branch: Mapping[str, int]) -> str:
    return ", ".join(f"{key} {sign:+d}" for key, sign in branch.items())


def _why_mobile(own: OwnModel, request: ModelRequest) -> str:
    loose, welds = own.loose(), own.welds()
    if loose:
        return f" (with {request.joint} held these still move: {few(loose, SHOWN)})"
    if welds:
        return f" (a weld makes two bodies one: {few(welds, SHOWN)}; use <connect> for a pin)"
    return ""


def _fits(
    own: OwnModel,
    request: ModelRequest,
    bare: Scene,
    choices: Mapping[str, Sequence[int]],
    chosen: Mapping[str, int],
) -> Iterator[_Fit]:
    """Yield every assembly with the ``chosen`` signs."""
    left = [key for key in choices if key not in chosen]
    drawn = own.drawn().bodies
    for signs in itertools.product(*(choices[key] for key in left)):
        branch = dict.fromkeys(choices, 1) | dict(chosen) | dict(zip(left, signs, strict=True))
        scene = replace(bare, branch=branch)
        try:
            state = solve(scene, np.zeros(1), bound=False).state()
        except CrankcheckError:
            continue
        placed = frames(scene, state)
        far = max(_distance(placed[name], drawn[name], scene.longest_m) for name in drawn)
        outside: Sequence[str] = ()
        # A start that can not be assembled is refused later, with its reach.
        with suppress(CrankcheckError):
            begun = _started(scene, request)
            if begun is not scene:
                state = solve(begun, np.zeros(1), bound=False).state()
            outside = own.outside(begun, state)
        yield _Fit(far, scene, outside)


def _distance(frame: Frame, pose: BodyPose, longest_m: float) -> float:
    turn = abs(math.remainder(float(pose.theta[0]) - frame.theta, math.tau))
    return max(turn, math.dist(frame.origin, pose.origin[0]) / (longest_m or 1.0))


def _why_not_assembled(own: OwnModel, bare: Scene, request: ModelRequest) -> str:
    try:
        solve(bare, np.zeros(1), bound=False)
    except ReachError as error:
        return out_of_reach(bare, request, str(error))
    except CrankcheckError as error:
        return f"{error}{_why_mobile(own, request)}"
    return "it can not be assembled in this pose"


def far_pins(own: OwnModel) -> str:
    """Return the pins far outside their bodies as the likely reason of a refusal; "" without."""
    far = [each.text for each in own.disturbances if each.kind == FAR_PIN]
    return f"; is it the linkage that you mean? {few(far, SHOWN)}" if far else ""


def out_of_reach(scene: Scene, request: ModelRequest, otherwise: str) -> str:
    """Return the requested and the possible range of the driver in words; ``otherwise`` if empty.
    The angle of the driver is its joint's reading, so that all is in the joint's own coordinate."""
    start = float(scene.driver.law.at(np.zeros(1))[0][0])
    way = math.copysign(math.tau, request.speed_rad_s)
    end = start + way * request.turns
    spans = [_near(span, start) for span in reach(scene)]
    if not spans:
        return otherwise
    reaches = " and ".join(
        f"{math.degrees(low):.4g} to {math.degrees(high):.4g} deg" for low, high in spans
    )
    inside = next((span for span in spans if span[0] <= start <= span[1]), None)
    cure = "start in between with --start, and use less of a turn with --turns"
    if inside is not None:
        left = (inside[1] if way > 0.0 else inside[0]) - start
        most = math.floor(1e3 * abs(left) / math.tau) / 1e3
        cure = f"use less of a turn, --turns {most:g} at most, or another --start"
    return (
        f"joint {request.joint} would turn from {math.degrees(start):.4g} to "
        f"{math.degrees(end):.4g} deg, and reaches {reaches}, where the loops close; {cure}"
    )


def _near(span: tuple[float, float], angle: float) -> tuple[float, float]:
    """Return the range, moved by whole turns, that is nearest to an angle."""
    turns = round((angle - (span[0] + span[1]) / 2) / math.tau) * math.tau
    return span[0] + turns, span[1] + turns


@dataclass(frozen=True)
class ModelRequest:
    """A model file and the joint that drives it, at ``speed_rad_s`` from the drawn pose, or from
    keyframe ``key``, or from ``start_deg`` of the joint's own coordinate.

    The step is the file's own where neither ``dt_s`` nor ``steps_per_turn`` is given; ``branch``
    overrides the drawn assembly. Raises CrankcheckError for an invalid speed, angle or assembly.
    """

    path: Path
    joint: str
    speed_rad_s: float
    key: str | None = None
    start_deg: float | None = None
    branch: Mapping[str, int] = field(default_factory=dict)
    dt_s: float | None = None
    steps_per_turn: float | None = None
    turns: float = 1.0
    tolerance: Mapping[str, float] = field(default_factory=dict)
    converge: bool = True

    def __post_init__(self) -> None:
        if not (math.isfinite(self.speed_rad_s) and self.speed_rad_s):
            raise CrankcheckError(
                f"--speed {self.speed_rad_s:g}: give that of the crank in rad/s, such as 10; -10 "
                "turns it the other way"
            )
        if self.start_deg is not None and not math.isfinite(self.start_deg):
            raise CrankcheckError(f"--start {self.start_deg:g}: give an angle")
        for name, sign in self.branch.items():
            if sign not in (1, -1):
                raise CrankcheckError(f"--branch {name}: found {sign}; it is 1 or -1")
