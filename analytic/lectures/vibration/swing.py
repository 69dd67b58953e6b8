"""How elastic links swing over a period: their middles, where they are off most, their spectra."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from analytic.elastic.reduced import ReducedForm
from models.array import Array

PLACES = 41
"""Along a link, where the largest deflection is looked for."""


@dataclass(frozen=True)
class Swing:
    """A link at N instants of a period: the deflection of its middle and its extension [m], (N,).

    ``largest_m`` is the largest deflection of any place on a link that bends, ``place_m`` from its
    first pin, at the instant ``when``; of one that only stretches the largest extension, at its
    end.
    """

    link: str
    length_m: float
    bends: bool
    middle: Array
    extension: Array
    largest_m: float
    place_m: float
    when: int

    @property
    def series(self) -> Array:
        """What its spectrum is of [m], (N,): the deflection of the middle, or the extension of a
        link that does not bend."""
        return self.middle if self.bends else self.extension

    @property
    def share(self) -> float:
        """The largest over the length."""
        return self.largest_m / self.length_m

    @property
    def amplitudes(self) -> Array:
        """Of `series` at orders 0, 1, 2, ... of the period [m]."""
        return spectrum(self.series)


def swings(form: ReducedForm, z: Array) -> dict[str, Swing]:
    """How the elastic links swing with coefficients (N, m) over a period, by name."""
    found, every = {}, form.about_origin(z)
    for name, (body, own) in form.assembly.elastic.items():
        q = every[:, own]
        bends = form.assembly.scene.elastic[name].bends
        x, length = np.linspace(0.0, body.length_m, PLACES), body.length_m
        across, extension = body.deflections(q, x), body.extension(q)
        away = np.abs(across) if bends else np.abs(extension)[:, None]
        when, place = np.unravel_index(int(away.argmax()), away.shape)
        found[name] = Swing(
            name, length, bends, across[:, PLACES // 2], extension,
            float(away[when, place]), float(x[place]) if bends else length, int(when),
        )  # fmt: skip
    return found


def spectrum(series: Array) -> Array:
    """The amplitudes of what is periodic (N,), N odd, at orders 0 to N // 2 of its period."""
    amplitudes = np.abs(np.fft.rfft(series)) / len(series)
    amplitudes[1:] *= 2.0
    return np.asarray(amplitudes)
