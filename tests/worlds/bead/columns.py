"""The columns of beads."""

from reports.judge.cell import Checked
from tests.worlds.bead.errors import BeadFacts
from tests.worlds.bead.swing import swing_of


def columns(checked: Checked) -> dict[str, object]:
    """How far it swings, and by how much its time is off."""
    facts = checked.errors.of_motion if checked.errors else None
    off = facts.period_off if isinstance(facts, BeadFacts) else None
    return {"swing_rad": abs(swing_of(checked.cell.scene).high_rad), "period_off": off}


COLUMNS = columns
