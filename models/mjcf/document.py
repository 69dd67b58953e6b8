"""The MJCF text of a scene for MuJoCo: one body per link, assembled, loops closed at pins.

The mechanism lies in the x-y plane and every hinge turns about z. Bodies are placed by the given
state; ``ref`` of each joint makes its coordinate read as the angle against the parent body, or as
the displacement of the slider. Each loop is closed by an ``equality/connect`` between two sites,
one on each body at that body's own coordinates of the point, so link lengths are exact. The
assembled state is the keyframe ``assembled``.

A massless slider block needs no body: the body pinned to it carries a slide and a hinge. The crank
is driven by a flywheel: an ``armature`` on its hinge so heavy that the mechanism cannot change its
speed. A law other than constant speed comes as a control stream: the motor's control is the angular
acceleration of the crank. Loads are actuators too, joints have constant friction, springs are
tendons (`models.mjcf.forces`).
"""

from xml.sax.saxutils import quoteattr

from models.errors import EngineError
from models.mjcf import forces, higher_pairs, options
from models.mjcf.options import AttributeRow, Attributes, Writing, attributes
from models.mjcf.tree import Limb, Tree, driven_freedom
from models.motion import State
from models.scene import GROUND, Scene
from models.scene.driver import Controlled, driver_rates
from models.scene.joints import bodies, centre_of, local_point, mass_of

LEAST_MASS = 1e-15
"""MuJoCo refuses moving bodies with a mass [kg] or inertia [kg m^2] below this (mjMINVAL)."""


def build(
    scene: Scene, state: State, writing: Writing | None = None, tree: Tree | None = None
) -> str:
    """Write the MJCF text of ``scene`` assembled at ``state``; the same input gives the same text.

    The default ``writing`` is `exact`, which runs as it is in any MuJoCo at constant speed; another
    law needs its control at each step. ``tree`` is a tree planned before.

    Raises EngineError for a body without mass, a controlled driver, a slider that needs a mass, or
    a pin in ``close`` that closes no loop; a load or friction that MuJoCo cannot have there.
    """
    _check_masses(scene)
    _check_driver(scene)
    writing = options.exact(scene) if writing is None else writing
    tree = tree or forces.planned(scene, state, writing.close, delay_s=writing.delay_s)
    lines = [
        f"<mujoco model={quoteattr(scene.name)}>",
        f"  <!-- {options.commentable(scene.source)} -->",
        "  <!-- Planar: in the x-y plane, hinges turn about z. SI units, angles in rad. -->",
        '  <compiler angle="radian" inertiafromgeom="false"/>',
        *_options(scene, writing),
        *_defaults(scene, writing),
        *_world(scene, tree, writing),
        *_equality(scene, tree),
        *_tendons(scene, state, tree),
        *_actuator(scene, tree, writing),
        *_keyframe(scene, state, tree, writing),
        "</mujoco>",
    ]
    return "\n".join(lines) + "\n"


def _check_masses(scene: Scene) -> None:
    for body in bodies(scene):
        mass, inertia = mass_of(scene, body)
        if mass < LEAST_MASS or inertia < LEAST_MASS:
            raise EngineError(
                f"{body}: mass_kg {mass:g}, inertia_kg_m2 {inertia:g}; MuJoCo moves no body with "
                f"less than {LEAST_MASS:g} of either, give both"
            )


def _check_driver(scene: Scene) -> None:
    """Refuse a controlled driver, which yields: the model prescribes the motion at any torque."""
    if isinstance(scene.driver.law, Controlled):
        raise EngineError(
            f"{scene.name}: its driver is controlled, and this model would keep its speed "
            'exactly; use law = "constant"'
        )


def _options(scene: Scene, writing: Writing) -> list[str]:
    """Write the solver options, always with gravity, as MuJoCo's default is the earth's."""
    gravity = (*scene.gravity_m_s2, 0.0)
    own = attributes({"gravity": gravity} | dict(writing.option))
    if not writing.flag:
        return [f"  <option{own}/>"]
    return [f"  <option{own}>", f"    <flag{attributes(writing.flag)}/>", "  </option>"]


def _defaults(scene: Scene, writing: Writing) -> list[str]:
    """Write the defaults: hinges about z; capsules without contact and mass."""
    thin = 0.012 * scene.longest_m
    seen: Attributes = {"type": "capsule", "size": thin, "contype": 0, "conaffinity": 0, "mass": 0}
    lines = [
        "  <default>",
        f'    <geom{attributes(seen)} rgba="0.35 0.5 0.65 1"/>',
        f'    <site{attributes({"size": 1.5 * thin})} rgba="0.8 0.3 0.2 1"/>',
        '    <joint axis="0 0 1"/>',
    ]
    if writing.connect:
        lines.append(f"    <equality{attributes(writing.connect)}/>")
    return [*lines, "  </default>"]


def _world(scene: Scene, tree: Tree, writing: Writing) -> list[str]:
    """Write the bodies, children inside their parents, and the sites of the closing pins."""
    lines = [
        "  <worldbody>",
        "    <!-- Bodies stand assembled; ref lets hinges read as angles against the parent. -->",
    ]
    if writing.flywheel:
        lines.append("    <!-- The crank's armature is a flywheel: it prescribes the speed. -->")
    lines += _sites(scene, tree, GROUND, "    ")
    lines += _children(scene, tree, writing, GROUND, "    ")
    return [*lines, "  </worldbody>"]


def _children(scene: Scene, tree: Tree, writing: Writing, parent: str, pad: str) -> list[str]:
    lines: list[str] = []
    for limb in (limb for limb in tree.limbs if limb.parent == parent):
        place: AttributeRow = {"name": limb.body, "pos": (*limb.offset, 0.0)}
        if limb.angle_rad:
            place["euler"] = (0.0, 0.0, limb.angle_rad)
        lines.append(f"{pad}<body{attributes(place)}>")
        lines += _freedoms(scene, tree, limb, writing, pad + "  ")
        lines += _matter(scene, limb.body, pad + "  ")
        soft = higher_pairs.touching(scene, limb.body, writing.connect)
        lines += [f"{pad}  {each}" for each in soft]
        lines += _sites(scene, tree, limb.body, pad + "  ")
        lines += _children(scene, tree, writing, limb.body, pad + "  ")
        lines.append(f"{pad}</body>")
    return lines


def _freedoms(scene: Scene, tree: Tree, limb: Limb, writing: Writing, pad: str) -> list[str]:
    """Write the joints of a body; the driven joint carries the flywheel."""
    lines, (driven, _) = [], driven_freedom(scene, tree.limbs)
    for freedom in limb.freedoms:
        row: AttributeRow = {"name": freedom.name}
        if freedom.kind == "slide":
            row |= {"type": "slide", "axis": (*freedom.axis, 0.0)}
        else:
            row |= {"type": "hinge", "pos": (*freedom.anchor, 0.0)}
        row["ref"] = freedom.ref
        if freedom.name == driven and writing.flywheel:
            row["armature"] = options.armature(scene, writing)
        row |= forces.friction_of(scene, limb, freedom, writing)
        lines.append(f"{pad}<joint{attributes(row)}/>")
    return lines


def _matter(scene: Scene, body: str, pad: str) -> list[str]:
    """Write the mass, and capsules to look at. All three moments of inertia equal the one about z:
    only it matters in the plane, and MuJoCo refuses the flat bodies that would be exact."""
    mass, inertia = mass_of(scene, body)
    row: AttributeRow = {"pos": (*centre_of(scene, body), 0.0), "mass": mass}
    row["diaginertia"] = (inertia, inertia, inertia)
    lines = [f"{pad}<inertial{attributes(row)}/>"]
    if body not in scene.links:
        side = 0.04 * scene.longest_m
        return [*lines, f"{pad}<geom{attributes({'type': 'box', 'size': (side, side, side)})}/>"]
    points = list(scene.links[body].points.values())
    bars: list[AttributeRow] = [{"fromto": (*points[0], 0.0, *end, 0.0)} for end in points[1:]]
    return lines + [f"{pad}<geom{attributes(bar)}/>" for bar in bars]


def _sites(scene: Scene, tree: Tree, body: str, pad: str) -> list[str]:
    """Write the sites of a body for loop closures and spring ends, each at the body's own
    coordinates of the point, and for loads."""
    closing = [c.point for c in tree.closures if body in c.bodies]
    points = dict.fromkeys([*closing, *forces.spring_points(scene, body)])
    rows: list[AttributeRow] = [
        {"name": f"{body}.{point}", "pos": (*local_point(scene, body, point), 0.0)}
        for point in points
    ]
    return [f"{pad}<site{attributes(row)}/>" for row in [*rows, *forces.load_sites(scene, body)]]


def _equality(scene: Scene, tree: Tree) -> list[str]:
    rows = [
        {"name": f"{c.point}: {c.bodies[0]} to {c.bodies[1]}"}
        | {f"site{i}": f"{body}.{c.point}" for i, body in enumerate(c.bodies, start=1)}
        for c in tree.closures
    ]
    lines = [f"    <connect{attributes(row)}/>" for row in rows]
    why = (
        "    <!-- Each loop is closed at one pin, by the copies of the point on its two bodies. -->"
    )
    lines = [*([why] if lines else []), *lines, *higher_pairs.equalities(scene, tree)]
    return ["  <equality>", *lines, "  </equality>"] if lines else []


def _tendons(scene: Scene, state: State, tree: Tree) -> list[str]:
    springs = forces.spring_lines(scene, forces.spring_tendons(scene, state, tree))
    lines = [*springs, *higher_pairs.pair_tendons(scene, tree)]
    return ["  <tendon>", *lines, "  </tendon>"] if lines else []


def _actuator(scene: Scene, tree: Tree, writing: Writing) -> list[str]:
    """Write the servo, or the motor for a law other than constant speed; then the loads."""
    lines = [*_drive(scene, tree, writing), *forces.load_actuators(scene)]
    return ["  <actuator>", *lines, "  </actuator>"] if lines else []


def _drive(scene: Scene, tree: Tree, writing: Writing) -> list[str]:
    if not options.has_control(scene, writing):
        return []
    driven, sense = driven_freedom(scene, tree.limbs)
    joint: AttributeRow = {"name": "drive", "joint": driven}
    if writing.servo_gain is not None:
        row = joint | {"kv": writing.servo_gain / scene.driver_arm_m**2}
        backwards: AttributeRow = {"gear": sense} if sense < 0.0 else {}
        what = ("angular velocity of the crank", "rad/s")
        what = what if scene.driver.slider is None else ("speed of the driven slider", "m/s")
        return [
            f"    <!-- control: {what[0]} [{what[1]}] -->",
            f"    <velocity{attributes(row | backwards)}/>",
        ]
    what = ("angular acceleration of the crank", "rad/s^2")
    what = what if scene.driver.slider is None else ("acceleration of the slider", "m/s^2")
    return [
        "    <!-- The driver's law is not in this file: it comes as the control of each -->",
        f"    <!-- step, the {what[0]} [{what[1]}]. Without it the -->",
        "    <!-- crank keeps the acceleration of the start and may leave its range. -->",
        f"    <motor{attributes(joint | {'gear': sense * options.armature(scene, writing)})}/>",
    ]


def _keyframe(scene: Scene, state: State, tree: Tree, writing: Writing) -> list[str]:
    """Write the assembled state; the limbs are in the order in which MuJoCo numbers joints."""
    freedoms = [f for limb in tree.limbs for f in limb.freedoms]
    row: AttributeRow = {
        "name": "assembled",
        "qpos": tuple(f.ref for f in freedoms),
        "qvel": tuple(f.rate for f in freedoms),
    }
    controls = forces.load_sizes(scene, state)
    if options.has_control(scene, writing):
        speed, acceleration = driver_rates(scene, state)
        servo = writing.servo_gain is not None
        controls = (speed if servo else acceleration, *controls)
    if controls:
        row["ctrl"] = controls
    return ["  <keyframe>", f"    <key{attributes(row)}/>", "  </keyframe>"]
