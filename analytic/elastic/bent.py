"""How elastic links are bent over their whole length, to be drawn, and to find where most."""

from __future__ import annotations

from analytic.elastic.elastic_motion import DrivenElasticMotion
from models.array import Array


def bent(motion: DrivenElasticMotion, time_s: Array, shares: Array) -> dict[str, Array]:
    """How far elastic links are from the line between their pins, by name [m], (T, K), at times [s]
    (T,), and at shares (K,) of the length from the first pin to the second."""
    now, _ = motion.instant(time_s)
    return {
        name: body.deflections(now.now.q[:, own], shares * body.length_m)
        for name, (body, own) in motion.form.assembly.elastic.items()
    }
