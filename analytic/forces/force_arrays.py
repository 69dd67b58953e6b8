"""The arrays of forces, filled chunk by chunk."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

import numpy as np

from analytic.dyads.plane import Real
from analytic.forces.bounded import Bounded, BoundedVec
from analytic.forces.coulomb import CoulombSolution
from analytic.structure.mobility import Structure
from models.array import Array, Mask
from models.forces import ForceBound, Forces, FrictionSolution, SliderForces
from models.friction import CoulombFriction, Friction


class ForceArrays:
    """The arrays of forces while they are filled; of redundant scenes the torque alone."""

    def __init__(
        self,
        time_s: Array,
        structure: Structure,
        sliders: Iterable[str],
        friction: Mapping[str, Friction],
        *,
        bound: bool,
    ) -> None:
        self.time_s, self.certified = time_s, bound
        count = len(time_s)
        held = {} if structure.redundant else structure.pins
        slid = () if structure.redundant else tuple(sliders)
        self.torque = np.empty(count)
        self.pins = {p: {b: np.empty((2, count)).T for b in names} for p, names in held.items()}
        self.sliders = {s: SliderForces(np.empty(count), np.empty(count)) for s in slid}
        self.friction = {joint: np.empty(count) for joint in friction}
        self.solution: FrictionSolution | None = None
        if any(isinstance(law, CoulombFriction) for law in friction.values()):
            self.solution = FrictionSolution(*(np.zeros(count) for _ in range(3)))
        if bound:
            self.bound = ForceBound(
                {p: {b: np.empty(count) for b in names} for p, names in held.items()},
                {s: SliderForces(np.empty(count), np.empty(count)) for s in slid},
                np.empty(count),
                {joint: np.empty(count) for joint in friction},
            )

    def write(
        self,
        span: slice,
        torque: Bounded,
        pins: Mapping[str, Mapping[str, BoundedVec]],
        sliders: Mapping[str, tuple[Bounded, Bounded]],
        friction: Mapping[str, Bounded],
    ) -> None:
        """Store the forces of a chunk."""
        self.torque[span] = torque.value
        for joint, series in self.friction.items():
            series[span] = friction[joint].value
        for point, by_body in self.pins.items():
            for body, array in by_body.items():
                v = pins[point][body].v
                array[span, 0], array[span, 1] = v.x, v.y
        for name, one in self.sliders.items():
            one.normal[span], one.moment[span] = (each.value for each in sliders[name])
        if not self.certified:
            return
        _put(self.bound.torque[span], torque.error)
        for point, limits in self.bound.pins.items():
            for body, limit in limits.items():
                _put(limit[span], pins[point][body].error)
        for name, most in self.bound.sliders.items():
            for array, each in zip((most.normal, most.moment), sliders[name], strict=True):
                _put(array[span], each.error)
        for joint, limit in self.bound.friction.items():
            _put(limit[span], friction[joint].error)

    def write_solution(self, span: slice, found: CoulombSolution) -> None:
        """Store how the friction of a chunk was found."""
        assert self.solution is not None
        self.solution.solutions[span] = found.solutions
        self.solution.iterations[span] = found.iterations
        self.solution.change[span] = found.change

    def locked(self, span: slice) -> Mask:
        """The samples of a chunk at which no finite torque overcomes the friction."""
        if self.solution is None:
            return np.zeros(len(self.torque[span]), np.bool_)
        return np.asarray(self.solution.solutions[span] == 0.0)

    def not_finite(self, span: slice) -> Mask:
        """The samples of a chunk at which a force is no number, by the sum of them; two forces of a
        pin that are opposite count once."""
        total = self.torque[span].copy()
        for by_body in self.pins.values():
            array = next(iter(by_body.values()))
            total += array[span, 0]
            total += array[span, 1]
        for one in self.sliders.values():
            total += one.normal[span]
            total += one.moment[span]
        return np.asarray(~np.isfinite(total))

    def leave_out(self, span: slice, samples: Mask) -> None:
        """Have no numbers at some samples of a chunk, and infinite bounds."""
        for array in _arrays(self):
            array[span][samples] = np.nan
        if self.certified:
            for array in _arrays(self.bound):
                array[span][samples] = np.inf

    def forces(self, undetermined: str, drive_unit: str) -> Forces:
        """The filled arrays as forces."""
        bound = self.bound if self.certified else None
        return Forces(
            self.time_s,
            self.pins,
            self.sliders,
            self.torque,
            bound,
            undetermined,
            self.friction,
            self.solution,
            drive_unit=drive_unit,
        )


def _arrays(of: ForceArrays | ForceBound) -> Iterator[Array]:
    yield of.torque
    for by_body in of.pins.values():
        yield from by_body.values()
    for one in of.sliders.values():
        yield from (one.normal, one.moment)
    yield from of.friction.values()


def _put(into: Array, error: Real) -> None:
    """Store bounds, infinite where they come out of what is not certain (0 times infinity)."""
    into[:] = error
    into[np.isnan(into)] = np.inf
