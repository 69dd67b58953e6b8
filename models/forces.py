"""What the motion asks of the joints and of the drive, over time."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from models.array import Array


@dataclass(frozen=True)
class SliderForces:
    """What the guide of a slider exerts on what slides: ``normal`` [N], the force along the line's
    direction turned by +90 deg, at the slider's point; ``moment`` [N m] about that point; (T,)."""

    normal: Array
    moment: Array


@dataclass(frozen=True)
class ForceBound:
    """What forces may be wrong by: the same keys, arrays of shape (T,), never negative.

    For pins the bound holds for the length of the error vector. Infinite where rounding leaves
    nothing certain.
    """

    pins: Mapping[str, Mapping[str, Array]]
    sliders: Mapping[str, SliderForces]
    torque: Array
    friction: Mapping[str, Array] = field(default_factory=dict)


@dataclass(frozen=True)
class FrictionSolution:
    """How Coulomb's friction, which hangs on the reactions that it changes, was found; (T,) each.

    ``solutions`` is 1 where there is one, 2 where there are two or more, of which the one with the
    least friction is given, and 0 where there is none: no finite torque keeps the mechanism moving.
    ``iterations`` were taken; ``change`` is what the last of them changed or, where there may be
    several solutions, what the one that is given leaves open, over the largest friction.
    """

    solutions: Array
    iterations: Array
    change: Array


@dataclass(frozen=True)
class Forces:
    """Reactions and driving torque, sampled at ``time_s`` (T,).

    ``pins`` holds, by point and body, the force of the pin on the body [N], (T, 2), in the ground's
    frame. Bodies stand in the order of the pin, the ground first, then links, then slider blocks:
    where two meet, the force on the second is what the first exerts on it. All forces of a pin add
    up to 0. ``torque``, (T,), is what the drive exerts on the driver, in ``drive_unit``: N m, or N
    along its line where that is a slider. ``undetermined`` says
    why there are no reactions where the equations of statics leave them open. What a producer does
    not give is NaN. ``friction`` holds what rubs, by joint: in a pin the couple [N m] that its
    first body exerts on its second, in a slider the force [N] of the guide on what slides, along
    the line; ``friction_solution`` is how that was found where it is Coulomb's.
    ``contradictions`` is what an engine's own numbers say against its forces.
    """

    time_s: Array
    pins: Mapping[str, Mapping[str, Array]]
    sliders: Mapping[str, SliderForces]
    torque: Array
    bound: ForceBound | None = None
    undetermined: str = ""
    friction: Mapping[str, Array] = field(default_factory=dict)
    friction_solution: FrictionSolution | None = None
    contradictions: tuple[str, ...] = ()
    drive_unit: str = "N m"

    def has_equilibria(self, number: int) -> NDArray[np.bool_]:
        """The samples (T,) at which Coulomb's friction has so many equilibria: 0 where it locks the
        mechanism, 2 where that may jam."""
        if self.friction_solution is None:
            return np.zeros(self.time_s.size, np.bool_)
        return np.asarray(self.friction_solution.solutions == number)

    def each_series(self, change: Callable[[Array], Array]) -> Forces:
        """The forces alone, without bound, with every series changed; their instants stay."""
        return replace(
            self,
            pins={
                point: {body: change(force) for body, force in bodies.items()}
                for point, bodies in self.pins.items()
            },
            sliders={
                name: SliderForces(change(slider.normal), change(slider.moment))
                for name, slider in self.sliders.items()
            },
            torque=change(self.torque),
            bound=None,
            friction={joint: change(series) for joint, series in self.friction.items()},
            friction_solution=None,
        )

    def stretch(self, kept: slice | NDArray[np.intp]) -> Forces:
        """Some of the samples, one after the other or by their numbers, without bound."""
        return replace(self.each_series(lambda series: series[kept]), time_s=self.time_s[kept])

    @staticmethod
    def joined(parts: Sequence[Forces]) -> Forces:
        """Stretches of samples one after the other."""
        first = parts[0]
        if len(parts) == 1:
            return first
        return replace(
            first,
            time_s=np.concatenate([part.time_s for part in parts]),
            pins={
                point: {
                    body: np.concatenate([part.pins[point][body] for part in parts])
                    for body in bodies
                }
                for point, bodies in first.pins.items()
            },
            sliders={
                name: SliderForces(
                    np.concatenate([part.sliders[name].normal for part in parts]),
                    np.concatenate([part.sliders[name].moment for part in parts]),
                )
                for name in first.sliders
            },
            torque=np.concatenate([part.torque for part in parts]),
            bound=None,
            friction={
                joint: np.concatenate([part.friction[joint] for part in parts])
                for joint in first.friction
            },
            friction_solution=None,
            contradictions=tuple(text for part in parts for text in part.contradictions),
        )
