"""`crankcheck view`: MuJoCo's viewer where there is a screen, else a picture in a file."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import numpy as np
from rich.console import Console

from analytic.kinematics import solve
from models.errors import harmless
from models.files import load_scene
from models.mjcf import build
from models.scene import Scene
from reports.output.write import check_file, write

ENDINGS = (".gif", ".png")


def run_view(name: str, output: Path | None, console: Console) -> None:
    """Show a scene. Raises CrankcheckError for a scene or a file that can not be used."""
    if output is not None:
        check_file(output, "-o", ENDINGS)
    scene = load_scene(name)
    if output is None and has_screen():
        _open_viewer(scene)
        return
    if output is None:
        output = Path(f"{scene.name}.gif")
        check_file(output, "view", ENDINGS)
        console.print("no screen here, so into a file:", style="dim")
    from reports.drawing import gif as picture

    content = picture.strip(scene) if output.suffix.lower() == ".png" else picture.animation(scene)
    write(output, content)
    told = harmless(f"{output}: {scene.name} over one turn")
    console.print(told, highlight=False, markup=False)


def has_screen() -> bool:
    """Whether a window can be opened here."""
    if sys.platform in ("darwin", "win32"):
        return True
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


def _open_viewer(scene: Scene) -> None:
    """MuJoCo's own viewer at the assembled state; returns when its window is closed."""
    from sim.mujoco.viewer import show

    show(build(scene, solve(scene, np.zeros(1)).state()), scene.driver.law)
