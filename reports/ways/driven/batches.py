"""The table of cells that are run as batches."""

from collections.abc import Sequence

from reports.judge.cell import Checked
from reports.output.numbers import readable
from reports.quantities import named
from reports.verify.table import CellTable

ERROR = "error\nrad, / L"
FACTS = (
    "worlds",
    "threads",
    "steps",
    "worst\nworld",
    "from alone\n/ bound",
    "us a\nstep",
    "us\nalone",
)


def _facts(one: Checked) -> Sequence[str]:
    batch = one.batch
    if batch is None:
        return ["-"] * len(FACTS)
    asked = one.cell.worlds, one.cell.threads, one.cell.steps
    alone = "0" if batch.exact else f"{batch.difference:.0e} / {batch.bound:.0e}"
    costs = readable(batch.us_per_step), readable(batch.us_alone)
    return [*map(str, asked), str(batch.worst), alone, *costs]


BATCHES = CellTable(
    "batches, ",
    {ERROR: [*named("place")]},
    ((0, (ERROR,), FACTS),),
    before=_facts,
    last="ended",
)
