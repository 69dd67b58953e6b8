"""`crankcheck chains`: number and type synthesis, as a list or drawn."""

from __future__ import annotations

from collections.abc import Iterator

from rich.console import Console

from analytic.chains.chain import Chain, assortment_in_words, assortments
from analytic.chains.inversions import Mechanism, inversions
from analytic.chains.number_synthesis import chain_names, chains
from analytic.chains.type_synthesis import type_in_letters, types
from models.errors import CrankcheckError
from reports.cli.commands.sheets import ENDINGS, save_sheet
from reports.cli.structures import ChainsRequest
from reports.describe.roman import roman
from reports.output.columns import plain_table
from reports.output.provenance import crankcheck_version
from reports.output.write import check_file
from reports.sheets.chain_sheet import DrawnChain, check_room, draw_chains
from reports.sheets.paper import Paper

MOST_TYPED = 8
"""Links of chains whose types are listed."""


def run_chains(request: ChainsRequest, console: Console) -> int:
    """List or draw chains. Raises CrankcheckError for what can not be asked."""
    paper = Paper.of(request.paper)
    if request.output is not None:
        check_file(request.output, "-o", ENDINGS)
    named = list(_asked(request))
    rows = [row for name, chain in named for row in _rows(request, name, chain)]
    kind = "chains" if request.sliders is None else "types of chains"
    told = f"{len(named)} {kind} of {request.links} links with mobility {request.mobility}"
    if request.inversions:
        told += f", {len(rows)} mechanisms"
    if request.output is not None:
        check_room(len(rows), paper)
        note = f"crankcheck {crankcheck_version()}, W = 3 (n - 1) - 2 p"
        save_sheet(console, draw_chains(rows, told, note, paper), request.output, told)
        return 0
    console.print(told, highlight=False, markup=False)
    _show(console, request, rows)
    if request.sliders is None and not request.inversions:
        _show_assortments(console, request, [chain for _, chain in named])
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
