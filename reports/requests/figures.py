"""`crankcheck figures`: the diagrams of a store for a paper, as SVG and PDF."""

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Annotated, cast

from matplotlib.figure import Figure
from rich.console import Console
from rich.progress import track

from models.errors import CrankcheckError, suggestion
from models.files.schema import NAME
from reports.figures.drawing import Drawing
from reports.figures.layout import Layout, laid_out
from reports.figures.style import saved, styled
from reports.output.console import say_whole, tell
from reports.output.numbers import count
from reports.output.write import check_folder, write
from reports.protocol.way import own_parts
from reports.requests.options import argument, option, output_option
from reports.results.overview import Report
from reports.store.reader import read_store

FIGURES: Mapping[str, Drawing] = {
    name: drawing
    for part in own_parts("figures").values()
    for name, drawing in cast(Mapping[str, Drawing], part).items()
}


Drawn = Callable[[], Figure | None]


@dataclass(frozen=True)
class FiguresRequest(Layout):
    folder: Annotated[Path, argument("DIR", "Folder of a sweep.")]
    output: Annotated[Path, output_option("Folder for the figures.")]
    scene: Annotated[Sequence[str], "Scene to draw; may be repeated; default: all."] = ()
    only: Annotated[Sequence[str], option("Figure to draw; may be repeated.", "FIGURE")] = ()

    @laid_out
    def run(self, console: Console, progress: Console) -> int:
        """Draw the store in ``folder`` into ``output``; returns the exit code, 0.

        ``scene`` and ``only`` (names of figures) choose, all where they are empty. Figures over all
        scenes are drawn where no scene is chosen, and where there are several.

        Raises CrankcheckError for no store there, no such scene or figure, or a folder that can not
        be written.
        """
        names = _chosen(self.only, FIGURES, "--only", "figure")
        check_folder(self.output, "-o")
        stored = read_store(self.folder)
        tell(stored.notice)
        report = Report(stored)
        figures = _planned(report, names, self.scene)
        check_folder(
            self.output, "-o", [f"{name}.{kind}" for name in figures for kind in self.formats]
        )
        empty = []
        quiet = not console.is_terminal
        for name in track(figures, "drawing", console=console, transient=True, disable=quiet):
            with styled():
                figure = figures[name]()
            if figure is None:
                empty.append(name)
                continue
            for kind in self.formats:
                write(self.output / f"{name}.{kind}", saved(figure, kind, f"crankcheck: {name}"))
        drawn = count(len(figures) - len(empty), "figure")
        lines = [
            f"{self.output}: {drawn}, each as {self.in_words}",
            *(f"  {x}: nothing to draw" for x in empty),
        ]
        say_whole(console, "\n".join(lines))
        return 0


def _planned(report: Report, names: Sequence[str], scenes: Sequence[str]) -> dict[str, Drawn]:
    """The figures to draw, by the name of their file without its ending."""
    chosen = _chosen(scenes, report.scenes, "--scene", "scene")
    if strange := next((scene for scene in chosen if not re.fullmatch(NAME, scene)), None):
        raise CrankcheckError(
            f"scene {strange!r} of the store: not a valid name of a scene, so it can name no "
            "file; the store was changed by hand: run `crankcheck sweep` again"
        )
    figures: dict[str, Drawn] = {}
    for name in names:
        of, over_all = FIGURES[name].of, FIGURES[name].over_all
        every = _whole(report, FIGURES[name])
        if over_all is not None and every and not scenes and (of is None or len(chosen) > 1):
            figures[name] = partial(over_all, every)
        if of is not None:
            fitting = ((scene, _report_on(report, FIGURES[name], scene)) for scene in chosen)
            figures |= {f"{name}-{scene}": partial(of, own, scene) for scene, own in fitting if own}
    if not figures:
        drives = {drive for name in names for drive in FIGURES[name].drives}
        raise CrankcheckError(
            f"--only {', '.join(names)}: drawn over all scenes, or for "
            f"{' or '.join(sorted(drives))} scenes, and --scene chose none of these; leave out "
            "--scene or --only"
        )
    return figures


def _whole(report: Report, drawing: Drawing) -> Report | None:
    """The part of a store for a figure over all scenes: driven scenes, where there are any, or
    cams of several numbers of facets."""
    if drawing.drives == ("facets",):
        return report if report.over_facets else None
    if report.driven is not None:
        return report.driven if "driven" in drawing.drives else report
    alike = len({line.way.name for line in report.lines}) < 2
    return report if alike and "free" in drawing.drives else None


def _report_on(report: Report, drawing: Drawing, scene: str) -> Report | None:
    """The part of a store that a figure of a scene shows; None for a scene of the other kind."""
    driven = report.driven
    if driven is not None and scene in driven.scenes and "driven" in drawing.drives:
        return driven
    kinds = {kind for line in report.lines_of(scene) for kind in line.way.kinds}
    return report if kinds & {*drawing.drives} - {"driven"} else None


def _chosen(asked: Sequence[str], names: Iterable[str], option: str, noun: str) -> list[str]:
    every = list(names)
    for name in asked:
        if name not in every:
            hint = suggestion(name, every, "there are", 2)
            raise CrankcheckError(f"{option} {name}: found no such {noun}; {hint}")
    return list(dict.fromkeys(asked)) or every
