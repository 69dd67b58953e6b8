"""How to read reactions and the driving torque out of pymunk, as a program of its own."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator

import pymunk

from models.errors import EngineError
from models.joints import Slot, bodies, joints, less, riding_body, turned
from models.laws import ConstantSpeed
from models.motion import State
from models.poses import centre_of, mass_of
from models.scene import GROUND, Point, Scene
from sim.engine import Settings
from sim.force_recipes import ForceRecipe
from sim.pymunk.engine import VELOCITY_SHIFT
from sim.pymunk.force_program import program
from sim.pymunk.settings import checked, exact_lines
from sim.pymunk.space import SpaceModel, build


def pymunk_force_recipe(scene: Scene, state: State, settings: Settings, dt_s: float) -> str:
    """See `sim.force_recipes.ForceRecipe`: the force of every pin that pymunk holds on its second
    body, and the torque. Covers what a driver at constant speed moves without loads, springs,
    friction or redundant links."""
    checked(settings)
    _check_covered(scene)
    delay = VELOCITY_SHIFT * dt_s
    model = build(scene, state, exact_lines=exact_lines(settings), delay_s=delay)
    turn = scene.driver.law.period_s
    texts = {
        "NAME": repr(scene.name),
        "STEPS_PER_TURN": f"{turn / dt_s:.6g}",
        "DT": repr(dt_s),
        "STEPS": repr(max(round(turn / dt_s), 1)),
        "START": repr(state.time_s),
        "GRAVITY": repr(tuple(scene.gravity_m_s2)),
        "ITERATIONS": repr(int(settings["iterations"])),
        "DAMPING": repr(float(settings["damping"])),
        "BIAS": repr(float(settings["error_bias"])),
        "CRANK": _crank(scene, model),
        "BODIES": _rows(_bodies(model)),
        "PINS": _rows(_pins(scene, model)),
        "READ": repr(_read(scene, model)),
        "FAR": repr(2.0 * scene.longest_m),
        "SLIDES": _rows(_slides(scene, model)),
    }
    return re.sub("<([A-Z_]+)>", lambda found: texts[found[1]], program(bool(scene.sliders)))


def _check_covered(scene: Scene) -> None:
    """Refuse what the program would leave out."""
    acting = {"loads": scene.loads, "springs": scene.springs, "friction": scene.friction}
    extra = [f"{table}.{name}" for table, named in acting.items() for name in named]
    if scene.is_free:
        extra.append("a driver that is let go")
    elif not scene.driver.is_crank:
        extra.append("a driver that is no crank")
    elif not isinstance(scene.driver.law, ConstantSpeed):
        extra.append("a driver whose speed is not constant")
    if extra:
        raise EngineError(
            f"{scene.name}: the recipe of pymunk leaves out {', '.join(extra)}; take them out, or "
            "run the scene itself with forces"
        )
    ties = joints(scene)
    pairs = sum(len(pin.bodies) - 1 for pin in ties.pins)
    unknown = 2 * pairs + 2 * len(ties.prisms) + len(ties.slots) + 1
    if unknown > 3 * len(bodies(scene)):
        raise EngineError(
            f"{scene.name}: its redundant links leave the reactions open, and a recipe "
            "shows how to read them; take a scene without"
        )


def _crank(scene: Scene, model: SpaceModel) -> str:
    """Name and mass of the crank, and the way from its pivot to its centre of mass."""
    name = scene.driver.link
    centre = less(centre_of(scene, name), model.centre[name])
    return repr((name, mass_of(scene, name)[0], centre))


def _bodies(model: SpaceModel) -> Iterator[str]:
    """Name, mass, moment of inertia, position, angle, velocity, angular velocity."""
    for name, body in model.bodies.items():
        mass, inertia = (0.0, 0.0) if body is model.crank else (body.mass, body.moment)
        turning = "math.inf" if math.isinf(inertia) else repr(inertia)
        moving = [_pair(body.position), body.angle, _pair(body.velocity), body.angular_velocity]
        yield f"({name!r}, {mass!r}, {turning}, {', '.join(map(repr, moving))})"


def _pins(scene: Scene, model: SpaceModel) -> Iterator[str]:
    """Point, its two bodies, and where each has it, from its origin."""
    for hinge, joint in model.hinges.items():
        if isinstance(joint, pymunk.PivotJoint):
            anchors = _pair(joint.anchor_a), _pair(joint.anchor_b)
        else:
            anchors = scene.ground[hinge.point], (0.0, 0.0)
            if hinge.first != GROUND:
                anchors = anchors[1], anchors[0]
        yield repr((hinge.point, hinge.first, hinge.other, *anchors))


def _slides(scene: Scene, model: SpaceModel) -> Iterator[str]:
    """Guide, body, its anchor, a place of the line and its direction, the ends of the groove or
    None for a rail, and the angle that is kept: None for a block without mass, 0 where an infinite
    moment keeps it."""
    for slide in joints(scene).slides:
        slider, line = slide.slider, model.lines[slide.slider.name]
        centre = (0.0, 0.0) if slider.on == GROUND else model.centre[slider.on]
        assert isinstance(line, pymunk.GrooveJoint | pymunk.PinJoint)
        anchor, ends = _pair(line.anchor_b), None
        if isinstance(line, pymunk.GrooveJoint):
            ends = _pair(line.groove_a), _pair(line.groove_b)
        gear = model.gears.get(slider.name)
        kept = None if isinstance(slide, Slot) else 0.0
        if isinstance(gear, pymunk.GearJoint):
            kept = gear.phase
        along = turned((1.0, 0.0), slider.direction_rad)
        start = less(slider.through_m, centre)
        yield repr((slider.on, riding_body(slide), anchor, start, along, ends, kept))


def _read(scene: Scene, model: SpaceModel) -> list[int]:
    """The pins whose force on their second body is the force of the hinge: not those where a block
    without mass has its part."""
    blocks = {slot.slider.point for slot in joints(scene).slots}
    return [k for k, hinge in enumerate(model.hinges) if hinge.point not in blocks]


def _pair(vector: pymunk.Vec2d) -> Point:
    return vector.x, vector.y


def _rows(items: Iterable[str]) -> str:
    """The items of a tuple, one a line."""
    return "".join(f"\n    {item}," for item in items)


FORCE_RECIPE: ForceRecipe = pymunk_force_recipe
