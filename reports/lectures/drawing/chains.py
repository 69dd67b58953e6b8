"""`crankcheck chains`: number and type synthesis, as a list or drawn."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from analytic.lectures.chains.assur_groups import Mechanism, inversions
from analytic.lectures.chains.chain import Chain, assortment_in_words, assortments
from analytic.lectures.chains.chain_synthesis import chain_names, chains, type_in_letters, types
from models.errors import CrankcheckError
from reports.lectures.drawing.positions import ENDINGS, save_sheet
from reports.lectures.drawing.sheets.field_sheets import DrawnChain, check_room, draw_chains
from reports.lectures.drawing.sheets.paper import Paper
from reports.output.console import plain_table
from reports.output.numbers import roman
from reports.output.provenance import crankcheck_version
from reports.output.write import check_file
from reports.requests.options import PaperSize

MOST_TYPED = 8
"""Links of chains whose types are listed."""


@dataclass(frozen=True)
class ChainsRequest:
    """What `chains` was asked for, as given."""

    links: Annotated[int, typer.Option(metavar="N", help="Links, the ground with them.")] = 6
    mobility: Annotated[int, typer.Option(metavar="W", help="Their mobility.")] = 1
    inversions: Annotated[
        bool, typer.Option("--inversions", help="The mechanisms: each link as the ground.")
    ] = False
    sliders: Annotated[
        int | None,
        typer.Option(metavar="K", help="Type synthesis: up to so many of the pins are sliders."),
    ] = None
    paper: PaperSize = "A4"
    output: Annotated[
        Path | None, typer.Option("-o", "--output", help="Draw them: .svg in layers, or .pdf.")
    ] = None

    def run(self, console: Console, progress: Console) -> int:
        """List or draw chains. Raises CrankcheckError for what can not be asked."""
        paper = Paper.of(self.paper)
        if self.output is not None:
            check_file(self.output, "-o", ENDINGS)
        named = list(_asked(self))
        rows = [row for name, chain in named for row in _rows(self, name, chain)]
        kind = "chains" if self.sliders is None else "types of chains"
        told = f"{len(named)} {kind} of {self.links} links with mobility {self.mobility}"
        if self.inversions:
            told += f", {len(rows)} mechanisms"
        if self.output is not None:
            check_room(len(rows), paper)
            note = f"crankcheck {crankcheck_version()}, W = 3 (n - 1) - 2 p"
            save_sheet(console, draw_chains(rows, told, note, paper), self.output, told)
            return 0
        console.print(told, highlight=False, markup=False)
        _show(console, self, rows)
        if self.sliders is None and not self.inversions:
            _show_assortments(console, self, [chain for _, chain in named])
        return 0


def _asked(request: ChainsRequest) -> Iterator[tuple[str, Chain]]:
    """The chains of pins with their names; where types are asked for, these."""
    if request.sliders is not None and request.sliders < 0:
        raise CrankcheckError(f"--sliders {request.sliders}: take 0 or more")
    if request.sliders is not None and request.links > MOST_TYPED:
        raise CrankcheckError(
            f"--sliders with {request.links} links: types are listed of chains of up to "
            f"{MOST_TYPED} links"
        )
    pinned = chains(request.links, request.mobility)
    for name, chain in zip(chain_names(pinned), pinned, strict=True):
        if request.sliders is None:
            yield name, chain
            continue
        for k, one in enumerate(types(chain, request.sliders), 1):
            number = "" if chain.loops == 1 else f"{name}-{k} "
            yield f"{number}{type_in_letters(one)}", one


def _rows(request: ChainsRequest, name: str, chain: Chain) -> Iterator[DrawnChain]:
    """What is listed or drawn of a chain: itself, or its mechanisms."""
    if not request.inversions:
        many = len(inversions(chain, name))
        counted = f"{many} mechanism{'s' if many > 1 else ''}"
        yield DrawnChain(chain, name, f"{assortment_in_words(chain.assortment)}; {counted}")
        return
    for mechanism in inversions(chain, name):
        yield DrawnChain(chain, mechanism.name, _words(mechanism), mechanism.ground)


def _words(mechanism: Mechanism) -> str:
    """The class by each driver, where one driver says where everything is."""
    if mechanism.chain.mobility != 1:
        return f"ground link {mechanism.ground + 1}"
    classes = sorted(set(mechanism.classes().values()))
    return "class " + " or ".join(map(roman, classes))


def _show(console: Console, request: ChainsRequest, rows: list[DrawnChain]) -> None:
    table = plain_table(gap=2)
    heads = ["mechanism", "ground"] if request.inversions else ["chain"]
    told = "links" if not request.inversions else "by its drivers"
    for head in (*heads, told, "joints of links, sliders with *"):
        table.add_column(head, overflow="fold")
    for row in rows:
        ground = [] if row.ground is None else [f"link {row.ground + 1}"]
        joints = " ".join(
            f"{a + 1}-{b + 1}{'*' if (a, b) in row.chain.sliders else ''}"
            for a, b in row.chain.joints
        )
        table.add_row(row.name, *ground, row.words, joints)
    console.print(table)


def _show_assortments(console: Console, request: ChainsRequest, every: list[Chain]) -> None:
    """All counts of links that the mobility allows, with how many chains each has."""
    table = plain_table(gap=2)
    table.add_column("assortment of links")
    table.add_column("chains", justify="right")
    for counts in assortments(request.links, request.mobility):
        many = sum(chain.assortment == counts for chain in every)
        table.add_row(assortment_in_words(counts), str(many))
    console.print("", table, sep="\n")
