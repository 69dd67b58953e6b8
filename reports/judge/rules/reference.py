"""CC111, CC112, CC134: the reference is another computation than the engine's, and certain enough;
for elastic links, the main error is attributed to the engine, the segments or the reference."""

import math
import sys
from collections.abc import Iterator

from reports.compare.errors import ElasticFacts, Error, Errors, largest
from reports.judge.rules.rule import Evidence, Finding, Level, measure
from reports.quantities import named
from reports.quantities.quantity import BodyKind
from sim.engine import Placing

LEAST_SAMPLES = 8
EITHER_SIDE = 1.0 + 1e-6
"""Factor on the largest jump of a cam's law up to which a bound is that of the jump."""
SHARE = 0.1
"""Largest uncertainty of the reference, as a share of its limit."""


class TwoComputations:
    id = "CC111"
    title = "two computations"
    explanation = (
        "Two independent computations never agree exactly over a whole run: an engine that "
        "integrates has the error of its step, one that solves its joints rounds its rates "
        "differently. A body that agrees better shows that the reference was compared with "
        "itself."
    )
    cure = (
        "Check the source of the adapter's numbers: it must read the engine. An engine that "
        "solves its joints in each step declares placing solved."
    )

    def check(self, evidence: Evidence) -> Finding | None:
        errors = evidence.errors
        if errors is None:
            return None
        placing, order = evidence.placing, evidence.order
        found = too_good(errors, placing, order)
        rows = [
            row
            for row in errors.rows
            if row.quantity in PLACES and row.kind == "total" and row.samples >= LEAST_SAMPLES
        ]
        if not found and not rows:
            return None
        if rows and max(row.pure for row in rows) == 0.0:
            text = "every position equals the reference to the last bit"
            return Finding(self.id, "fail", text, 0.0, 0.0)
        if not found:
            text = "engine and reference differ like two computations"
            return Finding(self.id, "pass", text, max(row.pure for row in rows))
        first = found[0]
        bodies = ", ".join(dict.fromkeys(f"{row.body_kind} {row.body}" for row in found))
        why = (
            f"integration has an error of step^{highest_order(errors, order)}"
            if placing == "integrated"
            else "separately computed rates round differently"
        )
        text = (
            f"{bodies}: {first.quantity} is off by {measure(first)} at most"
            f"{' at the logged crank angle' if first.kind == 'geometric' else ''}; {why}"
        )
        return Finding(self.id, "fail", text, first.pure)


class ReferenceCertain:
    id = "CC112"
    title = "reference certain"
    explanation = (
        "The reference carries a bound of its own error; near a singular position that grows, "
        "and a limit below it can not be judged."
    )
    cure = (
        "Keep away from the toggle position, remove friction from a joint that never turns, or "
        "widen the named tolerance."
    )

    def check(self, evidence: Evidence) -> Finding | None:
        if evidence.errors is None:
            return None
        worst, name, limit = 0.0, "", 0.0
        jump = EITHER_SIDE * evidence.errors.of_scene.law_jumps[0]
        for key, body, bound in _bounds(evidence.errors):
            if key not in evidence.limits or (key in JUMPING and bound <= jump):
                continue  # in a jump of a cam's law either side is right
            share = bound / evidence.limits[key].number
            share = math.inf if math.isnan(share) else share
            if share > worst:
                worst, name, limit = share, f"{key} of {body}", evidence.limits[key].number
        if worst <= SHARE:
            return Finding(
                self.id, "pass", f"reference within {worst:.1e} of the limits", worst, SHARE
            )
        text = (
            f"reference not certain: {name} has the uncertainty {worst * limit:.2g}, limit "
            f"{limit:.2g}"
        )
        return Finding(self.id, "fail", text, worst, SHARE)


def _bounds(errors: Errors) -> Iterator[tuple[str, str, float]]:
    """Yield tolerance, body and pure bound: for the reference at every sample, whatever the engine
    reports, and for the inputs of the errors."""
    for (quantity, body), bound in errors.uncertain.items():
        yield quantity, body, bound
    for row in errors.rows:
        if row.kind == "total":  # the others are shown, or have separate limits
            yield row.tolerance, row.body, row.pure_bound


LEAST = 5e-5
"""A nineteenth of the least observed multiple."""
PLACES, RATES = named("place"), named("derived")
FORCES = tuple(name for name in named("force") if name != "moment")
JUMPING = ("acceleration", *named("force"))
"""A block that is pinned at its point bears no moment, in an engine as in the reference."""
WHOLE = ("total", "geometric")
"""Errors of the run, except its start and change points, where an engine may have hardly moved."""
ROUNDING = sys.float_info.epsilon
"""A rate that is off by at most this share of its scale is the next number or the same."""

BENT = ("deflection", "segments")
SAME_BEND = 1e-11
"""Share of the largest deflection due to rounding; the nearest engine was off by 5e-7."""
STRAIGHT = 1e8
"""The longest link over the largest deflection, for practically rigid links."""
UNROUNDED = 1e-9
"""Error of an acceleration above rounding."""


def too_good(errors: Errors, placing: Placing, order: int) -> list[Error]:
    """Return the errors that are too small for their body and step, the smallest first.

    An engine that integrates positions has an error of a multiple of step^order at every body that
    does not move evenly with the driver (`reports.compare.hardness`): in its positions, total and
    geometric, in its rates, in the widest gap of its joints, and in the worst of its forces. On
    every shipped scene and 150 random ones, at 45 to 5760 steps a turn, the least was 9e-4 of that
    times the unevenness of the body. Numbers copied from the reference, however rounded afterwards,
    have no error, or none above the crank's.

    An engine that solves its joints in each step may have exact positions. Its rates are separate
    numbers nevertheless: over a whole run some of them are rounded in another way. Its forces
    depend on its accelerations: where these are off, so are the forces, by at least 0.1 of the
    inertia of all masses at that error, at 90 to 720 steps a turn on every shipped scene.
    """
    found = _nearer(errors, order) if placing == "integrated" else _the_same(errors)
    return sorted([*found, *_bent_the_same(errors)], key=lambda row: row.pure)


def highest_order(errors: Errors, order: int) -> int:
    """Return the order of the step of the errors of an engine of some ``order``."""
    return max(order, errors.of_motion.least_order)


def _nearer(errors: Errors, order: int) -> Iterator[Error]:
    """Yield errors smaller than any integrator leaves at this step; of gaps the widest alone, as an
    engine may hold some of its joints exactly."""
    scene = errors.of_scene
    least = LEAST * scene.step_rad ** highest_order(errors, order)
    for row in errors.rows:
        body = row.body_kind, row.body
        place = row.quantity in PLACES
        rate = row.quantity in RATES and row.source == "reported" and body in scene.uneven_rates
        if (place or rate) and row.kind in WHOLE and row.pure <= least * scene.uneven.get(body, -1):
            yield row
    gap = largest(row for row in errors.rows if row.quantity in named("closure"))
    borne = largest(row for row in errors.rows if row.quantity in FORCES)
    for widest in (gap, borne):
        if widest and widest.pure <= least * max(scene.uneven.values(), default=-1):
            yield widest


def _bent_the_same(errors: Errors) -> Iterator[Error]:
    """Yield deflections that equal a theory to rounding: no engine's steps and joints do."""
    if errors.of_links.slender >= STRAIGHT:
        return
    for row in errors.rows:
        if row.quantity in BENT and row.kind in WHOLE and row.pure <= SAME_BEND:
            yield row


def _the_same(errors: Errors) -> Iterator[Error]:
    """Yield the largest rate error of each body with all rates from the reference."""
    borne = largest(row for row in errors.rows if row.quantity in FORCES)
    moved = errors.worst("acceleration")
    off = moved.pure if moved and moved.pure > UNROUNDED else 0.0
    least = max(ROUNDING, LEAST * off * min(errors.of_forces.inertia_share, 1.0))
    if borne and errors.of_scene.uneven and borne.pure <= least:
        yield borne
    rates: dict[tuple[BodyKind, str], list[Error]] = {}
    for row in errors.rows:
        if row.quantity in RATES and row.source == "reported" and row.finite:
            rates.setdefault((row.body_kind, row.body), []).append(row)
    for body, own in rates.items():
        if body in errors.of_scene.uneven and all(row.pure <= ROUNDING for row in own):
            yield max(own, key=lambda row: row.pure)


UNSURE = 0.05
"""Least uncertainty of the beam, over the largest deflection, for advice: next to a resonance."""


class TruthEnds:
    id = "CC134"
    title = "where the reference ends"
    explanation = (
        "The error of the deflection has three parts: the engine against the exact chain of "
        "segments, that chain against the beam, and the uncertainty of the beam. If one of the "
        "last two is the largest, no engine and no step can reduce it."
    )
    cure = (
        "More segments (--segments), or --springs corrected; a shorter step does not help. If the "
        "beam itself is uncertain, keep away from whole numbers of its frequency over the speed, "
        "or give it damping_s."
    )

    def check(self, evidence: Evidence) -> Finding | None:
        errors = evidence.errors
        links = ElasticFacts.of(errors)
        if errors is None or links is None or evidence.status != "ok":
            return None
        own = engine_share(errors, links)
        parts = (
            f"parts of the largest deflection: engine {own:.1e}, {links.pieces} "
            f"{links.chain:.1e}{' (estimated)' if links.estimated else ''}, uncertainty of the "
            f"beam {links.doubt:.1e}, error of the linear theory {links.linear:.1e}"
        )
        if own > max(links.chain, links.doubt):
            return Finding(self.id, "pass", f"the engine has the largest part: {parts}", own)
        ends = f"the {links.pieces.split()[1]} limit"
        ends = ends if links.chain > links.doubt else "the reference limits"
        level: Level = "advice" if links.doubt > UNSURE else "pass"
        return Finding(self.id, level, f"{ends} the accuracy, not the engine: {parts}", own)


def engine_share(errors: Errors, links: ElasticFacts) -> float:
    """Return the engine's own error, over the largest deflection: against the exact chain, or the
    rest of its error against the beam."""
    exact, beam = errors.worst("segments"), errors.worst("deflection")
    if exact is not None:
        return exact.pure
    return max((beam.pure if beam else 0.0) - links.chain, 0.0)
