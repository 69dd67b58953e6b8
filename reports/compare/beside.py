"""A run beside the truth, which is solved for once at each set of instants that is asked for."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from typing import ClassVar

import numpy as np

from analytic.forces.kinetostatics import forces
from analytic.kinematics import solve, solve_driven
from models.array import Array
from models.motion import Motion, State
from models.scene import Same, Scene
from models.scene.driver import driver_place
from reports.compare.tracks import Track, angle_error, fitting, lacking, tracks
from reports.quantities import named
from sim.engine import Energy, Run

SETTLING = 40
"""Samples in which an engine that starts with closed pins comes to its steady error: rates of these
are rows of their own, of kind "start". (pymunk: its velocities jump by half a step's worth.)"""
SETS = 2
"""Sets of instants that are kept: those of places and of velocities are often two."""


@lru_cache(maxsize=1)
def truth_of(same: Same) -> Truth:
    """The truth of the scene that was asked for last: its cells follow one another, and most are
    logged at the same instants."""
    return Truth(same.scene)


@dataclass(frozen=True)
class Truth:
    """The reference of a scene at sets of instants, each solved for once; with ``bound``, what it
    may be wrong by as well; of some ``links`` and ``points`` alone, or of all for None."""

    scene: Scene
    bound: bool = True
    links: tuple[str, ...] | None = None
    points: tuple[str, ...] | None = None
    _motions: dict[bytes, Motion] = field(default_factory=dict, repr=False, compare=False)
    _loaded: dict[bytes, Motion] = field(default_factory=dict, repr=False, compare=False)

    def beside(self, run: Run) -> Beside | None:
        """A run beside this truth; None where it logged nothing."""
        return Beside.of(self, run)

    @property
    def given(self) -> Scene:
        """The scene that an engine is given: of elastic links, the segments."""
        return self.scene

    def logged(self, run: Run) -> Run:
        """A run of what an engine was given as one of the scene: the same, unless links bend."""
        return run

    @cached_property
    def start(self) -> State:
        """The state at time 0. Raises CrankcheckError where there is none."""
        return solve(self.scene, np.zeros(1), bound=False).state()

    def at(self, time_s: Array) -> Motion:
        """The reference at instants (T,). Raises CrankcheckError where there is none."""
        instants = time_s.tobytes()
        motion = self._motions.get(instants)
        if motion is None:
            motion = self._solved(time_s)
            _keep(self._motions, instants, motion)
        return motion

    def _solved(self, time_s: Array) -> Motion:
        return solve(self.scene, time_s, links=self.links, points=self.points, bound=self.bound)

    def with_forces_at(self, time_s: Array) -> Motion:
        """As `at`, with the forces; there are none (NaN) in dead points."""
        instants = time_s.tobytes()
        motion = self._loaded.get(instants)
        if motion is None:
            whole = self
            if self.links is not None or self.points is not None:
                whole = replace(self, links=None, points=None, _motions={}, _loaded={})
            motion = whole.at(time_s)
            load = forces(self.scene, motion, bound=self.bound, skip_dead_points=True)
            motion = replace(motion, forces=load)
            _keep(self._loaded, instants, motion)
        return motion


def _keep(motions: dict[bytes, Motion], instants: bytes, motion: Motion) -> None:
    """Keep a motion in the place of the oldest."""
    for oldest in list(motions)[: 1 - SETS]:
        motions.pop(oldest, None)  # another thread may have done so
    motions[instants] = motion


@dataclass(frozen=True)
class Beside:
    """A run that logged something, beside the truth; ``motion`` is what it logged.

    Runs of a scene that were logged at the same instants share what was solved for, where they
    share ``truth``. What is worked out raises CrankcheckError where there is no reference.
    """

    compared_by: ClassVar[tuple[str, ...]] = (".driven_errors",)
    """The modules that compare it, from `reports.compare` (`reports.compare.compare`)."""
    truth: Truth
    run: Run
    motion: Motion
    _own: dict[str, tuple[Track, ...]] = field(default_factory=dict, repr=False, compare=False)

    @staticmethod
    def of(truth: Truth, run: Run) -> Beside | None:
        """The run beside the truth; None where it logged nothing."""
        motion = run.motion
        return Beside(truth, run, motion) if motion is not None and motion.time_s.size else None

    @property
    def scene(self) -> Scene:
        return self.truth.scene

    @cached_property
    def reference(self) -> Motion:
        """The truth at the logged instants."""
        return self.truth.at(self.motion.time_s)

    @cached_property
    def at_crank(self) -> Motion:
        """The truth, without bounds, at the logged angles of the driver, which stands still."""
        still = np.zeros_like(self.crank)
        return solve_driven(self.scene, self.crank, still, still, self.motion.time_s, bound=False)

    @cached_property
    def driver_rad(self) -> Array:
        """The commanded angle of the driver [rad], (T,)."""
        return self.scene.driver.law.at(self.motion.time_s)[0]

    @cached_property
    def crank(self) -> Array:
        """The logged coordinate of the driver [rad, or m of a slider], (T,); NaN where there is
        none."""
        return fitting(driver_place(self.scene, self.motion), self.motion.time_s)

    @cached_property
    def drive(self) -> Array:
        """How far the driver is from where it was told to be [rad], (T,); of a slider over the
        longest length."""
        if self.scene.driver.slider is not None:
            return np.asarray((self.crank - self.driver_rad) / self.scene.driver_arm_m)
        return angle_error(self.crank, self.driver_rad)

    def driver_at(self, time_s: Array, reference: Motion) -> Array:
        """The true angle of the driver [rad] at instants, (T,), those of a reference."""
        return self.scene.driver.law.at(time_s)[0]

    def judged(self, track: Track, time_s: Array) -> Track:
        """A track of an error at the same time, as it is held to a limit."""
        return track

    @cached_property
    def whole(self) -> Motion:
        """The truth of all that is compared of the scene, which says how hard it is."""
        return self.reference

    @property
    def of_engine(self) -> bool:
        """Whether an engine made the run, which is never as near as the reference to itself."""
        return True

    @property
    def settling(self) -> int:
        """How many samples may be the start."""
        return SETTLING

    @property
    def is_even(self) -> bool:
        """Whether the logged places are to be differenced, at steps that are all the same."""
        return True

    @property
    def has_crank(self) -> bool:
        """Whether errors at the logged angle of the driver are asked for."""
        return True

    @property
    def missing(self) -> tuple[str, ...]:
        """What the scene has and the run should have logged."""
        gaps = self.tracks(named("closure"), self.reference)
        open_ = [f"gap of {track.body}" for track in gaps if track.body not in self.run.gaps]
        return (*lacking(self.motion, self.reference), *open_)

    @property
    def incomplete(self) -> str:
        """What the time stamps lack of those that were commanded, "" where they are whole."""
        return incomplete(self.run)

    @property
    def places(self) -> tuple[Track, ...]:
        """The tracks of place against the truth at the logged instants."""
        return self.tracks(named("place"), self.reference)

    def tracks(self, quantities: Sequence[str], reference: Motion) -> tuple[Track, ...]:
        """The tracks of some quantities of the log, against a reference of as many samples; those
        against the truth at the logged instants are kept."""
        kept = self._own if reference is self.reference else dict[str, tuple[Track, ...]]()
        for name in quantities:
            if name not in kept:
                kept[name] = tuple(tracks(self.scene, self.run, reference, (name,)))
        return tuple(track for name in quantities for track in kept[name])


ROUNDINGS = 4
"""Roundings of the largest time that a stamp may be off by: start + dt * k is two operations."""
EPSILON = float(np.finfo(np.float64).eps)


def incomplete(run: Run) -> str:
    """What the log lacks of the commanded samples, start + k * every * dt; "" where it is whole.

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
    """The run with its first samples alone, of all that it logged at each; itself where these are
    all."""
    motion = run.motion
    if motion is None or number >= motion.time_s.size:
        return run
    return each_at(run, lambda series: series[:number])


def each_at(run: Run, chosen: Callable[[Array], Array]) -> Run:
    """The run at some of its samples, of all that it logged at each."""
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
