"""Derivatives of engines after some steps, compared with those of the reference at the same time.

Outputs are the angle of each link and the place of each point on each body, over the longest link;
a unit of a dimension is the longest link, a radian, or the mass itself. So all numbers are pure.
"""

from __future__ import annotations

import math
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import cast

import numpy as np

from analytic.gradients.dimensions import dimensions, with_dimensions
from analytic.gradients.gradient import gradient, masses
from analytic.kinematics import solve
from models.array import Array
from models.errors import CrankcheckError, EngineError
from models.motion import Motion, State
from models.scene import Scene
from models.scene.joints import blocks, bodies
from sim.engine import Engine, Session, Settings
from sim.engine.gradient import Differentiated, PoseGradient, Variation, differences
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
class Output:
    """A number of a pose: the angle of a body, or a coordinate of a point on it over the longest
    link. ``axis`` is 0 or 1 for x or y, 2 for the angle."""

    body: str
    axis: int
    point: str = ""
    local: complex = 0.0

    @property
    def name(self) -> str:
        return f"{'xy'[self.axis]} of {self.point} on {self.body}" if self.point else self.body


def outputs(scene: Scene) -> list[Output]:
    """Return the outputs of a scene, body by body."""
    own = blocks(scene)
    found = [Output(name, 2) for name in scene.links]
    for name in bodies(scene):
        points = {own[name].point: (0.0, 0.0)} if name in own else scene.links[name].points
        found += [Output(name, a, p, complex(*at)) for p, at in points.items() for a in (0, 1)]
    return found


@dataclass(frozen=True)
class Question:
    """Gradients of a scene from its start on, after ``steps`` of ``dt_s`` [s]: by ``names``."""

    scene: Scene
    names: tuple[str, ...]
    steps: tuple[int, ...]
    dt_s: float
    of: str

    @cached_property
    def outputs(self) -> list[Output]:
        return outputs(self.scene)

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
    def truth(self) -> Array:
        """Derivatives of the reference (K, P, N), not a number where none is certain."""
        known = [name for name in self.names if name in self.units]
        found = gradient(self.scene, self.dt_s * np.array(self.steps, dtype=float), known)
        if found.locked:
            held = ", ".join(found.locked)
            raise CrankcheckError(f"{self.scene.name}: {held} has no derivative; leave it out")
        return np.stack([self._of_reference(name, found.by) for name in self.names], axis=1)

    @property
    def sizes(self) -> Array:
        """Return the largest derivative of the reference (K,), 0 where none is certain."""
        return np.asarray(np.nan_to_num(np.abs(self.truth)).max(axis=(1, 2)))

    def _of_reference(self, name: str, by: Mapping[str, Motion]) -> Array:
        if name not in by:
            return np.zeros((len(self.steps), len(self.outputs)))
        own, bound, unit = by[name], by[name].bound, self.units[name]
        assert bound is not None
        columns = []
        for one in self.outputs:
            if one.axis == 2:
                value, doubt = own.links[one.body].theta, bound.links[one.body].theta
                scale = unit
            else:
                value = own.points[one.point].position[:, one.axis]
                doubt, scale = bound.points[one.point].position, unit / self.scene.longest_m
            columns.append(np.where(np.isfinite(doubt), scale * value, np.nan))
        return np.stack(columns, axis=1)

    def of_engine(self, found: PoseGradient) -> Array:
        """Return the derivatives of an engine (K, P, N), not a number where the method has none."""
        row = {name: k for k, name in enumerate(bodies(self.scene))}
        known = dimensions(self.scene)
        every = np.full((len(self.steps), len(self.names), len(self.outputs)), np.nan)
        for p, name in enumerate(self.names):
            if name not in found.by:
                continue
            shifts = known[name].shifts if name in known else {}
            for n, one in enumerate(self.outputs):
                own = found.by[name][:, row[one.body]]
                if one.axis == 2:
                    every[:, p, n] = own[:, 2]
                    continue
                shift = self.units.get(name, 1.0) * shifts.get(("point", one.body, one.point), 0.0)
                turn = np.exp(1j * found.places[:, row[one.body], 2])
                place = own[:, 0] + 1j * own[:, 1] + turn * (1j * own[:, 2] * one.local + shift)
                every[:, p, n] = (place.imag if one.axis else place.real) / self.scene.longest_m
            every[:, p] = np.nan_to_num(every[:, p], nan=np.inf, posinf=np.inf, neginf=np.inf)
        return every

    def gaps(self, found: PoseGradient) -> dict[str, Array]:
        """Return the opening of each pin between two moving bodies (K,), over the longest link."""
        row = {name: k for k, name in enumerate(bodies(self.scene))}
        first: dict[str, Array] = {}
        gaps: dict[str, Array] = {}
        for one in self.outputs:
            if not one.point or one.axis:
                continue
            at = found.places[:, row[one.body]]
            place = at[:, 0] + 1j * at[:, 1] + np.exp(1j * at[:, 2]) * one.local
            other = first.setdefault(one.point, place)
            gap = np.abs(place - other) / self.scene.longest_m
            gaps[one.point] = np.maximum(gaps.get(one.point, 0.0), gap)
        return gaps

    @cached_property
    def followed(self) -> list[int]:
        """Numbers of the outputs of the follower."""
        of, sliders = self.of, self.scene.sliders
        if of in self.scene.links:
            return [n for n, one in enumerate(self.outputs) if one.body == of and one.axis == 2]
        point = sliders[of].point if of in sliders else of
        body = next(one.body for one in self.outputs if one.point == point)
        return [n for n, o in enumerate(self.outputs) if (o.point, o.body) == (point, body)]

    def astray(self, found: PoseGradient) -> Array:
        """Return the angle of the link that is farthest from the reference (K,) [rad]."""
        motion = solve(self.scene, self.dt_s * np.array(self.steps, dtype=float), bound=False)
        off = [
            np.remainder(found.places[:, k, 2] - motion.links[name].theta + math.pi, math.tau)
            for k, name in enumerate(bodies(self.scene))
            if name in motion.links
        ]
        return np.asarray(np.abs(np.array(off) - math.pi).max(axis=0))

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
    the opening of pins (K,) over the longest link, and the largest error of a link's angle (K,)
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
    wall_s: float = 0.0

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
        frames = [not one.local for one in self.question.outputs]  # no length on a body moves them
        largest = np.abs([self.slopes[k], self.question.truth[k]])[..., frames].max(axis=2)
        size = self.question.sizes[k]
        zero = (largest[0] <= NOTHING * size) & (largest[1] > NOTABLE * size)
        found = [n for n, is_zero in zip(self.question.names, zero, strict=True) if is_zero]
        text = [f"zero by {', '.join(found)}"] * bool(found)
        gaps = {pin: float(gap[k]) for pin, gap in self.gaps.items()}
        pin = max(gaps, key=lambda name: gaps[name], default="")
        if pin and gaps[pin] > TOLERANCE:
            text.append(f"loop open: {gaps[pin]:.2g} of the longest link at {pin}")
        elif self.astray is not None and self.astray[k] > ASTRAY:
            text.append(f"links elsewhere, by up to {self.astray[k]:.2g} rad")
        return text

    def rows(self) -> Iterator[dict[str, object]]:
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
                "output": self.question.outputs[int(n)].name,
                "angle_rad": self.angle(k),
                "order": self.order if k + 1 == len(self.question.steps) else math.nan,
                "findings": self.findings(k),
                "within": self.is_within(k),
            }


def engine_gradients(
    question: Question,
    choices: Sequence[tuple[str, str]],
    *,
    with_order: bool = False,
    with_runs: bool = False,
) -> Iterator[EngineGradient]:
    """Differentiate in engines with profiles, one result for each method; ``with_runs`` by
    differences of whole runs too, where an engine has derivatives of its own.

    Raises
    ------
    EngineError
        An engine that is unknown or not installed, or an unknown profile.
    """
    for name, profile in choices:
        chosen = engine(name)
        settings = resolved(profile_of(chosen, profile), None)
        blank = EngineGradient(question, chosen.name, chosen.version(), profile, "")
        for method in methods_of(name, with_runs=with_runs):
            try:
                yield from _compared(blank, method, settings, with_order=with_order)
            except EngineError as error:
                yield replace(blank, refusal=str(error))


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
    began = time.perf_counter()
    for found in method(asked.variation, settings, asked.dt_s, asked.steps):
        if found.refusal:
            yield replace(blank, method=found.method, refusal=found.refusal)
            continue
        wall, finer = time.perf_counter() - began, None
        if with_order:
            half = replace(asked, dt_s=0.5 * asked.dt_s, steps=(2 * asked.steps[-1],))
            again = method(half.variation, settings, half.dt_s, half.steps)
            finer = half.of_engine(next(one for one in again if one.method == found.method))[0]
        yield replace(
            blank,
            method=found.method,
            slopes=asked.of_engine(found),
            gaps=asked.gaps(found),
            astray=asked.astray(found),
            finer=finer,
            wall_s=wall,
        )
        began = time.perf_counter()


def _of_runs(
    chosen: Engine, variation: Variation, settings: Settings, dt_s: float, steps: Sequence[int]
) -> Iterator[PoseGradient]:
    def opened(scene: Scene, state: State) -> Session:
        return chosen.open(scene, state, settings, dt_s, "prescribed")

    yield differences(opened, variation, steps)
