"""Derivatives of engines after some steps, compared with those of the reference at the same time.

Outputs are the angles of links, and the coordinates of sliders and points over the longest link; a
unit of a dimension is the longest link, a radian, or the mass itself. So all numbers are pure.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import Any, cast

import numpy as np

from analytic.gradients.dimensions import dimensions, with_dimensions
from analytic.gradients.gradient import Gradient, gradient, masses
from analytic.kinematics import solve
from models.array import Array
from models.errors import CrankcheckError, EngineError
from models.motion import Bound, Motion, State
from models.scene import Scene
from reports.lectures.machine.engine_motions import columns, motions, poses_at
from sim.engine import Engine, Settings
from sim.engine.gradient import Differentiated, PoseGradient, Variation, differences
from sim.engine.measure import gaps
from sim.engine.settings import profile_of, resolved
from sim.registry import FIRST, capability, declaration, engine

TOLERANCE = 1e-2
"""Error of a gradient over its largest number. A step of Gauss and Newton with it leaves this share
of its way, times the condition of the fit: two digits a step."""
NOTHING = 1e-9
"""Derivative that counts as zero, over the largest of the reference."""
ASTRAY = 0.05
"""Angle of a link against the reference [rad] with which a pose is another one."""
NOTABLE = 1e-3
"""Derivative of the reference that is not small, over its largest."""


@dataclass(frozen=True)
class Question:
    """Gradients of a scene from its start on, after ``steps`` of ``dt_s`` [s]: by ``names``."""

    scene: Scene
    names: tuple[str, ...]
    steps: tuple[int, ...]
    dt_s: float
    of: str

    @cached_property
    def units(self) -> dict[str, float]:
        """Unit of each dimension [m or rad]; a mass has itself, and no place depends on it."""
        known = dimensions(self.scene)
        return {
            name: (self.scene.longest_m if known[name].unit == "m" else 1.0)
            for name in self.names
            if name in known
        }

    @cached_property
    def reference(self) -> Gradient:
        known = [name for name in self.names if name in self.units]
        found = gradient(self.scene, self.dt_s * np.array(self.steps, dtype=float), known)
        if found.locked:
            held = ", ".join(found.locked)
            raise CrankcheckError(f"{self.scene.name}: {held} has no derivative; leave it out")
        return found

    @cached_property
    def truth(self) -> Array:
        """Derivatives of the reference (K, P, N), not a number where none is certain."""
        own = self.columns(self.reference.motion)
        every = []
        for name in self.names:
            by = self.reference.by.get(name)
            if by is None or by.bound is None:
                every.append(np.zeros_like(own))
                continue
            certain = np.isfinite(self.columns(by.bound))
            every.append(np.where(certain, self.units[name] * self.columns(by), np.nan))
        return np.stack(every, axis=1)

    def columns(self, motion: Motion | Bound) -> Array:
        return columns(motion, self.reference.motion, self.scene.longest_m)

    @cached_property
    def outputs(self) -> list[str]:
        """Name of each column."""
        own = self.reference.motion
        points = [f"{axis} of {point}" for point in own.points for axis in "xy"]
        return [*own.links, *own.sliders, *points]

    @property
    def sizes(self) -> Array:
        """Return the largest derivative of the reference (K,), 0 where none is certain."""
        return np.asarray(np.nan_to_num(np.abs(self.truth)).max(axis=(1, 2)))

    def of_engine(self, by: Mapping[str, Motion]) -> Array:
        """Return the derivatives of an engine (K, P, N), not a number where the method has none."""
        none = np.full((len(self.steps), len(self.outputs)), np.nan)
        every = [self.columns(by[name]) if name in by else none for name in self.names]
        given = [name in by for name in self.names]  # what is not a number there went wrong
        found = np.stack(every, axis=1)
        return np.where(np.array(given)[:, None] & ~np.isfinite(found), np.inf, found)

    def astray(self, own: Motion) -> Array:
        """Return the angle of the link that is farthest from the reference (K,) [rad]."""
        true = self.reference.motion.links
        off = np.array([one.theta - true[name].theta for name, one in own.links.items()])
        return np.asarray(np.abs(np.remainder(off + math.pi, math.tau) - math.pi).max(axis=0))

    @property
    def followed(self) -> list[int]:
        """Numbers of the outputs of the follower."""
        own = (self.of, f"x of {self.of}", f"y of {self.of}")
        first = [n for n, name in enumerate(self.outputs) if name == self.of]
        return first or [n for n, name in enumerate(self.outputs) if name in own]

    @property
    def variation(self) -> Variation:
        return Variation(self.scene, _start(self.scene), self.names, self._shifted)

    def _shifted(self, name: str, by: float) -> tuple[Scene, State]:
        changed = _changed(self.scene, name, by * self.units.get(name, 1.0))
        return changed, _start(changed)


def _start(scene: Scene) -> State:
    return solve(scene, np.zeros(1), bound=False).state()


def _changed(scene: Scene, name: str, by: float) -> Scene:
    """Return the scene with a dimension changed by a length or an angle, a mass by a share."""
    if name.startswith("driver."):
        return replace(scene, driver=replace(scene.driver, law=scene.driver.law.turned(by)))
    known = dimensions(scene)
    if name in known:
        return with_dimensions(scene, {name: known[name].value + by})
    body, what = masses(scene)[name]
    links, sliders = dict(scene.links), dict(scene.sliders)
    if body in links:
        links[body] = replace(links[body], **{what: (1.0 + by) * getattr(links[body], what)})
    else:
        sliders[body] = replace(sliders[body], **{what: (1.0 + by) * getattr(sliders[body], what)})
    return replace(scene, links=links, sliders=sliders)


@dataclass(frozen=True)
class EngineGradient:
    """Derivatives of an engine with a profile by one method, (K, P, N) as those of the reference,
    the opening of joints (K,) [m], and the largest error of a link's angle (K,)
    [rad]; or the reason why there are none. ``finer`` are the derivatives with half the step,
    (P, N) after the last of the steps, where they were computed.
    """

    question: Question
    engine: str
    version: str
    profile: str
    method: str
    refusal: str = ""
    slopes: Array | None = None
    gaps: Mapping[str, Array] = field(default_factory=dict)
    astray: Array | None = None
    finer: Array | None = None

    @property
    def label(self) -> str:
        return f"{self.engine} {self.profile}"

    def off(self, k: int, slopes: Array | None = None) -> Array:
        """Return the errors (P, N) after the k-th of the steps, over the largest derivative of the
        reference (over 1 where it has none); not a number where the method leaves one out."""
        assert self.slopes is not None
        truth, own = self.question.truth[k], self.slopes[k] if slopes is None else slopes
        return np.asarray(np.abs(own - truth) / (self.question.sizes[k] or 1.0))

    def error(self, k: int) -> float:
        """Return the largest error, not a number where the reference is not certain."""
        if np.isnan(self.question.truth[k]).all():
            return math.nan
        off = self.off(k)
        return math.inf if np.isnan(off).all() else float(np.nanmax(off))

    def is_within(self, k: int) -> bool:
        return not self.error(k) > TOLERANCE

    @property
    def within(self) -> bool:
        return self.slopes is None or all(map(self.is_within, range(len(self.question.steps))))

    @property
    def order(self) -> float:
        """Return the power of the step with which the last error shrinks."""
        if self.finer is None:
            return math.nan
        last = len(self.question.steps) - 1
        finer = float(np.nanmax(self.off(last, self.finer)))
        return math.log2(self.error(last) / finer) if finer else math.inf

    def vectors(self, k: int) -> tuple[Array, Array]:
        """Return the gradient of the follower by all dimensions of the method, of this engine and
        of the reference."""
        assert self.slopes is not None
        columns = self.question.followed
        own, truth = self.slopes[k][:, columns], self.question.truth[k][:, columns]
        has = np.isfinite(own).all(axis=1) & np.isfinite(truth).all(axis=1)
        return own[has].ravel(), truth[has].ravel()

    def angle(self, k: int) -> float:
        """Return the angle between them [rad], not a number where one is zero or has one number."""
        if len(self.vectors(k)[0]) < 2:
            return math.nan
        own, truth = (v / np.linalg.norm(v) if v.any() else v * np.nan for v in self.vectors(k))
        return 2.0 * math.atan2(
            float(np.linalg.norm(own - truth)), float(np.linalg.norm(own + truth))
        )

    def findings(self, k: int) -> list[str]:
        """Return what the numbers say beside the error: derivatives of zero, open pins, and links
        elsewhere, as on the other branch."""
        assert self.slopes is not None
        angles = len(self.question.scene.links)  # a point also moves on its body
        largest = np.abs([self.slopes[k], self.question.truth[k]])[..., :angles].max(axis=2)
        size = self.question.sizes[k]
        zero = (largest[0] <= NOTHING * size) & (largest[1] > NOTABLE * size)
        found = [n for n, is_zero in zip(self.question.names, zero, strict=True) if is_zero]
        text = [f"zero by {', '.join(found)}"] * bool(found)
        size = self.question.scene.longest_m
        shares = {pin: float(gap[k]) / size for pin, gap in self.gaps.items()}
        pin = max(shares, key=lambda name: shares[name], default="")
        if pin and shares[pin] > TOLERANCE:
            text.append(f"loop open: {shares[pin]:.2g} of the longest link at {pin}")
        elif self.astray is not None and self.astray[k] > ASTRAY:
            text.append(f"links elsewhere, by up to {self.astray[k]:.2g} rad")
        return text

    def rows(self) -> Iterator[dict[str, Any]]:
        """Return the comparison after each number of steps."""
        if self.slopes is None:
            return
        for k, number in enumerate(self.question.steps):
            off = np.nan_to_num(self.off(k), nan=-1.0, posinf=math.inf)
            p, n = np.unravel_index(int(np.argmax(off)), off.shape)
            yield {
                "engine": self.engine,
                "version": self.version,
                "profile": self.profile,
                "method": self.method,
                "steps": number,
                "error": self.error(k),
                "dimension": self.question.names[int(p)],
                "output": self.question.outputs[int(n)],
                "angle_rad": self.angle(k),
                "order": self.order if k + 1 == len(self.question.steps) else math.nan,
                "findings": self.findings(k),
                "within": self.is_within(k),
            }


def engine_gradients(
    question: Question,
    name: str,
    profile: str,
    *,
    with_order: bool = False,
    with_runs: bool = False,
) -> Iterator[EngineGradient]:
    """Differentiate in an engine with a profile, one result for each method; ``with_runs`` by
    differences of whole runs too, where an engine has derivatives of its own.

    Raises
    ------
    EngineError
        An engine that is unknown or not installed, or an unknown profile.
    """
    chosen = engine(name)
    settings = resolved(profile_of(chosen, profile), None)
    blank = EngineGradient(question, chosen.name, chosen.version(), profile, "")
    for method in methods_of(name, with_runs=with_runs):
        try:
            yield from _compared(blank, method, settings, with_order=with_order)
        except EngineError as error:
            yield replace(blank, refusal=str(error))
        except CrankcheckError:
            raise
        except Exception as error:  # any error of an engine is a row of the result
            yield replace(blank, refusal=f"{type(error).__name__}: {error}")


def methods_of(name: str, *, with_runs: bool = False) -> list[Differentiated]:
    """Return an engine's own derivatives, or differences of its runs where it has none; with both
    where those are wanted as well."""
    own = "gradient" in declaration(name).offers
    methods = [cast(Differentiated, capability(name, "gradient"))] if own else []
    if not own or (with_runs and name != FIRST):  # whose own are differences too
        methods.append(partial(_of_runs, engine(name)))
    return methods


def _compared(
    blank: EngineGradient, method: Differentiated, settings: Settings, *, with_order: bool
) -> Iterator[EngineGradient]:
    asked = blank.question
    for found in method(asked.variation, settings, asked.dt_s, asked.steps):
        if found.refusal:
            yield replace(blank, method=found.method, refusal=found.refusal)
            continue
        finer = None
        if with_order:
            half = replace(asked, dt_s=0.5 * asked.dt_s, steps=(2 * asked.steps[-1],))
            again = method(half.variation, settings, half.dt_s, half.steps)
            same = next(one for one in again if one.method == found.method)
            finer = half.of_engine(motions(half.variation, same)[1])[0]
        motion, by = motions(asked.variation, found)
        yield replace(
            blank,
            method=found.method,
            slopes=asked.of_engine(by),
            gaps=gaps(asked.scene, poses_at(asked.scene, found.places)),
            astray=asked.astray(motion),
            finer=finer,
        )


def _of_runs(
    chosen: Engine, variation: Variation, settings: Settings, dt_s: float, steps: Sequence[int]
) -> Iterator[PoseGradient]:
    yield differences(chosen.open, variation, settings, dt_s, steps)
