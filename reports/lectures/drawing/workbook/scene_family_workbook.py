"""The workbook of a family that has no formulas of its own: values of all members, and charts."""

from __future__ import annotations

from typing import Any

from reports.describe.frame import motion_frame
from reports.lectures.drawing.workbook.charts import KINDS, Curves, add_chart, widen
from reports.lectures.drawing.workbook.scene_family import SceneFamily
from reports.output.frame_file import workbook

SHEET, TIME = "family", "time_s"


def scene_family_workbook(family: SceneFamily, origin: dict[str, str]) -> bytes:
    """The content of the workbook: the times of each member, the angles and displacements of all
    with their rates, and a chart for each of these with all members."""
    import pandas as pd

    scene = family.scene
    kept = [
        f"{name}{ending}"
        for name in (*(f"{slider}_slider" for slider in scene.sliders), *scene.links)
        if name != scene.driver.link
        for _, ending in KINDS
    ]
    members = {
        f"{family.name} = {value:.10g}": motion_frame(motion)
        for value, motion in zip(family.values, family.motions, strict=True)
    }
    kept = [name for name in kept if name in members[next(iter(members))]]
    frame = pd.DataFrame(
        {
            f"{column}, {member}": own[column]
            for member, own in members.items()
            for column in (TIME, *kept)
        }
    )
    places = {name: place for place, name in enumerate(frame.columns, 1)}

    def put(book: Any) -> None:
        widen(book[SHEET])
        for number, name in enumerate(kept):
            pairs = [(places[f"{TIME}, {each}"], places[f"{name}, {each}"]) for each in members]
            add_chart(book, number, name, Curves(SHEET, pairs, len(frame)))

    return workbook(frame, SHEET, origin, put)
