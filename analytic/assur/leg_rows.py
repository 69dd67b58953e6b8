"""What the legs of a triad ask of its central link: one equation each, at one instant.

::

      A o---L---o a        n |  o a           o A
                             | /              |  line of the central link
      circle: RR        ----------- line   ---+---------
                        line: PR           through: RP           angle: PP

P is the place of the origin of the central link's frame and R its rotation by phi. Two equations of
lines hold a point of the link in place; one of an angle and one of a line, a link that slides.
"""

from __future__ import annotations

from dataclasses import dataclass

from models.scene import Point


@dataclass(frozen=True)
class CircleRow:
    """|P + R a - A| = L: ``a`` in the link's frame [m], known pin ``A``, ``length`` L [m]."""

    a: Point
    pin: Point
    length: float

    @property
    def lengths(self) -> tuple[float, ...]:
        """What of it is in metres."""
        return (*self.a, *self.pin, self.length)


@dataclass(frozen=True)
class LineRow:
    """n . (P + R a - p) = 0: ``a`` runs on the known line through ``p`` with ``normal`` n."""

    a: Point
    normal: Point
    through: Point

    @property
    def lengths(self) -> tuple[float, ...]:
        """What of it is in metres."""
        return (*self.a, *self.through)


@dataclass(frozen=True)
class ThroughRow:
    """(R m) . (A - P) = m . b: the link's own line, ``normal`` m through ``b`` in its frame, passes
    through the known pin ``A``."""

    normal: Point
    b: Point
    pin: Point

    @property
    def lengths(self) -> tuple[float, ...]:
        """What of it is in metres."""
        return (*self.b, *self.pin)


@dataclass(frozen=True)
class AngleRow:
    """R (1, 0) is ``along``, a unit vector."""

    along: Point

    @property
    def lengths(self) -> tuple[float, ...]:
        """What of it is in metres."""
        return ()


LegRow = CircleRow | LineRow | ThroughRow | AngleRow
LegRows = tuple[LegRow, LegRow, LegRow]
