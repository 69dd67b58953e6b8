"""Gears of a scene in its MJCF text: a fixed tendon over hinges for each pair, kept at its length.

An ``equality/joint`` couples two coordinates. A pair on a moving carrier has three bodies, and an
angle is the sum of the hinges on the way to a body (`models.mjcf.forces`): a tendon takes them all.
Its length is the slip of the pitch circles [m], so that a loop and a mesh are alike in softness.
"""

from collections.abc import Iterator

from models.mjcf.forces import turning
from models.mjcf.options import AttributeRow, attributes
from models.mjcf.tree import Tree
from models.scene import Scene


def gear_tendons(scene: Scene, tree: Tree) -> Iterator[str]:
    """Write the tendons of the gears."""
    for gear in scene.gears.values():
        factors: dict[str, int] = {}
        for body, factor in gear.relation.items():
            for hinge in turning(tree, body)[0]:
                factors[hinge] = factors.get(hinge, 0) + factor
        arm = gear.slip_m(scene.points_of)
        yield f"    <fixed{attributes({'name': gear.joint})}>"
        for hinge, factor in factors.items():
            if factor:
                row: AttributeRow = {"joint": hinge, "coef": arm * factor}
                yield f"      <joint{attributes(row)}/>"
        yield "    </fixed>"


def gear_equalities(scene: Scene) -> Iterator[str]:
    """Write the equalities that keep the tendons of the gears at their length."""
    for gear in scene.gears.values():
        yield f"    <tendon{attributes({'name': gear.joint, 'tendon1': gear.joint})}/>"
