"""Hard cases: a map of where each engine breaks, what happened there in motion, and the truths."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence

from reports.drawing.packed import embedded
from reports.output.numbers import count, error_text
from reports.page.heat import SHADES, amount, heat, kind, outcomes_seen, same, shade, sign
from reports.page.sections.section import PageReport, Section
from reports.page.thinning import fitting
from reports.stability.critical import command
from reports.stability.grades import MEANINGS
from reports.stability.matrix import CaseFacts, Graded, Matrix, Picture

ROOM = 800_000
"""Characters for all moving pictures, where other sections need room as well."""
SCRIPTS = ("mechanism.js", "stage.js", "copying.js", "map.js", "hard.js")


def build(report: PageReport) -> Section | None:
    """The section; None for a store without hard cases beside it."""
    return None if report.matrix is None else hard(report.matrix)


def hard(matrix: Matrix, room: int = ROOM) -> Section:
    """The section of a matrix, its moving pictures in ``room`` characters."""
    drawn = _drawn(matrix, room)
    shown = [number for number, _ in drawn]
    chart = heat(matrix, frozenset(shown))
    cases = {case.name: case for case in matrix.cases}
    errors = list(dict.fromkeys(case.error_of for case in matrix.cases))
    meanings = {str(name): words for name, words in MEANINGS.items()}
    return Section(
        anchor="hard",
        title="Hard cases",
        template="hard.html",
        words={
            "columns": chart.columns,
            "engines": Counter(column.engine for column in chart.columns),
            "groups": chart.groups,
            "opened": matrix.runs[shown[0]].case if shown else None,
            "legend": [
                (sign(name), kind(name), name, meanings.get(name, "not known to this page"), number)
                for name, number in outcomes_seen(matrix).items()
            ],
            "shaded": errors[0] if len(errors) == 1 else "what each case says",
            "shades": [f"below {error_text(SHADES[0], 1)}", *map(_from, SHADES)],
            "failures": _failures(matrix, shown),
            "left_out": count(len(matrix.pictures) - len(drawn), "moving picture"),
            "thinned": len(drawn) < len(matrix.pictures),
            "cases": matrix.cases,
            "facts": matrix.facts,
        },
        embedded={
            "cases": {name: _case(case) for name, case in cases.items()},
            "runs": [_run(cases.get(run.case), run) for run in matrix.runs],
            **_pictures(drawn),
        },
        scripts=SCRIPTS,
        styles=("map.css",),
    )


def lighter(matrix: Matrix, section: Section, over: int) -> Section:
    """The section of a matrix again, by ``over`` characters of pictures lighter than it is."""
    assert section.embedded is not None
    held = len(embedded([section.embedded["drawings"], section.embedded["pictures"]]))
    return hard(matrix, held - over)


def _from(error: float) -> str:
    return f"from {error_text(error, 1) if error < 1.0 else '1'}"


def _drawn(matrix: Matrix, room: int) -> list[tuple[int, Picture]]:
    """The pictures that are shown with the numbers of their runs, in the order of the map.

    Where the room is short, the easiest failures of each case in each engine come first: they
    are where it breaks.
    """
    places = {case.name: index for index, case in enumerate(matrix.cases)}
    lines = {(run.engine, run.profile): None for run in matrix.runs}
    columns = {line: index for index, line in enumerate(lines)}
    shown = []
    for picture in matrix.pictures:
        number = _number(matrix, picture)
        if number is not None and picture.case in places:
            shown.append((number, picture))
    shown.sort(key=lambda x: (places[x[1].case], columns[x[1].engine, x[1].profile], x[0]))
    ranks: dict[tuple[str, str, str], int] = {}
    order = []
    for index, (_, one) in enumerate(shown):
        line = (one.case, one.engine, one.profile)
        ranks[line] = ranks.get(line, 0) + 1
        order.append((ranks[line], index))
    sizes = [len(embedded([one.drawing, one.rows])) for _, one in shown]
    return [shown[i] for i in fitting([index for _, index in sorted(order)], sizes, room)]


def _number(matrix: Matrix, picture: Picture) -> int | None:
    """The number of the run that a picture is of."""
    wanted = (picture.case, picture.engine, picture.profile)
    for number, run in enumerate(matrix.runs):
        if (run.case, run.engine, run.profile) == wanted and same(run.value, picture.value):
            return number
    return None


def _pictures(drawn: Sequence[tuple[int, Picture]]) -> dict[str, object]:
    """The pictures as the page reads them; a truth that several share is there once."""
    drawings: dict[str, tuple[int, Mapping[str, object]]] = {}
    pictures = []
    for number, picture in drawn:
        key = str(embedded(picture.drawing))
        index, _ = drawings.setdefault(key, (len(drawings), picture.drawing))
        pictures.append(
            {"run": number, "drawing": index, "rows": picture.rows, "title": picture.title}
        )
    return {"drawings": [drawing for _, drawing in drawings.values()], "pictures": pictures}


def _failures(matrix: Matrix, shown: Sequence[int]) -> dict[str, list[tuple[int, str]]]:
    """The runs with a picture by the title of their case: number, and what the choice says."""
    runs: dict[str, list[tuple[int, str]]] = {}
    for number in shown:
        run = matrix.runs[number]
        case = matrix.case(run.case)
        words = f"{run.engine} {run.profile}, {amount(run.value, case.unit)}: {run.outcome}"
        runs.setdefault(case.title, []).append((number, words))
    return runs


def _case(case: CaseFacts) -> dict[str, object]:
    """What the scripts need of a case."""
    return {
        "title": case.title,
        "parameter": case.parameter,
        "unit": case.unit,
        "within": case.within,
        "error_of": case.error_of,
        "good": ", ".join(case.good),
    }


def _driver(case: CaseFacts | None, place: float | None) -> str | None:
    """Where the driver stands, in words; None where it has no place."""
    if place is None or math.isnan(place):
        return None
    if case is not None and case.driver_unit == "m":
        return f"slider at {1e3 * place:.1f} mm"
    return f"crank at {math.degrees(place):.1f}\N{DEGREE SIGN}"


def _run(case: CaseFacts | None, run: Graded) -> dict[str, object]:
    """What the scripts need of a run."""
    return {
        **vars(run),
        "value_told": amount(run.value, case.unit if case else ""),
        "sign": sign(run.outcome),
        "kind": kind(run.outcome),
        "shade": shade(run.error),
        "held": case is not None and run.outcome in case.good,
        "at_driver": _driver(case, run.at_driver_rad),
        "command": command(run),
    }
