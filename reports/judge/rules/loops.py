"""CC135: what closes the loops holds."""

from models.errors import few
from reports.compare.branch import CLOSED
from reports.judge.rules.rule import Evidence, Finding
from reports.output.numbers import count

FREEDOMS = {"point": ("pin", 2)}
"""Name of a joint by the kind of its gap, and the freedoms that it takes from two bodies; of others
one is sure."""


class LoopsHold:
    id = "CC135"
    title = "loops"
    explanation = (
        "A joint that is open by a twentieth of the longest link holds nothing any more: what is "
        "left of the joints gives the mechanism more freedoms than it has. Solvers of joint "
        "coordinates may leave out the joints that close loops, without a word."
    )
    cure = (
        "Look at whether the solver enforces joints that close loops, and how stiff they are: a "
        "shorter step does not help where it leaves them out."
    )

    def check(self, evidence: Evidence) -> Finding | None:
        """Name the open joints, if any, and the freedoms that they add."""
        rows = evidence.errors.rows if evidence.errors else ()
        gaps = [row for row in rows if row.quantity == "gap" and row.kind == "total"]
        open_ = [row for row in gaps if row.finite and row.pure >= CLOSED]
        if not open_:
            return None
        worst = max(row.pure for row in open_)
        kinds = [FREEDOMS.get(row.body_kind, (row.body_kind, 1)) for row in open_]
        more = sum(taken for _, taken in kinds)
        names = few((f"{k} {row.body}" for (k, _), row in zip(kinds, open_, strict=True)), 4)
        text = (
            f"loop not enforced: {names} open by up to {worst:.2g} of the longest link, which "
            f"leaves {count(more, 'freedom')} more than the mechanism has"
        )
        return Finding(self.id, "fail", text, worst, CLOSED)
