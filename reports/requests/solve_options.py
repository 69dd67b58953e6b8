"""Options of `solve`, whatever the kind of the scene."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, ClassVar

import typer

from reports.requests.options import SceneName


@dataclass(frozen=True)
class SolveOptions:
    """Options of `solve`, whatever the kind of the scene."""

    answered_by: ClassVar[str] = "requests.solve:SolveRequest"
    scene: SceneName
    at_deg: Annotated[
        float | None, typer.Option(metavar="DEG", help="One position: the driver's angle.")
    ] = None
    at_m: Annotated[
        float | None,
        typer.Option(metavar="M", help="One position: the displacement of a slider that drives."),
    ] = None
    turns: Annotated[
        float | None, typer.Option(help="A motion over so many turns (default 1).")
    ] = None
    steps_per_turn: Annotated[
        int | None, typer.Option(help="Samples in a turn (default 12, in a file 360).")
    ] = None
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", help="Write .csv, .parquet or .xlsx, or a page, .html."),
    ] = None
    duration: Annotated[
        float | None,
        typer.Option(metavar="S", help="Free motion: for how long (default the scene's own)."),
    ] = None
    steps: Annotated[
        int | None,
        typer.Option(metavar="N", help="Free motion: samples in it (default 12, in a file 1000)."),
    ] = None
    clockwise: Annotated[
        bool, typer.Option("--clockwise", help="With --at-deg: the driver turning clockwise there.")
    ] = False
    along: Annotated[
        Sequence[str],
        typer.Option(metavar="POINT:DEG", help="Stroke of a point along a direction; repeatable."),
    ] = ()
    forces: Annotated[
        bool, typer.Option("--forces", help="The reactions and the driving torque as well.")
    ] = False
    figures: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR",
            help="With --forces: draw them over a turn; or a free motion, or elastic links; as SVG "
            "and PDF.",
        ),
    ] = None
    modes: Annotated[
        int | None,
        typer.Option(metavar="N", help="Elastic links: sines across each."),
    ] = None
    axial_modes: Annotated[
        int | None,
        typer.Option(metavar="N", help="Elastic links: sines along each."),
    ] = None
    elements: Annotated[
        int | None,
        typer.Option(metavar="N", help="Elastic links: beam elements of each."),
    ] = None
    shape: Annotated[
        str | None,
        typer.Option(
            help="Elastic links start periodic, quasi-static or straight (default the scene's own)."
        ),
    ] = None
    linear: Annotated[
        bool,
        typer.Option("--linear", help="Elastic links: leave out that a bent link is shorter."),
    ] = False
    family: Annotated[
        str | None,
        typer.Option(
            metavar="NAME=A,B,...",
            help="With -o FILE.xlsx, .html, .svg or .pdf: mechanisms that differ in a number, such "
            "as a length.",
        ),
    ] = None

    @property
    def at_place(self) -> str:
        """The option by which one position was asked for; "" where a motion was."""
        if self.at_deg is None and self.at_m is None:
            return ""
        return f"--at-m {self.at_m:g}" if self.at_deg is None else f"--at-deg {self.at_deg:g}"
