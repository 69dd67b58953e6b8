"""`crankcheck rotatability`: links that turn fully, circuits, and dead points."""

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any

from rich.console import Console

from analytic.dyads.chunk import driver_scale
from analytic.lectures.circuits.arcs import own_arc
from analytic.lectures.circuits.circuits import (
    AngleExtreme,
    Circuits,
    Position,
    circuits_of,
    transmissions,
)
from analytic.lectures.circuits.rotatability import (
    Rotation,
    at_limit,
    circuit_rotations,
    dead_points,
    rotations,
)
from analytic.mechanism.fourbar import grashof_of
from analytic.structure.mobility import analyse, refuse_higher_pairs
from models.errors import CrankcheckError, StructureError, harmless, shown
from models.files.reading import load_scene
from models.scene import Scene
from models.scene.driver import driver_unit
from reports.output.console import say, say_whole, show_rows
from reports.requests.options import SceneName, option

Row = Mapping[str, object]


@dataclass(frozen=True)
class RotatabilityRequest:
    """Arguments of `rotatability`, as given."""

    scene: SceneName
    position: Annotated[
        Sequence[str],
        option(
            "A position, such as 90 or 90:+- (signs by dyad in solving order); may be repeated: "
            "check that the driver leads through all in this order.",
            "DEG[:SIGNS]",
        ),
    ] = ()
    json: Annotated[bool, "Print JSON, not tables."] = False

    def run(self, console: Console, progress: Console) -> int:
        """Show the answer; return the exit code. Raises CrankcheckError for a faulty request."""
        scene = load_scene(self.scene)
        refuse_higher_pairs(scene, "rotatability")
        show = _show
        try:
            circuits = circuits_of(scene)
        except StructureError as error:
            analyse(scene)  # which refuses whatever is no mechanism
            if self.position:
                raise
            document, show = _of_own_branch(scene, str(error)), _show_own_branch
        else:
            positions = [_position(circuits, text) for text in self.position]
            found = {"defect": circuits.defect(positions)} if positions else {}
            document = _document(scene, circuits) | found
        if self.json:
            say_whole(console, json.dumps(document, indent=1))
        else:
            show(console, document)
        return int(document.get("defect", "none") != "none")


def _position(circuits: Circuits, text: str) -> Position:
    degrees, colon, written = text.partition(":")
    signs = circuits.signed.signs
    try:
        angle = math.radians(float(degrees))
    except ValueError:
        angle = math.nan
    fits = not colon or (len(written) == len(signs) and set(written) <= {"+", "-"})
    if not math.isfinite(angle) or not fits:
        dyads = ", ".join(circuits.signed.dyads) or "none"
        raise CrankcheckError(
            f"--position {shown(text)}: give degrees, and a sign + or - for each dyad after a "
            f"colon ({len(signs)}: {dyads}), such as 90:{'+' * len(signs)}"
        )
    given = tuple(1 if sign == "+" else -1 for sign in written)
    return Position(angle, given if colon else signs)


def _document(scene: Scene, circuits: Circuits) -> dict[str, object]:
    """The whole answer, angles in degrees, as JSON has it."""
    turning, free = rotations(scene, circuits.own[1]), dict[str, object]()
    if scene.is_free:
        turning = circuit_rotations(circuits, circuits.own[1])
        free["other_circuits"] = [
            {"circuit": number + 1, **rotation_row(one, is_limited=first.low is not None)}
            for number, (first, *_) in enumerate(circuits.circuits)
            if number != circuits.own[0]
            for one in circuit_rotations(circuits, first)
        ]
    dyads, merit = transmissions(circuits)
    grashof, (number, own) = grashof_of(scene), circuits.own
    return {
        "scene": scene.name,
        "type": None if grashof is None else grashof.name,
        "margin_m": None if grashof is None else grashof.margin_m,
        "rotations": [rotation_row(one, is_limited=own.low is not None) for one in turning],
        **free,
        "dyads": list(circuits.signed.dyads),
        "change_points": circuits.change_points,
        "circuit": number + 1,
        "branches": [
            {
                "circuit": k + 1,
                "signs": "".join("+" if sign > 0 else "-" for sign in arc.signs),
                "driver_from_deg": math.degrees(arc.range_rad[0]),
                "driver_to_deg": math.degrees(arc.range_rad[1]),
                "limits": [end.dyad for end in (arc.low, arc.high) if end is not None],
                "scene": arc is own,
            }
            for k, circuit in enumerate(circuits.circuits)
            for arc in circuit
        ],
        "dead_points": [
            {"input": p.input, "driver_deg": math.degrees(p.driver_rad), "where": p.where}
            for p in dead_points(circuits, turning)
        ],
        "transmission": [
            {
                "dyad": one.dyad,
                "kind": one.kind,
                **_extreme("smallest_deg", one.smallest_rad),
                **_extreme("largest_deg", one.largest_rad),
                "pressure_deg": None
                if one.pressure_rad is None
                else math.degrees(one.pressure_rad),
                "least_sine": one.least_sine.value,
                "least_sine_at_deg": math.degrees(one.least_sine.driver_rad),
            }
            for one in dyads
        ],
        "merit": merit.value,
        "merit_at_deg": math.degrees(merit.driver_rad),
    }


def _of_own_branch(scene: Scene, why: str) -> dict[str, object]:
    """The answer for a mechanism whose circuits are not found: the branch that it is on."""
    arc = own_arc(scene)
    scale = driver_scale(scene) if scene.driver.slider is not None else math.degrees(1.0)
    return {
        "scene": scene.name,
        "why_no_circuits": why,
        "driver": scene.driver.joint,
        "unit": driver_unit(scene),
        "ends": [
            {"at": end.angle_rad * scale, "where": at_limit(scene, end.dyad)}
            for end in (arc.low, arc.high)
            if end is not None
        ],
        "rotations": [
            rotation_row(r, is_limited=arc.low is not None) for r in rotations(scene, arc)
        ],
    }


def _show_own_branch(console: Console, document: Mapping[str, Any]) -> None:
    say(console, f"{document['scene']}: only its own branch")
    show_rows(console, document["rotations"], TABLES["rotations"].split())
    say(console, "")
    for end in document["ends"]:
        at = f"{end['at']:.6g} {document['unit']}"
        say(console, f"{document['driver']} ends at {at}: {end['where']}")
    if not document["ends"]:
        say(console, f"{document['driver']} turns fully")
    say(console, harmless(document["why_no_circuits"]))


def rotation_row(one: Rotation, *, is_limited: bool) -> Row:
    """The rotation of a link over a branch as a row; only a link without full turns has a swing."""
    low, high = (math.degrees(each) for each in (one.low_rad, one.high_rad))
    swings = one.turns == 0
    return {
        "link": one.link,
        "against": one.against,
        "does": one.word,
        "turns": one.turns,
        "driver_turns": None if is_limited else one.period_rad / math.tau,
        "from_deg": low if swings else None,
        "to_deg": high if swings else None,
        "swing_deg": high - low if swings else None,
    }


def _extreme(name: str, extreme: AngleExtreme | None) -> Row:
    """An extreme angle and the driver's angle there, both in degrees."""
    if extreme is None:
        return {name: None}
    at = math.degrees(extreme.driver_rad)
    return {name: math.degrees(extreme.value), name.replace("_deg", "_at_deg"): at}


TABLES = {
    "rotations": "link against does turns from_deg to_deg swing_deg",
    "other_circuits": "circuit link against does turns from_deg to_deg swing_deg",
    "branches": "circuit signs driver_from_deg driver_to_deg limits scene",
    "dead_points": "input driver_deg where",
    "transmission": "dyad kind smallest_deg smallest_at_deg largest_deg largest_at_deg "
    "pressure_deg least_sine least_sine_at_deg",
}
"""The tables in their order, and their columns."""


def _show(console: Console, document: Mapping[str, Any]) -> None:
    kind = "not a four-bar or slider-crank driven at its crank, so without a Grashof type"
    if document["type"] is not None:
        kind = f"{document['type']}, margin {document['margin_m']:.6g} m"
    say(console, f"{document['scene']}: {kind}")
    if "other_circuits" in document:
        say(console, f"free: rotations are over its whole circuit, {document['circuit']}")
    for name, columns in TABLES.items():
        if name == "other_circuits" and not document.get(name):
            continue
        if name == "branches":
            meet = ", those that meet in change points as one" if document["change_points"] else ""
            say(console, f"\ncircuits{meet}; signs of {', '.join(document['dyads']) or 'no dyad'}")
        elif name != "rotations":
            say(console, f"\n{name.replace('_', ' ')}" + ("" if document[name] else ": none"))
        if document[name]:
            show_rows(console, document[name], columns.split())
    say(console, f"\nindex of merit {document['merit']:.6g} at {document['merit_at_deg']:.6g} deg")
    if "defect" in document:
        found = document["defect"]
        told = "led through by the driver" if found == "none" else f"a {found} defect"
        say(console, f"positions: {told}")
