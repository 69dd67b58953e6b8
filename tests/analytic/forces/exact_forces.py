"""Reactions and driving torque in fifty digits: Newton's and Euler's equations of all bodies.

Positions and their derivatives come from `tests.analytic.chain`; every body gives three equations
for the unknown forces of its joints, and all of them are solved at once. Reactions are linear in
friction, whose law holds to forty digits.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from mpmath import matrix, mp, mpf

from analytic.kinematics import solve
from analytic.structure.mobility import analyse
from models.characteristics import Characteristic, Constant, Polynomial, Sine
from models.friction import CoulombFriction
from models.joints import block_name, local_point, sliding_body
from models.loads import Load
from models.scene import GROUND, Point, Scene, Slider
from models.springs import PinSpring, SlideSpring, Spring
from models.tabulated import Tabulated
from tests.analytic.chain import Solved, law_at
from tests.analytic.change_points.jets import Number

Pair = tuple[Number, Number]
STAYS = mpf(10) ** -40
FIRST, MOST = 40, 80
"""Plain substitutions, and Newton's steps after them."""


@dataclass(frozen=True)
class ExactForces:
    """At one time: forces of pins on bodies, of guides on sliders (normal, moment), the torque."""

    pins: Mapping[str, Mapping[str, Pair]]
    sliders: Mapping[str, Pair]
    torque: Number
    friction: Mapping[str, Number] = field(default_factory=dict)

    def series(self) -> Iterator[tuple[str, tuple[Number, ...]]]:
        """Everything, by the names of `tests.analytic.forces.beside`."""
        yield "torque", (self.torque,)
        for point, by_body in self.pins.items():
            yield from ((f"pin {point} on {body}", force) for body, force in by_body.items())
        for name, (normal, moment) in self.sliders.items():
            yield from ((f"normal {name}", (normal,)), (f"moment {name}", (moment,)))
        yield from ((f"rubbing {joint}", (size,)) for joint, size in self.friction.items())

    @property
    def largest(self) -> float:
        """The largest of its numbers."""
        return float(max(abs(number) for _, numbers in self.series() for number in numbers))


@dataclass(frozen=True)
class _Body:
    """The frame of a body: origin with acceleration, angle, angular acceleration and velocity."""

    origin: Pair
    push: Pair
    theta: Number
    omega: Number
    alpha: Number

    def arm(self, local: Point) -> Pair:
        c, s = mp.cos(self.theta), mp.sin(self.theta)
        x, y = mpf(local[0]), mpf(local[1])
        return c * x - s * y, s * x + c * y

    def place(self, local: Point) -> Pair:
        x, y = self.arm(local)
        return self.origin[0] + x, self.origin[1] + y

    def acceleration(self, local: Point) -> Pair:
        x, y = self.arm(local)
        w2 = self.omega**2
        return (self.push[0] - self.alpha * y - w2 * x, self.push[1] + self.alpha * x - w2 * y)


@dataclass(frozen=True)
class _Demand:
    """What the joints have to bring about: in ``b``, from the row ``at`` of a body on, a force and
    its moment about the body's origin. What acts is taken off it."""

    scene: Scene
    bodies: Mapping[str, _Body]
    at: Mapping[str, int]
    b: matrix

    def couple(self, name: str, size: Number) -> None:
        """A moment on a body."""
        if name != GROUND:
            self.b[self.at[name] + 2] -= size

    def push(self, name: str, place: Pair, force: Pair) -> None:
        """A force on a body at a place of the plane."""
        if name == GROUND:
            return
        (ox, oy), row = self.bodies[name].origin, self.at[name]
        self.b[row] -= force[0]
        self.b[row + 1] -= force[1]
        self.couple(name, (place[0] - ox) * force[1] - (place[1] - oy) * force[0])

    def along_line(self, slider: Slider, size: Number) -> None:
        """A force of the guide on what slides, along its line."""
        body = sliding_body(slider)
        angle = self.bodies[slider.on].theta + mpf(slider.direction_rad)
        place = self.bodies[body].place(local_point(self.scene, body, slider.point))
        fx, fy = size * mp.cos(angle), size * mp.sin(angle)
        self.push(body, place, (fx, fy))
        self.push(slider.on, place, (-fx, -fy))


def exact_forces(
    scene: Scene, time_s: float, solved: Solved, friction: Mapping[str, Number] | None = None
) -> ExactForces:
    """The forces of an exact motion at a time, under given friction in joints."""
    bodies = _bodies(scene, solved)
    names = [name for name in bodies if name != GROUND]
    at = {name: 3 * k for k, name in enumerate(names)}
    a = matrix(3 * len(names), 3 * len(names))
    demand = _Demand(scene, bodies, at, matrix(3 * len(names), 1))
    column = 0

    def force(body: str, place: Pair, along: Pair, sign: int) -> None:
        """The unknown of this column pushes a body at a place of the plane."""
        if body == GROUND:
            return
        ox, oy = bodies[body].origin
        row = at[body]
        a[row, column] += sign * along[0]
        a[row + 1, column] += sign * along[1]
        a[row + 2, column] += sign * ((place[0] - ox) * along[1] - (place[1] - oy) * along[0])

    hinges, slides = [], []
    for point, held in _pins(scene).items():
        for other in held[1:]:
            place = bodies[held[0]].place(local_point(scene, held[0], point))
            for along in ((mpf(1), mpf(0)), (mpf(0), mpf(1))):
                force(held[0], place, along, 1)
                force(other, place, along, -1)
                column += 1
            hinges.append((point, held[0], other))
    for slider in scene.sliders.values():
        body, angle = sliding_body(slider), bodies[slider.on].theta + mpf(slider.direction_rad)
        place = bodies[body].place(local_point(scene, body, slider.point))
        across = (-mp.sin(angle), mp.cos(angle))
        force(body, place, across, 1)
        force(slider.on, place, across, -1)
        a[at[body] + 2, column + 1] += 1
        if slider.on != GROUND:
            a[at[slider.on] + 2, column + 1] -= 1
        column += 2
        slides.append(slider.name)
    a[at[scene.driver.link] + 2, column] += 1
    for name in names:
        _inertia(demand, name)
    for load in scene.loads.values():
        _apply(demand, load, time_s, solved)
    for spring in scene.springs.values():
        _stretch(demand, spring, solved)
    for joint, size in (friction or {}).items():
        _rub(demand, joint, size)
    found = list(mp.lu_solve(a, demand.b))
    pins: dict[str, dict[str, Pair]] = {}
    for k, (point, one, other) in enumerate(hinges):
        for body, sign in ((one, 1), (other, -1)):
            x, y = pins.setdefault(point, {}).get(body, (mpf(0), mpf(0)))
            pins[point][body] = (x + sign * found[2 * k], y + sign * found[2 * k + 1])
    start = 2 * len(hinges)
    sliders = {
        name: (found[start + 2 * k], found[start + 2 * k + 1]) for k, name in enumerate(slides)
    }
    return ExactForces(pins, sliders, found[-1])


def _pins(scene: Scene) -> dict[str, list[str]]:
    held = {point: list(names) for point, names in scene.pins.items()}
    for slider in scene.sliders.values():
        if slider.link is None:
            held.setdefault(slider.point, []).append(block_name(slider))
    return {point: names for point, names in held.items() if len(names) > 1}


def _bodies(scene: Scene, solved: Solved) -> dict[str, _Body]:
    still = (mpf(0), mpf(0))
    found = {GROUND: _Body(still, still, mpf(0), mpf(0), mpf(0))}
    for link in scene.links.values():
        point, local = next(iter(link.points.items()))
        turn, at = solved.links[link.name], solved.points[point]
        place, push = (at.x.value, at.y.value), (at.x.second, at.y.second)
        own = _Body(place, push, turn.value, turn.rate, turn.second)
        back = (-local[0], -local[1])
        origin, shove = own.place(back), own.acceleration(back)
        found[link.name] = _Body(origin, shove, turn.value, turn.rate, turn.second)
    for slider in scene.sliders.values():
        if slider.link is None:
            at, on = solved.points[slider.point], found[slider.on]
            place, push = (at.x.value, at.y.value), (at.x.second, at.y.second)
            theta = on.theta + mpf(slider.direction_rad)
            found[block_name(slider)] = _Body(place, push, theta, on.omega, on.alpha)
    return found


def _inertia(demand: _Demand, name: str) -> None:
    """What joints and loads have to bring about: m (a - g), and the same about the origin."""
    scene, body = demand.scene, demand.bodies[name]
    if name in scene.links:
        holder = scene.links[name]
        mass, moment, centre = holder.mass_kg, holder.inertia_kg_m2, holder.centre_m
    else:
        block = scene.sliders[name.removeprefix("block ")]
        mass, moment, centre = block.mass_kg, block.inertia_kg_m2, (0.0, 0.0)
    ax, ay = body.acceleration(centre)
    x, y = body.arm(centre)
    fx = mpf(mass) * (ax - mpf(scene.gravity_m_s2[0]))
    fy = mpf(mass) * (ay - mpf(scene.gravity_m_s2[1]))
    row = demand.at[name]
    demand.b[row] += fx
    demand.b[row + 1] += fy
    demand.b[row + 2] += x * fy - y * fx + mpf(moment) * body.alpha


def _apply(demand: _Demand, load: Load, time_s: float, solved: Solved) -> None:
    """Take a load off what the joints have to bring about."""
    scene, body = demand.scene, demand.bodies[load.body]
    slider = None if load.slider is None else solved.sliders[load.slider]
    x = mpf(time_s)
    if load.over == "angle":
        x = law_at(scene.driver.law, time_s).value
    elif load.over == "displacement":
        x = slider.value
    size = value_of(load.characteristic, x)
    if load.stroke != "both":
        size = size if slider.rate * (1 if load.stroke == "forward" else -1) > 0 else mpf(0)
    if load.point is None:
        demand.couple(load.body, size)
        return
    angle = mpf(load.direction_rad) + (body.theta if load.frame == "body" else 0)
    fx, fy = size * mp.cos(angle), size * mp.sin(angle)
    demand.push(load.body, body.place(local_point(scene, load.body, load.point)), (fx, fy))


def _rub(demand: _Demand, joint: str, size: Number) -> None:
    """Take friction off what the joints have to bring about: a couple, or a force along a line."""
    if joint in demand.scene.sliders:
        demand.along_line(demand.scene.sliders[joint], size)
        return
    first, second = _pins(demand.scene)[joint]
    demand.couple(first, -size)
    demand.couple(second, size)


def _stretch(demand: _Demand, spring: Spring, solved: Solved) -> None:
    """A spring; in a pin its whole turns are those of the floats."""
    scene = demand.scene
    rate, damping, free = mpf(spring.rate), mpf(spring.damping), mpf(spring.free)
    if isinstance(spring, SlideSpring):
        sliding = solved.sliders[spring.slider]
        size = -(rate * (sliding.value - free) + damping * sliding.rate)
        demand.along_line(scene.sliders[spring.slider], size)
    elif isinstance(spring, PinSpring):
        one, other = (demand.bodies[name] for name in spring.bodies)
        off = other.theta - one.theta - free - 2 * mp.pi * _turns_at_start(scene, spring)
        size = rate * off + damping * (other.omega - one.omega)
        for name, own in zip(spring.bodies, (size, -size), strict=True):
            demand.couple(name, own)
    else:
        held = _pins(scene)
        ends = [solved.points[name] for name in spring.points]
        x, y = ends[1].x - ends[0].x, ends[1].y - ends[0].y
        length = mp.hypot(x.value, y.value)
        speed = (x.value * x.rate + y.value * y.rate) / length
        pull = (rate * (length - free) + damping * speed) / length
        for name, end, sign in zip(spring.points, ends, (1, -1), strict=True):
            force = (sign * pull * x.value, sign * pull * y.value)
            demand.push(held[name][0], (end.x.value, end.y.value), force)


def _turns_at_start(scene: Scene, spring: PinSpring) -> int:
    """The whole turns by which its angle is off the free one at time 0."""
    links = solve(scene, np.zeros(1), bound=False).links
    one, other = (links[n].theta[0] if n in links else 0.0 for n in spring.bodies)
    return round((other - one - spring.free) / math.tau)


def value_of(own: Characteristic, x: Number) -> Number:
    if isinstance(own, Constant):
        return mpf(own.value)
    if isinstance(own, Sine):
        return mpf(own.amplitude) * mp.sin(2 * mp.pi * x / mpf(own.period) + mpf(own.phase_rad))
    if isinstance(own, Polynomial):
        return sum((mpf(c) * x**k for k, c in enumerate(own.coefficients)), mpf(0))
    assert isinstance(own, Tabulated)
    rows = [(mpf(p), mpf(v)) for p, v in zip(own.places, own.values, strict=True)]
    if own.period is not None:
        period = mpf(own.period)
        x -= period * mp.floor((x - rows[0][0]) / period)
        rows.append((rows[0][0] + period, rows[0][1]))
    if own.interpolation == "pchip":
        return _cubic(rows, x, closed=own.period is not None)
    for (x0, y0), (x1, y1) in itertools.pairwise(rows):
        if x <= x1:
            return y0 + (y1 - y0) * (x - x0) / (x1 - x0)
    raise AssertionError("the table is too short")


def _cubic(rows: list[Pair], x: Number, *, closed: bool) -> Number:
    """The cubic of Fritsch and Butland, from Hermite's four polynomials."""
    chords = [(b[0] - a[0], (b[1] - a[1]) / (b[0] - a[0])) for a, b in itertools.pairwise(rows)]
    inner = [_harmonic(*pair) for pair in itertools.pairwise(chords)]
    if closed:
        slopes = [_harmonic(chords[-1], chords[0]), *inner, _harmonic(chords[-1], chords[0])]
    else:
        slopes = [_outer(*chords[:2]), *inner, _outer(*chords[:-3:-1])]
    for k, ((x0, y0), (x1, y1)) in enumerate(itertools.pairwise(rows)):
        if x <= x1:
            h = x1 - x0
            t = (x - x0) / h
            return (
                y0 * (1 + 2 * t) * (1 - t) ** 2
                + h * slopes[k] * t * (1 - t) ** 2
                + y1 * t**2 * (3 - 2 * t)
                + h * slopes[k + 1] * t**2 * (t - 1)
            )
    raise AssertionError("the table is too short")


def _harmonic(before: Pair, after: Pair) -> Number:
    """The slope between two chords, each its length and its slope."""
    (h0, d0), (h1, d1) = before, after
    if d0 * d1 <= 0:
        return mpf(0)
    return 3 * (h0 + h1) / ((2 * h1 + h0) / d0 + (h1 + 2 * h0) / d1)


def _outer(near: Pair, far: Pair) -> Number:
    (h0, d0), (h1, d1) = near, far
    slope = d0 + (d0 - d1) * h0 / (h0 + h1)
    if slope * d0 <= 0:
        return mpf(0)
    return 3 * d0 if d0 * d1 <= 0 and abs(slope) > 3 * abs(d0) else slope


def exact_rubbed(scene: Scene, time_s: float, solved: Solved) -> ExactForces:
    """The forces with friction."""
    way = {joint: -mp.sign(_rate(scene, joint, solved)) for joint in scene.friction}
    alone = _reactions(scene, exact_forces(scene, time_s, solved))
    influence = {
        joint: _less(_reactions(scene, exact_forces(scene, time_s, solved, {joint: mpf(1)})), alone)
        for joint in scene.friction
    }
    given = {
        joint: way[joint] * mpf(law.size)
        for joint, law in scene.friction.items()
        if not isinstance(law, CoulombFriction)
    }
    friction = {joint: given.get(joint, mpf(0)) for joint in scene.friction}
    for step in range(MOST):
        bears = {
            joint: _sum(
                [alone[joint], *(_times(influence[k][joint], friction[k]) for k in friction)]
            )
            for joint in friction
        }
        factors = {j: way[j] * _factor(scene, j, law) for j, law in scene.friction.items()
                   if isinstance(law, CoulombFriction)}  # fmt: skip
        after = given | {j: factor * mp.hypot(*bears[j]) for j, factor in factors.items()}
        change = max(abs(after[joint] - friction[joint]) for joint in friction)
        if change <= STAYS * max(abs(size) for size in friction.values()):
            return replace(exact_forces(scene, time_s, solved, friction), friction=friction)
        friction = after if step < FIRST else _newton(alone, influence, bears, factors, given)
    raise AssertionError(f"friction does not settle at {time_s} s")


def _newton(
    alone: Mapping[str, Pair],
    influence: Mapping[str, Mapping[str, Pair]],
    bears: Mapping[str, Pair],
    factors: Mapping[str, Number],
    given: Mapping[str, Number],
) -> dict[str, Number]:
    """The friction where the reactions keep their directions, which makes it linear."""
    names = list(factors)
    if not names:
        return dict(given)
    a, b = mp.eye(len(names)), matrix(len(names), 1)
    for row, joint in enumerate(names):
        size = mp.hypot(*bears[joint]) or mpf(1)
        u = _times(bears[joint], factors[joint] / size)
        b[row] = _dot(u, alone[joint])
        b[row] += sum(_dot(u, influence[k][joint]) * size for k, size in given.items())
        for column, other in enumerate(names):
            a[row, column] -= _dot(u, influence[other][joint])
    return dict(zip(names, mp.lu_solve(a, b), strict=True)) | dict(given)


def _dot(one: Pair, other: Pair) -> Number:
    return one[0] * other[0] + one[1] * other[1]


def _times(one: Pair, factor: Number) -> Pair:
    return one[0] * factor, one[1] * factor


def _sum(pairs: list[Pair]) -> Pair:
    return sum(x for x, _ in pairs), sum(y for _, y in pairs)


def _factor(scene: Scene, joint: str, law: CoulombFriction) -> Number:
    if joint in scene.sliders:
        return mpf(law.mu)
    return mpf(law.radius_m) * mp.sin(mp.atan(mpf(law.mu)))


def _reactions(scene: Scene, found: ExactForces) -> dict[str, Pair]:
    """What friction grows with, by joint; a normal force as (N, 0)."""
    return {
        joint: (found.sliders[joint][0], mpf(0))
        if joint in scene.sliders
        else list(found.pins[joint].values())[1]
        for joint in scene.friction
    }


def _less(one: Mapping[str, Pair], other: Mapping[str, Pair]) -> dict[str, Pair]:
    return {n: (one[n][0] - other[n][0], one[n][1] - other[n][1]) for n in one}


def _rate(scene: Scene, joint: str, solved: Solved) -> Number:
    """How fast the second body of a joint moves against the first."""
    if joint in scene.sliders:
        return solved.sliders[joint].rate
    turning = {GROUND: mpf(0)} | {name: link.rate for name, link in solved.links.items()}
    for slider in scene.sliders.values():
        if slider.link is None:
            turning[block_name(slider)] = turning[slider.on]
    first, second = analyse(scene).pins[joint]
    return turning[second] - turning[first]
