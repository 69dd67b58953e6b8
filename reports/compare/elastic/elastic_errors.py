"""The errors of elastic links: beside the beam, beside the exact chain, and of that itself."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from models.array import Array
from models.motion import Motion
from reports.compare.elastic.elastic_beside import ElasticBeside
from reports.compare.elastic.elastic_facts import ElasticFacts
from reports.compare.elastic.elastic_truth import FEW
from reports.compare.error_rows import instants_of, whole_row
from reports.compare.errors import Error, ErrorKind, Errors
from reports.compare.series import length
from reports.quantities import QUANTITIES, named
from reports.quantities.elastic import largest_deflection

BEAM, CHAIN = ("deflection", "extension"), ("segments",)
"""What is held to the beam, and to the exact chain."""
THINNED = 400
"""Samples at which the theories are compared with each other: none of them has a jump."""


def with_elastic(errors: Errors, beside: ElasticBeside) -> Errors:
    """The errors of a run with those of its elastic links, and what is known of these."""
    facts = elastic_facts(beside)
    return replace(errors, rows=(*errors.rows, *elastic_rows(beside)), elastic=facts)


def elastic_rows(beside: ElasticBeside) -> list[Error]:
    """Deflections and extensions, of kind "total" those of the run; of kind "chain" those of the
    exact chain, beside the beam."""
    at = instants_of(beside, beside.motion.time_s, beside.reference)
    rows = [whole_row(track, at) for track in beside.tracks(BEAM, beside.reference)]
    exact = beside.exact
    if exact is not None:
        rows += [whole_row(track, at) for track in beside.tracks(CHAIN, exact)]
        rows += _theory_rows(beside, exact, "chain")
    return rows


def _theory_rows(beside: ElasticBeside, other: Motion, kind: ErrorKind) -> Iterator[Error]:
    """Another theory's motion in place of the run."""
    at = instants_of(beside, beside.motion.time_s, beside.reference)
    theirs = replace(beside, run=replace(beside.run, motion=other), motion=other, _own={})
    for track in theirs.tracks(BEAM, beside.reference):
        yield whole_row(track, at, kind=kind)


def elastic_facts(beside: ElasticBeside) -> ElasticFacts:
    """What is known beside the errors."""
    truth, time_s = beside.elastic, beside.motion.time_s
    some = time_s[:: max(1, time_s.size // THINNED)]
    beam = truth.beam_at(some)
    largest = largest_deflection(beside.scene, beam)
    lasts = float(time_s[-1] - time_s[0])
    share = 1.0
    if beside.exact is None:
        share = (FEW / truth.chain.count) ** 2
    chain = truth.few.at(some) if beside.exact is None else truth.exact.at(some)
    return ElasticFacts(
        segments=truth.chain.count,
        springs="corrected" if truth.chain.corrected else "plain",
        ratio=truth.ratio,
        cycles=0.0 if truth.is_periodic else truth.lowest_rad_s * lasts / (2.0 * np.pi),
        slender=beside.scene.longest_m / largest,
        doubt=_doubt(beside, some, beam) / largest,
        linear=_apart(truth.linear_at(some), beam) / largest,
        apart={name: share * size for name, size in _apart_by_name(beside, chain, beam).items()},
        estimated=beside.exact is None,
    )


def _doubt(beside: ElasticBeside, time_s: Array, beam: Motion) -> float:
    """What the beam may be off by [m]: by its sines, and by where the chains go to."""
    truth = beside.elastic
    off = _apart(truth.fewer_sines_at(time_s), beam)
    if not truth.is_periodic:
        return off
    goal = truth.limit_of_chains_at(time_s)
    own = (np.abs(goal[name] - beam.elastic[name].middle).max() for name in goal)
    return max(off, float(max(own)))


def _apart(one: Motion, other: Motion) -> float:
    """The largest difference of deflections [m]."""
    return max(
        float(np.abs(one.elastic[name].middle - other.elastic[name].middle).max())
        for name in other.elastic
    )


def _apart_by_name(beside: ElasticBeside, chain: Motion, beam: Motion) -> dict[str, float]:
    """The largest difference of all that is compared, as pure numbers by quantity."""
    found: dict[str, float] = {}
    for name in named("place", "derived", "force", "elastic"):
        for measure in QUANTITIES[name].measures:
            ours, theirs = (measure.truth(beside.scene, each) for each in (beam, chain))
            if name in CHAIN or not ours:
                continue
            scale = measure.scale(beside.scene, beam)
            for body in ours.keys() & theirs.keys():
                off = float(np.max(length(theirs[body] - ours[body]))) / scale
                found[name] = max(found.get(name, 0.0), off)
    return found
