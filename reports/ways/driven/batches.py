"""The table of cells that are run as batches."""

from collections.abc import Sequence

from reports.judge.cell import Checked
from reports.output.numbers import readable
from reports.verify.table import CellTable

FACTS = (
    *("worlds", "threads", "steps", "error\nrad, / L", "in\nworld"),
    *("from alone\n/ bound", "us a\nstep", "us\nalone"),
)


def _facts(one: Checked) -> Sequence[str]:
    cell, batch = one.cell, one.batch
    asked = [str(cell.worlds), str(cell.threads), str(cell.steps)]
    if batch is None:
        return [*asked, *["-"] * (len(FACTS) - len(asked))]
    alone = "0" if batch.exact else f"{batch.difference:.0e} / {batch.bound:.0e}"
    costs = readable(batch.us_per_step), readable(batch.us_alone)
    return [*asked, f"{batch.error:.1e}", str(batch.error_in), alone, *costs]


BATCHES = CellTable("batches, ", {}, ((0, (), FACTS),), before=_facts, last="ended")
