"""The solutions of a synthesis beside each other, on one page: drawn, tabulated, proven."""

import base64
import math
from collections.abc import Mapping, Sequence

from analytic.lectures.synthesis.examine import Examined
from models.lectures.tasks.task import TaskTable
from reports.lectures.design.construction_view import placements_of
from reports.lectures.design.design_tables import proof_rows, remarks
from reports.lectures.design.proof import Met
from reports.lectures.drawing.sheets.field_sheets import draw_assemblies
from reports.lectures.drawing.sheets.paper import Canvas, Paper, sheet_note
from reports.output.numbers import count
from reports.page.build import Head, assembled
from reports.page.sections.section import Section

Proofs = Mapping[int, Sequence[Met]]


def solutions_sheet(every: Sequence[Examined], task: TaskTable, paper: Paper) -> Canvas | None:
    """All solutions in their first positions, to one scale; None where none stands in it. Raises
    CrankcheckError for paper that is too small."""
    drawn = []
    for number, one in enumerate(every, 1):
        placement = placements_of(one)[0]
        if placement is not None:
            told = ", ".join(one.defects) or f"{_transmission(one)} deg"
            drawn.append((placement, f"{number}: {told}", not one.defects))
    if not drawn:
        return None
    return draw_assemblies(drawn, f"solutions of {task.name}", sheet_note(every[0].scene), paper)


def solutions_page(
    every: Sequence[Examined],
    task: TaskTable,
    counted: str,
    sheet: bytes | None,
    proofs: Proofs,
    facts: Mapping[str, str],
) -> str:
    """The page; ``sheet`` is an SVG of all solutions, ``facts`` are versions and settings. It leads
    to the pages of the constructions, `construction_name`, beside it."""
    sections = [_solutions(every, task, counted, sheet)]
    if proofs:
        rows = proof_rows(proofs)
        words = {"rows": rows, "within": all(row.within for row in rows)}
        sections.append(Section("proof", "Proof in engines", "synthesis_proof.html", words))
    told = [f"{name} {value}" for name, value in facts.items() if name != "made"]
    head = Head(
        f"crankcheck: {task.name}",
        (count(len(every), "solution"), *told),
        made=facts.get("made", ""),
        first="solutions",
    )
    return assembled(head, sections)


def _solutions(
    every: Sequence[Examined], task: TaskTable, counted: str, sheet: bytes | None
) -> Section:
    rows = [
        {
            "number": number,
            "page": construction_name(number, "html"),
            "scene": scene_name(number),
            "defects": ", ".join(one.defects),
            "driver": "turns" if one.turns_fully else "swings",
            "transmission": _transmission(one),
            "extent": f"{one.extent_m:.4g}",
            "type": one.grashof,
            "chosen": [f"{name}: {value}" for name, value in one.proposal.chosen.items()],
            "remarks": remarks(one),
        }
        for number, one in enumerate(every, 1)
    ]
    picture = "" if sheet is None else base64.b64encode(sheet).decode()
    words = {"rows": rows, "source": task.source, "counted": counted, "picture": picture}
    return Section("solutions", "Solutions", "synthesis_solutions.html", words)


def construction_name(number: int, kind: str) -> str:
    """The file of a solution's construction."""
    return f"construction-{number}.{kind}"


def scene_name(number: int) -> str:
    """The file of a solution's scene."""
    return f"solution-{number}.toml"


def _transmission(one: Examined) -> str:
    return f"{math.degrees(one.least_transmission_rad):.2f}"
