"""A hard case: a bead that is free ever nearer to the top of its wire, where a swing lasts."""

import math
from dataclasses import replace
from pathlib import Path

from models.files.reading import load_scene
from models.scene.driver import Released
from reports.stability.case import Case, Trial

SCENE = Path(__file__).with_name("bead.toml")


def below_the_top(angle_rad: float) -> Trial:
    scene = load_scene(SCENE)
    law = Released(0.5 * math.pi - angle_rad, 0.0, 4.0)
    return Trial(
        replace(scene, driver=replace(scene.driver, law=law)), 2000.0, turns=1.0, drive="free"
    )


CASES = {
    "beads": (
        Case(
            name="bead-top",
            title="a bead beside the top of its wire",
            source="a test",
            truth="the swing in elliptic functions",
            expected="the time of a swing grows without end",
            parameter="angle below the top",
            unit="rad",
            values=(1.0, 0.1, 0.01),
            trial=below_the_top,
            judge="bead",
        ),
    )
}
