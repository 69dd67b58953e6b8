"""`crankcheck joint`: the class of a joint, and its freedoms."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import Annotated

import typer
from rich.console import Console
from rich.text import Text

from analytic.lectures.schemes.joint_class import JointAnalysis, analyse_joint
from models.lectures.touching import Touching, load_touching, shipped_contacts
from reports.output.console import hanging, plain_table


@dataclass(frozen=True)
class JointRequest:
    """What `joint` was asked for, as given."""

    joint: Annotated[
        str | None,
        typer.Argument(metavar="NAME", help="A shipped name, or a file; all are listed if none."),
    ] = None

    def run(self, console: Console, progress: Console) -> int:
        """Show one joint, or list the shipped ones. Raises CrankcheckError for what can not be
        read."""
        if self.joint is None:
            _list(console)
        else:
            show_joint(console, analyse_joint(load_touching(self.joint)))
        return 0


def show_joint(console: Console, joint: JointAnalysis) -> None:
    """The class of a joint by its contacts alone, and by what its neighbours leave."""
    touching = joint.touching
    hanging(console, f"{touching.name}: ", touching.source, "bold")
    if touching.note:
        console.print(Text(touching.note))
    hanging(console, "touches  ", f"{_contacts(touching)}: {_pair(touching)}")
    alone = f"{joint.alone}{'' if joint.kept else '; a force must keep the two together'}"
    hanging(console, "alone    " if joint.guided else "joint    ", alone)
    for name, guided in joint.guided.items():
        guide = touching.guides[name]
        why = f" ({guide.why})" if guide.why else ""
        leaves = ", ".join(guide.leaves)
        hanging(console, "guided   ", f"{guided}, where its neighbours leave {leaves}{why}")
    at = ", ".join(f"{each:g}" for each in touching.at)
    console.print(Text(f"Q: turn about an axis through ({at}) m, T: displacement along it", "dim"))


def _list(console: Console) -> None:
    table = plain_table(gap=2)
    for head in ("joint", "pair", "class", "guided", "freedoms"):
        table.add_column(head, overflow="fold", no_wrap=head == "joint")
    for name in shipped_contacts():
        joint = analyse_joint(load_touching(name))
        last = [*joint.guided.values()]
        classes = ", ".join(str(each) for each in sorted({each.constraints for each in last}))
        free = " or ".join(" ".join(each.freedoms) for each in last or [joint.alone])
        pair = "lower" if joint.touching.is_lower_pair else "higher"
        table.add_row(name, pair, str(joint.alone.constraints), classes or "-", Text(free))
    console.print(table, highlight=False)


def _pair(touching: Touching) -> str:
    return "a lower pair" if touching.is_lower_pair else "a higher pair"


def _contacts(touching: Touching) -> str:
    """How often the two touch, and in what."""
    counts = Counter(contact.kind for contact in touching.contacts)
    return ", ".join(f"{kind} x {n}" if n > 1 else kind for kind, n in counts.items())
