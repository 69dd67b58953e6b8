"""The exudyn system of a scene: a rigid body in the plane per link, a joint per pin and line;
and the package itself, with its output.

The node of a body is at its centre of mass. All bodies have three coordinates, the driven crank
too: its drive is one more constraint. A pair on a line is a prismatic joint whose second marker, on
the guide, lies on the line; with a massless block it leaves the angle free. The nodes of beams have
a tangent in place of an angle. exudyn's type stubs leave out ``self`` and its items are untyped, so
all of it is `Any` here.
"""

import contextlib
import io
import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from importlib import import_module
from itertools import chain, pairwise
from typing import Any

from models.errors import EngineError
from models.motion import State
from models.scene import GROUND, Point, Scene, elastic
from models.scene import joints as pairs
from sim.engine import EPSILON
from sim.engine.acting import EngineBodies, centres
from sim.engine.ties import Hinge, hinges, refuse_massless
from sim.exudyn import rows

SAID = re.compile(r"Python WARNING|Python ERROR")
"""Beginning of each of exudyn's messages about a run."""
PLACE = re.compile(r"\[(?:Python )?file .*?\]:?")
"""Place of a call in a Python program, which exudyn adds to all its messages."""


@contextlib.contextmanager
def quiet(heard: list[str]) -> Iterator[None]:
    """Add exudyn's output meanwhile to ``heard``; it prints by way of ``sys.stdout``."""
    said = io.StringIO()
    try:
        with contextlib.redirect_stdout(said):
            yield
    finally:
        heard += [text for part in SAID.split(said.getvalue()) if (text := plain(part))]


def plain(text: str) -> str:
    """Return a message of exudyn in one line, without its rules of asterisks."""
    return " ".join(PLACE.sub("", text).replace("*", "").split())


with quiet([]):  # it reports the effects of its environment variables
    exu: Any = import_module("exudyn")
    items: Any = import_module("exudyn.itemInterface")
VERSION = str(exu.config.Version())


ANGLE = 2
"""Coordinate of a node that is its angle."""
Index = Any
"""exudyn's own numbers of nodes, objects, markers and loads."""
ADDERS = {kind[0]: f"Add{kind}" for kind in ("Node", "Object", "Marker", "Load", "Sensor")}


@dataclass(frozen=True)
class PlaneSystem(EngineBodies):
    """A system before its assembly: the ground and the bodies by name, as they were added.

    ``start_rad`` is the angle of a body or the ground at the start. ``hinge`` has the joints of
    pins, ``prismatic`` the joint of each slider; ``weights`` are the loads of gravity.
    Nodes of beams are in ``node`` alone, and their angles at the start [rad] in ``looked``; the
    elements of each beam are in ``elements``. A system lives as long as its ``container``.
    """

    start_rad: Mapping[str, float]
    container: Any
    system: Any
    body: dict[str, Index] = field(default_factory=dict)
    node: dict[str, Index] = field(default_factory=dict)
    hinge: dict[Hinge, Index] = field(default_factory=dict)
    prismatic: dict[str, Index] = field(default_factory=dict)
    weights: list[Index] = field(default_factory=list)
    looked: dict[str, float] = field(default_factory=dict)
    elements: dict[str, list[Index]] = field(default_factory=dict)

    def add(self, kind: str, **numbers: object) -> Index:
        """Add an item of exudyn by its class name, such as ``NodePointGround``."""
        return getattr(self.system, ADDERS[kind[0]])(getattr(items, kind)(**numbers))

    def marker(self, name: str, anchor: Point) -> Index:
        """Add a marker at a place of a body or of the ground, from its node [m]."""
        if name in self.looked:
            if anchor != (0.0, 0.0):
                raise EngineError(
                    f"{name}: a force acts {anchor[1]:g} m beside it; exudyn's beams take "
                    "forces on their line; give that link segments (--springs plain)"
                )
            return self.add("MarkerNodeRigid", nodeNumber=self.node[name])
        place = [*anchor, 0.0]
        return self.add("MarkerBodyRigid", bodyNumber=self.body[name], localPosition=place)

    def marker_at(self, name: str, place: Point) -> Index:
        """Add a marker at a place in the frame of a link or of the ground [m]."""
        return self.marker(name, self.from_centre(name, place))

    def coordinate_marker(self, name: str, coordinate: int = ANGLE) -> Index:
        """Add a marker of a coordinate of a body's node, or of the ground, which is 0; angles count
        from the start. Raises EngineError for the node of a beam, whose angle is no coordinate."""
        if name in self.looked and coordinate == ANGLE:
            raise EngineError(
                f"{name}: a moment acts on it, and the nodes of exudyn's beams have no angle; "
                "give that link segments (--springs plain)"
            )
        if name == GROUND:
            node, coordinate = self.add("NodePointGround"), 0
        else:
            node = self.node[name]
        return self.add("MarkerNodeCoordinate", nodeNumber=node, coordinate=coordinate)

    def weigh(self, body: Index) -> None:
        """Add gravity to a body or an element."""
        gravity = [*self.scene.gravity_m_s2, 0.0]
        if any(gravity):
            marker = self.add("MarkerBodyMass", bodyNumber=body)
            load = self.add("LoadMassProportional", markerNumber=marker, loadVector=gravity)
            self.weights.append(load)


def add_node(made: PlaneSystem, name: str, place: list[float], rates: list[float]) -> None:
    """Add a node of a beam: its place, and its tangent, longer than 1 by the strain there."""
    (x, y, theta), (u, v, omega) = place, rates
    c, s = math.cos(theta), math.sin(theta)
    long, faster = 1.0 + made.state.strain.get(name, 0.0), made.state.strain_rate.get(name, 0.0)
    made.node[name] = made.add(
        "NodePoint2DSlope1",
        referenceCoordinates=[x, y, long * c, long * s],
        initialVelocities=[u, v, faster * c - long * omega * s, faster * s + long * omega * c],
    )
    made.looked[name] = theta


def add_elements(made: PlaneSystem, beam: elastic.Beam) -> None:
    """Add the elements between the nodes of a beam, straight at rest for any place of these.

    An element is a cubic in its own length (absolute nodal coordinates); it bends by EI times the
    curvature of its axis over its stretch, and stretches by EA (|r'| - 1). Source: exudyn's manual,
    ObjectANCFCable2D; J. Gerstmayr, H. Irschik, J. Sound and Vibration 318 (2008).
    """
    made.elements[beam.name] = [
        made.add(
            "ObjectANCFCable2D",
            length=beam.element_m,
            massPerLength=beam.density_kg_m,
            bendingStiffness=beam.flexural_n_m2,
            axialStiffness=beam.axial_n,
            bendingDamping=beam.damping_s * beam.flexural_n_m2,
            axialDamping=beam.damping_s * beam.axial_n,
            nodeNumbers=[made.node[node] for node in pair],
        )
        for pair in pairwise(beam.nodes)
    ]
    for element in made.elements[beam.name]:
        made.weigh(element)


def held_beams(made: PlaneSystem) -> Mapping[str, tuple[elastic.Beam, ...]]:
    """Return exudyn's values of each beam, by element: a beam of one element each."""

    def held(beam: elastic.Beam) -> Iterator[elastic.Beam]:
        for element, pair in zip(made.elements[beam.name], pairwise(beam.nodes), strict=True):
            yield _held(made.system.GetObject(element), beam.name, pair)

    return {name: tuple(held(beam)) for name, beam in made.scene.beams.items()}


def _held(own: Mapping[str, float], name: str, nodes: tuple[str, str]) -> elastic.Beam:
    """Return an element; its damping is NaN where its two dampings differ in time."""
    names = "length", "massPerLength", "bendingStiffness", "axialStiffness"
    length, density, flexural, axial = (float(own[each]) for each in names)
    damping = float(own["bendingDamping"]) / flexural, float(own["axialDamping"]) / axial
    damping_s = damping[0] if math.isclose(*damping, rel_tol=1e-12) else math.nan
    return elastic.Beam(name, nodes, length, density, flexural, axial, damping_s)


def node_masses(beams: Mapping[str, tuple[elastic.Beam, ...]]) -> dict[str, float]:
    """Return the mass of each node of `held_beams` [kg]: half of its elements'."""
    found: dict[str, float] = {}
    for one in chain.from_iterable(beams.values()):
        for node in one.nodes:
            found[node] = found.get(node, 0.0) + 0.5 * one.density_kg_m * one.length_m
    return found


def roundings_n(scene: Scene, state: State) -> tuple[float, float]:
    """Return the rounding of the axial force of a beam [N], 0 without any: its strain is a
    difference of positions over the length of an element; and that of the inertia of the heaviest
    body [N, N m]: m L w^2 and m L^2 w^2, at the largest rate of the start."""
    size, one = scene.longest_m, EPSILON["double"]
    reach = max([size, *(math.hypot(*place) for place in state.position.values())])
    pulls = [one * beam.axial_n * reach / beam.element_m for beam in scene.beams.values()]
    heaviest = max((pairs.mass_of(scene, body)[0] for body in pairs.bodies(scene)), default=0.0)
    paces = [math.hypot(*velocity) / size for velocity in state.velocity.values()]
    pace = max([*paces, *map(abs, state.omega.values())])
    return max(pulls, default=0.0), one * heaviest * pace**2 * max(size, size**2)


def build(scene: Scene, state: State, *, prescribed: bool) -> PlaneSystem:
    """Build the system of ``scene`` at ``state``, without a drive. Raises EngineError for a link
    without mass that has to move freely (a ``prescribed`` crank need not have any), and for a
    massless block that no body carries."""
    container, own = exu.SystemContainer(), rows.body_rows(scene, state)
    start_rad = {GROUND: 0.0} | {name: place[2] for name, (_, _, place, _) in own.items()}
    system = container.AddSystem()
    made = PlaneSystem(scene, state, start_rad, container, system, centre=centres(scene))
    made.body[GROUND] = made.add("ObjectGround")
    held = {prism.body for prism in pairs.joints(scene).prisms}
    nodes = {node for beam in scene.beams.values() for node in beam.nodes}
    for name, (mass, inertia, place, rates) in own.items():
        if name in nodes:
            add_node(made, name, place, rates)
            continue
        if not (prescribed and name == scene.driver.link and not scene.driver.is_inner):
            refuse_massless(scene, "exudyn", name, turns=name not in held)
        node = made.add("NodeRigidBody2D", referenceCoordinates=place, initialVelocities=rates)
        body = made.add("ObjectRigidBody2D", mass=mass, inertia=inertia, nodeNumber=node)
        made.node[name], made.body[name] = node, body
        made.weigh(body)
    for beam in scene.beams.values():
        add_elements(made, beam)
    for hinge in hinges(scene, GROUND):
        ends = [made.marker(*end) for end in made.hinge_ends(hinge)]
        made.hinge[hinge] = made.add("ObjectJointRevolute2D", markerNumbers=ends)
    for name, (rider, tip, guide, through, axis, normal, keeps) in rows.line_rows(made).items():
        made.prismatic[name] = made.add(
            "ObjectJointPrismatic2D",
            markerNumbers=[made.marker(rider, tip), made.marker(guide, through)],
            axisMarker0=axis,
            normalMarker1=normal,
            constrainRotation=keeps,
        )
    return made
