"""The pymunk space of a scene: a body per link, joints as constraints, shapes for cams by contact
alone; and a point on a line where the groove joint is in error.

Bodies have their origin at the centre of gravity, as Chipmunk needs it. A driven crank is a
kinematic body on its pivot. A massless slider block is a groove for the point of its link. A body
that slides on the ground cannot turn: it gets an infinite moment; on a moving guide a gear of ratio
1 holds its angle.

Chipmunk's groove joint solves for both components of the impulse and then drops the one along the
line. Unless a push along the line moves the bodies along the line alone, the sliding speed leaks
into the constraint: the point leaves its line, by an error of first order in the step with any
number of iterations, and a slider-crank with a massless piston falls apart. A rail holds the point
by one scalar constraint across the line.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import pymunk

from models.errors import EngineError
from models.motion import State
from models.scene import GROUND, Point, Scene, span
from models.scene import joints as pairs
from models.scene.joints import Prism, Slot, turned
from sim.engine import Drive
from sim.engine.ties import Hinge, hinges, refuse_driver_angle, refuse_massless
from sim.pymunk import native
from sim.pymunk.cam_contacts import add_contact
from sim.pymunk.rolling import cam_line, mesh


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
class SpaceModel(native.SpaceBodies):
    """A space with its bodies and constraints, and the crank.

    ``motor`` is the servo, or the motor of an inner pin, if any. Of the constraints, ``hinges``
    belong to the pins (None for a kinematic crank), and by slider ``lines`` hold a point on its
    line, ``gears`` an angle. ``rubs`` is the friction of pins; ``springs`` are the space's own.
    """

    motor: pymunk.SimpleMotor | None = None
    hinges: Mapping[Hinge, pymunk.Constraint | None] = field(default_factory=dict)
    lines: Mapping[str, pymunk.Constraint] = field(default_factory=dict)
    gears: Mapping[str, pymunk.Constraint] = field(default_factory=dict)
    rubs: tuple[native.PinFriction, ...] = ()
    springs: Mapping[str, native.NativeSpring] = field(default_factory=dict)

    @property
    def crank(self) -> pymunk.Body:
        """The driven body."""
        return self.bodies[self.scene.driver.link]


def build(
    scene: Scene,
    state: State,
    *,
    drive: Drive = "prescribed",
    exact_lines: bool = True,
    with_springs: bool = False,
    delay_s: float = 0.0,
    dt_s: float = 0.0,
) -> SpaceModel:
    """Build the space of ``scene`` at ``state``.

    A crank that is not prescribed is dynamic: with a motor under a servo, free without one. Points
    on lines run in Chipmunk's grooves or, with ``exact_lines``, on a `Rail` where the groove is in
    error. ``with_springs`` the space has the scene's springs. Velocities belong to ``delay_s``
    later (see `models.scene.joints.frames`). Cams are set for steps of ``dt_s``.

    Raises EngineError for a link without mass that has to move freely, and for a massless block
    that no body carries.
    """
    driver = scene.driver
    _check_drive(scene, drive)
    pinned = drive != "prescribed" or driver.is_inner
    placed = _placed(scene, state, delay_s, None if pinned else driver.link)
    motor = None
    if pinned and drive != "free":
        ends = placed.body(driver.link), placed.body(driver.base)
        motor = pymunk.SimpleMotor(*ends, ends[0].angular_velocity - ends[1].angular_velocity)
    pivots = _pins(placed, pinned=pinned)
    _add(placed, motor, *pivots.values())
    lines: dict[str, pymunk.Constraint] = {}
    gears: dict[str, pymunk.Constraint] = {}
    for slide in pairs.joints(scene).slides:
        name = slide.slider.name
        if name == driver.slider and not pinned:
            continue  # a kinematic body, at a prescribed position
        lines[name] = _line(placed, slide, exact_lines)
        if isinstance(slide, Prism) and slide.slider.on != GROUND:
            gears[name] = _gear(placed, slide)
        _add(placed, lines[name], gears.get(name))
    _add(placed, *(mesh(placed, gear) for gear in scene.gears.values()))
    for k, cam in enumerate(scene.cams.values()):
        if cam.facets:
            add_contact(placed, cam, k)
        else:
            _add(placed, cam_line(placed, cam, dt_s))
    rubs = native.pin_friction(placed)
    springs = native.native_springs(placed, _reach(scene)) if with_springs else {}
    _add(placed, *(one.motor for one in rubs), *(one.constraint for one in springs.values()))
    joints: dict[str, Any] = {"hinges": pivots, "lines": lines, "gears": gears}
    return SpaceModel(**vars(placed), motor=motor, **joints, rubs=rubs, springs=springs)


def _placed(
    scene: Scene, state: State, delay_s: float, kinematic: str | None
) -> native.SpaceBodies:
    """Add the bodies of a scene to a new space; one may be ``kinematic``."""
    placed = native.SpaceBodies(scene, state, pymunk.Space())
    placed.space.gravity = scene.gravity_m_s2
    fixed_angle = {p.body for p in pairs.joints(scene).prisms if p.slider.on == GROUND}
    where = pairs.frames(scene, state, delay_s)
    for name in pairs.bodies(scene):
        turns = name == kinematic and scene.driver.slider is None
        centre = pairs.centre_of(scene, name)
        if turns:
            centre = pairs.local_point(scene, name, scene.driver_pivot)
        body = _body(scene, name, name == kinematic, name in fixed_angle)
        body.position = where[name].at(centre)
        body.angle = where[name].theta
        body.velocity = (0.0, 0.0) if turns else where[name].velocity_at(body.position)
        body.angular_velocity = where[name].omega
        placed.centre[name], placed.bodies[name] = centre, body
        placed.space.add(body)
    return placed


def _add(placed: native.SpaceBodies, *constraints: pymunk.Constraint | None) -> None:
    """Add constraints, where there are any, without collision bookkeeping; there are no shapes."""
    for constraint in filter(None, constraints):
        constraint.collide_bodies = False
        placed.space.add(constraint)


def _check_drive(scene: Scene, drive: Drive) -> None:
    """Refuse a joint that pymunk cannot drive. Raises EngineError."""
    driver = scene.driver
    refuse_driver_angle(scene, "pymunk")
    if driver.slider is None or drive == "free":
        return
    if driver.is_inner or drive == "servo":
        what = "between two moving bodies" if driver.is_inner else "by a servo"
        raise EngineError(
            f"{scene.name}: pymunk has no motor along a line, and drives no slider {what}; "
            "drive a slider on the ground, prescribed, or use another engine"
        )
    slider = scene.sliders[driver.slider]
    if slider.link is None and slider.mass_kg == 0.0:
        raise EngineError(
            f"{scene.name}: the driven block {driver.slider} has no mass, so it is no body of "
            f"pymunk's; give sliders.{driver.slider} a mass_kg above 0"
        )


def _body(scene: Scene, name: str, kinematic: bool, fixed_angle: bool) -> pymunk.Body:
    if kinematic:
        return pymunk.Body(body_type=pymunk.Body.KINEMATIC)
    refuse_massless(scene, "pymunk", name, turns=not fixed_angle)
    mass, inertia = pairs.mass_of(scene, name)
    return pymunk.Body(mass, math.inf if fixed_angle else inertia)


def _pins(placed: native.SpaceBodies, *, pinned: bool) -> dict[Hinge, pymunk.Constraint | None]:
    """Make all pins; a kinematic crank needs none to the ground and is not ``pinned``."""
    scene, driver = placed.scene, placed.scene.driver
    made: dict[Hinge, pymunk.Constraint | None] = {}
    # Immovable bodies first, so that all others hang on the firmest.
    for hinge in hinges(scene, *([GROUND] if driver.is_inner else [GROUND, driver.link])):
        (first, a), (other, b) = placed.hinge_ends(hinge)
        driven = {first, other} == {GROUND, driver.link} and not pinned
        if driven and hinge.point == scene.driver_pivot:
            made[hinge] = None
        else:
            made[hinge] = pymunk.PivotJoint(placed.body(first), placed.body(other), a, b)
    return made


def _line(placed: native.SpaceBodies, slide: Prism | Slot, exact_lines: bool) -> pymunk.Constraint:
    scene, along_line = placed.scene, turned((1.0, 0.0), slide.slider.direction_rad)
    (rider, anchor), (on, start) = placed.line_ends(slide)
    guide, body = placed.body(on), placed.body(rider)
    off = abs(along_line[0] * start[1] - along_line[1] * start[0])
    small = 1e-12 * scene.longest_m
    sound = (_firm(body) or math.hypot(*anchor) < small) and (_firm(guide) or off < small)
    if sound or not exact_lines:
        a, b = _groove(placed, slide)
        return pymunk.GrooveJoint(guide, body, a, b, anchor)
    return Rail(body, guide, anchor, start, along_line, 2.0 * scene.longest_m).joint()


def _gear(placed: native.SpaceBodies, prism: Prism) -> pymunk.Constraint:
    """Make the gear for a sliding body's angle on a moving guide."""
    guide, body = placed.body(prism.slider.on), placed.body(prism.body)
    # A gear counts whole turns, and each of the two bodies comes with some of its own.
    kept = pairs.sliding_angle(prism.slider)
    kept += math.tau * round((body.angle - guide.angle - kept) / math.tau)
    return pymunk.GearJoint(guide, body, kept, 1.0)


def _firm(body: pymunk.Body) -> bool:
    """True if no push turns the body."""
    return not native.moves_freely(body) or math.isinf(body.moment)


def _reach(scene: Scene) -> float:
    """Return a distance out of reach of any slider [m]."""
    return FAR * sum(map(span, (scene.ground, *(link.points for link in scene.links.values()))))


def _groove(placed: native.SpaceBodies, slide: Prism | Slot) -> list[Point]:
    """Return the ends of a groove on the guide [m], out of reach of any motion."""
    scene, slider, rider = placed.scene, slide.slider, pairs.riding_body(slide)
    where = pairs.frames(scene, placed.state)
    place = where[rider].at(pairs.local_point(scene, rider, slider.point))
    now, _ = pairs.along(slider, where[slider.on], place, (0.0, 0.0))
    u, (x, y) = turned((1.0, 0.0), slider.direction_rad), slider.through_m
    ends = now - _reach(scene), now + _reach(scene)
    return [placed.from_centre(slider.on, (x + s * u[0], y + s * u[1])) for s in ends]
