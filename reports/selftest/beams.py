"""Faults of elastic links that are beams of an engine's own: only the bending tells."""

from __future__ import annotations

from functools import partial

from reports.selftest.beam_changes import begun, damped, heavier, in_beam, stiffer, stretchier
from reports.selftest.elastic_runs import BENT
from reports.selftest.fault import Fault
from reports.selftest.node_changes import bent_by, in_chain_log, of_beam
from sim.registry import engine

_beam = partial(
    Fault, "beam", scenes=(BENT,), rule="CC131", needs=lambda name: engine(name).applies_beams
)
FAULTS = (
    _beam(
        name="beam-modulus",
        what="the modulus is too large",
        plant=in_beam(stiffer),
        size=1e-2,
        unit="of it",
    ),
    _beam(
        name="beam-mass",
        what="the beam is too heavy",
        plant=in_beam(heavier),
        size=1e-2,
        unit="of it",
    ),
    _beam(
        name="beam-damping",
        what="the beam damps",
        plant=in_beam(damped),
        size=1e-3,
        unit="s",
    ),
    _beam(
        name="beam-stretches",
        what="EA is that many times too small",
        plant=in_beam(stretchier),
        size=1e4,
        unit="times",
    ),
    _beam(
        name="beam-straight",
        what="starts straight, and rings",
        plant=begun("straight"),
    ),
    _beam(
        name="beam-unswung",
        what="starts as if it did not swing",
        plant=begun("quasi-static"),
    ),
    _beam(
        name="beam-bend-scaled",
        what="the deflection is too large",
        plant=in_chain_log(bent_by(lambda off, share: (1.0 + share) * off)),
        size=1e-2,
        unit="of it",
    ),
    _beam(
        name="beam-linear-given",
        what="the linear theory, handed in",
        plant=in_chain_log(of_beam(stiffened=False)),
    ),
    _beam(
        name="beam-theory-given",
        what="the beam, handed back",
        plant=in_chain_log(of_beam(stiffened=True)),
        rule="CC111",
    ),
)
