"""A kinematic scheme: links and joints of given class and place, before masses, drivers and loads.

A scheme is drawn in one position, in which all its loops close: every point and axis is given in
the frame of the ground there. It may be planar or spatial.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from models.scene import GROUND

Place = tuple[float, float, float]
"""A point [m] or a direction [-] in space; planar ones have a third coordinate of 0."""
PLANAR, SPATIAL = "planar", "spatial"
FREEDOMS: Mapping[str, Mapping[str, int]] = {
    PLANAR: {"pin": 1, "slider": 1, "contact": 2, "gear": 2},
    SPATIAL: {
        "revolute": 1,
        "prismatic": 1,
        "screw": 1,
        "cylindrical": 2,
        "universal": 2,
        "spherical": 3,
        "planar": 3,
        "ball-in-tube": 4,
        "cylinder-on-plane": 4,
        "ball-on-plane": 5,
    },
}
"""Freedoms of each kind of joint, out of the three of the plane, or the six of space."""
HIGHER = {"contact", "gear", "ball-in-tube", "cylinder-on-plane", "ball-on-plane"}
"""Kinds of joints with contact along a line or in a point."""


@dataclass(frozen=True)
class SchemeJoint:
    """A joint of two links.

    ``at`` is a point of its axis, its centre or the contact point; ``axes`` are its directions: the
    axis, the normal of a plane or of a contact (out of the first link), or two of them. ``radii``
    [m] are the radii of curvature of a planar contact's two profiles, positive if convex, or of two
    pitch circles, negative for inner teeth; ``lead`` [m] is a screw's displacement in a turn;
    ``pressure`` [rad] is the angle of a gear's line of action.
    """

    name: str
    kind: str
    between: tuple[str, str]
    at: Place = (0.0, 0.0, 0.0)
    axes: tuple[Place, ...] = ()
    radii: tuple[float, float] = (0.0, 0.0)
    lead: float = 0.0
    pressure: float = 0.0


@dataclass(frozen=True)
class Scheme:
    """Links and joints, with the mobility by the source, if stated."""

    name: str
    space: str
    source: str
    links: tuple[str, ...]
    joints: tuple[SchemeJoint, ...]
    mobility: int | None = None
    note: str = ""

    @property
    def dimension(self) -> int:
        """The freedoms of a free link: 3 in the plane, 6 in space."""
        return 3 if self.space == PLANAR else 6

    def freedoms(self, joint: SchemeJoint) -> int:
        """Return the number of freedoms of a joint."""
        return FREEDOMS[self.space][joint.kind]

    def joint_class(self, joint: SchemeJoint) -> int:
        """Return the class of a joint: its constraints on two links, out of the six of space."""
        return 6 - self.freedoms(joint)

    @property
    def classes(self) -> Mapping[int, int]:
        """The number of joints by class, the highest class first."""
        counts = Counter(map(self.joint_class, self.joints))
        return {each: counts[each] for each in sorted(counts, reverse=True)}

    @property
    def constraints(self) -> int:
        """Number of constraints of all joints, each counted."""
        return sum(self.dimension - self.freedoms(joint) for joint in self.joints)

    @property
    def count(self) -> int:
        """The mobility by count: 3 n - 2 p5 - p4 in the plane, 6 n - sum k p_k in space."""
        return self.dimension * len(self.links) - self.constraints

    @property
    def count_in_words(self) -> str:
        """The count as text: letters, numbers and result."""
        letters, numbers = [f"{self.dimension} n"], [f"{self.dimension}*{len(self.links)}"]
        classes = (5, 4) if self.space == PLANAR else tuple(self.classes)
        for each in classes:
            factor = each - 6 + self.dimension
            letters.append(f"{factor} p{each}" if factor > 1 else f"p{each}")
            numbers.append(f"{factor}*{self.classes.get(each, 0)}")
        return f"W = {' - '.join(letters)} = {' - '.join(numbers)} = {self.count}"

    def joints_of(self, link: str) -> Iterator[SchemeJoint]:
        """Return the joints of a link."""
        return (joint for joint in self.joints if link in joint.between)

    def neighbours(self, link: str) -> set[str]:
        """Return the links, and the ground, that share a joint with a link."""
        return {each for joint in self.joints_of(link) for each in joint.between} - {link}

    def loose(self) -> list[str]:
        """List the links that no row of joints connects to the ground."""
        reached, waiting = {GROUND}, [GROUND]
        while waiting:
            fresh = self.neighbours(waiting.pop()) - reached
            reached |= fresh
            waiting += fresh
        return [link for link in self.links if link not in reached]

    def without_links(self, *links: str) -> Scheme:
        """Return the scheme without some links and their joints."""
        kept = tuple(link for link in self.links if link not in links)
        joints = tuple(joint for joint in self.joints if not set(links) & set(joint.between))
        return replace(self, links=kept, joints=joints)

    def without_joints(self, *names: str) -> Scheme:
        """Return the scheme without some joints."""
        return replace(self, joints=tuple(each for each in self.joints if each.name not in names))
