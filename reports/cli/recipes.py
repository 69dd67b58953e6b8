"""The commands that tell how something is read out of an engine."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from reports.cli.application import app, command
from reports.output.console import terminal

recipe_app = typer.Typer(no_args_is_help=True, help="Show how something is read out of an engine.")
app.add_typer(recipe_app, name="recipe")


@dataclass(frozen=True)
class ForceRecipeRequest:
    """What `recipe forces` was asked for, as given."""

    engine: Annotated[str, typer.Option(help="Engine.")]
    scene: Annotated[
        str, typer.Option(metavar="SCENE", help="A shipped name, or a scene file.")
    ] = "fourbar-lecture-1"
    profile: Annotated[str, typer.Option(help="Profile of the engine.")] = "tuned"
    steps_per_turn: Annotated[float, typer.Option(help="Steps in a turn.")] = 720.0
    output: Annotated[Path | None, typer.Option("-o", "--output", help="Write a .py file.")] = None


@partial(command, of=recipe_app)
def forces(request: ForceRecipeRequest) -> int:
    """Show a program that reads reactions and the driving torque right; it needs the engine alone.

    Run it to have them over a turn, as lines of numbers with commas.
    """
    from reports.cli.commands import recipe as verb

    return verb.run_force_recipe(request, terminal())
