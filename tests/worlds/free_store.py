"""A real store of a scene that was let go for a while, in two engines with two profiles."""

import re
from io import StringIO
from pathlib import Path

from rich.console import Console

from models.files.reading import shipped
from reports.requests.sweep import SweepRequest
from tests.worlds.in_process import in_this_process

SCENE = "fourbar-swing"
LASTS_S = 0.6


def filled(folder: Path) -> Path:
    """The store in a folder; the variants go from profile to profile, and not by engine. The scene
    lasts for a second, as figures integrate all of it."""
    nowhere, scene = Console(file=StringIO()), folder.with_name(f"{SCENE}.toml")
    text = shipped("free")[SCENE].read_text(encoding="utf-8")
    scene.write_text(re.sub("^duration_s = .*", "duration_s = 1.0", text, flags=re.M))
    asked = SweepRequest(
        folder,
        scenes=(str(scene),),
        engines=("mujoco", "pymunk"),
        profiles=("tuned", "as-shipped"),
        timing=False,
        free=True,
        dt_s="4e-3,2e-3",
        duration_s=LASTS_S,
        jobs=1,
    )
    with in_this_process():
        asked.run(nowhere, nowhere)
    return folder
