"""The names of a scene's bodies, as they stand in the names of columns."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from models.scene import GROUND, Scene
from reports.logs.kinds import LoggedKind
from reports.logs.own_columns import Meaning, own_meanings

DRIVERS = {"driver", "input", "motor"}
SHORT = 2
"""Names of bodies up to this length are told apart by case: `a` is an acceleration, `A` a point."""


@dataclass(frozen=True)
class SceneNames:
    """The bodies of a scene, as the names of columns may have them."""

    scene: Scene

    @cached_property
    def points(self) -> frozenset[str]:
        return frozenset([*self.scene.pins, *(each.point for each in self.scene.sliders.values())])

    @cached_property
    def bodies(self) -> Sequence[str]:
        """All names, longest first."""
        every = {*self.scene.links, *self.points, *self.scene.sliders, GROUND}
        return sorted(every, key=lambda name: (-len(name), name))

    @cached_property
    def own(self) -> Mapping[str, Meaning | str]:
        """What the columns say that we write ourselves, by name."""
        return own_meanings({body: self.kinds_of(body) for body in self.bodies})

    def kinds_of(self, name: str) -> tuple[LoggedKind, ...]:
        """What has that name: often a slider and its point have the same."""
        there: Iterable[tuple[LoggedKind, bool]] = (
            ("link", name in self.scene.links),
            ("point", name in self.points),
            ("slider", name in self.scene.sliders),
            ("elastic", name in self.scene.elastic),
        )
        return tuple(kind for kind, holds in there if holds)

    def found(self, text: str) -> tuple[list[str], list[str]]:
        """The bodies that a text names, in its order, and the words left, in lower case: `xC` and
        `rockerAngle` too."""
        bodies, words = self._apart(text)
        if not bodies:
            bodies, words = self._apart(self._parted(text))
        if not bodies and not DRIVERS.isdisjoint(words):
            bodies = [self.scene.driver.name]
            words = [word for word in words if word not in DRIVERS]
        return bodies, words

    def _in_its_case(self, text: str) -> str:
        """The body that is spelled so, or else the only one in other letters; "" for several."""
        alike = [name for name in self.bodies if name.lower() == text.lower()]
        return text if text in alike else alike[0] if len(alike) == 1 else ""

    def _parted(self, text: str) -> str:
        """A text with a space before each capital in a word, and between a point and its axis."""
        text = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", text)
        points = "|".join(re.escape(name) for name in self.bodies if name in self.points)
        text = re.sub(rf"(?<![A-Za-z0-9])({points})([va]?[xy])(?![A-Za-z0-9])", r"\1 \2", text)
        return re.sub(rf"(?<![A-Za-z0-9])([va]?[xy])({points})(?![A-Za-z0-9])", r"\1 \2", text)

    def _apart(self, text: str) -> tuple[list[str], list[str]]:
        """The bodies of a text, and its other words."""
        places: list[tuple[int, str]] = []
        for name in self.bodies:
            flags = 0 if len(name) <= SHORT else re.IGNORECASE
            pattern = rf"(?<![A-Za-z0-9]){re.escape(name)}(?![A-Za-z0-9])"
            while hit := re.search(pattern, text, flags):
                body = self._in_its_case(hit[0])
                if not body:
                    break
                places.append((hit.start(), body))
                text = text[: hit.start()] + " " * len(name) + text[hit.end() :]
        words = [word.strip("/").lower() for word in re.split(r"[^A-Za-z0-9°µμ²/^*']+", text)]
        return [name for _, name in sorted(places)], [word for word in words if word]
