"""Natural frequencies: of a mechanism whose driver is held still, and of its links alone.

Held at an angle the mechanism vibrates with K y = w^2 M y. M varies with the angle, as the coupler
moves the rocker more or less, and w with it; the frequencies of the moving mechanism are near to
the means over a turn.
"""

import math
from dataclasses import dataclass

import numpy as np

from analytic.elastic.reduced import ReducedForm
from models.array import Array
from models.scene import Scene
from models.scene.cut_links import line_of
from models.scene.laws import ConstantSpeed

SHOWN = 3
"""Number of modes of a link, of each kind, that are shown."""


@dataclass(frozen=True)
class LinkMode:
    """A mode of a link between its pins alone, both at rest: ``kind`` is across or along."""

    link: str
    kind: str
    number: int
    frequency_rad_s: float


def link_modes(scene: Scene, number: int = SHOWN) -> list[LinkMode]:
    """Return the first modes of all elastic links, of each kind that they have."""
    found = []
    for name, own in scene.elastic.items():
        line = line_of(scene, name)
        for kind, has, frequency in (
            ("across", own.bends, own.bending_rad_s),
            ("along", own.stretches, own.axial_rad_s),
        ):
            found += [
                LinkMode(name, kind, k, frequency(line.length_m, line.density_kg_m, k))
                for k in range(1, number + 1)
                if has
            ]
    return found


def lowest_rad_s(scene: Scene) -> float:
    """Lowest natural frequency of the elastic links alone: the unit of frequency ratios."""
    return min(mode.frequency_rad_s for mode in link_modes(scene, 1))


@dataclass(frozen=True)
class NaturalModes:
    """Natural frequencies ``frequency_rad_s`` (N, m) at N angles of the driver, the lowest first,
    and coefficients of the shapes of each, (N, m, m), one a column, of modal mass 1."""

    frequency_rad_s: Array
    shape: Array

    @property
    def mean_rad_s(self) -> Array:
        """The mean over the turn, (m,)."""
        return np.asarray(self.frequency_rad_s.mean(axis=0))


def natural_modes(mass: Array, stiffness: Array) -> NaturalModes:
    """Return the modes of matrices (N, m, m). A mode without stiffness left has frequency 0."""
    # With M = L L', symmetric for v = L' y.
    inverse = np.linalg.inv(np.linalg.cholesky(0.5 * (mass + np.swapaxes(mass, 1, 2))))
    onto = np.swapaxes(inverse, 1, 2)
    even = 0.5 * (stiffness + np.swapaxes(stiffness, 1, 2))
    squares, shapes = np.linalg.eigh(inverse @ even @ onto)
    return NaturalModes(np.sqrt(np.maximum(squares, 0.0)), onto @ shapes)


MOST = 30.0
"""Sensitivity from which no motion is shown: one percent of a modulus changes it by a third."""
MODES = 20
"""Number of modes of a link among which the resonating one is searched."""


@dataclass(frozen=True)
class FrequencySensitivity:
    """Share of the largest deflection that changes, over the share by which all links are stiffer
    (``size``); most of it is at an ``order`` of the driver's turns, in a ``link``."""

    size: float
    order: int
    link: str

    @property
    def resonates(self) -> bool:
        return not self.size < MOST


def sensitivity(form: ReducedForm, z: Array, change: Array) -> FrequencySensitivity:
    """Return the sensitivity of coefficients at N instants of a period, (N, m), from their
    ``change`` for twice the stiffness.

    A whole frequency ratio alone says little: next to 10 the driver hardly excites the mode that
    would resonate, next to 5 it does. So the motion itself decides, by the share of its deflection
    that changes, over the small share by which all links are stiffer: 1 far below the first natural
    frequency, unbounded where an undamped natural frequency is a whole multiple of the driver's.
    """
    whole, largest = float(np.abs(change).max(initial=0.0)), float(np.abs(z).max(initial=0.0))
    size = whole / largest if largest else 0.0
    orders = np.abs(np.fft.rfft(change, axis=0))
    order, coefficient = np.unravel_index(int(orders.argmax()), orders.shape)
    every = form.assembly.elastic.items()
    links = [name for name, (_, own) in every for _ in range(own.start + 3, own.stop)]
    return FrequencySensitivity(size, int(order), links[int(coefficient)])


def resonance_text(form: ReducedForm, found: FrequencySensitivity) -> str:
    """Return the text of a resonance: its mode and its cures."""
    scene = form.assembly.scene
    turning, speed = math.tau / form.period_s, ""
    text = f"{scene.name}: a resonance: elastic.{found.link} vibrates at order {found.order} of the"
    text += f" driver, {turning:.6g} rad/s"
    if mode := _nearest_mode(scene, found.link, found.order * turning):
        frequency = mode.frequency_rad_s
        text += (
            f"; its mode {mode.number} {mode.kind} has {frequency:.6g} rad/s, "
            f"{frequency / turning:.4g} times that"
        )
        if isinstance(form.law, ConstantSpeed):
            speed = f" ({frequency / (found.order + 0.5):.4g} rad/s is half-way to the next)"
    change = f"{found.size:.0f} %" if found.size < 1e4 else "any amount"
    more = "more " * any(own.damping_s for own in scene.elastic.values())
    return (
        f"{text}. One percent of stiffness changes its deflection by {change}: take another speed"
        f"{speed}, or give elastic links {more}damping_s"
    )


def _nearest_mode(scene: Scene, link: str, rad_s: float) -> LinkMode | None:
    """Return the mode of a link with the nearest frequency; None for a frequency of 0."""
    if not rad_s:
        return None
    modes = (mode for mode in link_modes(scene, MODES) if mode.link == link)
    return min(modes, key=lambda mode: abs(math.log(mode.frequency_rad_s / rad_s)))
