"""`crankcheck mobility`, the motions of a scheme by count and by rank, and `joint`, its class."""

from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from rich.console import Console
from rich.text import Text

from analytic.lectures.schemes.joint_chains import JointAnalysis, analyse_joint, replaced
from analytic.lectures.schemes.scheme_mobility import SchemeMobility, scheme_mobility
from models.errors import CrankcheckError, harmless
from models.lectures.scheme import HIGHER, Scheme
from models.lectures.scheme_files import find_scheme, load_scheme, scheme_text, shipped_schemes
from models.lectures.touching import Touching, load_touching, shipped_contacts
from reports.output.console import grid, hanging, say_whole
from reports.output.numbers import count
from reports.output.write import check_file, write
from reports.requests.options import argument, output_option

HEAD = 10
"""Width of the heads of paragraphs, in letters."""
NameOrFile = Annotated[
    str | None, argument("NAME", "A shipped name, or a file; default: a list of all.")
]


@dataclass(frozen=True)
class MobilityRequest:
    """Arguments of `mobility`, as given."""

    scheme: NameOrFile = None
    replace: Annotated[bool, "Links with lower pairs in place of planar higher pairs."] = False
    output: Annotated[Path | None, output_option("With --replace: write that scheme as .toml.")] = (
        None
    )

    def run(self, console: Console, progress: Console) -> int:
        """Show a scheme, or list the shipped ones; 1 where its file states another mobility. Raises
        CrankcheckError for a faulty request."""
        if self.output is not None and not self.replace:
            raise CrankcheckError("-o writes the scheme that --replace makes; add --replace")
        if self.scheme is None:
            if self.replace:
                raise CrankcheckError(
                    "--replace: name a scheme, as in crankcheck mobility cam-roller"
                )
            _list(console)
            return 0
        scheme = load_scheme(self.scheme)
        read = [find_scheme(self.scheme)]
        check_file(self.output, "-o", (".toml",), inputs=read, edited=True)
        mobility = scheme_mobility(scheme)
        show_mobility(console, mobility)
        if self.replace:
            _show_replaced(console, scheme, self)
        return int(_is_contradicted(mobility))


def show_mobility(console: Console, mobility: SchemeMobility) -> None:
    """Show the count, the rank, the mobility, and passive constraints and idle freedoms by name."""
    scheme = mobility.scheme
    hanging(console, f"{scheme.name}: ", scheme.source, "bold")
    if scheme.note:
        console.print(Text(scheme.note))
    for head, text in _paragraphs(mobility):
        hanging(console, head.ljust(HEAD), text)


def _paragraphs(mobility: SchemeMobility) -> list[tuple[str, str]]:
    scheme = mobility.scheme
    rank = f"{mobility.rank} of {scheme.constraints} constraints are independent"
    names = f": {mobility.passive}" if str(mobility.passive) else ""
    passive = f"{count(mobility.spare, 'constraint')}{names}" if mobility.spare else "none"
    idle = f"{count(mobility.idle_count, 'freedom')}: " if mobility.idle else "none"
    told = [
        ("count", f"{scheme.count_in_words}, with n = {len(scheme.links)} moving links"),
        ("rank", f"{rank}, next to the drawn position"),
        ("mobility", _mobility(mobility)),
        ("passive", passive),
        ("idle", idle + "; ".join(map(str, mobility.idle))),
    ]
    if mobility.margin_is_small:
        nearly = (
            f"the equations are dependent to {mobility.near.margin:.1e}: with more digits the "
            "scheme may have one more motion"
        )
        told.append(("nearly", nearly))
    return told


def _is_contradicted(mobility: SchemeMobility) -> bool:
    return mobility.scheme.mobility not in (None, mobility.real)


def _mobility(mobility: SchemeMobility) -> str:
    """The real mobility, its idle part, and the particulars of the drawn position."""
    words = f"W = {mobility.real}"
    if mobility.idle:
        words += f", {mobility.useful} without idle ones"
    if mobility.near.is_singular:
        words += (
            f"; {mobility.near.here} in the drawn position, which is singular: next to it a motion "
            "is gone"
        )
    if mobility.yielding:
        words += (
            f"; {count(mobility.yielding, 'motion')} more, of first order alone: the scheme shakes"
        )
    if mobility.near.others:
        others = ", ".join(map(str, mobility.near.others))
        words += f"; {others} on another branch that begins here"
    if _is_contradicted(mobility):
        words += f"; the file says {mobility.scheme.mobility}"
    return words


def _show_replaced(console: Console, scheme: Scheme, request: MobilityRequest) -> None:
    fewer = replaced(scheme)
    if fewer == scheme:
        raise CrankcheckError(f"{scheme.name}: no higher pair; there is nothing to replace")
    own = {joint.name for joint in scheme.joints}
    gone = [joint.name for joint in scheme.joints if joint.kind in HIGHER]
    fresh = [joint for joint in fewer.joints if joint.name not in own]
    words = ", ".join(
        f"{j.kind} {j.name} ({j.between[0]}, {j.between[1]}) at ({j.at[0]:.6g}, {j.at[1]:.6g}) m"
        for j in fresh
    )
    hanging(console, "replaced".ljust(HEAD), f"{', '.join(gone)} by {words}")
    real = scheme_mobility(fewer).real
    hanging(console, "".ljust(HEAD), f"{fewer.count_in_words}; mobility {real}")
    if request.output is not None:
        write(request.output, scheme_text(fewer))
        told = harmless(f"{request.output}: {scheme.name} with lower pairs alone")
        say_whole(console, told)


def _list(console: Console) -> None:
    heads = ("scheme", "space", "count", "mobility", "idle", "source")
    table = grid(heads, whole=("scheme",))
    for name in shipped_schemes():
        scheme = load_scheme(name)
        mobility = scheme_mobility(scheme)
        numbers = (scheme.count, mobility.real, mobility.idle_count)
        table.add_row(name, scheme.space, *map(str, numbers), Text(scheme.source))
    console.print(table, highlight=False)


@dataclass(frozen=True)
class JointRequest:
    """Arguments of `joint`, as given."""

    joint: NameOrFile = None

    def run(self, console: Console, progress: Console) -> int:
        """Show a joint, or list the shipped ones. Raises CrankcheckError for a bad file."""
        if self.joint is None:
            _list_contacts(console)
        else:
            show_joint(console, analyse_joint(load_touching(self.joint)))
        return 0


def show_joint(console: Console, joint: JointAnalysis) -> None:
    """Show the class of a joint by its contacts alone, and where its neighbours guide it."""
    touching = joint.touching
    hanging(console, f"{touching.name}: ", touching.source, "bold")
    if touching.note:
        console.print(Text(touching.note))
    counts = Counter(contact.kind for contact in touching.contacts)
    contacts = ", ".join(f"{kind} x {n}" if n > 1 else kind for kind, n in counts.items())
    hanging(console, "touches  ", f"{contacts}: a {_pair(touching)} pair")
    alone = f"{joint.alone}{'' if joint.kept else '; a force must keep the two together'}"
    hanging(console, "alone    " if joint.guided else "joint    ", alone)
    for name, guided in joint.guided.items():
        guide = touching.guides[name]
        why = f" ({guide.why})" if guide.why else ""
        leaves = ", ".join(guide.leaves)
        hanging(console, "guided   ", f"{guided}, where its neighbours leave {leaves}{why}")
    at = ", ".join(f"{each:g}" for each in touching.at)
    console.print(Text(f"Q: turn about an axis through ({at}) m, T: displacement along it", "dim"))


def _list_contacts(console: Console) -> None:
    table = grid(("joint", "pair", "class", "guided", "freedoms"), whole=("joint",))
    for name in shipped_contacts():
        joint = analyse_joint(load_touching(name))
        last = [*joint.guided.values()]
        classes = ", ".join(str(each) for each in sorted({each.constraints for each in last}))
        free = " or ".join(" ".join(each.freedoms) for each in last or [joint.alone])
        alone = str(joint.alone.constraints)
        table.add_row(name, _pair(joint.touching), alone, classes or "-", Text(free))
    console.print(table, highlight=False)


def _pair(touching: Touching) -> str:
    return "lower" if touching.is_lower_pair else "higher"
