"""Loads, springs and friction of a scene, as exudyn applies them."""

import math
from collections.abc import Callable
from functools import lru_cache, partial
from typing import Any

import numpy as np

from models.array import Array
from models.errors import CrankcheckError, EngineError, few
from models.scene import GROUND, Scene
from models.scene import joints as pairs
from models.scene.characteristics import Constant, Staircase
from models.scene.loads import ConstantFriction, LineSpring, Load, PinSpring, Spring
from sim.engine import Drive
from sim.engine.load_magnitudes import ahead, known_ahead
from sim.engine.ties import spring_ends
from sim.exudyn.system import ANGLE, Index, PlaneSystem, exu

KIND = exu.OutputVariableType
Size = Callable[[Any, float], float] | float
"""A size [N or N m], or one by the system and the time on exudyn's clock."""
Vector = tuple[float, float, float]
Axis = Vector | Callable[[Any], Vector]
"""A direction, or one by the system."""


class Applied:
    """Adds forces and torques to the system ``made``: numbers, or callbacks of exudyn. ``fault`` is
    the reason why one of them has lost its size.

    exudyn calls in the present state of its Newton's method, so that a load belongs to the end of
    the step. A block without mass is no body here: a force on it acts on the body whose point rides
    on the line, a torque on the guide, with which it turns.
    """

    def __init__(self, made: PlaneSystem) -> None:
        self.scene, self.made = made.scene, made
        self.massless = {pairs.block_name(s.slider): s for s in pairs.joints(made.scene).slots}
        """Sliders whose block is no body in exudyn, by the name of the block."""
        get = made.system.GetObject
        self.ends = {name: get(own)["markerNumbers"] for name, own in made.prismatic.items()}
        """Markers of each sliding point, and of the point that its line passes through."""
        self.fault = ""

    def angle(self, system: Any, body: str) -> tuple[float, float]:
        """Return the present angle [rad] and rate [rad/s] of a body or the ground."""
        if body == GROUND:
            return 0.0, 0.0
        node = self.made.node[body]
        turned = float(system.GetNodeOutput(node, KIND.Coordinates)[ANGLE])
        rate = float(system.GetNodeOutput(node, KIND.Coordinates_t)[ANGLE])
        return self.made.start_rad[body] + turned, rate

    def line(self, system: Any, name: str, turned_rad: float = 0.0) -> Vector:
        """Return the present direction of the line of a slider, or one turned against it."""
        slider = self.scene.sliders[name]
        angle = self.angle(system, slider.on)[0] + slider.direction_rad + turned_rad
        return math.cos(angle), math.sin(angle), 0.0

    def slider(self, system: Any, name: str) -> tuple[float, float]:
        """Return the present displacement [m] and speed [m/s] of a slider, against its guide."""
        tip, start = self.ends[name]
        (x, y), (u, v) = (
            (system.GetMarkerOutput(tip, what) - system.GetMarkerOutput(start, what)).tolist()[:2]
            for what in (KIND.Position, KIND.Velocity)
        )
        c, s, _ = self.line(system, name)
        _, omega = self.angle(system, self.scene.sliders[name].on)
        return c * x + s * y, c * (u + omega * y) + s * (v - omega * x)

    def turning(self, body: str) -> str:
        """Return the body that a body turns with: for a block without mass, its guide."""
        slot = self.massless.get(body)
        return body if slot is None else slot.slider.on

    def torque(self, body: str, size: Size) -> None:
        """Add a torque on a body or a block; the ground feels none."""
        turning = self.turning(body)
        if turning != GROUND:
            marker = self.made.marker_at(turning, (0.0, 0.0))
            self.push("LoadTorqueVector", marker, size, (0.0, 0.0, 1.0))

    def push(self, kind: str, marker: Index, size: Size, axis: Axis, **more: object) -> None:
        """Add a load of a size along an axis."""

        def vector(system: Any, time_s: float, _: object) -> list[float]:
            try:
                now = size(system, time_s) if callable(size) else size
            except CrankcheckError as error:
                self.fault = str(error)  # exudyn would show it with a traceback
                raise
            return [now * each for each in (axis(system) if callable(axis) else axis)]

        if callable(size) or callable(axis):
            more["loadVectorUserFunction"] = vector
        else:
            more["loadVector"] = vector(None, 0.0, None)
        self.made.add(kind, markerNumber=marker, **more)


def step_mean(stairs: Staircase, start_s: float, dt_s: float, time_s: float) -> float:
    """Return the mean of a staircase about the end of a step, or the start, with weights that fall
    to 0 at a step's distance [N or N m].

    A step weighs its two ends alike, so that a jump that only one of them feels acts half a step
    too early or too late; with these means the impulse over both steps is right, at the right
    instant. There is no step before ``start_s``: a jump up to then counts from there.
    """

    def share(place: float) -> float:
        if place <= start_s:
            return 1.0
        since = min(max((time_s - place) / dt_s, -1.0), 1.0)
        if time_s <= start_s:  # the available half of the mean
            return (1.0 + since) ** 2
        return 1.0 - 0.5 * (1.0 - since) ** 2 if since > 0.0 else 0.5 * (1.0 + since) ** 2

    rises = zip(stairs.places, stairs.values, (0.0, *stairs.values), strict=False)
    return math.fsum((value - before) * share(place) for place, value, before in rises)


def apply_loads(applied: Applied, start_s: float, drive: Drive, dt_s: float) -> None:
    """Add all loads. Raises EngineError for a load on an unknown body."""
    known, made = [*pairs.bodies(applied.scene), *applied.massless], applied.made
    for load in applied.scene.loads.values():
        if load.body not in known:
            raise EngineError(
                f"loads.{load.name}: found body {load.body}; use one of {few(known, 12)}"
            )
        size = _size(applied, load, start_s, drive, dt_s)
        if load.point is None:
            applied.torque(load.body, size)
            continue
        in_body, slot = load.frame == "body", applied.massless.get(load.body)
        axis: Axis = math.cos(load.direction_rad), math.sin(load.direction_rad), 0.0
        if slot is None:
            marker = made.marker(load.body, made.anchor(load.body, load.point))
        else:
            marker, _ = applied.ends[slot.slider.name]
        if in_body and slot is not None:
            slider, in_body = slot.slider, False
            turned = load.direction_rad + pairs.sliding_angle(slider) - slider.direction_rad
            axis = partial(applied.line, name=slider.name, turned_rad=turned)
        applied.push("LoadForceVector", marker, size, axis, bodyFixed=in_body)


def _size(applied: Applied, load: Load, start_s: float, drive: Drive, dt_s: float) -> Size:
    """Return the size of a load.

    If the load moves the mechanism, a jump in time keeps its impulse (`step_mean`); with a
    prescribed crank all forces belong to the instant.
    """
    scene, own = applied.scene, load.characteristic
    if isinstance(own, Constant) and load.stroke == "both":
        return own.value
    if known_ahead(load, drive):
        if isinstance(own, Staircase) and drive != "prescribed":
            return lambda _, time_s: step_mean(own, start_s, dt_s, start_s + time_s)
        # Computed once in a step.
        at = lru_cache(1)(lambda time_s: float(ahead(scene, load, np.array([time_s]))[0]))
        return lambda _, time_s: at(start_s + time_s)

    def of_present(system: Any, time_s: float) -> float:
        theta, _ = applied.angle(system, scene.driver.link)
        slid = {} if load.slider is None else {load.slider: applied.slider(system, load.slider)}
        omega = 0.0 if load.over != "omega" else applied.angle(system, load.body)[1]
        return load.size(start_s + time_s, theta, slid, omega)

    return of_present


class Springs:
    """Adds the springs of a scene to a system, as exudyn's own spring-dampers: between points along
    their line; in a pin between the angles of two nodes, which count turns; along the line of a
    slider between the guide, whose axis turns with it, and the riding body."""

    def __init__(self, applied: Applied) -> None:
        self._applied, self._made = applied, applied.made
        self._ahead: dict[str, float] = {}
        self._index = {name: self._add(own) for name, own in applied.scene.springs.items()}

    def _add(self, spring: Spring) -> Index:
        """Add a spring; angles of nodes count from the start."""
        made = self._made
        own: dict[str, Any] = {"stiffness": spring.rate, "damping": spring.damping}
        if isinstance(spring, PinSpring):
            first, second = map(self._applied.turning, spring.bodies)
            opened = made.start_rad[second] - made.start_rad[first]
            ahead = self._ahead[spring.name] = opened + pairs.whole_turns(spring, opened)
            own["markerNumbers"] = [made.coordinate_marker(body) for body in (first, second)]
            kind, own["offset"] = "ObjectConnectorCoordinateSpringDamper", spring.free - ahead
            return made.add(kind, **own)
        own["markerNumbers"] = [made.marker_at(*e) for e in spring_ends(made.scene, spring)]
        if isinstance(spring, LineSpring):
            return made.add("ObjectConnectorSpringDamper", referenceLength=spring.free, **own)
        axis = pairs.turned((1.0, 0.0), made.scene.sliders[spring.slider].direction_rad)
        own["axisMarker0"] = [*axis, 0.0]
        return made.add("ObjectConnectorLinearSpringDamper", offset=spring.free, **own)

    def held(self) -> dict[str, tuple[float, float, float]]:
        """Return rate, damping and slack length or angle of the springs, as exudyn has them."""
        told = {}
        for name, index in self._index.items():
            own = self._made.system.GetObject(index)
            free = float(own["offset"] if "offset" in own else own["referenceLength"])
            free += self._ahead.get(name, 0.0)
            told[name] = (float(own["stiffness"]), float(own["damping"]), free)
        return told


def apply_friction(applied: Applied, drive: Drive) -> None:
    """Add friction in sliders and pins. Raises EngineError for friction that is not constant, and
    for joints that may come to rest, where a force against the motion is undefined."""
    scene = applied.scene
    if scene.friction and drive == "free":
        raise EngineError(
            f"friction ({', '.join(scene.friction)}): exudyn gets it as forces against the "
            "motion, and joints without a drive come to rest and stick; remove it, or use "
            "drive prescribed"
        )
    for name, friction in scene.friction.items():
        if not isinstance(friction, ConstantFriction):
            raise EngineError(f"friction.{name}: exudyn gets none that follows the reactions")
        rub = _rub_line if friction.joint in scene.sliders else _rub_pin
        rub(applied, friction, still_rad_s(scene))


def _rub_pin(applied: Applied, friction: ConstantFriction, still: float) -> None:
    def size(own: str, other: str, system: Any, _: float) -> float:
        rate = applied.angle(system, own)[1] - applied.angle(system, other)[1]
        return float(against(friction.size, rate, still))

    first, second = map(applied.turning, pairs.joined_at(applied.scene)[friction.joint][:2])
    applied.torque(first, partial(size, first, second))
    applied.torque(second, partial(size, second, first))


def _rub_line(applied: Applied, friction: ConstantFriction, still: float) -> None:
    """Add a force along the line on the sliding body, and the opposite on the guide."""
    slider, least = applied.scene.sliders[friction.joint], still * applied.scene.longest_m
    (tip, guide), axis = applied.ends[slider.name], partial(applied.line, name=slider.name)

    def size(sign: float, system: Any, _: float) -> float:
        return sign * float(against(friction.size, applied.slider(system, slider.name)[1], least))

    applied.push("LoadForceVector", tip, partial(size, 1.0), axis)
    if slider.on != GROUND:
        applied.push("LoadForceVector", guide, partial(size, -1.0), axis)


def still_rad_s(scene: Scene) -> float:
    """Return the least speed with friction; the direction of a lower one is rounding [rad/s]."""
    return 1e-9 * scene.pace_rad_s


def against(size: float, speed: Array | float, still: float) -> Array:
    """Return the size against speeds, 0 at rest."""
    return np.where(np.abs(speed) > still, -np.copysign(size, speed), 0.0)
