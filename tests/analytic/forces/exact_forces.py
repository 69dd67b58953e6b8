"""Reactions and driving torque in fifty digits: Newton's and Euler's equations of all bodies.

Positions and their derivatives come from `tests.analytic.chain`; every body gives three equations
for the unknown forces of its joints, and all of them are solved at once. Reactions are linear in
friction, whose law holds to forty digits.
"""

import itertools
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from mpmath import matrix, mp, mpc, mpf

from analytic.kinematics import solve
from models.scene import GROUND, Point, Scene, Slider
from models.scene.characteristics import Characteristic, Constant, Polynomial, Sine
from models.scene.joints import block_name, joined_at, local_point, sliding_body
from models.scene.loads import CoulombFriction, Load, PinSpring, SlideSpring, Spring
from models.scene.tabulated import Tabulated
from tests.analytic.chain import Solved, law_at
from tests.analytic.change_points.jets import Number
from tests.analytic.oracle import Place

STAYS = mpf(10) ** -40
FIRST, MOST = 40, 80
"""Plain substitutions, and Newton's steps after them."""


@dataclass(frozen=True)
class ExactForces:
    """At one time, vectors as x + iy: forces of pins on bodies, of guides on sliders (normal,
    moment), the torque, and friction."""

    pins: Mapping[str, Mapping[str, mpc]]
    sliders: Mapping[str, tuple[Number, Number]]
    torque: Number
    friction: Mapping[str, Number] = field(default_factory=dict)

    def series(self) -> Iterator[tuple[str, tuple[Number, ...]]]:
        """Everything, by the names of `tests.analytic.forces.beside`."""
        yield "torque", (self.torque,)
        for point, by_body in self.pins.items():
            yield from ((f"pin {point} on {body}", (f.real, f.imag)) for body, f in by_body.items())
        for name, (normal, moment) in self.sliders.items():
            yield from ((f"normal {name}", (normal,)), (f"moment {name}", (moment,)))
        yield from ((f"rubbing {joint}", (size,)) for joint, size in self.friction.items())

    @property
    def largest(self) -> float:
        return float(max(abs(number) for _, numbers in self.series() for number in numbers))


@dataclass(frozen=True)
class _Body:
    """The frame of a body: origin with acceleration, angle, angular acceleration and velocity."""

    origin: mpc
    push: mpc
    theta: Number
    omega: Number
    alpha: Number

    def arm(self, local: Point) -> mpc:
        return mp.expj(self.theta) * mpc(*local)

    def place(self, local: Point) -> mpc:
        return self.origin + self.arm(local)

    def acceleration(self, local: Point) -> mpc:
        return self.push + (mpc(0, self.alpha) - self.omega**2) * self.arm(local)


@dataclass(frozen=True)
class _Demand:
    """What the joints have to bring about: in ``b``, from the row ``at`` of a body on, a force and
    its moment about the body's origin. What acts is taken off it."""

    scene: Scene
    bodies: Mapping[str, _Body]
    at: Mapping[str, int]
    b: matrix

    def couple(self, name: str, size: Number) -> None:
        if name != GROUND:
            self.b[self.at[name] + 2] -= size

    def push(self, name: str, place: mpc, force: mpc) -> None:
        if name != GROUND:
            row = self.at[name]
            self.b[row] -= force.real
            self.b[row + 1] -= force.imag
            self.couple(name, _cross(place - self.bodies[name].origin, force))

    def along_line(self, slider: Slider, size: Number) -> None:
        """A force of the guide on what slides, along its line."""
        along, place = _line(self.scene, self.bodies, slider)
        self.push(sliding_body(slider), place, size * along)
        self.push(slider.on, place, -size * along)


def _cross(one: mpc, other: mpc) -> Number:
    return (mp.conj(one) * other).imag


def _line(scene: Scene, bodies: Mapping[str, _Body], slider: Slider) -> tuple[mpc, mpc]:
    """The direction of a guide, and the place of its slider."""
    body = sliding_body(slider)
    along = mp.expj(bodies[slider.on].theta + mpf(slider.direction_rad))
    return along, bodies[body].place(local_point(scene, body, slider.point))


def exact_forces(
    scene: Scene, time_s: float, solved: Solved, friction: Mapping[str, Number] | None = None
) -> ExactForces:
    """The forces of an exact motion at a time, under given friction in joints."""
    friction = friction or {}
    bodies = _bodies(scene, solved)
    names = [name for name in bodies if name != GROUND]
    at = {name: 3 * k for k, name in enumerate(names)}
    a = matrix(3 * len(names), 3 * len(names))
    demand = _Demand(scene, bodies, at, matrix(3 * len(names), 1))
    columns = itertools.count()

    def unknown(one: str, other: str, place: mpc, along: mpc) -> None:
        """A force on a body at a place of the plane, and its reaction on another."""
        column = next(columns)
        for body, force in ((one, along), (other, -along)):
            if body != GROUND:
                moment = _cross(place - bodies[body].origin, force)
                for k, part in enumerate((force.real, force.imag, moment)):
                    a[at[body] + k, column] += part

    def turning(*signs: tuple[str, int]) -> None:
        column = next(columns)
        for body, sign in signs:
            if body != GROUND:
                a[at[body] + 2, column] += sign

    hinges = [(p, held[0], other) for p, held in joined_at(scene).items() for other in held[1:]]
    for point, first, other in hinges:
        place = bodies[first].place(local_point(scene, first, point))
        for along in (mpc(1), mpc(0, 1)):
            unknown(first, other, place, along)
    for slider in scene.sliders.values():
        along, place = _line(scene, bodies, slider)
        unknown(sliding_body(slider), slider.on, place, mpc(0, 1) * along)
        turning((sliding_body(slider), 1), (slider.on, -1))
    turning((scene.driver.link, 1))
    for name in names:
        _inertia(demand, name)
    for load in scene.loads.values():
        _apply(demand, load, time_s, solved)
    for spring in scene.springs.values():
        _stretch(demand, spring, solved)
    for joint, size in friction.items():
        _rub(demand, joint, size)
    found = iter(mp.lu_solve(a, demand.b))
    pins: dict[str, dict[str, mpc]] = {}
    for point, one, other in hinges:
        force, held = mpc(next(found), next(found)), pins.setdefault(point, {})
        held[one], held[other] = held.get(one, mpc(0)) + force, held.get(other, mpc(0)) - force
    sliders = {name: (next(found), next(found)) for name in scene.sliders}
    return ExactForces(pins, sliders, next(found), friction)


def _bodies(scene: Scene, solved: Solved) -> dict[str, _Body]:
    found = {GROUND: _Body(mpc(0), mpc(0), mpf(0), mpf(0), mpf(0))}
    for link in scene.links.values():
        point, (x, y) = next(iter(link.points.items()))
        turn, back = solved.links[link.name], (-x, -y)
        own = _Body(*_moving(solved.points[point]), turn.value, turn.rate, turn.second)
        found[link.name] = replace(own, origin=own.place(back), push=own.acceleration(back))
    for slider in scene.sliders.values():
        if slider.link is None:
            on, moving = found[slider.on], _moving(solved.points[slider.point])
            theta = on.theta + mpf(slider.direction_rad)
            found[block_name(slider)] = _Body(*moving, theta, on.omega, on.alpha)
    return found


def _moving(at: Place) -> tuple[mpc, mpc]:
    return mpc(at.x.value, at.y.value), mpc(at.x.second, at.y.second)


def _inertia(demand: _Demand, name: str) -> None:
    """What joints and loads have to bring about: m (a - g), and the same about the origin."""
    scene, body = demand.scene, demand.bodies[name]
    if name in scene.links:
        holder = scene.links[name]
        mass, moment, centre = holder.mass_kg, holder.inertia_kg_m2, holder.centre_m
    else:
        block = scene.sliders[name.removeprefix("block ")]
        mass, moment, centre = block.mass_kg, block.inertia_kg_m2, (0.0, 0.0)
    force = mpf(mass) * (body.acceleration(centre) - mpc(*scene.gravity_m_s2))
    demand.push(name, body.place(centre), -force)
    demand.couple(name, -mpf(moment) * body.alpha)


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
    place = body.place(local_point(scene, load.body, load.point))
    demand.push(load.body, place, size * mp.expj(angle))


def _rub(demand: _Demand, joint: str, size: Number) -> None:
    """Take friction off what the joints have to bring about: a couple, or a force along a line."""
    if joint in demand.scene.sliders:
        demand.along_line(demand.scene.sliders[joint], size)
        return
    first, second = joined_at(demand.scene)[joint]
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
        ends = [solved.points[name] for name in spring.points]
        way = ends[1] - ends[0]
        pull = rate * (way.length.value - free) + damping * way.length.rate
        force = pull * mp.expj(way.angle.value)
        for name, end, own in zip(spring.points, ends, (force, -force), strict=True):
            demand.push(joined_at(scene)[name][0], _moving(end)[0], own)


def _turns_at_start(scene: Scene, spring: PinSpring) -> int:
    """The whole turns by which its angle is off the free one at time 0."""
    links = solve(scene, np.zeros(1), bound=False).links
    one, other = (links[n].theta[0] if n in links else 0.0 for n in spring.bodies)
    return round((other - one - spring.free) / math.tau)


Pair = tuple[Number, Number]


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
    way = {joint: -mp.sign(_rate(scene, joint, solved)) for joint in scene.friction}
    alone = _reactions(scene, exact_forces(scene, time_s, solved))
    influence = {}
    for joint in scene.friction:
        by = _reactions(scene, exact_forces(scene, time_s, solved, {joint: mpf(1)}))
        influence[joint] = {name: by[name] - alone[name] for name in by}
    given = {
        joint: way[joint] * mpf(law.size)
        for joint, law in scene.friction.items()
        if not isinstance(law, CoulombFriction)
    }
    factors = {j: way[j] * _factor(scene, j, law) for j, law in scene.friction.items()
               if isinstance(law, CoulombFriction)}  # fmt: skip
    friction = {joint: given.get(joint, mpf(0)) for joint in scene.friction}
    for step in range(MOST):
        bears = {
            joint: alone[joint] + sum(influence[k][joint] * friction[k] for k in friction)
            for joint in friction
        }
        after = given | {j: factor * abs(bears[j]) for j, factor in factors.items()}
        change = max(abs(after[joint] - friction[joint]) for joint in friction)
        if change <= STAYS * max(abs(size) for size in friction.values()):
            return exact_forces(scene, time_s, solved, friction)
        friction = after if step < FIRST else _newton(alone, influence, bears, factors, given)
    raise AssertionError(f"friction does not settle at {time_s} s")


def _newton(
    alone: Mapping[str, mpc],
    influence: Mapping[str, Mapping[str, mpc]],
    bears: Mapping[str, mpc],
    factors: Mapping[str, Number],
    given: Mapping[str, Number],
) -> dict[str, Number]:
    """The friction where the reactions keep their directions, which makes it linear."""
    names = list(factors)
    if not names:
        return dict(given)
    a, b = mp.eye(len(names)), matrix(len(names), 1)
    for row, joint in enumerate(names):
        u = mp.conj(bears[joint]) * factors[joint] / (abs(bears[joint]) or mpf(1))
        known = alone[joint] + sum(influence[k][joint] * size for k, size in given.items())
        b[row] = (u * known).real
        for column, other in enumerate(names):
            a[row, column] -= (u * influence[other][joint]).real
    return dict(zip(names, mp.lu_solve(a, b), strict=True)) | dict(given)


def _factor(scene: Scene, joint: str, law: CoulombFriction) -> Number:
    if joint in scene.sliders:
        return mpf(law.mu)
    return mpf(law.radius_m) * mp.sin(mp.atan(mpf(law.mu)))


def _reactions(scene: Scene, found: ExactForces) -> dict[str, mpc]:
    """What friction grows with, by joint."""
    return {
        joint: mpc(found.sliders[joint][0])
        if joint in scene.sliders
        else list(found.pins[joint].values())[1]
        for joint in scene.friction
    }


def _rate(scene: Scene, joint: str, solved: Solved) -> Number:
    """How fast the second body of a joint moves against the first."""
    if joint in scene.sliders:
        return solved.sliders[joint].rate
    turning = {GROUND: mpf(0)} | {name: link.rate for name, link in solved.links.items()}
    for slider in scene.sliders.values():
        if slider.link is None:
            turning[block_name(slider)] = turning[slider.on]
    first, second = joined_at(scene)[joint]
    return turning[second] - turning[first]
