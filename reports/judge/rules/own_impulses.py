"""CC126: what an engine says of a joint by itself goes with the forces that were read out of it."""

from __future__ import annotations

from reports.judge.rules.rule import Evidence, Finding


class NothingContradicts:
    id = "CC126"
    title = "forces as the engine has them"
    explanation = (
        "Where an engine reports sizes alone, its forces follow from the momentum of its bodies, "
        "and are held to those sizes: so its solver is judged, and not the arithmetic beside it."
    )
    cure = (
        "Something acts on the bodies that the balance does not know of, or friction in a joint "
        "that stands still may be either way: the forces are not to be trusted there."
    )

    def check(self, evidence: Evidence) -> Finding | None:
        against = evidence.errors.of_forces.contradictions if evidence.errors else ()
        if not against:
            return None
        more = f" (and {len(against) - 1} more)" if len(against) > 1 else ""
        return Finding(self.id, "fail", against[0] + more, float(len(against)), 0.0)
