"""Options of `solve`, whatever the kind of the scene."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, ClassVar

from reports.requests.options import SceneName, option, output_option


@dataclass(frozen=True)
class SolveOptions:
    """Options of `solve`, whatever the kind of the scene."""

    answered_by: ClassVar[str] = "requests.solve:SolveRequest"
    scene: SceneName
    at_deg: Annotated[float | None, option("One position: the driver's angle.", "DEG")] = None
    at_m: Annotated[
        float | None, option("One position: the displacement of a slider that drives.", "M")
    ] = None
    turns: Annotated[float | None, "A motion over so many turns (default 1)."] = None
    steps_per_turn: Annotated[int | None, "Samples in a turn (default 12, in a file 360)."] = None
    output: Annotated[
        Path | None, output_option("Write .csv, .parquet or .xlsx, or a page, .html.")
    ] = None
    duration: Annotated[
        float | None, option("Free motion: for how long (default the scene's own).", "S")
    ] = None
    steps: Annotated[
        int | None, option("Free motion: samples in it (default 12, in a file 1000).", "N")
    ] = None
    clockwise: Annotated[bool, "With --at-deg: the driver turning clockwise there."] = False
    along: Annotated[
        Sequence[str], option("Stroke of a point along a direction; repeatable.", "POINT:DEG")
    ] = ()
    forces: Annotated[bool, "The reactions and the driving torque as well."] = False
    figures: Annotated[
        Path | None,
        option(
            "With --forces: draw them over a turn; or a free motion, or elastic links; as SVG "
            "and PDF.",
            "DIR",
        ),
    ] = None
    modes: Annotated[int | None, option("Elastic links: sines across each.", "N")] = None
    axial_modes: Annotated[int | None, option("Elastic links: sines along each.", "N")] = None
    elements: Annotated[int | None, option("Elastic links: beam elements of each.", "N")] = None
    shape: Annotated[
        str | None,
        "Elastic links start periodic, quasi-static or straight (default the scene's own).",
    ] = None
    linear: Annotated[bool, "Elastic links: leave out that a bent link is shorter."] = False
    family: Annotated[
        str | None,
        option(
            "With -o FILE.xlsx, .html, .svg or .pdf: mechanisms that differ in a number, such "
            "as a length.",
            "NAME=A,B,...",
        ),
    ] = None

    @property
    def at_place(self) -> str:
        """The option by which one position was asked for; "" where a motion was."""
        if self.at_deg is None and self.at_m is None:
            return ""
        return f"--at-m {self.at_m:g}" if self.at_deg is None else f"--at-deg {self.at_deg:g}"
