"""Bodies and joints of a scene as numbers of exudyn's items, for the system and for the recipe."""

from collections.abc import Iterator

from models.motion import State
from models.scene import GROUND, Point, Scene
from models.scene import joints as pairs
from sim.engine import ties
from sim.engine.acting import PlacedBodies

BodyRow = tuple[float, float, list[float], list[float]]
"""Mass, inertia about the centre of mass, place of that and angle, and the rates of both."""
LineRow = tuple[str, Point, str, Point, list[float], list[float], bool]
"""What slides and where on it, its guide and a place on the line, their directions, and whether the
angle is kept: a block without mass is a point, which may turn."""


def body_rows(scene: Scene, state: State) -> dict[str, BodyRow]:
    """Return the bodies by name."""
    rows, frames = {}, pairs.frames(scene, state)
    for name in pairs.bodies(scene):
        frame = frames[name]
        place = frame.at(pairs.centre_of(scene, name))
        rates = [*frame.velocity_at(place), frame.omega]
        rows[name] = (*pairs.mass_of(scene, name), [*place, frame.theta], rates)
    return rows


def pin_rows(placed: PlacedBodies) -> Iterator[tuple[ties.Hinge, Point, Point]]:
    """Yield the hinges, with their places on both bodies."""
    for hinge in ties.hinges(placed.scene, GROUND):
        first, other = (placed.anchor(body, hinge.point) for body in (hinge.first, hinge.other))
        yield hinge, first, other


def line_rows(placed: PlacedBodies) -> dict[str, LineRow]:
    """Return the pairs on lines, by slider."""
    rows = {}
    for slide in pairs.joints(placed.scene).slides:
        slider, rider = slide.slider, pairs.riding_body(slide)
        keeps = isinstance(slide, pairs.Prism)
        through = placed.from_centre(slider.on, slider.through_m)
        own = slider.direction_rad - (pairs.sliding_angle(slider) if keeps else 0.0)
        axis = [*pairs.turned((1.0, 0.0), own), 0.0]
        normal = [*pairs.turned((0.0, 1.0), slider.direction_rad), 0.0]
        tip = placed.anchor(rider, slider.point)
        rows[slider.name] = rider, tip, slider.on, through, axis, normal, keeps
    return rows
