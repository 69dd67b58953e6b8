"""`crankcheck solve --family`: mechanisms that differ in one number, side by side."""

import base64
import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator
from rich.console import Console

from models.errors import CrankcheckError
from models.scene import Scene
from reports.describe.facts import describe_law
from reports.figures.drawing import DASHES
from reports.figures.sheet import Panels, sheet
from reports.figures.style import COLUMN_IN, PAGE_IN, mark_zero, saved, shorten, styled
from reports.lectures.drawing.workbook.family import (
    KINDS,
    FamilyCurves,
    extremes,
    family,
    family_curves,
    scene_curves,
    scene_family,
)
from reports.lectures.drawing.workbook.live_workbook import (
    MOST_LIVE,
    formulas_of,
    live_workbook,
    scene_family_workbook,
)
from reports.output.console import say_whole
from reports.output.numbers import count
from reports.output.palette import COLOURS
from reports.output.write import crankcheck_version, write
from reports.page.build import Head, assembled
from reports.page.sections.section import Section
from reports.protocol.way import way_of
from reports.requests import solving
from reports.requests.options import SolveOptions, given

LARGEST = 1e9
"""Largest number of a mechanism [SI]."""


def run_family(scene: Scene, request: SolveOptions, console: Console) -> None:
    """Write the family. Raises CrankcheckError for a faulty request."""
    assert request.family is not None
    _check(scene, request)
    name, values = _values(request.family)
    if request.output is None:
        raise CrankcheckError(
            f"--family {request.family}: give a file for it, -o FILE"
            f"{', FILE'.join(solving.FAMILY_ENDINGS)}"
        )
    time_s = solving.instants_of(scene, request)
    if time_s.size * len(values) > MOST_LIVE:
        raise CrankcheckError(
            f"--family {request.family}: {time_s.size} rows of {len(values)} members; at most "
            f"{MOST_LIVE} of all together: take fewer turns, or fewer steps in a turn"
        )
    origin = {"scene": scene.name, "source": scene.source, "family": request.family}
    ending = request.output.suffix.lower()
    is_workbook = ending == solving.WORKBOOK
    step_deg = math.degrees(float(time_s[1]) * scene.pace_rad_s)
    table = formulas_of(scene, time_s.size, step_deg)
    if table is not None and is_workbook:
        content: bytes | str = live_workbook(family(table, name, values), origin)
    elif is_workbook:
        content = scene_family_workbook(scene_family(scene, name, values, time_s), origin)
    else:
        curves = (
            scene_curves(scene_family(scene, name, values, time_s))
            if table is None
            else family_curves(table, name, values)
        )
        content = (
            family_page_of(scene, curves)
            if ending == solving.PAGE
            else family_drawing(scene, curves, ending[1:])
        )
    write(request.output, content)
    told = f"{request.output}: {len(values)} members of {scene.name}, {time_s.size} rows"
    say_whole(console, told)


NO_FAMILY = {"elastic": "has elastic links", "free": "is in free motion"}
"""Kinds of scenes without families, and the reasons."""


def _check(scene: Scene, request: SolveOptions) -> None:
    """Refuse a family of a scene without one, or of a single position. Raises CrankcheckError."""
    if why := NO_FAMILY.get(way_of(scene).kinds[0]):
        raise CrankcheckError(
            f"--family {request.family}: {scene.name} {why}; members of a family have rigid "
            "links, and follow a law of motion"
        )
    for option in given(request, "at_deg", "at_m", "clockwise", "along", "forces", "figures"):
        raise CrankcheckError(
            f"--family with {option}: a family is position, velocity and acceleration over "
            f"whole turns; leave {option} out"
        )
    solving.refuse_times(scene, request)
    solving.elastic_choice(request).refuse_of_rigid(scene)


def _values(text: str) -> tuple[str, list[float]]:
    """Parse a name and numbers, such as L=3.5,2.5. Raises CrankcheckError."""
    name, equals, numbers = text.partition("=")
    try:
        values = [float(number) for number in numbers.split(",")] if equals else []
    except ValueError:
        values = []
    if not values or not all(abs(value) <= LARGEST for value in values):
        raise CrankcheckError(
            f"--family {text}: write a name and numbers up to {LARGEST:g}, such as L=3.5,2.5,2.2"
        )
    return name.strip(), values


TICKS_DEG = [1, 1.5, 3, 4.5, 6, 9, 10]
"""Steps of an axis of angles, within a power of ten."""


def draw_family(
    curves: FamilyCurves, title: str, notes: Sequence[str], kinds: Sequence[str] = KINDS
) -> Figure:
    """The figure: a row for each of the ``kinds``, below each other over one axis."""
    rows = [curves.of_kind(kind) for kind in kinds]
    wide = len(rows[0])
    looks = [_look(k) for k in range(len(curves.values))]
    lines = [Line2D([], [], **look) for look in looks]
    entries = list(zip(lines, curves.members, strict=True))
    height = 1.25 if len(rows) > 1 else 1.9
    panels = Panels(len(rows), wide, height, 0.52, 0.08, 0.12, between=(0.5, 0.13))
    width = COLUMN_IN if wide == 1 else PAGE_IN
    ends = [end for angle in curves.angles_deg for end in (np.min(angle), np.max(angle))]
    with styled():
        figure, axes = sheet(width, panels, title, entries, notes)
        for at, one in enumerate(axes):
            chart = rows[at // wide][at % wide]
            mark_zero(one, *chart.curves)
            for angle, curve, look in zip(curves.angles_deg, chart.curves, looks, strict=True):
                one.plot(angle, curve, **look)
            one.set_xlim(min(ends), max(ends))
            one.xaxis.set_major_locator(MaxNLocator(9, steps=TICKS_DEG))
            shorten(one)
            one.set_ylabel(chart.label)
            is_lowest = at // wide == len(rows) - 1
            one.tick_params(labelbottom=is_lowest)
            if is_lowest:
                one.set_xlabel("angle of the crank [deg]")
    return figure


def _look(k: int) -> dict[str, Any]:
    """The look of a member's curve: a hue of its own, and dashes where hues run out."""
    dashes = DASHES[k % len(DASHES)]
    colour = COLOURS[5 * k % len(COLOURS)]  # of another family than the one before
    return {"color": colour, "linestyle": (0, dashes) if dashes else "-", "linewidth": 1.0}


def family_page_of(scene: Scene, curves: FamilyCurves) -> str:
    """The page as HTML: a figure each of position, velocity and acceleration."""
    title = _title(scene, curves)
    figures = []
    for kind in KINDS:
        svg = saved(draw_family(curves, "", [], [kind]), "svg", f"{title}: {kind}")
        words = f"{kind.capitalize()} over the angle of the crank."
        figures.append((kind, words, base64.b64encode(svg).decode("ascii")))
    section = Section(
        anchor="family",
        title=f"Members over {curves.name}",
        template="scene_family.html",
        words={
            "source": f"{scene.source}. {scene.note}".rstrip(),
            "name": curves.name,
            "labels": [chart.label for chart in curves.charts],
            "rows": extremes(curves),
            "notes": _notes(scene, curves),
            "figures": figures,
        },
        styles=("forces.css",),
    )
    facts = (count(len(curves.values), "member"), f"crankcheck {crankcheck_version()}")
    head = Head(f"crankcheck: {scene.name}, family", facts, made="", first="family")
    return assembled(head, [section])


def family_drawing(scene: Scene, curves: FamilyCurves, kind: str) -> bytes:
    """Three panels in one file of a kind of figures: svg or pdf."""
    title = _title(scene, curves)
    notes = [f"{scene.source}. {scene.note}".rstrip(), *_notes(scene, curves)]
    return saved(draw_family(curves, title, notes), kind, title)


def _title(scene: Scene, curves: FamilyCurves) -> str:
    return f"{scene.name}, family of {curves.name}"


def _notes(scene: Scene, curves: FamilyCurves) -> list[str]:
    speed = "" if curves.name == "omega" else f"; {scene.driver.joint} {describe_law(scene)}"
    return [f"crankcheck {crankcheck_version()}, closed form{speed}."]
