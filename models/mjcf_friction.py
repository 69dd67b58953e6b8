"""Friction of joints in the MJCF text, and the tree that it asks for.

MuJoCo has friction that is constant (``frictionloss``), in hinges and slides of the tree; a
connect, which closes a loop, has none. So loops close at pins that do not rub.
"""

from __future__ import annotations

from models.closings import closings
from models.errors import EngineError
from models.friction import ConstantFriction
from models.mjcf_options import Writing
from models.mjcf_text import AttributeRow
from models.motion import State
from models.scene import Scene
from models.tree import Freedom, Limb, Tree, plan


def planned(scene: Scene, state: State, writing: Writing) -> Tree:
    """The tree of a scene, with all joints that rub in it.

    Raises
    ------
    EngineError
        As `models.tree.plan`; where each way to close the loops closes one at a pin that rubs.
    """
    tree = plan(scene, state, writing.close, delay_s=writing.delay_s)
    rubbing = [one.joint for one in scene.friction.values() if one.joint not in scene.sliders]
    at_closures = [point for point in rubbing if _closes(tree, point)]
    if not at_closures:
        return tree
    if not writing.close:
        for close in closings(scene, state):
            other = plan(scene, state, close, delay_s=writing.delay_s)
            if not any(_closes(other, point) for point in rubbing):
                return other
    where = ", ".join(at_closures)
    raise EngineError(
        f"close = {where}: a pin that closes a loop of {scene.name} in MuJoCo has no friction, and "
        f"friction.{at_closures[0]} asks for it; leave a pin of that loop without, and close there"
    )


def _closes(tree: Tree, point: str) -> bool:
    return any(closure.point == point for closure in tree.closures)


def rubbing_freedom(scene: Scene, limb: Limb, joint: str) -> Freedom | None:
    """The freedom of a limb that is the pin or slider named; None where it has no such."""
    if joint in scene.sliders:
        kind, fits = "slide", limb.slider is not None and limb.slider.name == joint
    else:
        kind, fits = "hinge", limb.point == joint
    return next((each for each in limb.freedoms if fits and each.kind == kind), None)


def friction_of(scene: Scene, limb: Limb, freedom: Freedom, writing: Writing) -> AttributeRow:
    """The attributes of a joint that rubs, as stiff as the step allows; none for another.

    Raises
    ------
    EngineError
        Coulomb's friction, which MuJoCo has in contacts alone.
    """
    for name, one in scene.friction.items():
        if rubbing_freedom(scene, limb, one.joint) is not freedom:
            continue
        if not isinstance(one, ConstantFriction):
            raise EngineError(
                f"friction.{name}: a joint of MuJoCo has constant friction alone, not one that "
                "grows with its reaction; give torque_n_m or force_n in place of mu, or use the "
                "reference alone"
            )
        row: AttributeRow = {"frictionloss": one.size}
        for key, value in (writing.rubbing or writing.connect).items():
            row[f"{key}friction"] = value
        return row
    return {}
