"""The pymunk space of a scene: a body per link, joints as constraints, no shapes;
and a point on a line where the groove joint is in error.

Bodies have their origin at the centre of gravity, as Chipmunk needs it; `Body.local` keeps the
place of the link's own frame. A driven crank is a kinematic body on its pivot. A massless slider
block is a groove for the point of its link. A body that slides on the ground cannot turn: it gets
an infinite moment; on a moving guide a gear of ratio 1 holds its angle.

A groove is in error where pushed bodies turn; the reason and the remedy follow.

Chipmunk's groove joint solves for both components of the impulse and then drops the one along the
line. Unless a push along the line moves the bodies along the line alone, the sliding speed leaks
into the constraint: the point leaves its line, by an error of first order in the step with any
number of iterations, and a slider-crank with a massless piston falls apart. A rail holds the point
by one scalar constraint across the line.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import pymunk

from models.errors import EngineError
from models.motion import State
from models.scene import GROUND, Point, Scene, Slider, span
from models.scene.joints import (
    Joints,
    Prism,
    Slot,
    along,
    bodies,
    centre_of,
    frames,
    joints,
    less,
    local_point,
    mass_of,
    riding_body,
    sliding_angle,
    turned,
)
from sim.engine import Drive
from sim.engine.momentum_balance import Hinge
from sim.pymunk.native import NativeSpring, PinFriction, moves_freely, native_springs, pin_friction


@dataclass(frozen=True)
class Rail:
    """A point held on a line by a pin joint whose far end moves along with the point.

    The far end lies across the line from the point, at a fixed distance, in the frame of the guide;
    it is set between the position and the velocity half of each step.
    """

    rider: pymunk.Body
    guide: pymunk.Body
    anchor: Point
    start: Point
    along: Point
    arm: float

    def joint(self) -> pymunk.PinJoint:
        """Make the pin joint, set for the present positions."""
        joint = pymunk.PinJoint(self.guide, self.rider, (0.0, 0.0), self.anchor)
        joint.distance = self.arm
        self.follow(joint, None)
        joint.pre_solve = self.follow
        return joint

    def follow(self, joint: pymunk.Constraint, _space: object) -> None:
        """Bring the far end level with the point."""
        place = self.guide.world_to_local(self.rider.local_to_world(self.anchor))
        (ux, uy), (x, y) = self.along, self.start
        s = (place[0] - x) * ux + (place[1] - y) * uy
        joint.anchor_a = (
            x + s * ux - self.arm * uy,
            y + s * uy + self.arm * ux,
        )


FAR = 1e3
"""Distance of a groove's ends over the sum of all lengths: where lines cross at a small angle a
slider travels much further than any link is long. Chipmunk then rounds at 1e-13 of the lengths."""


@dataclass(frozen=True)
class SpaceModel:
    """A space, its moving bodies by name in the order they were added, and the crank.

    ``centre`` is the origin of each pymunk body in the frame of the link [m]. ``motor`` is the
    servo, or the motor of an inner pin, if any. Of the constraints, ``hinges`` belong to the pins
    (None for a kinematic crank), and by slider ``lines`` hold a point on its line, ``gears`` an
    angle. ``rubs`` is the friction of pins; ``springs`` are the space's own.
    """

    space: pymunk.Space
    bodies: Mapping[str, pymunk.Body]
    centre: Mapping[str, Point]
    crank: pymunk.Body
    motor: pymunk.SimpleMotor | None
    hinges: Mapping[Hinge, pymunk.Constraint | None]
    lines: Mapping[str, pymunk.Constraint]
    gears: Mapping[str, pymunk.Constraint]
    rubs: tuple[PinFriction, ...]
    springs: Mapping[str, NativeSpring]


def build(
    scene: Scene,
    state: State,
    *,
    drive: Drive = "prescribed",
    exact_lines: bool = True,
    with_springs: bool = False,
    delay_s: float = 0.0,
) -> SpaceModel:
    """Build the space of ``scene`` at ``state``.

    A crank that is not prescribed is dynamic: with a motor under a servo, free without one. Points
    on lines run in Chipmunk's grooves or, with ``exact_lines``, on a `Rail` where the groove is in
    error. ``with_springs`` the space has the scene's springs. Velocities belong to ``delay_s``
    later (see `models.scene.joints.frames`).

    Raises
    ------
    EngineError
        A link without mass that has to move freely, or a massless block that no body carries.
    """
    driver = scene.driver
    _check_drive(scene, drive)
    pinned = drive != "prescribed" or driver.is_inner
    space = pymunk.Space()
    space.gravity = scene.gravity_m_s2
    ties = joints(scene)
    fixed_angle = {p.body for p in ties.prisms if p.slider.on == GROUND}
    where = frames(scene, state, delay_s)
    made: dict[str, pymunk.Body] = {GROUND: space.static_body}
    centre: dict[str, Point] = {GROUND: (0.0, 0.0)}
    for name in bodies(scene):
        kinematic = name == driver.link and not pinned
        turns = kinematic and driver.slider is None
        pivot = scene.driver_pivot
        centre[name] = local_point(scene, name, pivot) if turns else centre_of(scene, name)
        body = _body(scene, name, kinematic, name in fixed_angle)
        body.position = where[name].at(centre[name])
        body.angle = where[name].theta
        body.velocity = where[name].velocity_at(body.position) if not turns else (0.0, 0.0)
        body.angular_velocity = where[name].omega
        made[name] = body
        space.add(body)
    motor = None
    crank = made[driver.link]
    if pinned and drive != "free":
        rate = where[driver.link].omega - where[driver.base].omega
        motor = pymunk.SimpleMotor(crank, made[driver.base], rate)
        space.add(_plain(motor))
    hinges = _pins(scene, ties, made, centre, pinned=pinned)
    for constraint in hinges.values():
        if constraint is not None:
            space.add(_plain(constraint))
    lines: dict[str, pymunk.Constraint] = {}
    gears: dict[str, pymunk.Constraint] = {}
    for slide in ties.slides:
        name = slide.slider.name
        if name == driver.slider and not pinned:
            continue  # a kinematic body, at a prescribed position
        lines[name] = _line(scene, state, slide, made, centre, exact_lines)
        space.add(_plain(lines[name]))
        if isinstance(slide, Prism) and slide.slider.on != GROUND:
            gears[name] = _gear(slide, made)
            space.add(_plain(gears[name]))
    rubs = pin_friction(scene, made)
    for rub in rubs:
        if rub.motor is not None:
            space.add(_plain(rub.motor))
    springs = native_springs(scene, state, made, centre, _reach(scene)) if with_springs else {}
    for spring in springs.values():
        space.add(_plain(spring.constraint))
    del made[GROUND]
    return SpaceModel(space, made, centre, crank, motor, hinges, lines, gears, rubs, springs)


def _check_drive(scene: Scene, drive: Drive) -> None:
    """Refuse a joint that pymunk cannot drive. Raises EngineError."""
    driver = scene.driver
    if not driver.is_crank and any(load.over == "angle" for load in scene.loads.values()):
        raise EngineError(
            f"{scene.name}: a load goes with the driver's angle, and pymunk is given that of a "
            f"crank alone; this driver is {driver.joint}"
        )
    if driver.slider is None or drive == "free":
        return
    if driver.is_inner or drive == "servo":
        what = "between two moving bodies" if driver.is_inner else "by a servo"
        raise EngineError(
            f"{scene.name}: pymunk has no motor along a line, and drives no slider {what}; drive "
            "a slider on the ground, prescribed, or take another engine"
        )
    slider = scene.sliders[driver.slider]
    if slider.link is None and slider.mass_kg == 0.0:
        raise EngineError(
            f"{scene.name}: the driven block {driver.slider} has no mass, so it is no body of "
            f"pymunk's; give sliders.{driver.slider} a mass_kg above 0"
        )


def _body(scene: Scene, name: str, kinematic: bool, fixed_angle: bool) -> pymunk.Body:
    """Make a body with the mass of the scene."""
    if kinematic:
        return pymunk.Body(body_type=pymunk.Body.KINEMATIC)
    mass, inertia = mass_of(scene, name)
    if mass <= 0.0 or (inertia <= 0.0 and not fixed_angle):
        raise EngineError(
            f"{name}: mass_kg {mass:g}, inertia_kg_m2 {inertia:g}; pymunk moves no body without "
            "both, give them"
        )
    return pymunk.Body(mass, math.inf if fixed_angle else inertia)


def _plain(constraint: pymunk.Constraint) -> pymunk.Constraint:
    """Return the constraint without collision bookkeeping; there are no shapes."""
    constraint.collide_bodies = False
    return constraint


def _pins(
    scene: Scene,
    ties: Joints,
    made: Mapping[str, pymunk.Body],
    centre: Mapping[str, Point],
    *,
    pinned: bool,
) -> dict[Hinge, pymunk.Constraint | None]:
    """Make all pins; a kinematic crank needs none to the ground and is not ``pinned``."""
    hinges: dict[Hinge, pymunk.Constraint | None] = {}
    for joint in ties.pins:
        first, *others = _pinned_bodies(scene, joint.bodies)
        for other in others:
            hinge = Hinge(joint.point, first, other)
            driven = {first, other} == {GROUND, scene.driver.link} and not pinned
            if driven and joint.point == scene.driver_pivot:
                hinges[hinge] = None
                continue
            a = _anchor(scene, centre, first, joint.point)
            b = _anchor(scene, centre, other, joint.point)
            hinges[hinge] = pymunk.PivotJoint(made[first], made[other], a, b)
    return hinges


def _line(
    scene: Scene,
    state: State,
    slide: Prism | Slot,
    made: Mapping[str, pymunk.Body],
    centre: Mapping[str, Point],
    exact_lines: bool,
) -> pymunk.Constraint:
    """Make the constraint of a point on a line."""
    slider, rider = slide.slider, riding_body(slide)
    guide, body = made[slider.on], made[rider]
    anchor = _anchor(scene, centre, rider, slider.point)
    along_line = turned((1.0, 0.0), slider.direction_rad)
    start = less(slider.through_m, centre[slider.on])
    off = abs(along_line[0] * start[1] - along_line[1] * start[0])
    small = 1e-12 * scene.longest_m
    sound = (_firm(body) or math.hypot(*anchor) < small) and (_firm(guide) or off < small)
    if sound or not exact_lines:
        ends = [less(end, centre[slider.on]) for end in _groove(scene, state, slider, rider)]
        return pymunk.GrooveJoint(guide, body, ends[0], ends[1], anchor)
    return Rail(body, guide, anchor, start, along_line, 2.0 * scene.longest_m).joint()


def _gear(prism: Prism, made: Mapping[str, pymunk.Body]) -> pymunk.Constraint:
    """Make the gear for a sliding body's angle on a moving guide."""
    guide, body = made[prism.slider.on], made[prism.body]
    # A gear counts whole turns, and each of the two bodies comes with some of its own.
    kept = sliding_angle(prism.slider)
    kept += math.tau * round((body.angle - guide.angle - kept) / math.tau)
    return pymunk.GearJoint(guide, body, kept, 1.0)


def _firm(body: pymunk.Body) -> bool:
    """True if no push turns the body."""
    return not moves_freely(body) or math.isinf(body.moment)


def _anchor(scene: Scene, centre: Mapping[str, Point], body: str, point: str) -> Point:
    """Return a point in the coordinates of the pymunk body."""
    return less(local_point(scene, body, point), centre[body])


def _pinned_bodies(scene: Scene, names: tuple[str, ...]) -> tuple[str, ...]:
    """Return the bodies of a pin, immovable ones first, so that all others hang on the firmest."""
    firm = {GROUND: 0} if scene.driver.is_inner else {GROUND: 0, scene.driver.link: 1}
    return tuple(sorted(names, key=lambda name: firm.get(name, 2)))


def _reach(scene: Scene) -> float:
    """Return a distance out of reach of any slider [m]."""
    return FAR * sum(map(span, (scene.ground, *(link.points for link in scene.links.values()))))


def _groove(scene: Scene, state: State, slider: Slider, rider: str) -> tuple[Point, Point]:
    """Return the ends of a groove in the frame of the guide [m], out of reach of any motion."""
    where = frames(scene, state)
    place = where[rider].at(local_point(scene, rider, slider.point))
    now, _ = along(slider, where[slider.on], place, (0.0, 0.0))
    reach = _reach(scene)
    u = turned((1.0, 0.0), slider.direction_rad)
    a, b = now - reach, now + reach
    x, y = slider.through_m
    return (x + a * u[0], y + a * u[1]), (x + b * u[0], y + b * u[1])
