"""Words for a space of motions: Qx, Tz where axes of the frame do, else an axis with its place.

Qx, Qy, Qz are turns about axes through a point, Tx, Ty, Tz displacements along them: as the problem
book "Bai tap co hoc may" writes the freedoms of a joint (exercise 1-1).
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from analytic.lectures.schemes.screws import Vector, rank, rotation, translation
from models.array import Array

SLACK = 1e-9
"""What a number may be off to be shown as 0."""


def named_twists(at: Vector = (0.0, 0.0, 0.0), planar: bool = False) -> Mapping[str, Array]:
    """The twists of the names, of axes through a point; those of the plane alone where asked."""
    turns = {f"Q{name}": rotation(at, axis) for name, axis in zip("xyz", np.eye(3), strict=True)}
    slides = {f"T{name}": translation(axis) for name, axis in zip("xyz", np.eye(3), strict=True)}
    names = ("Qz", "Tx", "Ty") if planar else (*turns, *slides)
    return {name: (turns | slides)[name] for name in names}


def names_of_freedoms(twists: Array, at: Vector) -> list[str]:
    """Words for a basis of a space of twists (6, d): names first, what is left as axes."""
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
    """One twist for people: the axis that it turns about, or the direction that it slides along."""
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
    """The rows in echelon form about a point, so that as many numbers as can be are 0."""
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
    """Three numbers, the first that is not 0 above 0 for a direction's sake left as it is."""
    clean = np.where(np.abs(vector) < SLACK, 0.0, vector)
    return "(" + ", ".join(f"{each:.6g}" for each in clean) + ")"
