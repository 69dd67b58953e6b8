"""A family of mechanisms as a drawing or a page, put together: its figures, and what stands with
them."""

from __future__ import annotations

import base64
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from models.scene import Scene
from reports.describe.facts import describe_law
from reports.figures.marks import COLOURS, DASHES
from reports.figures.saving import saved
from reports.figures.sheet import Panels, sheet
from reports.figures.style import COLUMN_IN, PAGE_IN, mark_zero, shorten, styled
from reports.lectures.drawing.workbook.family import KINDS, FamilyCurves, extremes
from reports.output.numbers import count
from reports.output.provenance import crankcheck_version
from reports.page.build import Head, assembled
from reports.page.sections.section import Section

TICKS_DEG = [1, 1.5, 3, 4.5, 6, 9, 10]
"""Steps of an axis of angles, within a power of ten."""


def draw_family(
    curves: FamilyCurves, title: str, notes: Sequence[str], kinds: Sequence[str] = KINDS
) -> Figure:
    """The figure: a row for each of the ``kinds``, below each other over one axis."""
    rows = [curves.of_kind(kind) for kind in kinds]
    wide = len(rows[0])
    looks = [_look(k) for k in range(len(curves.values))]
    entries: list[tuple[Artist, str]] = [
        (Line2D([], [], **look), member) for look, member in zip(looks, curves.members, strict=True)
    ]
    height = 1.25 if len(rows) > 1 else 1.9
    panels = Panels(len(rows), wide, height, 0.52, 0.08, 0.12, between=(0.5, 0.13))
    width = COLUMN_IN if wide == 1 else PAGE_IN
    with styled():
        figure, axes = sheet(width, panels, title, entries, notes)
        for at, one in enumerate(axes):
            chart = rows[at // wide][at % wide]
            mark_zero(one, *chart.curves)
            for angle, curve, look in zip(curves.angles_deg, chart.curves, looks, strict=True):
                one.plot(angle, curve, **look)
            _mark_angles(one, curves)
            shorten(one)
            one.set_ylabel(chart.label)
            is_lowest = at // wide == len(rows) - 1
            one.tick_params(labelbottom=is_lowest)
            if is_lowest:
                one.set_xlabel("angle of the crank [deg]")
    return figure


def _mark_angles(axes: Any, curves: FamilyCurves) -> None:
    """Limits of the axis of angles, and numbers at parts of a turn."""
    ends = [end for angle in curves.angles_deg for end in (np.min(angle), np.max(angle))]
    axes.set_xlim(min(ends), max(ends))
    axes.xaxis.set_major_locator(MaxNLocator(9, steps=TICKS_DEG))


def _look(k: int) -> dict[str, Any]:
    """The curve of a member: a hue of its own, and dashes for where there are none."""
    dashes = DASHES[k % len(DASHES)]
    shades = COLOURS[k % len(COLOURS)]
    colour = shades[1 + k // len(COLOURS) % (len(shades) - 1)]
    return {"color": colour, "linestyle": (0, dashes) if dashes else "-", "linewidth": 1.0}


def build(
    scene: Scene, curves: FamilyCurves, notes: Sequence[str], figures: Mapping[str, bytes]
) -> Section:
    """The section; ``figures`` are SVG files by the kind of what they show."""
    return Section(
        anchor="family",
        title=f"Members over {curves.name}",
        template="scene_family.html",
        words={
            "source": f"{scene.source}. {scene.note}".rstrip(),
            "name": curves.name,
            "labels": [chart.label for chart in curves.charts],
            "rows": extremes(curves),
            "notes": notes,
            "figures": [
                (kind, f"{kind.capitalize()} over the angle of the crank.", _encoded(svg))
                for kind, svg in figures.items()
            ],
        },
        styles=("forces.css",),
    )


def _encoded(svg: bytes) -> str:
    return base64.b64encode(svg).decode("ascii")


def family_page(
    scene: Scene, curves: FamilyCurves, notes: Sequence[str], figures: Mapping[str, bytes]
) -> str:
    """The page; ``figures`` are SVG files by the kind of what they show."""
    head = Head(
        title=f"crankcheck: {scene.name}, family",
        facts=(count(len(curves.values), "member"), f"crankcheck {crankcheck_version()}"),
        made="",
        first="family",
    )
    return assembled(head, [build(scene, curves, notes, figures)])


def family_drawing(scene: Scene, curves: FamilyCurves, kind: str) -> bytes:
    """Three panels in one file of a kind of figures: svg or pdf."""
    title = _title(scene, curves)
    notes = [f"{scene.source}. {scene.note}".rstrip(), *_notes(scene, curves)]
    return saved(draw_family(curves, title, notes), kind, title)


def family_page_of(scene: Scene, curves: FamilyCurves) -> str:
    """The page as HTML: a figure each of position, velocity and acceleration."""
    title = _title(scene, curves)
    figures = {
        kind: saved(draw_family(curves, "", [], [kind]), "svg", f"{title}: {kind}")
        for kind in KINDS
    }
    return family_page(scene, curves, _notes(scene, curves), figures)


def _title(scene: Scene, curves: FamilyCurves) -> str:
    return f"{scene.name}, family of {curves.name}"


def _notes(scene: Scene, curves: FamilyCurves) -> list[str]:
    """Where the curves come from."""
    speed = "" if curves.name == "omega" else f"; {scene.driver.joint} {describe_law(scene)}"
    return [f"crankcheck {crankcheck_version()}, closed form{speed}."]
