"""The closure of a scheme's loops in the freedoms of its joints, and what it leaves of them.

A tree of joints places every link from the ground; each joint that is not of the tree closes a
loop, which is as many equations as the plane or space has freedoms. With f freedoms of joints and
L loops the count is f - 3 L or f - 6 L, the same as 3 n - 2 p5 - p4 and 6 n - sum k p_k, and the
mobility at a position f - rank of the equations' derivative.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from analytic.lectures.schemes.drawing_frame import DrawingFrame
from analytic.lectures.schemes.joint_chains import Element, chain_of
from analytic.lectures.schemes.screws import DEPENDENT, carried, displaced, gap, kernel
from models.array import Array
from models.errors import StructureError
from models.lectures.scheme import Scheme, SchemeJoint
from models.scene import GROUND

IN_PLANE = [2, 3, 4]
"""Of a twist, what moves in the plane."""


@dataclass(frozen=True)
class Placed:
    """A link: its pose (4, 4) from the drawn one, and its twist for each freedom (6, f)."""

    pose: Array
    twists: Array


@dataclass(frozen=True)
class Loops:
    """A scheme's joints in ``frame``, its tree, and the joints that close loops."""

    scheme: Scheme
    frame: DrawingFrame
    chains: Mapping[str, tuple[Element, ...]]
    columns: Mapping[str, range]
    tree: tuple[tuple[SchemeJoint, str, str], ...]
    closing: tuple[SchemeJoint, ...]
    freedoms: int

    @classmethod
    def of(cls, scheme: Scheme, frame: DrawingFrame | None = None) -> Loops:
        """The loops of a scheme. Raises StructureError where a link hangs on nothing."""
        if loose := scheme.loose():
            raise StructureError(f"{scheme.name}: no row of joints leads to {', '.join(loose)}")
        frame = frame or DrawingFrame.of(scheme)
        chains = {joint.name: chain_of(frame.joint(joint)) for joint in scheme.joints}
        columns, used = {}, 0
        for joint in scheme.joints:
            count = scheme.freedoms(joint)
            columns[joint.name], used = range(used, used + count), used + count
        tree, closing = _spanned(scheme)
        return cls(scheme, frame, chains, columns, tree, closing, used)

    def placed(self, q: Array) -> dict[str, Placed]:
        """Every link as the joints of the tree place it, their freedoms at ``q`` (f,)."""
        links = {GROUND: Placed(np.eye(4), np.zeros((6, self.freedoms)))}
        for joint, known, link in self.tree:
            links[link] = self._beyond(joint, known, links[known], q)
        return links

    def closure(self, q: Array) -> tuple[Array, Array]:
        """How far each loop is from closed (k,), and the derivative of that (k, f)."""
        links = self.placed(q)
        rows = IN_PLANE if self.scheme.dimension == 3 else list(range(6))
        open_by, slopes = [np.zeros(0)], [np.zeros((0, self.freedoms))]
        for joint in self.closing:
            first, second = joint.between
            there = self._beyond(joint, first, links[first], q)
            open_by.append(gap(there.pose @ _inverse(links[second].pose))[rows])
            slopes.append((there.twists - links[second].twists)[rows])
        return np.concatenate(open_by), np.concatenate(slopes)

    def moves(self, q: Array, share: float = DEPENDENT) -> Array:
        """The motions of the joints' freedoms that keep all loops closed at ``q``: (f, d).

        What opens the loops by less than a ``share`` of what does most is one of them."""
        return kernel(self.closure(q)[1], share)

    def margin(self, q: Array) -> float:
        """The least of what holds: the smallest singular value of the closure that is not 0, over
        the largest."""
        values = np.linalg.svd(self.closure(q)[1])[1] if self.closing else np.ones(1)
        kept = values[values > DEPENDENT * values[0]]
        return float(kept[-1] / kept[0]) if len(kept) else 1.0

    def joint_twists(self, q: Array) -> dict[str, Array]:
        """What each joint leaves at ``q``, as twists (6, f of the joint)."""
        links = self.placed(q)
        return {
            joint.name: self._beyond(
                joint,
                joint.between[0],
                Placed(links[joint.between[0]].pose, 0 * links[GROUND].twists),
                q,
            ).twists[:, self.columns[joint.name]]
            for joint in self.scheme.joints
        }

    def part(self, scheme: Scheme, q: Array) -> tuple[Loops, Array]:
        """The loops of a scheme with fewer joints, and what of ``q`` is theirs."""
        loops = Loops.of(scheme, self.frame)
        kept = [column for joint in scheme.joints for column in self.columns[joint.name]]
        return loops, q[kept]

    def _beyond(self, joint: SchemeJoint, known: str, link: Placed, q: Array) -> Placed:
        """Where a joint puts the link on its other side than ``known``."""
        first = self.columns[joint.name].start
        backward = known != joint.between[0]
        chain = self.chains[joint.name]
        pose, twists = link.pose, link.twists.copy()
        for element in reversed(chain) if backward else chain:
            column = first + element.freedom
            factor = -element.factor if backward else element.factor
            twists[:, column] += factor * carried(pose, element.twist)
            pose = pose @ displaced(element.twist, factor * q[column])
        return Placed(pose, twists)


def _spanned(
    scheme: Scheme,
) -> tuple[tuple[tuple[SchemeJoint, str, str], ...], tuple[SchemeJoint, ...]]:
    """The joints of a tree from the ground, each with the link it hangs on and the one that it
    places, and the joints that are left."""
    known, tree, used = [GROUND], [], set()
    for link in known:  # grows while it is gone through
        for joint in scheme.joints_of(link):
            other = joint.between[joint.between[0] == link]
            if other not in known:
                known.append(other)
                tree.append((joint, link, other))
                used.add(joint.name)
    return tuple(tree), tuple(joint for joint in scheme.joints if joint.name not in used)


def _inverse(pose: Array) -> Array:
    turn, place = pose[:3, :3], pose[:3, 3]
    back = np.eye(4)
    back[:3, :3], back[:3, 3] = turn.T, -turn.T @ place
    return back
