"""A run of the pieces of elastic links as one of the scene whose links they are."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from models.array import Array
from models.cut_links import CutScene
from models.motion import Forces
from sim.engine import Run


def folded_run(cut: CutScene, run: Run) -> Run:
    """Links, points and pins of the scene; the pins between pieces are told by the deflection,
    which is off where they come apart."""
    motion = run.motion
    if motion is None:
        return run
    inner = {node for name in cut.scene.elastic for node in cut.nodes(name)[1:-1]}
    folded = cut.folded(motion)
    if folded.forces is not None:
        folded = replace(folded, forces=_without(folded.forces, inner, _links(cut)))
    gaps = {name: gap for name, gap in run.gaps.items() if name not in inner}
    return replace(run, motion=folded, gaps=gaps)


def _links(cut: CutScene) -> dict[str, str]:
    """The elastic link by segment."""
    return {part: name for name in cut.scene.elastic for part in cut.bodies(name)}


def _without(forces: Forces, inner: set[str], links: Mapping[str, str]) -> Forces:
    """The forces in the pins of the scene, on its links."""

    def on_links(bodies: Mapping[str, Array]) -> dict[str, Array]:
        return {links.get(body, body): force for body, force in bodies.items()}

    pins = {point: on_links(own) for point, own in forces.pins.items() if point not in inner}
    friction = {joint: own for joint, own in forces.friction.items() if joint not in inner}
    return replace(forces, pins=pins, friction=friction)
