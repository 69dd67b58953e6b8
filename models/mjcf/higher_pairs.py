"""Gears and cams of a scene in its MJCF text, as relations of joint coordinates.

A pair of gears is a fixed tendon over hinges, kept at its length: an ``equality/joint`` couples two
coordinates, a pair on a moving carrier has three bodies, and an angle is the sum of the hinges on
the way to a body (`models.mjcf.forces`). Its length is the slip of the pitch circles [m], so that a
loop and a mesh are alike in softness.

A cam is a relation of two tendons: a parabola through its law about the angle of the assembled
state. The parabola is for that angle alone; a program has to set it at each step. MuJoCo takes the
softness of an equality from the inertias of both sides alike, without the slope between them, so
the cam's side is as long as its follower moves at most: its angle in a joint of its own would leave
a light cam hundreds of times too soft. By contact it is a chain of capsules along its facets, and
the follower a sphere or a box, that touch nothing else.
"""

import math
from collections import Counter
from collections.abc import Iterator, Mapping
from itertools import pairwise

from models.errors import EngineError
from models.mjcf.forces import sliding_joint, turning
from models.mjcf.options import AttributeRow, Attributes, attributes
from models.mjcf.tree import Limb, Tree
from models.scene import Scene
from models.scene.cam_contacts import follower_shape
from models.scene.pairs import CamPair


def pair_tendons(scene: Scene, tree: Tree) -> Iterator[str]:
    """Write the tendons of gears, and of cams as a relation. Raises EngineError as `equalities`."""
    for gear in scene.gears.values():
        factors = Counter[str]()
        for body, factor in gear.relation.items():
            factors.update(dict.fromkeys(turning(tree, body)[0], factor))
        arm = gear.slip_m(scene.points_of)
        joints = {name: arm * count for name, count in factors.items() if count}
        yield from _fixed(f"gear {gear.name}", joints)
    for relation in cam_relations(scene, tree):
        yield from _fixed(relation.name, {relation.cam: relation.reach})
        yield from _fixed(f"follower's {relation.name}", {relation.follower: 1.0})


def _fixed(name: str, joints: Mapping[str, float]) -> Iterator[str]:
    """Write a fixed tendon over joints with their coefficients."""
    yield f"    <fixed{attributes({'name': name})}>"
    for joint, coef in joints.items():
        yield f"      <joint{attributes({'joint': joint, 'coef': coef})}/>"
    yield "    </fixed>"


def equalities(scene: Scene, tree: Tree) -> Iterator[str]:
    """Write the equalities of cams, and those that keep the tendons of gears at their length.
    Raises EngineError for a cam or a follower that does not hang on its carrier in the tree."""
    for gear in scene.gears:  # a scene's own names hold no space
        yield f"    <tendon{attributes(dict.fromkeys(('name', 'tendon1'), f'gear {gear}'))}/>"
    for relation in cam_relations(scene, tree):
        row: AttributeRow = {"name": relation.name}
        row |= {"tendon1": f"follower's {relation.name}", "tendon2": relation.name}
        row["polycoef"] = relation.coefficients(relation.cam_ref)
        yield f"    <tendon{attributes(row)}/>"


def touching(scene: Scene, body: str, softness: Attributes) -> Iterator[str]:
    """Write the shapes of a body for its cams by contact, as soft as loops with these attributes.
    Raises EngineError as `follower_shape`."""
    for k, pair in enumerate(scene.cams.values()):
        if not pair.facets or body not in (pair.cam, pair.follower):
            continue
        shape, rows = follower_shape(scene, pair), list[AttributeRow]()
        if body == pair.cam:
            ends = pairwise((*pair.outline, pair.outline[0]))
            rows = [{"fromto": (*a, 0.0, *b, 0.0), "size": shape.skin_m} for a, b in ends]
        elif pair.profile.follower.is_flat:
            (x, y), (ux, uy), half = shape.place, shape.away, shape.reach_m
            off = shape.skin_m + half
            rows = [{"type": "box", "pos": (x + off * ux, y + off * uy, 0.0), "size": 3 * (half,)}]
            rows[0]["euler"] = (0.0, 0.0, math.atan2(-ux, uy))
        else:
            rows = [{"type": "sphere", "pos": (*shape.place, 0.0)}]
            rows[0]["size"] = shape.roller_m - shape.skin_m
        mask = "contype" if body == pair.cam else "conaffinity"
        for row in rows:
            yield f"<geom{attributes({**row, 'condim': 1, **softness, mask: 1 << k})}/>"


def cam_relations(scene: Scene, tree: Tree) -> list["CamRelation"]:
    """Return the relations of the cams that are held by one. Raises EngineError: `equalities`."""
    return [CamRelation(scene, tree, pair) for pair in scene.cams.values() if not pair.facets]


class CamRelation:
    """Relation of the joints of ``cam`` and ``follower``, by name; the coordinates at which MuJoCo
    counts both from 0 are ``cam_ref`` and ``follower_ref``; the tendon of the cam is longer by
    ``reach`` for each rad."""

    def __init__(self, scene: Scene, tree: Tree, pair: CamPair) -> None:
        self.name, self.pair, points = f"cam {pair.name}", pair, scene.points_of
        centre, pivot = pair.pivots(points)
        self.lowest = pair.lowest(points, scene.sliders)
        self.cam = _hinge(tree.limbs, pair.cam, centre, pair.carrier)
        self.follower = (
            sliding_joint(tree.limbs, pair.slider)
            if pair.slider
            else _hinge(tree.limbs, pair.follower, pivot, pair.carrier)
        )
        refs = {own.name: own.ref for limb in tree.limbs for own in limb.freedoms}
        self.cam_ref, self.follower_ref = refs[self.cam], refs[self.follower]
        self.reach = max(map(abs, pair.profile.law.extremes[1]))

    def coefficients(self, at: float, ahead: float = 0.0) -> tuple[float, ...]:
        """Return MuJoCo's five coefficients of the parabola about a coordinate ``at`` of the cam;
        the follower is to be ``ahead`` by so many times the second derivative."""
        value, first, second = self.pair.lift(at)
        x = self.cam_ref - at
        constant = self.lowest + value - self.follower_ref + first * x + 0.5 * second * x * x
        slope, bend = (first + second * x) / self.reach, 0.5 * second / self.reach**2
        return constant + ahead * second, slope, bend, 0.0, 0.0


def _hinge(limbs: tuple[Limb, ...], body: str, point: str, carrier: str) -> str:
    """Return the joint of a body that hangs on its carrier in the tree."""
    for limb in limbs:
        if limb.body == body and limb.parent == carrier and limb.point == point:
            return limb.freedoms[0].name
    raise EngineError(
        f"{body}: its pin {point} to {carrier} closes a loop here, and a cam needs it as a joint; "
        "close the loop at another pin (close = ...)"
    )
