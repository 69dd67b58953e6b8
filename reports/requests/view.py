"""`crankcheck view`: an engine's viewer where there is a screen, else a picture in a file."""

from __future__ import annotations

import os
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from rich.console import Console

from models.errors import harmless
from models.files import find_scene, load_scene
from reports.output.console import say
from reports.output.write import check_file, write
from reports.requests.options import SceneName, output_option
from reports.way.way import way_of
from sim.viewing import viewer

ENDINGS = (".gif", ".png")


@dataclass(frozen=True)
class ViewRequest:
    """What `view` was asked for, as given."""

    scene: SceneName
    output: Annotated[
        Path | None, output_option("Draw into a .gif or .png in place of the viewer.")
    ] = None
    forces: Annotated[bool, "Draw the forces as arrows, into a file."] = False

    def run(self, console: Console, progress: Console) -> int:
        """Show a scene; the viewer draws no forces of ours, so that these go into a file.

        Raises CrankcheckError for a scene or a file that can not be used, or forces that there are
        none of.
        """
        output = self.output
        read = [find_scene(self.scene)]
        if output is not None:
            check_file(output, "-o", ENDINGS, inputs=read)
        scene = load_scene(self.scene)
        if output is None and has_screen() and not self.forces:
            viewer()(*way_of(scene).opened(scene))
            return 0
        if output is None:
            output = Path(f"{scene.name}.gif")
            check_file(output, "view", ENDINGS, inputs=read)
            why = "forces are drawn" if self.forces else "no screen here, so"
            console.print(f"{why} into a file:", style="dim")
        from reports.drawing import gif as picture

        draw = picture.strip if output.suffix.lower() == ".png" else picture.animation
        content = draw(scene, with_forces=self.forces)
        write(output, content)
        say(console, harmless(f"{output}: {scene.name} {way_of(scene).over}"))
        return 0


def has_screen() -> bool:
    """Whether a window can be opened here."""
    if sys.platform in ("darwin", "win32"):
        return True
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
