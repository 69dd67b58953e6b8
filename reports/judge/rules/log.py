"""CC101, CC109, CC115, CC117, CC119, CC124, CC126: the run is as requested, came to its end, and
its log is complete, made of numbers, holds all required parts, and is consistent."""

from reports.judge.rules.rule import Evidence, Finding, Level


class StatusOk:
    id = "CC101"
    title = "status"
    explanation = "A run that stopped early, or never started, shows nothing about the rest."
    cure = (
        "An unsupported scene prints what to change; a run that came apart needs a shorter step "
        "(--steps-per-turn); one that left its branch needs lengths, or a range of the driver, "
        "away from the singular position that it passes."
    )

    def check(self, evidence: Evidence) -> Finding | None:
        if evidence.status == "ok":
            return Finding(self.id, "pass", "the run came to its end")
        reason = f": {evidence.reason}" if evidence.reason else ""
        early = evidence.stopped_at_s > 0.0 and evidence.status != "branch-changed"
        at = f" at t = {evidence.stopped_at_s:.4g} s" if early else ""
        return Finding(self.id, "fail", f"{evidence.status}{at}{reason}")


class ValuesFinite:
    id = "CC109"
    title = "finite values"
    explanation = (
        "A NaN or an infinity in a log is a failure, even at one sample or at the end; so is a "
        "link, point, slider or pin of the scene that is missing from the log."
    )
    cure = (
        "Shorten the step; find the first bad step in the engine's warnings; if a body is "
        "missing, check the readings of the adapter."
    )

    def check(self, evidence: Evidence) -> Finding | None:
        if evidence.errors is None:
            return None
        broken = [row for row in evidence.errors.rows if not row.finite]
        if evidence.errors.missing:
            text = f"missing from the log: {', '.join(evidence.errors.missing)}"
            return Finding(self.id, "fail", text, float(len(broken)), 0.0)
        if not broken:
            return Finding(self.id, "pass", "every logged number is finite")
        first = min(broken, key=lambda row: row.time_of_maximum_s)
        bodies = ", ".join(dict.fromkeys(f"{row.quantity} of {row.body}" for row in broken[:4]))
        text = f"not finite from t = {first.time_of_maximum_s:.4g} s on: {bodies}"
        return Finding(self.id, "fail", text, float(len(broken)), 0.0)


class LogComplete:
    id = "CC115"
    title = "complete log"
    explanation = (
        "A run with status ok has logged every commanded sample, stamped with its whole number of "
        "steps; a sample that was not logged was not judged."
    )
    cure = "Check how the adapter logs: time stamps are start + k dt, not a summed clock."

    def check(self, evidence: Evidence) -> Finding | None:
        if evidence.status != "ok":
            return None  # short by its nature: the status fails already
        fault = "nothing was logged" if evidence.errors is None else evidence.errors.incomplete
        if fault:
            return Finding(self.id, "fail", fault)
        return Finding(self.id, "pass", "every commanded sample was logged at its time")


class AsAsked:
    id = "CC117"
    title = "as asked"
    explanation = (
        "The numbers belong to the requested engine, settings, drive, step and samples, and a "
        "finer run is a separate run: otherwise the verdict is that of another cell."
    )
    cure = (
        "Check the program that runs the cells: it must not return a stored, renamed or thinned "
        "run."
    )

    def check(self, evidence: Evidence) -> Finding | None:
        if evidence.unasked is None:
            return None
        copied = evidence.convergence.copied if evidence.convergence else ()
        faults = [*evidence.unasked, *copied]
        if faults:
            return Finding(self.id, "fail", "; ".join(faults), float(len(faults)), 0.0)
        return Finding(self.id, "pass", "the runs are the requested ones")


class Required:
    id = "CC119"
    title = "required"
    explanation = (
        "A quantity that the log lacks is not judged, and is a failure only if it is required."
    )
    cure = "Log the named quantity or body, or leave it out of --require."

    def check(self, evidence: Evidence) -> Finding | None:
        if evidence.absent is None:
            return None
        if evidence.absent:
            text = f"not in the log: {'; '.join(evidence.absent)}"
            return Finding(self.id, "fail", text, float(len(evidence.absent)), 0.0)
        return Finding(self.id, "pass", "the log has all that is required")


ROUNDING = 1e-9
"""A share of the largest reaction above any rounding of sums of a few forces."""


class PinsBalance:
    id = "CC124"
    title = "balance of pins"
    explanation = (
        "A pin has no mass: its forces on its bodies add up to zero, however the engine steps. "
        "Otherwise one of the forces is not the pin's."
    )
    cure = (
        "Check which bodies the adapter adds up: the force on one body is opposite to that on "
        "the other."
    )

    def check(self, evidence: Evidence) -> Finding | None:
        found = evidence.errors.of_forces.unbalanced if evidence.errors else None
        if found is None:
            return None
        level: Level = "pass" if found.share <= ROUNDING else "fail"
        text = (
            f"forces in pin {found.point} add up to {found.share:.2g} of the largest reaction; "
            f"limit {ROUNDING:.2g}"
        )
        return Finding(self.id, level, text, found.share, ROUNDING)


class NothingContradicts:
    id = "CC126"
    title = "forces as the engine has them"
    explanation = (
        "If an engine reports only sizes of forces, the forces are computed from the momentum "
        "of its bodies, and compared with these sizes: so its solver is judged, and not this "
        "computation."
    )
    cure = (
        "A load outside the balance acts on the bodies, or friction in a joint at rest may have "
        "either sign: do not trust the forces there."
    )

    def check(self, evidence: Evidence) -> Finding | None:
        against = evidence.errors.of_forces.contradictions if evidence.errors else ()
        if not against:
            return None
        more = f" (and {len(against) - 1} more)" if len(against) > 1 else ""
        return Finding(self.id, "fail", against[0] + more, float(len(against)), 0.0)
