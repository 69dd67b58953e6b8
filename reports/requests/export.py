"""`crankcheck export`: a scene as MJCF."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated

import numpy as np
from rich.console import Console

from analytic.kinematics import solve
from models.errors import CrankcheckError
from models.files import find_scene, load_scene
from models.mjcf import build
from models.mjcf_options import exact
from models.motion import State
from models.scene import Scene
from reports.compare.free.kept_motion import released_state
from reports.output.console import put
from reports.output.write import check_file
from reports.plan.elastic import SPRINGS, held_steps, segmented
from reports.plan.free import under_control
from reports.requests.options import SceneName, option, output_option
from reports.way.length import SEGMENTS


@dataclass(frozen=True)
class ExportRequest:
    """What `export` was asked for, as given."""

    scene: SceneName
    output: Annotated[Path | None, output_option("Write an .xml file.")] = None
    close: Annotated[
        Sequence[str], option("Close a loop at this pin; may be repeated.", "PIN")
    ] = ()

    def run(self, console: Console, progress: Console) -> int:
        """The MJCF of a scene, assembled at its start, into a file or to the terminal; an elastic
        link is the chain of segments that the engine is given.

        Loops are closed at the pins of ``close``, the others where `models.tree` says.
        """
        if self.output is not None:
            check_file(self.output, "-o", (".xml",), inputs=[find_scene(self.scene)])
        own = under_control(load_scene(self.scene))
        scene, start = opened(own)
        # Of segments the step is one that holds their fastest vibration.
        steps = (held_steps(own, SEGMENTS, SPRINGS[0]),) if own.elastic else ()
        text = build(scene, start, replace(exact(scene, *steps), close=tuple(self.close)))
        put(console, self.output, text, f"MJCF of {scene.name}")
        return 0


def opened(scene: Scene) -> tuple[Scene, State]:
    """What an engine is given of a scene, which of elastic links are segments, and where it begins.
    Raises CrankcheckError where it can not."""
    if scene.elastic:
        return segmented(scene)
    return scene, start_of(scene)


def start_of(scene: Scene) -> State:
    """Where a scene begins. Raises CrankcheckError where it can not."""
    try:
        return solve(scene, np.zeros(1)).state()
    except CrankcheckError:
        if not scene.is_free:
            raise
        return released_state(scene)  # of several freedoms there is no closed form
