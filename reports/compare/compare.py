"""Compare a run with the reference, which is solved once at each set of requested instants.

Total error: the reference at the commanded time. Geometric error: the reference at the crank angle
that the engine logged, so that a crank which lags shows in the drive and not in the geometry.

The kind of comparison (`Beside`) names the modules that compare it; they are loaded on demand.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, fields, replace
from functools import cached_property, lru_cache
from importlib import import_module
from typing import ClassVar, Protocol, cast

import numpy as np

from analytic.forces.kinetostatics import forces
from analytic.kinematics import solve, solve_driven
from models.array import Array
from models.motion import Motion, State
from models.scene import Same, Scene, driver
from reports.compare.errors import Error, Errors
from reports.compare.tracks import Track, angle_error, fitting, lacking, tracks
from reports.quantities import named
from sim.engine import Energy, Run, Settings, SettingValue, Setup
from sim.run.check import SAME, rounding_of

SETTLING = 40
"""Samples in which an engine that starts with closed pins comes to its steady error: their rates
are separate rows, of kind "start". (pymunk: its velocities jump by half a step's worth.)"""
SETS = 3
"""Sets of instants that are kept: positions, and velocities half a step before or after them."""


@lru_cache(maxsize=1)
def truth_of(same: Same) -> Truth:
    """Return the reference of the scene requested last: its cells follow one another."""
    return Truth(same.scene)


@dataclass(frozen=True)
class Truth:
    """The reference of a scene at sets of instants, each solved once; with ``bound``, its own
    uncertainty too; for some ``links`` and ``points`` alone, or for all if None."""

    scene: Scene
    bound: bool = True
    links: tuple[str, ...] | None = None
    points: tuple[str, ...] | None = None
    _motions: dict[bytes, Motion] = field(default_factory=dict, repr=False, compare=False)
    _loaded: dict[bytes, Motion] = field(default_factory=dict, repr=False, compare=False)

    def beside(self, run: Run) -> Beside | None:
        """Return a run beside this reference; None where it logged nothing."""
        motion = run.motion
        return self._beside(run, motion) if motion is not None and motion.time_s.size else None

    def _beside(self, run: Run, motion: Motion) -> Beside:
        return Beside(self, run, motion)

    @property
    def given(self) -> Scene:
        """The scene for the engine: with segments for elastic links."""
        return self.scene

    def logged(self, run: Run) -> Run:
        """Return a run of the engine's scene as one of the scene: the same, unless links bend."""
        return run

    @cached_property
    def start(self) -> State:
        """The state at time 0. Raises CrankcheckError where there is none."""
        return solve(self.scene, np.zeros(1), bound=False).state()

    def at(self, time_s: Array) -> Motion:
        """Return the reference at instants (T,). Raises CrankcheckError where there is none."""
        return kept(self._motions, time_s, self._solved)

    def _solved(self, time_s: Array) -> Motion:
        return solve(self.scene, time_s, links=self.links, points=self.points, bound=self.bound)

    def with_forces_at(self, time_s: Array) -> Motion:
        """Return `at` with the forces; there are none (NaN) in dead points."""
        return kept(self._loaded, time_s, self._solved_with_forces)

    def _solved_with_forces(self, time_s: Array) -> Motion:
        whole = self
        if self.links is not None or self.points is not None:
            whole = replace(self, links=None, points=None, _motions={}, _loaded={})
        motion = whole.at(time_s)
        load = forces(self.scene, motion, bound=self.bound, skip_dead_points=True)
        return replace(motion, forces=load)


def kept(motions: dict[bytes, Motion], time_s: Array, solved: Callable[[Array], Motion]) -> Motion:
    """Return the motion at instants (T,), solved once, and then kept in the place of that whose
    last use is longest ago."""
    instants = time_s.tobytes()
    motion = motions.pop(instants, None)
    if motion is None:
        motion = solved(time_s)
    for oldest in list(motions)[: 1 - SETS]:
        motions.pop(oldest, None)  # another thread may have done so
    motions[instants] = motion
    return motion


@dataclass(frozen=True)
class Beside:
    """A run that logged something, beside the reference; ``motion`` is the logged one.

    Runs of a scene that were logged at the same instants share the solutions, where they share
    ``truth``. Derived values raise CrankcheckError where there is no reference.
    """

    compared_by: ClassVar[tuple[str, ...]] = (".driven_errors",)
    """The modules that compare it, from `reports.compare` (`reports.compare.compare`)."""
    truth: Truth
    run: Run
    motion: Motion
    _own: dict[str, tuple[Track, ...]] = field(default_factory=dict, repr=False, compare=False)

    @property
    def scene(self) -> Scene:
        return self.truth.scene

    @cached_property
    def reference(self) -> Motion:
        """The reference at the logged instants."""
        return self.truth.at(self.motion.time_s)

    @cached_property
    def at_crank(self) -> Motion:
        """The reference, without bounds, at the logged angles of the driver, with rates 0."""
        still = np.zeros_like(self.crank)
        return solve_driven(self.scene, self.crank, still, still, self.motion.time_s, bound=False)

    @cached_property
    def driver_rad(self) -> Array:
        """The commanded angle of the driver [rad], (T,)."""
        return self.scene.driver.law.at(self.motion.time_s)[0]

    @cached_property
    def crank(self) -> Array:
        """The logged coordinate of the driver [rad, or m of a slider], (T,); NaN without one."""
        return fitting(driver.driver_place(self.scene, self.motion), self.motion.time_s)

    @cached_property
    def drive(self) -> Array:
        """Error of the driver's place [rad], (T,); for a slider over the longest length."""
        if self.scene.driver.slider is not None:
            return np.asarray((self.crank - self.driver_rad) / self.scene.driver_arm_m)
        return angle_error(self.crank, self.driver_rad)

    def driver_at(self, time_s: Array, reference: Motion) -> Array:
        """Return the true angle of the driver [rad] at the instants of a reference, (T,)."""
        return self.scene.driver.law.at(time_s)[0]

    def judged(self, track: Track, time_s: Array) -> Track:
        """Return a track of an error at the same time in the form that limits apply to."""
        return track

    @cached_property
    def whole(self) -> Motion:
        """The reference of all compared quantities of the scene, for its difficulty."""
        return self.reference

    @property
    def of_engine(self) -> bool:
        """True if an engine made the run: it is never as near as the reference to itself."""
        return True

    @property
    def settling(self) -> int:
        """Largest number of samples of the start."""
        return SETTLING

    @property
    def is_even(self) -> bool:
        """True if the logged positions can be differenced, with equal steps throughout."""
        return True

    @property
    def has_crank(self) -> bool:
        """True if errors at the logged angle of the driver are required."""
        return True

    @property
    def missing(self) -> tuple[str, ...]:
        """Parts of the scene that the run should have logged."""
        gaps = self.tracks(named("closure"), self.reference)
        open_ = [f"gap of {track.body}" for track in gaps if track.body not in self.run.gaps]
        return (*lacking(self.motion, self.reference), *open_)

    @property
    def incomplete(self) -> str:
        """Gap of the time stamps against the commanded ones, "" where they are complete."""
        return incomplete(self.run)

    @property
    def places(self) -> tuple[Track, ...]:
        """The tracks of position against the reference at the logged instants."""
        return self.tracks(named("place"), self.reference)

    def tracks(self, quantities: Sequence[str], reference: Motion) -> tuple[Track, ...]:
        """Return the tracks of some quantities of the log, against a reference of as many samples;
        tracks against the reference at the logged instants are kept."""
        kept = self._own if reference is self.reference else dict[str, tuple[Track, ...]]()
        for name in quantities:
            if name not in kept:
                kept[name] = tuple(tracks(self.scene, self.run, reference, (name,)))
        return tuple(track for name in quantities for track in kept[name])


ROUNDINGS = 4
"""Roundings of the largest time that a stamp may be off by: start + dt * k is two operations."""
EPSILON = float(np.finfo(np.float64).eps)


def incomplete(run: Run) -> str:
    """Return the gap of the log in the commanded samples, start + k * every * dt; "" if complete.

    A run that did not end well has a short log by its nature: its status says so already.
    """
    if run.motion is None:
        return "nothing was logged"
    stamps = run.motion.time_s
    commanded = run.start_s + run.dt_s * (run.every * np.arange(run.steps // run.every + 1.0))
    if stamps.shape != commanded.shape:
        return (
            f"{stamps.size} samples, not the {commanded.size} of {run.steps} steps logged every "
            f"{run.every}"
        )
    off = np.abs(stamps - commanded)
    room = ROUNDINGS * EPSILON * float(np.max(np.abs(commanded)))
    bad = np.flatnonzero(~(off <= room))
    if bad.size:
        first = int(bad[0])
        return (
            f"sample {first} is stamped {stamps[first]:.9g} s, not {commanded[first]:.9g} s "
            f"({bad.size} of {stamps.size} are off the commanded times)"
        )
    return ""


def first_samples(run: Run, number: int) -> Run:
    """Return the run with its first samples alone in all its series; itself if these are all."""
    motion = run.motion
    if motion is None or number >= motion.time_s.size:
        return run
    return each_at(run, lambda series: series[:number])


def each_at(run: Run, chosen: Callable[[Array], Array]) -> Run:
    """Return the run at some of its samples, in all its series."""
    assert run.motion is not None
    energy = run.energy
    return replace(
        run,
        motion=replace(run.motion.each_series(chosen), time_s=chosen(run.motion.time_s)),
        gaps={name: chosen(gap) for name, gap in run.gaps.items()},
        velocity_time_s=None if run.velocity_time_s is None else chosen(run.velocity_time_s),
        acceleration_time_s=(
            None if run.acceleration_time_s is None else chosen(run.acceleration_time_s)
        ),
        energy=energy and Energy(chosen(energy.kinetic_j), chosen(energy.potential_j)),
    )


class Comparing(Protocol):
    """A module that compares runs of a kind."""

    def compared(self, beside: Beside, errors: Errors | None) -> Errors:
        """Return the errors of a run, added to the errors of the modules before."""

    def places(self, beside: Beside) -> list[Error]:
        """Return drive or phase errors, total errors of position and gaps alone."""


def compare(beside: Beside | None) -> Errors | None:
    """Return the errors of a run, a row per quantity, body, source and kind; None for an empty log.

    Samples that are not finite, and bodies or pins of the scene that a run lacks, give errors that
    are not finite; gaps of a user's own log give none.
    """
    errors: Errors | None = None
    for module in _modules(beside):
        assert beside is not None
        errors = module.compared(beside, errors)
    return errors


def places(beside: Beside | None) -> list[Error]:
    """Return drive error, total errors of position and gaps alone; none for an empty log."""
    if beside is None:
        return []
    return [row for module in _modules(beside) for row in module.places(beside)]


def _modules(beside: Beside | None) -> Iterator[Comparing]:
    for name in beside.compared_by if beside else ():
        yield cast(Comparing, import_module(name, __package__))


ROUNDING = 1e-12
"""Largest relative difference by rounding, for a number computed in another order."""


def not_asked_for(run: Run, setup: Setup, holds: Settings, scene: Scene, state: State) -> list[str]:
    """Return the differences between the run's own data and the request, field by field.

    ``holds`` are the settings as an engine with the requested ones reports them; ``state`` is the
    requested start of the run.
    """
    texts = [
        _words(field.name, getattr(setup, field.name), getattr(run, field.name))
        for field in fields(setup)
        if field.name != "asked" and getattr(run, field.name) != getattr(setup, field.name)
    ]
    told = [
        _words(f"setting {name}", setup.asked.get(name), run.asked.get(name))
        for name in dict.fromkeys([*setup.asked, *run.asked])
        if name not in setup.asked or name not in run.asked or setup.asked[name] != run.asked[name]
    ]
    held = [
        _words(f"setting {name}, as the engine holds it", value, run.settings.get(name))
        for name, value in holds.items()
        if run.motion is not None and not _equal(run.settings.get(name), value)
    ]
    return [*texts, *(told or held), *_elsewhere(run, scene, state)]


def _elsewhere(run: Run, scene: Scene, state: State) -> list[str]:
    """Return the bodies whose first logged position differs from the state's."""
    motion = run.motion
    if motion is None or not motion.time_s.size:
        return []
    first = motion.state()
    size = max(scene.longest_m, *(math.hypot(*place) for place in state.position.values()))
    turned = {
        f"link {name}": abs(math.remainder(first.theta[name] - angle, math.tau))
        for name, angle in state.theta.items()
        if name in first.theta
    }
    moved = {
        f"point {name}": math.dist(first.position[name], place) / size
        for name, place in state.position.items()
        if name in first.position
    } | {
        f"slider {name}": abs(first.displacement[name] - place) / size
        for name, place in state.displacement.items()
        if name in first.displacement
    }
    same = max(SAME, rounding_of(run.precision))
    far = [*((*each, "rad") for each in turned.items()), *((*each, "L") for each in moved.items())]
    return [f"start: {body} has an error of {by:.2g} {unit}" for body, by, unit in far if by > same]


def _words(name: str, asked: object, found: object) -> str:
    return f"{name}: requested {_short(asked)}, the run has {_short(found)}"


def _short(value: object) -> str:
    return "none" if value is None else f"{value:.9g}" if isinstance(value, float) else repr(value)


def _equal(found: SettingValue | None, asked: SettingValue) -> bool:
    if found is None or isinstance(found, str) or isinstance(asked, str):
        return found == asked
    return math.isclose(found, asked, rel_tol=ROUNDING)
