"""Closure of a scheme's loops in the freedoms of its joints, and the remaining motions.

A tree of joints places every link from the ground; each joint outside the tree closes a loop, with
as many equations as the plane or space has freedoms. With f freedoms of joints and L loops the
count is f - 3 L or f - 6 L, the same as 3 n - 2 p5 - p4 and 6 n - sum k p_k, and the mobility at a
position f - rank of the equations' derivative.

That rank, which compares turns with displacements, is taken in the drawing's own frame: it is that
on paper, whatever the unit and the place of the drawing.

The rank at the drawn position alone may mislead both ways: links in a line seem to have one more
motion, and a stretched row of bars seems to give way. So the scheme is moved: a step along a motion
that the equations leave, then back to closed loops (Levenberg-Marquardt). A finite motion survives
that; one of first order alone vanishes. The steps start next to the drawn position, in random
directions, so that the result holds in general. Source for the terms: K. H. Hunt, Kinematic
Geometry of Mechanisms, chapter 2 (transitory and full-cycle mobility); the steps are ours.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from analytic.lectures.schemes.joint_chains import Element, chain_of
from analytic.lectures.schemes.screws import DEPENDENT, carried, displaced, gap, kernel
from models.array import Array
from models.errors import StructureError
from models.lectures.scheme import Place, Scheme, SchemeJoint
from models.scene import GROUND

PLACELESS = ("slider", "prismatic", "planar")
"""Kinds of joints that are the same wherever they are drawn."""


@dataclass(frozen=True)
class DrawingFrame:
    """Origin [m] and size [m] of the drawing."""

    origin: Place
    size: float

    @classmethod
    def of(cls, scheme: Scheme) -> DrawingFrame:
        """Make the frame about the first joint that has a place; the size is the largest distance
        of the joints in a coordinate, or the largest radius where they are in one place."""
        places = [j.at for j in scheme.joints if j.kind not in PLACELESS or any(j.at)]
        if not places:
            return cls((0.0, 0.0, 0.0), 1.0)
        spread = float(np.ptp(np.array(places), axis=0).max())
        radii = [abs(each) for j in scheme.joints for each in j.radii if np.isfinite(each)]
        return cls(places[0], spread or max([*radii, 0.0]) or 1.0)

    def at(self, place: Place) -> Array:
        """Return a point of the drawing in this frame [-]."""
        return np.asarray(np.subtract(place, self.origin) / self.size)

    def joint(self, joint: SchemeJoint) -> SchemeJoint:
        """Return a joint in this frame."""
        x, y, z = map(float, self.at(joint.at))
        first, second = (each / self.size for each in joint.radii)
        return replace(joint, at=(x, y, z), radii=(first, second), lead=joint.lead / self.size)

    def in_drawing(self, twist: Array) -> Array:
        """Return a twist (6,) of this frame about the drawing's own origin [m]."""
        omega, v = twist[:3], twist[3:] * self.size
        return np.concatenate([omega, v - np.cross(omega, self.origin)])


IN_PLANE = [2, 3, 4]
"""Components of a twist that move in the plane."""


@dataclass(frozen=True)
class PlacedLink:
    """Link: its pose (4, 4) from the drawn one, and its twist for each freedom (6, f)."""

    pose: Array
    twists: Array


@dataclass(frozen=True)
class Loops:
    """Scheme's joints in ``frame``, its tree, and the joints that close loops."""

    scheme: Scheme
    frame: DrawingFrame
    chains: Mapping[str, tuple[Element, ...]]
    columns: Mapping[str, range]
    tree: tuple[tuple[SchemeJoint, str, str], ...]
    closing: tuple[SchemeJoint, ...]
    freedoms: int

    @classmethod
    def of(cls, scheme: Scheme, frame: DrawingFrame | None = None) -> Loops:
        """Find the loops of a scheme. Raises StructureError for an unconnected link."""
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

    def placed(self, q: Array) -> dict[str, PlacedLink]:
        """Return every link as the joints of the tree place it, their freedoms at ``q`` (f,)."""
        links = {GROUND: PlacedLink(np.eye(4), np.zeros((6, self.freedoms)))}
        for joint, known, link in self.tree:
            links[link] = self._beyond(joint, known, links[known], q)
        return links

    def closure(self, q: Array) -> tuple[Array, Array]:
        """Return the gap of each loop (k,), and its derivative (k, f)."""
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
        """Return the motions of the joints' freedoms that keep all loops closed at ``q``: (f, d).
        They open the loops by less than a ``share`` of the strongest direction."""
        return kernel(self.closure(q)[1], share)

    def margin(self, q: Array) -> float:
        """Return the smallest singular value of the closure that is not 0, over the largest."""
        values = np.linalg.svd(self.closure(q)[1])[1] if self.closing else np.ones(1)
        kept = values[values > DEPENDENT * values[0]]
        return float(kept[-1] / kept[0]) if len(kept) else 1.0

    def joint_twists(self, q: Array) -> dict[str, Array]:
        """Return the freedoms of each joint at ``q``, as twists (6, f of the joint)."""
        links, found = self.placed(q), {}
        for joint in self.scheme.joints:
            first = joint.between[0]
            still = PlacedLink(links[first].pose, np.zeros((6, self.freedoms)))
            twists = self._beyond(joint, first, still, q).twists
            found[joint.name] = twists[:, self.columns[joint.name]]
        return found

    def part(self, scheme: Scheme, q: Array) -> tuple[Loops, Array]:
        """Return the loops of a scheme with fewer joints, and their part of ``q``."""
        loops = Loops.of(scheme, self.frame)
        kept = [column for joint in scheme.joints for column in self.columns[joint.name]]
        return loops, q[kept]

    def _beyond(self, joint: SchemeJoint, known: str, link: PlacedLink, q: Array) -> PlacedLink:
        """Return the place of the link on a joint's other side than ``known``."""
        first = self.columns[joint.name].start
        backward = known != joint.between[0]
        chain = self.chains[joint.name]
        pose, twists = link.pose, link.twists.copy()
        for element in reversed(chain) if backward else chain:
            column = first + element.freedom
            factor = -element.factor if backward else element.factor
            twists[:, column] += factor * carried(pose, element.twist)
            pose = pose @ displaced(element.twist, factor * q[column])
        return PlacedLink(pose, twists)


def _spanned(
    scheme: Scheme,
) -> tuple[tuple[tuple[SchemeJoint, str, str], ...], tuple[SchemeJoint, ...]]:
    """Return the joints of a tree from the ground, each with its known link and the one that it
    places, and the other joints."""
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


AWAY = 0.2
"""Distance of the test position from the drawn one [rad, or shares of the scheme's size]."""
LOOK = 1e-2
"""Step that tests a motion; a finite one differs from the step by its square."""
CLOSED = 1e-13
SHAKES = 1e-5
"""Share of the loops' opening below which a motion may be a shake, and is tried: next to the drawn
position a shaking scheme is closed to rounding, and so is off by the root of that."""
MOST_STEPS = 60
TRIES = 4
SEED = 18


@dataclass(frozen=True)
class Neighbourhood:
    """Motions of a scheme at the drawn position and next to it. ``at`` (f,) is the position next to
    the drawn one, ``moves`` (f, d) are all motions that the equations leave there, ``finite`` is
    the number of real motions among them; ``here`` is the number that the equations leave at the
    drawn position."""

    here: int
    at: Array
    moves: Array
    finite: int
    others: tuple[int, ...]
    """Mobility on other branches that begin at the drawn position."""
    margin: float
    """Smallest restraint there, over the largest (`Loops.margin`)."""

    @property
    def is_singular(self) -> bool:
        """True if the drawn position has motions that those next to it have not."""
        return self.here > int(self.moves.shape[1])


def neighbourhood(loops: Loops) -> Neighbourhood:
    """Move a scheme out of the drawn position, and count its motions there."""
    here = loops.moves(np.zeros(loops.freedoms))
    draw = np.random.default_rng(SEED)
    found = []
    for _ in range(TRIES):
        at = _left(loops, here, draw)
        moves = loops.moves(at, SHAKES)
        found.append((_finite(loops, at, moves, draw), at, moves))
        if not loops.closing:
            break  # without loops all positions are alike
    finite, at, moves = max(found, key=lambda each: each[0])
    others = tuple(sorted({each[0] for each in found} - {finite}))
    return Neighbourhood(here.shape[1], at, moves, finite, others, loops.margin(at))


def settled(loops: Loops, q: Array) -> Array | None:
    """Return the closed position next to ``q``, or None without convergence."""
    for _ in range(MOST_STEPS):
        open_by, slope = loops.closure(q)
        size = float(np.linalg.norm(open_by))
        if size < CLOSED * max(1, len(open_by)):
            return q
        left, values, right = np.linalg.svd(slope, full_matrices=False)
        # Damped by the square of the gap: rows that depend on others are left alone.
        damping = values / (values**2 + min(size**2, 1e-4) + 1e-18)
        q = q - right.T @ (damping * (left.T @ open_by))
    return q if size < 1e3 * CLOSED else None


def _left(loops: Loops, moves: Array, draw: np.random.Generator) -> Array:
    """Return a position off the drawn one, or that itself where nothing moves."""
    stay = np.zeros(loops.freedoms)
    if moves.shape[1] == 0:
        return stay
    for share in (1.0, 0.3, 0.1):
        direction = moves @ draw.standard_normal(moves.shape[1])
        direction *= share * AWAY / max(float(np.abs(direction).max()), 1e-300)
        there = settled(loops, direction)
        # A motion of first order alone ends at the drawn position, or slowly approaches it.
        if there is not None and 0.05 < np.abs(there).max() / (share * AWAY) < 3.0:
            return there
    return stay


def _finite(loops: Loops, at: Array, moves: Array, draw: np.random.Generator) -> int:
    """Return the number of independent motions at a position that survive a step."""
    count = int(moves.shape[1])
    if count == 0 or not loops.closing:
        return count
    if loops.closure(at)[1].shape[0] + count == loops.freedoms:
        return count  # independent equations: the remaining motions continue (implicit functions)
    turned, _ = np.linalg.qr(draw.standard_normal((count, count)))
    steps = [settled(loops, at + LOOK * step) for step in (moves @ turned).T]
    way = np.array([np.zeros_like(at) if step is None else step - at for step in steps]) / LOOK
    values = np.linalg.svd(way @ moves, compute_uv=False)
    return int(np.count_nonzero(values > 0.2))
