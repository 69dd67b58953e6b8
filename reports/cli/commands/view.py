"""`crankcheck view`: an engine's viewer where there is a screen, else a picture in a file."""

from __future__ import annotations

import os
import sys
from pathlib import Path

from rich.console import Console

from models.errors import harmless
from models.files import find_scene, load_scene
from reports.cli.commands.listing import start_of
from reports.output.write import check_file, write
from reports.plan.elastic import refuse_bent
from sim.viewing import viewer

ENDINGS = (".gif", ".png")


def run_view(
    name: str, output: Path | None, console: Console, *, with_forces: bool = False
) -> None:
    """Show a scene; the viewer draws no forces of ours, so that these go into a file.

    Raises CrankcheckError for a scene or a file that can not be used, or forces that there are
    none of.
    """
    read = [find_scene(name)]
    if output is not None:
        check_file(output, "-o", ENDINGS, inputs=read)
    scene = load_scene(name)
    refuse_bent(scene, "view", f"crankcheck solve {name} -o {scene.name}.html shows how it bends")
    if output is None and has_screen() and not with_forces:
        viewer()(scene, start_of(scene))
        return
    if output is None:
        output = Path(f"{scene.name}.gif")
        check_file(output, "view", ENDINGS, inputs=read)
        why = "forces are drawn" if with_forces else "no screen here, so"
        console.print(f"{why} into a file:", style="dim")
    from reports.drawing import gif as picture

    draw = picture.strip if output.suffix.lower() == ".png" else picture.animation
    content = draw(scene, with_forces=with_forces)
    write(output, content)
    what = "in free motion" if scene.is_free else "over one turn"
    told = harmless(f"{output}: {scene.name} {what}")
    console.print(told, highlight=False, markup=False)


def has_screen() -> bool:
    """Whether a window can be opened here."""
    if sys.platform in ("darwin", "win32"):
        return True
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
