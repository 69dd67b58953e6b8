"""Program that reads reactions and the driving torque out of pymunk."""

import math
import re
from collections.abc import Iterable, Iterator

import pymunk

from models.errors import EngineError
from models.motion import State
from models.scene import GROUND, Point, Scene, laws
from models.scene.joints import Slot, bodies, centre_of, joints, mass_of, turned
from sim.engine import Settings
from sim.engine.ties import hinges
from sim.pymunk.engine import VELOCITY_SHIFT
from sim.pymunk.settings import checked
from sim.pymunk.space import SpaceModel, build
from sim.registry.offers import ForceRecipe


def pymunk_force_recipe(scene: Scene, state: State, settings: Settings, dt_s: float) -> str:
    """Write the recipe (`sim.registry.offers.ForceRecipe`): the force of every pymunk pin on its
    second body, and the torque. It covers a driver at constant speed without loads, springs,
    friction or redundant links."""
    checked(settings)
    _check_covered(scene)
    delay = VELOCITY_SHIFT * dt_s
    model = build(scene, state, exact_lines=settings["lines"] == "exact", delay_s=delay)
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
        "CRANK": _crank(model),
        "BODIES": _rows(_bodies(model)),
        "PINS": _rows(_pins(model)),
        "READ": repr(_read(model)),
        "FAR": repr(2.0 * scene.longest_m),
        "SLIDES": _rows(_slides(model)),
    }
    text = PROGRAM
    for part, own in (("<SLIDERS>", SLIDERS), ("<ACROSS>", ACROSS)):
        text = text.replace(part, own if scene.sliders else "")
    return re.sub("<([A-Z_]+)>", lambda found: texts[found[1]], text)


def _check_covered(scene: Scene) -> None:
    tables = {"loads": scene.loads, "springs": scene.springs, "friction": scene.friction}
    extra = [f"{table}.{name}" for table, named in tables.items() for name in named]
    if scene.is_free:
        extra.append("a driver in free motion")
    elif not scene.driver.is_crank:
        extra.append("a driver that is no crank")
    elif not isinstance(scene.driver.law, laws.ConstantSpeed):
        extra.append("a driver whose speed is not constant")
    if extra:
        raise EngineError(
            f"{scene.name}: the recipe of pymunk leaves out {', '.join(extra)}; remove them, or "
            "run the scene itself with forces"
        )
    ties, pins = joints(scene), [*hinges(scene)]
    if 2 * len(pins) + 2 * len(ties.prisms) + len(ties.slots) + 1 > 3 * len(bodies(scene)):
        raise EngineError(
            f"{scene.name}: its redundant links leave the reactions open, and a recipe "
            "shows how to read them; take a scene without"
        )


def _crank(model: SpaceModel) -> str:
    """Return name and mass of the crank, and the way from its pivot to its centre of mass."""
    name = model.scene.driver.link
    centre = model.from_centre(name, centre_of(model.scene, name))
    return repr((name, mass_of(model.scene, name)[0], centre))


def _bodies(model: SpaceModel) -> Iterator[str]:
    """Yield name, mass, moment of inertia, position, angle, velocity, angular velocity."""
    for name, body in model.bodies.items():
        mass, inertia = (0.0, 0.0) if body is model.crank else (body.mass, body.moment)
        turning = "math.inf" if math.isinf(inertia) else repr(inertia)
        moving = [_pair(body.position), body.angle, _pair(body.velocity), body.angular_velocity]
        yield f"({name!r}, {mass!r}, {turning}, {', '.join(map(repr, moving))})"


def _pins(model: SpaceModel) -> Iterator[str]:
    """Yield the point, its two bodies, and its place on each, from its origin."""
    for hinge, joint in model.hinges.items():
        if isinstance(joint, pymunk.PivotJoint):
            anchors = _pair(joint.anchor_a), _pair(joint.anchor_b)
        else:
            anchors = model.scene.ground[hinge.point], (0.0, 0.0)
            if hinge.first != GROUND:
                anchors = anchors[1], anchors[0]
        yield repr((hinge.point, hinge.first, hinge.other, *anchors))


def _slides(model: SpaceModel) -> Iterator[str]:
    """Yield the guide, the body, its anchor, a place of the line and its direction, the ends of the
    groove or None for a rail, and the constant angle: None for a block without mass, 0 where an
    infinite moment keeps it."""
    for slide in joints(model.scene).slides:
        slider, line = slide.slider, model.lines[slide.slider.name]
        assert isinstance(line, pymunk.GrooveJoint | pymunk.PinJoint)
        anchor, ends = _pair(line.anchor_b), None
        if isinstance(line, pymunk.GrooveJoint):
            ends = _pair(line.groove_a), _pair(line.groove_b)
        gear = model.gears.get(slider.name)
        kept = None if isinstance(slide, Slot) else 0.0
        if isinstance(gear, pymunk.GearJoint):
            kept = gear.phase
        along = turned((1.0, 0.0), slider.direction_rad)
        (rider, _), (guide, start) = model.line_ends(slide)
        yield repr((guide, rider, anchor, start, along, ends, kept))


def _read(model: SpaceModel) -> list[int]:
    """Return the pins whose force on their second body is the force of the hinge: not those with a
    block without mass."""
    blocks = {slot.slider.point for slot in joints(model.scene).slots}
    return [k for k, hinge in enumerate(model.hinges) if hinge.point not in blocks]


def _pair(vector: pymunk.Vec2d) -> Point:
    return vector.x, vector.y


def _rows(items: Iterable[str]) -> str:
    return "".join(f"\n    {item}," for item in items)


FORCE_RECIPE: ForceRecipe = pymunk_force_recipe


PROGRAM = '''\
"""Reactions and driving torque out of pymunk.

pymunk reports the magnitude of a joint's impulse, not its direction. The vectors follow from the
momentum of the bodies: m (v' - v) / dt is the sum of the forces on a body.
"""

import math

import numpy as np
import pymunk

DT, STEPS, START = <DT>, <STEPS>, <START>  # of <NAME>: <STEPS_PER_TURN> steps a turn
UNTOLD = 3  # steps in which joints make up for the half step that velocities are away from them
# pymunk has no mass of a kinematic crank: its own, and the way from its pivot to its centre.
CRANK, CRANK_MASS, CRANK_CENTRE = <CRANK>

space = pymunk.Space()
space.gravity = <GRAVITY>
space.iterations = <ITERATIONS>
space.damping = <DAMPING>

# Name, mass, moment of inertia, position of the centre of mass, angle, velocity, angular velocity.
# Velocities are those of half a step later: a step moves the positions first, with the velocity of
# the step before. The crank is kinematic, with its origin on its pivot.
BODIES = (<BODIES>
)
bodies = {"ground": space.static_body}
for name, mass, moment, position, angle, velocity, turning in BODIES:
    kinematic = pymunk.Body(body_type=pymunk.Body.KINEMATIC)
    body = bodies[name] = kinematic if name == CRANK else pymunk.Body(mass, moment)
    body.position, body.angle = position, angle
    body.velocity, body.angular_velocity = velocity, turning
    space.add(body)
moving = [name for name, *_ in BODIES]

# Point, its two bodies, and where each has it. The crank needs none on its pivot; its force there
# is an unknown like the others.
PINS = (<PINS>
)
READ = <READ>  # those whose force is printed
pivots = {}
for k, (_, first, second, in_first, in_second) in enumerate(PINS):
    if {first, second} != {"ground", CRANK}:
        pivots[k] = pymunk.PivotJoint(bodies[first], bodies[second], in_first, in_second)
        space.add(pivots[k])
<SLIDERS>for joint in space.constraints:
    joint.error_bias = <BIAS>  # the share of an error of place that is left after a second
    joint.collide_bodies = False


def unknown(*pushes):
    """What an unknown of size 1 is to each body: force, and moment about the body's origin."""
    rows = np.zeros((len(moving), 3))
    for name, place, (x, y), moment in pushes:
        if name != "ground":
            arm = place - bodies[name].position
            rows[moving.index(name)] += x, y, arm.x * y - arm.y * x + moment
    return rows.ravel()


def gain(name, velocity, turning):
    """What joints and drive gave a body in the last step, from its velocities before."""
    body = bodies[name]
    if name == CRANK:  # at constant speed its centre of mass is drawn to the pivot
        arm = pymunk.Vec2d(*CRANK_CENTRE).rotated(body.angle)
        force = CRANK_MASS * (-(body.angular_velocity**2) * arm - space.gravity)
        return [force.x, force.y, arm.cross(force)]
    kept = space.damping**DT
    force = body.mass * ((body.velocity - kept * velocity) / DT - space.gravity)
    fixed = math.isinf(body.moment)
    moment = 0.0 if fixed else body.moment * (body.angular_velocity - kept * turning) / DT
    return [force.x, force.y, moment]


names = [f"{PINS[k][0]}.{PINS[k][2]}" for k in READ]
print("time_s", *(f"{name}.{axis}_n" for name in names for axis in "xy"), "torque_n_m", sep=",")
for step in range(1, UNTOLD + STEPS + 1):
    before = {name: (bodies[name].velocity, bodies[name].angular_velocity) for name in moving}
    space.step(DT)
    if step <= UNTOLD:
        continue
    # The step found its impulses where the bodies are now: arms, and forces, belong to its end.
    columns = []
    for _, first, second, in_first, in_second in PINS:
        here = bodies[first].local_to_world(in_first)
        there = bodies[second].local_to_world(in_second)
        for x, y in ((1.0, 0.0), (0.0, 1.0)):
            columns.append(unknown((second, there, (x, y), 0.0), (first, here, (-x, -y), 0.0)))
<ACROSS>    columns.append(unknown((CRANK, bodies[CRANK].position, (0.0, 0.0), 1.0)))
    right = [number for name in moving for number in gain(name, *before[name])]
    found = np.linalg.solve(np.column_stack(columns), right)
    for k, pivot in pivots.items():  # pymunk's own word
        length = math.hypot(found[2 * k], found[2 * k + 1])
        assert abs(pivot.impulse / DT - length) < 1e-6 * np.abs(found).max()
    forces = [number for k in READ for number in found[2 * k : 2 * k + 2]]
    print(*(repr(float(number)) for number in (START + step * DT, *forces, found[-1])), sep=",")
'''

SLIDERS = '''
# Guide, body on its line, where that has its point, a place of the line and its direction in the
# guide, the ends of a groove or None, and the angle that is kept: None where there is none to keep.
SLIDES = (<SLIDES>
)
FAR = <FAR>


def level(joint, rider, guide, anchor, start, along):
    """Bring the far end of a rail level with the point. A groove joint lets the sliding speed leak
    across the line where a push turns the bodies; a pin joint with a moving end does not."""
    way = guide.world_to_local(rider.local_to_world(anchor)) - start
    place = start + along.dot(way) * along
    joint.anchor_a = place + FAR * along.perpendicular()


for guide, rider, anchor, start, along, ends, kept in SLIDES:
    pair = bodies[guide], bodies[rider]
    if ends is not None:
        space.add(pymunk.GrooveJoint(*pair, *ends, anchor))
    else:
        rail = pymunk.PinJoint(*pair, (0.0, 0.0), anchor)
        rail.distance = FAR
        line = (*pair[::-1], anchor, pymunk.Vec2d(*start), pymunk.Vec2d(*along))
        rail.pre_solve = lambda joint, _space, line=line: level(joint, *line)
        space.add(rail)
    if kept is not None and guide != "ground":  # on the ground an infinite moment keeps it
        space.add(pymunk.GearJoint(*pair, kept, 1.0))
'''

ACROSS = """\
    for guide, rider, anchor, _, along, _, kept in SLIDES:
        place = bodies[rider].local_to_world(anchor)
        x, y = pymunk.Vec2d(*along).rotated(bodies[guide].angle).perpendicular()
        columns.append(unknown((rider, place, (x, y), 0.0), (guide, place, (-x, -y), 0.0)))
        if kept is not None:
            turn = (rider, place, (0.0, 0.0), 1.0), (guide, place, (0.0, 0.0), -1.0)
            columns.append(unknown(*turn))
"""
