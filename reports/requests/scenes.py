"""`crankcheck scenes`: the shipped scenes."""

from __future__ import annotations

from dataclasses import dataclass

from rich.console import Console
from rich.text import Text

from analytic.structure.groups import Bridge
from analytic.structure.mobility import analyse
from models.errors import StructureError
from models.files.reading import KINEMATICS, kinds, load_scene, shipped
from models.scene import Scene
from reports.describe.facts import describe_law
from reports.output.console import plain_table


@dataclass(frozen=True)
class ScenesRequest:
    """What `scenes` was asked for: nothing in particular."""

    def run(self, console: Console, progress: Console) -> int:
        """The shipped scenes by kind: structure, driver and source."""
        for kind in kinds():
            console.print(Text(_heading(kind), "bold"))
            table = plain_table(gap=2)
            for head in ("scene", "groups", "driver", "source"):
                table.add_column(head, overflow="fold", no_wrap=head == "scene")
            for name in shipped(kind):
                scene = load_scene(name)
                table.add_row(name, _groups(scene), describe_law(scene), Text(scene.source))
            console.print(table, highlight=False)
        return 0


def _groups(scene: Scene) -> str:
    """The Assur groups of a scene in solving order, a dash for one that is none of dyads."""
    try:
        parts = analyse(scene).order
        return " + ".join(part.kind for part in parts if not isinstance(part, Bridge))
    except StructureError:
        return "-"


def _heading(kind: str) -> str:
    """A kind, and how to ask for all its scenes."""
    by_name = f"all of them by `{kind}`, as in `crankcheck verify {kind}`"
    return f"{kind}: {'all of them where no scene is named' if kind == KINEMATICS else by_name}"
