"""`crankcheck equilibria`: positions of rest under weights, springs and loads, stable or not."""

import json
import math
from dataclasses import dataclass
from typing import Annotated

from rich.console import Console

from analytic.lectures.regulation.equilibria import equilibria
from analytic.structure.mobility import refuse_higher_pairs
from models.files.reading import load_scene
from reports.output.console import say, say_each, say_whole, show_rows
from reports.requests.options import SceneName

COLUMNS = "circuit scene rests links_deg potential_j frequency_hz"


@dataclass(frozen=True)
class EquilibriaRequest:
    """Arguments of `equilibria`, as given."""

    scene: SceneName
    json: Annotated[bool, "Print JSON, not a table."] = False

    def run(self, console: Console, progress: Console) -> int:
        """Show the positions of rest. Raises CrankcheckError as `equilibria`."""
        scene = load_scene(self.scene)
        if scene.cams:  # which rest over whole dwells
            refuse_higher_pairs(scene, "a position of rest")
        rests = equilibria(scene)
        rows = [
            {
                "circuit": one.circuit + 1,
                "scene": one.circuit == rests.circuits.own[0],
                "rests": "stable" if one.stiffness > 0.0 else "unstable",
                "links_deg": {name: math.degrees(a) for name, a in one.angles_rad.items()},
                "potential_j": one.potential_j,
                "frequency_hz": math.sqrt(one.stiffness) / math.tau
                if one.stiffness > 0.0
                else None,
            }
            for one in rests.found
        ]
        notes = [
            f"circuit {number + 1} is left out: loads are not given everywhere in it"
            for number in rests.beyond
        ]
        notes += ["none: the loads drive it everywhere"] * (not rows)
        notes += ["friction is left out: it also holds positions near these"] * bool(scene.friction)
        if self.json:
            document = {"scene": scene.name, "equilibria": rows, "notes": notes}
            say_whole(console, json.dumps(document, indent=1))
            return 0
        say(console, f"{scene.name}: positions of rest, where loads over a speed are those at 0")
        show_rows(console, rows, COLUMNS.split())
        say_each(console, notes)
        return 0
