"""Screws: the motions that a joint leaves, the loads that a contact takes, and finite motions.

A twist is (omega, v): angular velocity, and velocity of the point of the body that is at the
origin. A wrench is (m, f): moment about the origin, and force; so that the plain product of the two
is the power. Both are of shape (6,), in the frame of the ground. Source: J. M. McCarthy and
G. S. Soh, Geometric Design of Linkages, chapter on spatial kinematics; K. H. Hunt, Kinematic
Geometry of Mechanisms, chapter 3.

Qx, Qy, Qz are turns about axes through a point, Tx, Ty, Tz displacements along them, as in the
problem book "Bai tap co hoc may" (exercise 1-1).
"""

from collections.abc import Mapping, Sequence

import numpy as np

from models.array import Array

Vector = Sequence[float] | Array
DEPENDENT = 1e-8
"""Share of the largest singular value below which another is 0: lengths are of the size of 1."""


def rotation(at: Vector, axis: Vector, pitch: float = 0.0) -> Array:
    """Return the twist of a turn about an axis, with ``pitch`` displacement for each radian."""
    direction = np.asarray(axis, dtype=float)
    return np.concatenate([direction, np.cross(at, direction) + pitch * direction])


def translation(axis: Vector) -> Array:
    """Return the twist of a displacement along a direction."""
    return np.concatenate([np.zeros(3), np.asarray(axis, dtype=float)])


def force(at: Vector, along: Vector) -> Array:
    """Return the wrench of a force on a line."""
    direction = np.asarray(along, dtype=float)
    return np.concatenate([np.cross(at, direction), direction])


def couple(about: Vector) -> Array:
    """Return the wrench of a moment alone."""
    return np.concatenate([np.asarray(about, dtype=float), np.zeros(3)])


def across(axis: Vector) -> tuple[Array, Array]:
    """Return two directions square to one and to each other, along the frame's if possible."""
    direction = np.asarray(axis, dtype=float) / np.linalg.norm(axis)
    rest = np.eye(3)[np.argsort(np.abs(direction), kind="stable")[0]]
    first = rest - (rest @ direction) * direction
    first /= np.linalg.norm(first)
    return first, np.cross(direction, first)


def cross_matrix(a: Array) -> Array:
    """Return the matrix that takes b to a x b."""
    return np.array([[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]])


def displaced(twist: Array, by: float) -> Array:
    """Return the finite motion of a twist as a matrix (4, 4): exp of the twist times ``by``."""
    omega, v = twist[:3] * by, twist[3:] * by
    angle = float(np.linalg.norm(omega))
    move = np.eye(4)
    if angle < 1e-12:
        move[:3, :3] += cross_matrix(omega)
        move[:3, 3] = v
        return move
    w = cross_matrix(omega)
    a, b = np.sin(angle) / angle, 2.0 * (np.sin(angle / 2.0) / angle) ** 2
    move[:3, :3] += a * w + b * w @ w
    # The integral of the rotation over the way, Rodrigues' series summed.
    move[:3, 3] = v + b * (w @ v) + (1.0 - a) / angle**2 * (w @ w @ v)
    return move


def carried(move: Array, twist: Array) -> Array:
    """Return a twist whose axis is moved along with a body."""
    turn, place = move[:3, :3], move[:3, 3]
    omega = turn @ twist[:3]
    return np.concatenate([omega, turn @ twist[3:] + cross_matrix(place) @ omega])


def gap(move: Array) -> Array:
    """Return a motion's distance from none, as a twist; its derivative there is the motion's."""
    turn = move[:3, :3]
    skew = (turn - turn.T) / 2.0
    return np.array([skew[2, 1], skew[0, 2], skew[1, 0], *move[:3, 3]])


def rank(rows: Array) -> int:
    """Return the number of independent rows (k, m)."""
    return 0 if rows.size == 0 else _rank(np.linalg.svd(rows)[1])


def kernel(rows: Array, share: float = DEPENDENT) -> Array:
    """Return an orthonormal basis (m, d) of the kernel of the rows (k, m)."""
    if rows.shape[0] == 0 or rows.size == 0:
        return np.eye(rows.shape[1])
    _, values, basis = np.linalg.svd(rows)
    return np.asarray(basis[_rank(values, share) :].T)


def _rank(values: Array, share: float = DEPENDENT) -> int:
    return int(np.count_nonzero(values > share * max(1.0, float(values[0]))))


def reciprocal(twists: Array) -> Array:
    """Return the wrenches (k, 6) that do no work on any of the twists (6, d)."""
    return kernel(twists.T).T


SLACK = 1e-9
"""Largest value that is shown as 0."""


def named_twists(at: Vector = (0.0, 0.0, 0.0), planar: bool = False) -> Mapping[str, Array]:
    """Return the named twists about axes through a point; if ``planar``, of the plane alone."""
    turns = {f"Q{name}": rotation(at, axis) for name, axis in zip("xyz", np.eye(3), strict=True)}
    slides = {f"T{name}": translation(axis) for name, axis in zip("xyz", np.eye(3), strict=True)}
    names = ("Qz", "Tx", "Ty") if planar else (*turns, *slides)
    return {name: (turns | slides)[name] for name in names}


def names_of_freedoms(twists: Array, at: Vector) -> list[str]:
    """Return words for a basis of a space of twists (6, d): names first, the rest as axes."""
    size, found = rank(twists.T), np.zeros((0, 6))
    names: list[str] = []
    for name, twist in named_twists(at).items():
        if rank(np.vstack([twists.T, twist])) == size:
            found, names = np.vstack([found, twist]), [*names, name]
    basis = _reduced(twists.T, at)
    for twist in basis:
        if rank(np.vstack([found, twist])) > len(found):
            found, names = np.vstack([found, twist]), [*names, axis_in_words(twist)]
    return names


def axis_in_words(twist: Array) -> str:
    """Return a twist in words: the axis that it turns about, or the direction of its slide."""
    omega, v = twist[:3], twist[3:]
    size = float(np.linalg.norm(omega))
    if size <= SLACK * max(1.0, float(np.linalg.norm(v))):
        return f"slide along {_numbers(v / np.linalg.norm(v))}"
    pitch = float(omega @ v) / size**2
    point = np.cross(omega, v) / size**2  # the point of the axis next to the origin
    where = f"{_numbers(omega / size)} through {_numbers(point)} m"
    if abs(pitch) <= SLACK:
        return f"turn about {where}"
    return f"screw about {where}, {2.0 * np.pi * pitch:.6g} m in a turn"


def _reduced(rows: Array, at: Vector) -> Array:
    """Return the rows in echelon form about a point, so that as many numbers as possible are 0."""
    shift = np.eye(6)
    shift[3:, :3] = -np.array([np.cross(at, axis) for axis in np.eye(3)]).T  # v there, not at 0
    left = rows @ shift.T
    row = 0
    for column in range(6):
        if row == len(left):
            break
        best = row + int(np.argmax(np.abs(left[row:, column])))
        if abs(left[best, column]) < SLACK:
            continue
        left[[row, best]] = left[[best, row]]
        left[row] /= left[row, column]
        others = np.arange(len(left)) != row
        left[others] -= np.outer(left[others, column], left[row])
        row += 1
    back = np.eye(6)
    back[3:, :3] = -shift[3:, :3]
    return np.asarray(left[:row] @ back.T)


def _numbers(vector: Array) -> str:
    """Return three numbers as text, rounding shown as 0."""
    clean = np.where(np.abs(vector) < SLACK, 0.0, vector)
    return "(" + ", ".join(f"{each:.6g}" for each in clean) + ")"
