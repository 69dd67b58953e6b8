"""Loads, springs and friction of a scene in its MJCF text."""

from collections.abc import Sequence
from dataclasses import dataclass

from models.errors import EngineError
from models.mjcf.options import AttributeRow, Writing, attributes, commentable
from models.mjcf.tree import Freedom, Limb, Tree, closings, plan
from models.motion import State
from models.scene import GROUND, Point, Scene, joints
from models.scene.characteristics import Constant
from models.scene.driver import driver_place_in
from models.scene.loads import ConstantFriction, LineSpring, Load, PinSpring, Spring

AXES = "ground axes"
"""The fixed site along whose axes forces in the ground's frame act."""


@dataclass(frozen=True)
class PointOfApplication:
    """Point of a load on the bodies of the tree: ``place`` [m] of ``body``, and for a force its
    direction, in the frame of the body if it ``turns`` with it, else in the ground's."""

    body: str
    place: Point
    direction_rad: float = 0.0
    turns: bool = False


def point_of_application(scene: Scene, load: Load) -> PointOfApplication:
    """Return the point of a load. A block without mass is no body: it transfers a force to the body
    pinned to it, and a torque to its guide. Raises EngineError for a force on a block without mass,
    along a moving guide."""
    slot = _block_without_mass(scene, load.body)
    if slot is None:
        if load.point is None:
            return PointOfApplication(load.body, joints.centre_of(scene, load.body))
        place = joints.local_point(scene, load.body, load.point)
        return PointOfApplication(load.body, place, load.direction_rad, load.frame == "body")
    slider = slot.slider
    if load.point is None:
        return PointOfApplication(slider.on, slider.through_m)
    carrier = joints.riding_body(slot)
    place, direction = joints.local_point(scene, carrier, slider.point), load.direction_rad
    if load.frame == "body":
        if slider.on != GROUND:
            raise EngineError(
                f"loads.{load.name}: slider {slider.name} is a block without mass, which is no "
                f"body in MuJoCo, so a force along its guide, {slider.on}, cannot be held; give "
                f"sliders.{slider.name} a mass_kg above 0, or the force in the ground's frame"
            )
        direction += slider.direction_rad
    return PointOfApplication(carrier, place, direction)


def _block_without_mass(scene: Scene, body: str) -> joints.Slot | None:
    slots = joints.joints(scene).slots
    return next((slot for slot in slots if joints.block_name(slot.slider) == body), None)


def load_sites(scene: Scene, body: str) -> list[AttributeRow]:
    """Return the sites for the loads of a body, and on the ground the site of its axes."""
    rows: list[AttributeRow] = []
    acting = [(load, point_of_application(scene, load)) for load in scene.loads.values()]
    if body == GROUND and any(_needs_axes(load, at) for load, at in acting):
        rows.append({"name": AXES})
    return rows + [
        {"name": _name(load), "pos": (*at.place, 0.0)} for load, at in acting if at.body == body
    ]


def _needs_axes(load: Load, at: PointOfApplication) -> bool:
    return load.point is not None and not at.turns


def _name(load: Load) -> str:
    """Name of its actuator and its site; no other name of a scene has a space there."""
    return f"load {load.name}"


def load_actuators(scene: Scene) -> list[str]:
    """Write the actuators, in the order of the loads.

    A force acts at a site of its body, along the axes of that site or, by ``refsite``, of the
    ground; a torque likewise. `mj_rnePostConstraint` does not count such actuators as external
    forces: a reader of reactions has to subtract them.
    """
    if not scene.loads:
        return []
    lines = [
        "    <!-- loads: the control of each is its size [N or N m]. The keyframe has those of -->",
        "    <!-- the start; load it, as without it all controls are 0 and no load acts. -->",
    ]
    for load in scene.loads.values():
        if not isinstance(load.characteristic, Constant) or load.stroke != "both":
            lines += _not_in_the_file(load)
        at = point_of_application(scene, load)
        row: AttributeRow = {"name": _name(load), "site": _name(load)}
        if load.point is None:
            row["gear"] = (0, 0, 0, 0, 0, 1)
        else:
            if _needs_axes(load, at):
                row["refsite"] = AXES
            row["gear"] = (*joints.turned((1.0, 0.0), at.direction_rad), 0, 0, 0, 0)
        lines.append(f"    <motor{attributes(row)}/>")
    return lines


def _not_in_the_file(load: Load) -> list[str]:
    course = "" if isinstance(load.characteristic, Constant) else f" over the {load.over}"
    stroke = "" if load.stroke == "both" else f" on the {load.stroke} stroke"
    slider = "" if load.slider is None else f" of {load.slider}"
    return [
        f"    <!-- {commentable(load.name)}: its course{course}{stroke}{slider} is not in this -->",
        "    <!-- file: it comes as the control of each step. -->",
    ]


def load_sizes(scene: Scene, state: State) -> tuple[float, ...]:
    """Return the sizes of the loads in a state [N or N m]."""
    theta = driver_place_in(scene, state)
    sliding = {name: (s, state.speed[name]) for name, s in state.displacement.items()}
    return tuple(
        load.size(state.time_s, theta, sliding, state.omega.get(load.body, 0.0))
        for load in scene.loads.values()
    )


@dataclass(frozen=True)
class SpringTendon:
    """The tendon of a spring, whose q is ``sense`` times the length of the tendon plus ``shift``.

    ``joints`` are the joints whose coordinates it adds up, with their signs, or a single joint with
    factor 0; none for a spring between points. ``sense`` is -1 where the slack length would be
    negative otherwise: MuJoCo takes -1 for "as the model stands".
    """

    spring: Spring
    joints: tuple[tuple[str, int], ...] = ()
    shift: float = 0.0
    sense: int = 1

    @property
    def name(self) -> str:
        """Name of the tendon; a scene's own names hold no space."""
        return f"spring {self.spring.name}"

    @property
    def slack_length(self) -> float:
        """Length [m or rad] of the tendon at which the spring is slack."""
        return self.sense * (self.spring.free - self.shift)


def spring_tendons(scene: Scene, state: State, tree: Tree) -> tuple[SpringTendon, ...]:
    """Plan the tendons, in the order of the springs; angles in pins belong to ``state``.

    Between two points a tendon runs from site to site, and its length is their distance. In a pin
    or along a slider it is a sum of joint coordinates: the angle of one body against another is the
    sum of the angles on the way between them through the tree, so that a pin that closes a loop
    also has its spring. The file is complete for springs.
    """
    return tuple(_tendon(spring, state, tree) for spring in scene.springs.values())


def _tendon(spring: Spring, state: State, tree: Tree) -> SpringTendon:
    if isinstance(spring, LineSpring):
        return SpringTendon(spring)
    if isinstance(spring, PinSpring):
        (first, before), (second, after) = (turning(tree, body) for body in spring.bodies)
        signs = {name: 1 for name in second if name not in first}
        signs |= {name: -1 for name in first if name not in second}
        start, end = (0.0 if b == GROUND else state.theta[b] for b in spring.bodies)
        shift = after - before + joints.whole_turns(spring, end - start)
    else:
        signs, shift = {sliding_joint(tree.limbs, spring.slider): 1}, 0.0
    if not signs:  # they never turn against each other, but a tendon needs a joint
        signs = {next(freedom.name for limb in tree.limbs for freedom in limb.freedoms): 0}
    slack = spring.free - shift
    sense = -1 if slack < 0.0 else 1
    signed = tuple((name, sense * sign) for name, sign in signs.items())
    return SpringTendon(spring, signed, shift, sense)


def turning(tree: Tree, body: str) -> tuple[list[str], float]:
    """Return the hinges whose coordinates add up to the angle of a body, and the angle [rad] that
    bodies without a hinge add to them."""
    limbs = {limb.body: limb for limb in tree.limbs}
    hinges, angle = list[str](), 0.0
    while body != GROUND:
        limb = limbs[body]
        own = [freedom.name for freedom in limb.freedoms if freedom.kind == "hinge"]
        hinges += own
        angle += 0.0 if own else limb.angle_rad
        body = limb.parent
    return hinges, angle


def sliding_joint(limbs: Sequence[Limb], slider: str) -> str:
    """Return the joint for the displacement of a slider; all slides are in the tree."""
    freedoms = next(limb.freedoms for limb in limbs if limb.slider and limb.slider.name == slider)
    return next(freedom.name for freedom in freedoms if freedom.kind == "slide")


def spring_points(scene: Scene, body: str) -> list[str]:
    """Return the points of a body from which springs run to others."""
    return [
        point
        for spring in scene.springs.values()
        if isinstance(spring, LineSpring)
        for point, (carrier, _) in zip(spring.points, joints.line_ends(scene, spring), strict=True)
        if carrier == body
    ]


def spring_lines(scene: Scene, tendons: tuple[SpringTendon, ...]) -> list[str]:
    """Write the tendons of springs; none for a scene without."""
    lines = [
        "    <!-- Springs: each pulls with stiffness (length - springlength) + damping rate. -->",
    ]
    for tendon in tendons:
        lines += _tendon_lines(scene, tendon)
    return lines if tendons else []


def _tendon_lines(scene: Scene, tendon: SpringTendon) -> list[str]:
    spring = tendon.spring
    row: AttributeRow = {"name": tendon.name, "stiffness": spring.rate, "damping": spring.damping}
    row["springlength"] = tendon.slack_length
    if isinstance(spring, LineSpring):
        kind, part = "spatial", "site"
        ends = zip(spring.points, joints.line_ends(scene, spring), strict=True)
        parts: list[AttributeRow] = [{"site": f"{body}.{point}"} for point, (body, _) in ends]
    else:
        kind, part = "fixed", "joint"
        parts = [{"joint": name, "coef": sign} for name, sign in tendon.joints]
    return [
        f"    <{kind}{attributes(row)}>",
        *(f"      <{part}{attributes(each)}/>" for each in parts),
        f"    </{kind}>",
    ]


def planned(
    scene: Scene, state: State, close: str | Sequence[str] = (), *, delay_s: float = 0.0
) -> Tree:
    """Plan the tree of a scene, with all joints with friction in it.

    Engines have constant friction (MuJoCo's ``frictionloss``) in hinges and slides of the tree;
    loop closures have none. So loops close at pins without friction. Raises EngineError as
    `models.mjcf.tree.plan`, and where every way to close the loops takes a pin with friction.
    """
    tree = plan(scene, state, close, delay_s=delay_s)
    rubbing = [one.joint for one in scene.friction.values() if one.joint not in scene.sliders]
    at_closures = [point for point in rubbing if _closes(tree, point)]
    if not at_closures:
        return tree
    if not close:
        for others in closings(scene, state):
            other = plan(scene, state, others, delay_s=delay_s)
            if not any(_closes(other, point) for point in rubbing):
                return other
    where = ", ".join(at_closures)
    raise EngineError(
        f"close = {where}: a pin that closes a loop of {scene.name} has no friction here, and "
        f"friction.{at_closures[0]} requires it; leave a pin of that loop without friction, and "
        "close there"
    )


def _closes(tree: Tree, point: str) -> bool:
    return any(closure.point == point for closure in tree.closures)


def rubbing_freedom(scene: Scene, limb: Limb, joint: str) -> Freedom | None:
    """Return the freedom of a limb for the named pin or slider; None if it has none."""
    if joint in scene.sliders:
        kind, fits = "slide", limb.slider is not None and limb.slider.name == joint
    else:
        kind, fits = "hinge", limb.point == joint
    return next((each for each in limb.freedoms if fits and each.kind == kind), None)


def friction_of(scene: Scene, limb: Limb, freedom: Freedom, writing: Writing) -> AttributeRow:
    """Return the attributes of a joint with friction, as stiff as the step allows; else none.
    Raises EngineError for Coulomb's friction, which MuJoCo has in contacts only."""
    for name, one in scene.friction.items():
        if rubbing_freedom(scene, limb, one.joint) is not freedom:
            continue
        if not isinstance(one, ConstantFriction):
            raise EngineError(
                f"friction.{name}: a joint of MuJoCo has only constant friction, none that "
                "grows with its reaction; give torque_n_m or force_n in place of mu, or use "
                "the reference alone"
            )
        row: AttributeRow = {"frictionloss": one.size}
        for key, value in (writing.rubbing or writing.connect).items():
            row[f"{key}friction"] = value
        return row
    return {}
