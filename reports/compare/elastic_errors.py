"""The errors of elastic links: against the beam, against the exact chain, and of that itself."""

from dataclasses import replace
from functools import partial

import numpy as np

from models.motion import Motion
from reports.compare import compare, tracks
from reports.compare.elastic_truth import ElasticBeside
from reports.compare.error_rows import instants_of, whole_row
from reports.compare.errors import ElasticFacts, Error, Errors
from reports.quantities import QUANTITIES, named

BEAM, CHAIN = ("deflection", "extension"), ("segments",)
"""Quantities compared with the beam, and with the exact chain."""


def compared(beside: compare.Beside, errors: Errors | None) -> Errors:
    """Return the errors of a run as with rigid links, and those of its elastic links."""
    assert isinstance(beside, ElasticBeside)
    assert errors is not None
    return replace(errors, rows=(*errors.rows, *places(beside)), of_links=elastic_facts(beside))


def places(beside: compare.Beside) -> list[Error]:
    """Return deflections and extensions against the beam: of the run, of kind "total", and of the
    exact chain, of kind "chain"."""
    assert isinstance(beside, ElasticBeside)
    at = instants_of(beside, beside.motion.time_s, beside.reference)
    rows = [whole_row(track, at) for track in beside.tracks(BEAM, beside.reference)]
    exact = beside.exact
    if exact is not None:
        rows += [whole_row(track, at) for track in beside.tracks(CHAIN, exact)]
        theirs = replace(beside, run=replace(beside.run, motion=exact), motion=exact, _own={})
        chain = theirs.tracks(BEAM, beside.reference)
        rows += [whole_row(track, at, kind="chain") for track in chain]
    return rows


def elastic_facts(beside: ElasticBeside) -> ElasticFacts:
    """Return the facts beside the errors."""
    truth, theory, time_s = beside.elastic, beside.elastic.theory, beside.motion.time_s
    apart = truth.apart(partial(_apart_by_name, beside))
    for other, looked in theory.doubted:
        off = _apart_by_name(beside, other, looked)
        apart |= {name: apart[name] + size for name, size in off.items() if name not in BEAM}
    return ElasticFacts(
        segments=truth.cut.count,
        springs=truth.springs,
        ratio=theory.lowest_rad_s / beside.scene.pace_rad_s,
        cycles=theory.cycles_per_s * float(time_s[-1] - time_s[0]),
        slender=beside.scene.longest_m / theory.largest_m,
        doubt=truth.doubt,
        linear=theory.linear_m / theory.largest_m,
        apart=apart,
        estimated=not truth.is_exact,
        straight=theory.shape == "straight",
        pushed=truth.pushed,
    )


def _apart_by_name(beside: ElasticBeside, chain: Motion, beam: Motion) -> dict[str, float]:
    """Return the largest differences of all compared quantities, as pure numbers by quantity."""
    found: dict[str, float] = {}
    for name in named("free", "place", "derived", "force", "elastic"):
        for measure in QUANTITIES[name].measures:
            ours, theirs = (measure.truth(beside.scene, each) for each in (beam, chain))
            if name in CHAIN or not ours:
                continue
            scale = measure.scale(beside.scene, beam)
            for body in ours.keys() & theirs.keys():
                off = float(np.max(tracks.length(theirs[body] - ours[body]))) / scale
                found[name] = max(found.get(name, 0.0), off)
    return found
