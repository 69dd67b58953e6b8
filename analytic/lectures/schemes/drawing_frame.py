"""The frame in which a scheme's loops are closed: about one of its joints, in shares of its size.

So that rank, which compares turns with displacements, is that of a drawing on paper, whatever the
unit and the place of the drawing.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from models.array import Array
from models.lectures.scheme import Place, Scheme, SchemeJoint

PLACELESS = ("slider", "prismatic", "planar")
"""Kinds that are the same wherever they are drawn."""


@dataclass(frozen=True)
class DrawingFrame:
    """An origin [m], and the size of the drawing [m]."""

    origin: Place
    size: float

    @classmethod
    def of(cls, scheme: Scheme) -> DrawingFrame:
        """About the first joint that has a place; the size is how far the joints are apart, at most
        in a coordinate, or the largest radius where they are in one place."""
        places = [j.at for j in scheme.joints if j.kind not in PLACELESS or any(j.at)]
        if not places:
            return cls((0.0, 0.0, 0.0), 1.0)
        spread = float(np.ptp(np.array(places), axis=0).max())
        radii = [abs(each) for j in scheme.joints for each in j.radii if np.isfinite(each)]
        return cls(places[0], spread or max([*radii, 0.0]) or 1.0)

    def at(self, place: Place) -> Array:
        """A point of the drawing in this frame [-]."""
        return np.asarray(np.subtract(place, self.origin) / self.size)

    def joint(self, joint: SchemeJoint) -> SchemeJoint:
        """A joint in this frame."""
        x, y, z = map(float, self.at(joint.at))
        first, second = (each / self.size for each in joint.radii)
        return replace(joint, at=(x, y, z), radii=(first, second), lead=joint.lead / self.size)

    def in_drawing(self, twist: Array) -> Array:
        """A twist (6,) of this frame, about the drawing's own origin [m]."""
        omega, v = twist[:3], twist[3:] * self.size
        return np.concatenate([omega, v - np.cross(omega, self.origin)])
