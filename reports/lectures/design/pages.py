"""Pages of a synthesis: a construction step by step, and all solutions side by side."""

import base64
import math
from collections.abc import Mapping, Sequence

import numpy as np

from analytic.lectures.drawings.polygon import PlacedMechanism
from analytic.lectures.synthesis import design
from analytic.lectures.synthesis.examine import Examined
from models.array import Array
from models.lectures.shipped_tables import TaskTable
from reports.describe.facts import describe_law
from reports.drawing.moving import drawing
from reports.drawing.shape import turn_of
from reports.lectures.design import construction_view
from reports.lectures.design.design_tables import proof_rows, remarks
from reports.lectures.design.proof import Met
from reports.lectures.drawing.sheets.paper import Canvas, Paper, sheet_note
from reports.lectures.drawing.sheets.position_sheet import draw_assemblies
from reports.output.numbers import count, listed
from reports.output.write import crankcheck_version
from reports.page.build import Head, assembled
from reports.page.sections.section import Section

INSTANTS = 241
"""Number of instants over the range of the driver, both ends included."""
LASTS_MS = 8000
"""Duration of the motion [ms]: slow enough to see the positions."""
AROUND = 1.5
"""Length of lines beyond the figure, in its sizes: a screen is wider than its box."""
EVERY = 4
"""Stride of the places along a circle: these suffice for a screen."""
MOVES = "The mechanism goes through its precision positions."


def construction_page(proposed: Examined | design.Proposal) -> str:
    """The page of a construction, one file that loads nothing. Raises CrankcheckError for a
    proposal that can not be assembled in its first position."""
    view = construction_view.ConstructionView.of(proposed)
    scene = view.examined.scene
    section = Section(
        anchor="construction",
        title="Construction, step by step",
        template="construction.html",
        words={
            "steps": [*(step.words for step in view.steps), MOVES],
            "source": scene.source,
            "chosen": view.examined.proposal.chosen,
            "doubts": _doubts(view),
        },
        embedded=_embedded(view),
        scripts=("mechanism.js", "construction_figure.js", "construction.js"),
        styles=("construction.css",),
    )
    facts = (
        count(len(view.placements), "precision position"),
        describe_law(scene),
        f"crankcheck {crankcheck_version()}",
    )
    head = Head(f"crankcheck: construction of {scene.name}", facts, made="", first="construction")
    return assembled(head, [section])


def _doubts(view: construction_view.ConstructionView) -> list[str]:
    doubt, defects = view.examined.proposal.doubt, view.examined.defects
    return [doubt] * bool(doubt) + [f"It has a defect: {listed(defects)}."] * bool(defects)


def _embedded(view: construction_view.ConstructionView) -> dict[str, object]:
    """The drawn parts of the page: places [m] as x, y after one another."""
    motion = turn_of(view.examined.scene, INSTANTS)
    moves = drawing(view.examined.scene, motion.time_s, motion)
    places = [view.shown, *(point.position for point in motion.points.values())]
    low, high = (end(np.concatenate(places), axis=0) for end in (np.min, np.max))
    spare = AROUND * float(np.max(high - low))
    curves = {
        id(curve): number for number, curve in enumerate(construction_view.curves_of(view.steps))
    }
    return {
        "drawing": moves | {"box": [*low, *high]},
        "steps": [
            [_element(each, low - spare, high + spare, curves) for each in step.elements]
            for step in view.steps
        ],
        "poses": [_pose(view, k) for k in range(len(view.placements))],
        "at": construction_view.positions_on_way(view, motion),
        "far": [{"at": list(at), "words": words} for at, words in view.far(low, high)],
        "lasts_ms": LASTS_MS,
    }


def _element(
    element: design.Element, low: Array, high: Array, curves: dict[int, int]
) -> dict[str, object]:
    """A dot, or lines as far as they are in a box; curves have one of several looks."""
    if isinstance(element, design.Dot):
        at = list(construction_view.xy(element.place))
        return {"at": at, "letter": element.letter, "fixed": element.fixed, "look": element.look}
    lines = construction_view.strokes(element, low, high)
    if isinstance(element, design.DrawnCircle):
        lines = [np.concatenate([line[:-1:EVERY], line[-1:]]) for line in lines]
    is_curve = isinstance(element, design.DrawnCurve) and id(element) in curves
    look = (
        f"curve-{curves[id(element)] % len(construction_view.CURVES)}" if is_curve else element.look
    )
    return {"look": look, "lines": _flat(lines)}


def _flat(lines: list[Array]) -> list[list[float]]:
    return [[float(number) for number in line.ravel()] for line in lines]


def _pose(view: construction_view.ConstructionView, number: int) -> dict[str, object]:
    """The requirements of a position: the links with required angles, or else with required points,
    as placed there, or all links; and the required places of points."""
    placed, position = view.placements[number], view.examined.positions[number]
    places = [
        list(construction_view.xy(each.place))
        for each in position.asked
        if isinstance(each, design.AskedPlace)
    ]
    return {"links": _flat(_asked_links(view, placed)), "places": places}


def _asked_links(
    view: construction_view.ConstructionView, placed: PlacedMechanism | None
) -> list[Array]:
    if placed is None:
        return []
    names, points, _ = design.names_of(view.examined.positions)
    every = placed.scene.links.values()
    asked = [link for link in every if link.name in names]
    some = asked or [link for link in every if set(link.points) & set(points)]
    rings = [[placed.points[name] for name in link.points] for link in some or every]
    return [np.array([*ring, ring[0]] if len(ring) > 2 else ring) for ring in rings]


Proofs = Mapping[int, Sequence[Met]]


def solutions_sheet(every: Sequence[Examined], task: TaskTable, paper: Paper) -> Canvas | None:
    """All solutions in their first positions, to one scale; None where none can be placed there.
    Raises CrankcheckError for paper that is too small."""
    drawn = []
    for number, one in enumerate(every, 1):
        placement = construction_view.placements_of(one)[0]
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
    """The page of all solutions; ``sheet`` is their SVG, ``facts`` are versions and settings. It
    links to the pages of the constructions, `construction_name`, beside it."""
    sections = [_solutions(every, task, counted, sheet)]
    if proofs:
        rows = proof_rows(proofs)
        words = {"rows": rows, "within": all(row["within"] for row in rows)}
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
    template, styles = "synthesis_solutions.html", ("forces.css",)
    return Section("solutions", "Solutions", template, words, styles=styles)


def construction_name(number: int, kind: str) -> str:
    """The file name of a solution's construction."""
    return f"construction-{number}.{kind}"


def scene_name(number: int) -> str:
    """The file name of a solution's scene."""
    return f"solution-{number}.toml"


def _transmission(one: Examined) -> str:
    return f"{math.degrees(one.least_transmission_rad):.2f}"
