"""Random triads as scenes: a central link on three legs of any kind, the first on a crank."""

import itertools
import math
from dataclasses import dataclass, field, replace

import numpy as np

from models.files.reading import parse_scene
from models.scene import Scene

KINDS = tuple(
    kinds
    for kinds in itertools.combinations_with_replacement(("RR", "PR", "RP", "PP"), 3)
    if kinds.count("PP") < 2
)
"""The legs of all triads: outer joint, inner joint."""


@dataclass
class Drawn:
    rng: np.random.Generator
    kinds: tuple[str, str, str]
    crank_m: float = 0.3
    ground: dict[str, complex] = field(default_factory=dict)
    platform: dict[str, complex] = field(default_factory=dict)
    crank: dict[str, complex] = field(default_factory=dict)
    tables: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.place, self.pivot = self._point(), 2.0 * self._point()
        self.angle, self.start = (float(x) for x in self.rng.uniform(-3.0, 3.0, 2))
        self.ground["A"], self.crank["A"] = self.pivot, 0j
        self.crank["B"] = complex(self.crank_m)
        for i, kind in enumerate(self.kinds):
            getattr(self, f"_{kind.lower()}")(i)

    def _point(self) -> complex:
        return complex(*self.rng.normal(size=2))

    def _on_platform(self, at: complex) -> complex:
        return (at - self.place) / np.exp(1j * self.angle)

    def _known(self, i: int) -> tuple[str, float, complex]:
        """The body that a leg hangs on, its angle and origin."""
        return ("ground", 0.0, 0j) if i else ("crank", self.start, self.pivot)

    def _pin(self, i: int) -> tuple[str, complex]:
        if not i:
            return "B", self.pivot + self.crank_m * np.exp(1j * self.start)
        self.ground[f"K{i}"] = at = 2.0 * self._point()
        return f"K{i}", at

    def _corner(self, i: int) -> complex:
        """A point of the platform, by name, and where it is."""
        local = self._point()
        self.platform[f"C{i}"] = local
        return complex(self.place + local * np.exp(1j * self.angle))

    def _rr(self, i: int) -> None:
        corner, (pin, at) = self._corner(i), self._pin(i)
        self._link(f"leg{i}", {pin: 0j, f"C{i}": complex(abs(corner - at))})

    def _pr(self, i: int) -> None:
        corner, (on, turn, origin) = self._corner(i), self._known(i)
        direction = self._direction()
        through = (corner - origin) / np.exp(1j * turn) - 0.4 * np.exp(1j * direction)
        self._slider(f"C{i}", on, through, direction)

    def _rp(self, i: int) -> None:
        pin, at = self._pin(i)
        direction = self._direction()
        through = self._on_platform(at) - 0.3 * np.exp(1j * direction)
        self._slider(pin, "platform", through, direction)

    def _pp(self, i: int) -> None:
        corner, (on, turn, origin) = self._corner(i), self._known(i)
        out, lean, inner = (self._direction() for _ in range(3))
        leg, at = turn + out + lean, corner + self._point()
        through = (at - origin) / np.exp(1j * turn) - 0.2 * np.exp(1j * out)
        self._slider(f"S{i}", on, through, out, f"leg{i}", f"X{i}", lean)
        kept = self.angle - leg - inner
        through = (corner - at) / np.exp(1j * leg) - 0.5 * np.exp(1j * inner)
        self._slider(f"T{i}", f"leg{i}", through, inner, "platform", f"C{i}", kept)
        self._link(f"leg{i}", {f"X{i}": 0j, f"Y{i}": 0.4 + 0.1j})

    def _direction(self) -> float:
        return float(self.rng.uniform(-3.0, 3.0))

    def _link(self, name: str, points: dict[str, complex]) -> None:
        self.tables.append(f"links.{name}.points = {_points(points)}")

    def _slider(
        self, name: str, on: str, through: complex, direction: float, link: str = "",
        point: str = "", angle: float = 0.0,
    ) -> None:  # fmt: skip
        rows = f'on = "{on}", through_m = {_pair(through)}, direction_deg = {_degrees(direction)}'
        if link:
            rows += f', link = "{link}", point = "{point}", angle_deg = {_degrees(angle)}'
        self.tables.append(f"sliders.{name} = {{ {rows} }}")

    @property
    def text(self) -> str:
        spare = {"U": 0j, "V": 1.1 + 0j} if len(self.platform) < 2 else {}
        links = [t for t in self.tables if t.startswith("links")]
        rows = ['name = "triad"\nsource = "test"', f"ground.points = {_points(self.ground)}"]
        rows += [f"links.crank.points = {_points(self.crank)}", *links]
        rows += [f"links.platform.points = {_points(self.platform | spare)}"]
        rows += [t for t in self.tables if t.startswith("sliders")]
        driver = f'link = "crank", speed_rad_s = 1.0, start_deg = {_degrees(self.start)}'
        return "\n".join([*rows, f"driver = {{ {driver} }}"])


def _degrees(angle: float) -> str:
    return repr(math.degrees(angle))


def _pair(at: complex) -> str:
    return f"[{float(at.real)!r}, {float(at.imag)!r}]"


def _points(points: dict[str, complex]) -> str:
    return "{ " + ", ".join(f"{name} = {_pair(at)}" for name, at in points.items()) + " }"


def triad(kinds: tuple[str, str, str], seed: int, crank_m: float = 0.3) -> tuple[Scene, float]:
    """A scene of one triad, and the angle of its central link as it was drawn [rad]."""
    drawn = Drawn(np.random.default_rng(seed), kinds, crank_m)
    return parse_scene(drawn.text, "test"), drawn.angle


def on_branch(scene: Scene, number: int) -> Scene:
    return replace(scene, branch={"platform": number})
