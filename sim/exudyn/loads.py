"""Loads of a scene, as exudyn applies them."""

import math
from collections.abc import Callable
from functools import cached_property, lru_cache, partial
from typing import Any

import numpy as np

from models.errors import CrankcheckError, EngineError, few
from models.scene import GROUND, Point, Scene, Slider
from models.scene.characteristics import Constant, Staircase
from models.scene.joints import (
    block_name,
    bodies,
    joints,
    riding_body,
    sliding_angle,
    sliding_body,
)
from models.scene.loads import Load
from sim.engine import Drive
from sim.engine.load_magnitudes import ahead, known_ahead
from sim.exudyn.system import ANGLE, Index, PlaneSystem, exu, items

KIND = exu.OutputVariableType


class Present:
    """Present state of a system, for actions that depend on it."""

    def __init__(self, applied: "Applied") -> None:
        self._scene, self._made = applied.scene, applied.made
        # Markers of the sliding point and of the point that the line passes through.
        self._ends = {
            slider.name: (applied.tip(slider), self._made.marker_at(slider.on, slider.through_m))
            for slider in (slide.slider for slide in joints(self._scene).slides)
        }

    def angle(self, system: Any, body: str) -> tuple[float, float]:
        """Return angle [rad] and rate [rad/s] of a body or the ground."""
        if body == GROUND:
            return 0.0, 0.0
        node = self._made.node[body]
        turned = float(system.GetNodeOutput(node, KIND.Coordinates)[ANGLE])
        rate = float(system.GetNodeOutput(node, KIND.Coordinates_t)[ANGLE])
        return self._made.start_rad[body] + turned, rate

    def line(self, system: Any, name: str, turned_rad: float = 0.0) -> Point:
        """Return the direction of the line of a slider in the plane, or one turned against it."""
        slider = self._scene.sliders[name]
        angle = self.angle(system, slider.on)[0] + slider.direction_rad + turned_rad
        return math.cos(angle), math.sin(angle)

    def slider(self, system: Any, name: str) -> tuple[float, float]:
        """Return displacement [m] and speed [m/s] of a slider, against its guide."""
        tip, start = self._ends[name]
        (x, y), (u, v) = (
            (system.GetMarkerOutput(tip, what) - system.GetMarkerOutput(start, what)).tolist()[:2]
            for what in (KIND.Position, KIND.Velocity)
        )
        c, s = self.line(system, name)
        _, omega = self.angle(system, self._scene.sliders[name].on)
        return c * x + s * y, c * (u + omega * y) + s * (v - omega * x)


Size = Callable[[Any, float], float]
"""A size [N or N m], of the system and of the time on exudyn's clock."""
Vector = Callable[[Any, float], Point]
"""A force [N], of the same."""


class Applied:
    """Adds forces and torques to the system ``made``: numbers, or callbacks of exudyn. ``fault`` is
    the reason why one of them has lost its size.

    exudyn calls with the time and in the present state of its Newton's method, so that a load
    belongs to the end of the step, as all forces of an implicit step. A block without mass is no
    body here: a force on it acts on the body whose point rides on the line, a torque on the guide,
    with which it turns.
    """

    def __init__(self, made: PlaneSystem) -> None:
        self.scene, self.made = made.scene, made
        self.massless = {block_name(slot.slider): slot for slot in joints(made.scene).slots}
        """Sliders whose block is no body in exudyn, by the name of the block."""
        self.fault = ""

    @cached_property
    def present(self) -> Present:
        """The present state of the system."""
        return Present(self)

    def turning(self, body: str) -> str:
        """Return the body that a body turns with: for a block without mass, its guide."""
        slot = self.massless.get(body)
        return body if slot is None else slot.slider.on

    def on(self, body: str, point: str) -> Index:
        """Return a marker at a point of a body, or of the riding body of a block without mass."""
        slot = self.massless.get(body)
        if slot is not None:
            body, point = riding_body(slot), slot.slider.point
        return self.made.marker(body, self.made.anchor(body, point))

    def tip(self, slider: Slider) -> Index:
        """Return a marker at the sliding point."""
        return self.on(sliding_body(slider), slider.point)

    def force(self, marker: Index, force: Vector | Point, *, in_body: bool = False) -> None:
        """Add a force, in the frame of the ground or of the body."""
        vector = (lambda *now: [*force(*now), 0.0]) if callable(force) else [*force, 0.0]
        self._add(items.LoadForceVector(markerNumber=marker, bodyFixed=in_body), vector)

    def torque(self, body: str, torque: Size | float) -> None:
        """Add a torque on a body or a block; the ground feels none."""
        turning = self.turning(body)
        if turning != GROUND:
            marker = self.made.marker_at(turning, (0.0, 0.0))
            none = 0.0, 0.0
            told = (lambda *now: [*none, torque(*now)]) if callable(torque) else [*none, torque]
            self._add(items.LoadTorqueVector(markerNumber=marker), told)

    def _add(self, load: Any, vector: Callable[[Any, float], list[float]] | list[float]) -> None:
        """Add a load of three numbers, or of a function of the system and of time."""

        def called(system: Any, time_s: float, _: object) -> list[float]:
            assert callable(vector)
            try:
                return vector(system, time_s)
            except CrankcheckError as error:
                self.fault = str(error)  # exudyn would show it with a traceback
                raise

        if callable(vector):
            load.loadVectorUserFunction = called
        else:
            load.loadVector = vector
        self.made.system.AddLoad(load)


def step_mean(stairs: Staircase, start_s: float, dt_s: float, time_s: float) -> float:
    """Return the mean of a staircase about the end of a step, or the start, with weights that fall
    to 0 at a step's distance [N or N m].

    A step weighs its two ends alike, so that a jump that only one of them feels acts half a step
    too early or too late, at any place in the step; with these means the impulse over both steps is
    right, and belongs to the right instant. There is no step before ``start_s``: a jump up to then
    counts from there.
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
    known = [*bodies(applied.scene), *applied.massless]
    for load in applied.scene.loads.values():
        if load.body not in known:
            raise EngineError(
                f"loads.{load.name}: found body {load.body}; use one of {few(known, 12)}"
            )
        size = _size(applied, load, start_s, drive, dt_s)
        if load.point is None:
            applied.torque(load.body, size)
            continue
        marker, in_body = applied.on(load.body, load.point), load.frame == "body"
        direction: Any = math.cos(load.direction_rad), math.sin(load.direction_rad)
        if in_body and load.body in applied.massless:
            slider, in_body = applied.massless[load.body].slider, False
            turned = load.direction_rad + sliding_angle(slider) - slider.direction_rad
            direction = partial(applied.present.line, name=slider.name, turned_rad=turned)
        applied.force(marker, _pointing(size, direction), in_body=in_body)


def follows_rates(scene: Scene, drive: Drive) -> bool:
    """True if a load depends on a speed that is not known before the step."""
    return drive != "prescribed" and any(
        load.over in ("omega", "speed") for load in scene.loads.values()
    )


def _size(applied: Applied, load: Load, start_s: float, drive: Drive, dt_s: float) -> Size | float:
    """Return the size of a load: a number for a constant one.

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

    present = applied.present

    def of_present(system: Any, time_s: float) -> float:
        theta, _ = present.angle(system, scene.driver.link)
        slid = {} if load.slider is None else {load.slider: present.slider(system, load.slider)}
        omega = 0.0 if load.over != "omega" else present.angle(system, load.body)[1]
        return load.size(start_s + time_s, theta, slid, omega)

    return of_present


def _pointing(size: Size | float, direction: Callable[[Any], Point] | Point) -> Any:
    """Return a force of a size in a direction, each a number or a function of the present state."""

    def vector(system: Any, time_s: float) -> Point:
        force = size(system, time_s) if callable(size) else size
        c, s = direction(system) if callable(direction) else direction
        return force * c, force * s

    return vector if callable(size) or callable(direction) else vector(None, 0.0)
