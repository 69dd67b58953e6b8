"""Hard cases: a map of where each engine breaks, its motion there, and the references.

Shapes and words only: a sign gives the outcome of a cell, a shade the size of its error.
"""

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from reports.drawing.moving import embedded
from reports.output.numbers import count, error_text
from reports.page.sections.section import PageReport, Section, fitting
from reports.results.engine_table import FEWEST
from reports.stability import grades, table
from reports.stability.matrix import OUTCOMES, CaseFacts, Graded, Line, Matrix, Outcome, Picture
from reports.stability.running import command

ROOM = 800_000
"""Characters for all moving pictures, where other sections need room as well."""
SCRIPTS = ("mechanism.js", "stage.js", "copying.js", "map.js", "hard.js")


def build(report: PageReport) -> Section | None:
    """Return the section; None for a store without hard cases beside it."""
    return None if report.matrix is None else hard(report.matrix)


def hard(matrix: Matrix, room: int = ROOM) -> Section:
    """Return the section of a matrix, its moving pictures in ``room`` characters."""
    drawn = _drawn(matrix, room)
    shown = [number for number, _ in drawn]
    chart = heat(matrix, frozenset(shown))
    cases = {case.name: case for case in matrix.cases}
    errors = list(dict.fromkeys(case.error_of for case in matrix.cases))
    meanings = {str(name): words for name, words in grades.MEANINGS.items()}
    return Section(
        anchor="hard",
        title="Hard cases",
        template="hard.html",
        words={
            "columns": chart.columns,
            "engines": Counter(column.engine for column in chart.columns),
            "groups": chart.groups,
            "places": places(chart.columns),
            "profiles": list(dict.fromkeys(column.profile for column in chart.columns)),
            "opened": matrix.runs[shown[0]].case if shown else None,
            "opened_engine": matrix.runs[shown[0]].engine if shown else None,
            "legend": [
                (sign(name), kind(name), name, meanings.get(name, "unknown on this page"), number)
                for name, number in outcomes_seen(matrix).items()
            ],
            "shaded": errors[0] if len(errors) == 1 else "see the details of each case",
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
    """Return the section of a matrix with ``over`` characters of pictures less."""
    assert section.embedded is not None
    held = len(embedded([section.embedded["drawings"], section.embedded["pictures"]]))
    return hard(matrix, held - over)


def _from(error: float) -> str:
    return f"from {error_text(error, 1) if error < 1.0 else '1'}"


def _drawn(matrix: Matrix, room: int) -> list[tuple[int, Picture]]:
    """Return the shown pictures with the numbers of their runs, in the order of the map.

    The easiest failures of each case in each engine, its limits, come first if the room is short.
    """
    places = {case.name: index for index, case in enumerate(matrix.cases)}
    columns = list(dict.fromkeys((run.engine, run.profile) for run in matrix.runs))
    shown = []
    for picture in matrix.pictures:
        number = _number(matrix, picture)
        if number is not None and picture.case in places:
            shown.append((number, picture))
    shown.sort(key=lambda x: (places[x[1].case], columns.index((x[1].engine, x[1].profile)), x[0]))
    ranks = Counter[Line]()
    order = []
    for index, (_, one) in enumerate(shown):
        ranks[one.line] += 1
        order.append((ranks[one.line], index))
    sizes = [len(embedded([one.drawing, one.rows])) for _, one in shown]
    return [shown[i] for i in fitting([index for _, index in sorted(order)], sizes, room)]


def _number(matrix: Matrix, picture: Picture) -> int | None:
    for number, run in enumerate(matrix.runs):
        if run.line == picture.line and same(run.value, picture.value):
            return number
    return None


def _pictures(drawn: Sequence[tuple[int, Picture]]) -> dict[str, object]:
    """Return the pictures as the page reads them; a shared reference is included once."""
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
    """Return the runs with a picture by the title of their case: number, and text of the choice."""
    runs: dict[str, list[tuple[int, str]]] = {}
    for number in shown:
        run = matrix.runs[number]
        case = matrix.case(run.case)
        words = f"{run.engine} {run.profile}, {amount(run.value, case.unit)}: {run.outcome}"
        runs.setdefault(case.title, []).append((number, words))
    return runs


def _case(case: CaseFacts) -> dict[str, object]:
    told = ("title", "parameter", "unit", "within", "error_of")
    return {name: getattr(case, name) for name in told} | {"good": ", ".join(case.good)}


def _driver(case: CaseFacts | None, place: float | None) -> str | None:
    if place is None or math.isnan(place):
        return None
    if case is not None and case.driver_unit == "m":
        return f"slider at {1e3 * place:.1f} mm"
    return f"crank at {math.degrees(place):.1f}\N{DEGREE SIGN}"


def _run(case: CaseFacts | None, run: Graded) -> dict[str, object]:
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


SIGNS: Mapping[str, str] = {str(name): letter for name, letter in table.LETTERS.items()} | {
    "ok": "\N{CHECK MARK}",
    "unsupported": "\N{EN DASH}",
}
"""One sign per outcome, so that the map is readable without its colours: as on the terminal."""
STRANGE = "?"
"""Sign of an outcome unknown to this page."""
SHADES = (1e-6, 1e-4, 1e-2, 1.0)
"""Errors from which on a cell is a shade stronger: pure numbers."""
LONGEST = 200
"""Characters of a reason in the words of a cell; the whole reason is shown with the run."""
HeatKey = tuple[str, str]
"""An engine and its profile: a column of the map."""


@dataclass(frozen=True)
class HeatCell:
    """One value of a case in one column; ``number`` is the number of its run, None if not run.

    ``kind`` names the outcome for the style sheet, ``shade`` goes from 0 to 4, and is -1 where the
    run has no error; ``held`` says that the engine holds with this outcome.
    """

    number: int | None
    label: str
    sign: str
    kind: str
    shade: int
    held: bool
    words: str
    pictured: bool


Strip = tuple[list[HeatCell], str]
"""A case in one column: its cells from easy to hard, and its limit in words."""


@dataclass(frozen=True)
class HeatColumn:
    """An engine with a profile, and the number of cases in which it holds throughout."""

    engine: str
    profile: str
    words: str

    @property
    def name(self) -> str:
        return f"{self.engine} {self.profile}"


@dataclass(frozen=True)
class Heat:
    """The whole map: columns, and by group in the order of the cases a strip for each of these."""

    columns: list[HeatColumn]
    groups: Mapping[str, list[tuple[CaseFacts, list[Strip]]]]


def places(columns: Sequence[HeatColumn]) -> dict[str, list[int | None]]:
    """Return the columns of each engine by profile, for a map with a row for each of many engines;
    empty for few, which stand side by side."""
    numbers = {(column.engine, column.profile): at for at, column in enumerate(columns)}
    engines, profiles = (dict.fromkeys(name[k] for name in numbers) for k in (0, 1))
    if len(engines) < FEWEST:
        return {}
    return {engine: [numbers.get((engine, each)) for each in profiles] for engine in engines}


def kind(outcome: str) -> str:
    """Return the name of any outcome in the style sheet."""
    return outcome if outcome in OUTCOMES else "strange"


def sign(outcome: str) -> str:
    """Return the sign of an outcome."""
    return SIGNS.get(outcome, STRANGE)


def shade(error: float | None) -> int:
    """Return the strength of the shade of an error, by its power of ten; -1 if it is not finite."""
    if error is None or not math.isfinite(error):
        return -1
    return sum(error >= limit for limit in SHADES)


def amount(value: float | None, unit: str) -> str:
    """Return a value of a case with its unit."""
    return f"{'?' if value is None else f'{value:.6g}'} {unit}".strip()


def same(one: float | None, other: float | None) -> bool:
    """True if two values of a case are equal; missing numbers are equal to each other."""
    if _lost(one) or _lost(other):
        return _lost(one) and _lost(other)
    return one == other


def heat(matrix: Matrix, pictured: frozenset[int] = frozenset()) -> Heat:
    """Return the map of a matrix; ``pictured`` are the runs with a moving picture, by number."""
    lines = list(dict.fromkeys((run.engine, run.profile) for run in matrix.runs))
    numbered: dict[tuple[str, HeatKey], list[tuple[int, Graded]]] = {}
    for number, run in enumerate(matrix.runs):
        numbered.setdefault((run.case, (run.engine, run.profile)), []).append((number, run))
    words = {(one.case, (one.engine, one.profile)): one.words for one in matrix.critical}
    groups: dict[str, list[tuple[CaseFacts, list[Strip]]]] = {}
    for case in matrix.cases:
        strips = [
            (
                [*_cells(case, numbered.get((case.name, line), []), pictured)],
                words.get((case.name, line), ""),
            )
            for line in lines
        ]
        groups.setdefault(case.group, []).append((case, strips))
    by_column = zip(*(strips for group in groups.values() for _, strips in group), strict=True)
    held = [_held(strips) for strips in by_column] or [_held(())] * len(lines)
    columns = [HeatColumn(*line, told) for line, told in zip(lines, held, strict=True)]
    return Heat(columns, groups)


def _held(strips: Sequence[Strip]) -> str:
    run = [[cell.held for cell in cells if cell.number is not None] for cells, _ in strips]
    ran = [cells for cells in run if cells]
    return f"holds {sum(map(all, ran))} of {len(ran)} throughout"


def _cells(
    case: CaseFacts, runs: Sequence[tuple[int, Graded]], pictured: frozenset[int]
) -> Iterator[HeatCell]:
    """Yield a cell for each value, also for one that was not run."""
    for value, label in zip(case.values, case.labels, strict=True):
        own = [pair for pair in runs if pair[1].grid and same(pair[1].value, value)]
        if not own:
            words = f"{amount(value, case.unit)}: not run"
            yield HeatCell(None, label, "\N{MIDDLE DOT}", "none", -1, False, words, False)
            continue
        number, run = own[0]
        yield HeatCell(
            number=number,
            label=label,
            sign=sign(run.outcome),
            kind=kind(run.outcome),
            shade=shade(run.error),
            held=run.outcome in case.good,
            words=told(case, run),
            pictured=number in pictured,
        )


def told(case: CaseFacts, run: Graded) -> str:
    """Return a run in words: value, outcome, error and reason."""
    holds = "holds" if run.outcome in case.good else "fails"
    reason = run.reason if len(run.reason) <= LONGEST else f"{run.reason[: LONGEST - 1]}\u2026"
    words = f"{amount(run.value, case.unit)}, {run.engine} {run.profile}: {run.outcome} ({holds})"
    return f"{words}; error {error_text(run.error)}" + (f"; {reason}" if reason else "")


def outcomes_seen(matrix: Matrix) -> dict[str, int]:
    """Return the outcomes of the grid with their counts, known ones in their order, then others."""
    counts = Counter(str(run.outcome) for run in matrix.runs if run.grid)
    names: tuple[Outcome, ...] = OUTCOMES
    return {
        name: counts[name] for name in (*names, *sorted(set(counts) - set(names))) if counts[name]
    }


def _lost(value: float | None) -> bool:
    return value is None or math.isnan(value)
