"""Bodies and lines of a scene as numbers of exudyn's items, for the system and for the recipe."""

from models.motion import State
from models.scene import Point, Scene
from models.scene import joints as pairs
from sim.engine.acting import EngineBodies

BodyRow = tuple[float, float, list[float], list[float]]
"""Mass, inertia about the centre of mass, place of that and angle, and the rates of both."""
LineRow = tuple[str, Point, str, Point, list[float], list[float], bool]
"""The sliding body and the point on it, its guide and a place on the line, their directions, and
whether the angle is kept: a block without mass is a point, which may turn."""


def body_rows(scene: Scene, state: State) -> dict[str, BodyRow]:
    """Return the bodies by name."""
    rows, frames = {}, pairs.frames(scene, state)
    for name in pairs.bodies(scene):
        frame = frames[name]
        place = frame.at(pairs.centre_of(scene, name))
        rates = [*frame.velocity_at(place), frame.omega]
        rows[name] = (*pairs.mass_of(scene, name), [*place, frame.theta], rates)
    return rows


def line_rows(placed: EngineBodies) -> dict[str, LineRow]:
    """Return the pairs on lines, by slider."""
    rows = {}
    for slide in pairs.joints(placed.scene).slides:
        slider, keeps = slide.slider, isinstance(slide, pairs.Prism)
        tip, start = placed.line_ends(slide)
        own = slider.direction_rad - (pairs.sliding_angle(slider) if keeps else 0.0)
        axis = [*pairs.turned((1.0, 0.0), own), 0.0]
        normal = [*pairs.turned((0.0, 1.0), slider.direction_rad), 0.0]
        rows[slider.name] = (*tip, *start, axis, normal, keeps)
    return rows
