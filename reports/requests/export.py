"""`crankcheck export`: a scene as MJCF."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated

from rich.console import Console

from models.files import find_scene, load_scene
from models.mjcf import build
from models.mjcf_options import exact
from reports.output.console import put
from reports.output.write import check_file
from reports.plan.free import under_control
from reports.requests.options import SceneName, option, output_option
from reports.way.way import way_of


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
        way = way_of(own)
        scene, start = way.opened(own)
        # Of segments the step is one that holds their fastest vibration.
        steps = way.held_steps(own)
        text = build(scene, start, replace(exact(scene, *steps), close=tuple(self.close)))
        put(console, self.output, text, f"MJCF of {scene.name}")
        return 0
