"""The springs of a scene in its MJCF text: a tendon each, with stiffness and damping of its own.

Between two points it runs from site to site, and its length is their distance. In a pin or along a
slider it is a sum of joint coordinates: the angle of one body against another is the sum of the
angles on the way between them through the tree, so that a pin has its spring also where it closes a
loop. Springs are all in the file: it needs nothing beside.
"""

from __future__ import annotations

from dataclasses import dataclass

from models.mjcf_text import AttributeRow, attributes
from models.motion import State
from models.scene import GROUND, Scene
from models.spring_ends import line_ends, whole_turns
from models.springs import LineSpring, PinSpring, Spring
from models.tree import Limb, Tree


@dataclass(frozen=True)
class SpringTendon:
    """The tendon of a spring, whose q is ``sense`` times the length of the tendon plus ``shift``.

    ``joints`` are those whose coordinates it adds up, with their signs, or one that it adds 0
    times; none where it runs between points. ``sense`` is -1 where the length at which it is slack
    would be negative otherwise: MuJoCo takes -1 for "as the model stands".
    """

    spring: Spring
    joints: tuple[tuple[str, int], ...] = ()
    shift: float = 0.0
    sense: int = 1

    @property
    def name(self) -> str:
        """A scene's own names hold no space."""
        return f"spring {self.spring.name}"

    @property
    def slack_length(self) -> float:
        """The length [m or rad] of the tendon at which the spring is slack."""
        return self.sense * (self.spring.free - self.shift)


def spring_tendons(scene: Scene, state: State, tree: Tree) -> tuple[SpringTendon, ...]:
    """The tendons, in the order of the springs; angles in pins are those at ``state``."""
    return tuple(_tendon(spring, state, tree) for spring in scene.springs.values())


def _tendon(spring: Spring, state: State, tree: Tree) -> SpringTendon:
    if isinstance(spring, LineSpring):
        return SpringTendon(spring)
    if isinstance(spring, PinSpring):
        (first, before), (second, after) = (_turning(tree, body) for body in spring.bodies)
        signs = {name: 1 for name in second if name not in first}
        signs |= {name: -1 for name in first if name not in second}
        start, end = (0.0 if b == GROUND else state.theta[b] for b in spring.bodies)
        shift = after - before + whole_turns(spring, end - start)
    else:
        signs, shift = {_sliding(tree, spring.slider): 1}, 0.0
    if not signs:  # they never turn against each other; a tendon asks for a joint all the same
        signs = {next(freedom.name for limb in tree.limbs for freedom in limb.freedoms): 0}
    sense = -1 if spring.free < shift else 1
    joints = tuple((name, sense * sign) for name, sign in signs.items())
    return SpringTendon(spring, joints, shift, sense)


def _turning(tree: Tree, body: str) -> tuple[list[str], float]:
    """The hinges whose coordinates add up to the angle of a body, and the angle [rad] that bodies
    without a hinge add to them."""
    limbs = {limb.body: limb for limb in tree.limbs}
    hinges, angle = list[str](), 0.0
    while body != GROUND:
        limb = limbs[body]
        own = [freedom.name for freedom in limb.freedoms if freedom.kind == "hinge"]
        hinges += own
        angle += 0.0 if own else limb.angle_rad
        body = limb.parent
    return hinges, angle


def _sliding(tree: Tree, slider: str) -> str:
    """The joint that is the displacement of a slider; all slides are in the tree."""

    def slides(limb: Limb) -> bool:
        return limb.slider is not None and limb.slider.name == slider

    limb = next(limb for limb in tree.limbs if slides(limb))
    return next(freedom.name for freedom in limb.freedoms if freedom.kind == "slide")


def spring_points(scene: Scene, body: str) -> list[str]:
    """The points of a body from which springs run to others."""
    return [
        point
        for spring in scene.springs.values()
        if isinstance(spring, LineSpring)
        for point, (carrier, _) in zip(spring.points, line_ends(scene, spring), strict=True)
        if carrier == body
    ]


def tendon_lines(scene: Scene, tendons: tuple[SpringTendon, ...]) -> list[str]:
    """The section of the tendons; none for a scene without springs."""
    if not tendons:
        return []
    lines = [
        "  <tendon>",
        "    <!-- Springs: each pulls with stiffness (length - springlength) + damping rate. -->",
    ]
    for tendon in tendons:
        lines += _tendon_lines(scene, tendon)
    return [*lines, "  </tendon>"]


def _tendon_lines(scene: Scene, tendon: SpringTendon) -> list[str]:
    """The element of a tendon with its sites or joints."""
    spring = tendon.spring
    row: AttributeRow = {"name": tendon.name, "stiffness": spring.rate, "damping": spring.damping}
    row["springlength"] = tendon.slack_length
    if isinstance(spring, LineSpring):
        kind, part = "spatial", "site"
        ends = zip(spring.points, line_ends(scene, spring), strict=True)
        parts: list[AttributeRow] = [{"site": f"{body}.{point}"} for point, (body, _) in ends]
    else:
        kind, part = "fixed", "joint"
        parts = [{"joint": name, "coef": sign} for name, sign in tendon.joints]
    return [
        f"    <{kind}{attributes(row)}>",
        *(f"      <{part}{attributes(each)}/>" for each in parts),
        f"    </{kind}>",
    ]
