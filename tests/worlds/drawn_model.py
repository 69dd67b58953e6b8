"""A scene as somebody else might write it in MJCF: in any plane, with frames and axes anywhere.

Nothing here is taken from `models.mjcf.document`: bodies are placed one by one in space, so that
what reads such a model is held to another writer.
"""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from xml.sax.saxutils import quoteattr

import numpy as np

from models.array import Array
from models.mjcf.tree import Freedom, Limb, LoopPin, plan
from models.motion import State
from models.scene import GROUND, Point, Scene
from models.scene.joints import Frame, bodies, centre_of, frames, joints, local_point, mass_of

HALF = "-far-half"
"""What the name of the second half of a cut link ends with."""
UPRIGHT = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
"""Turns the x-y plane into the x-z plane."""


@dataclass(frozen=True)
class Drawing:
    """How a model is drawn: in a plane placed by ``turn`` (3, 3) and ``shift_m`` (3,); with random
    frames, orders of siblings and senses of hinges where ``askew`` is a number; closed between
    ``sites`` or bodies; with ``free`` bodies that closures alone tie; with the link ``cut`` in two
    that a weld ties; with another zero of joints (``reads``), and a driver ``balanced`` on its
    hinge."""

    turn: Array | None = None
    shift_m: Sequence[float] = (0.0, 0.0, 0.0)
    askew: int | None = None
    sites: bool = True
    free: bool = False
    cut: str | None = None
    degrees: bool = False
    reads: float = 0.0
    balanced: bool = False


@dataclass
class _Body:
    """A body in space, with the text of what is on it, and its children."""

    name: str
    origin: Array
    axes: Array
    inside: list[str]
    children: list[_Body]


def drawn(scene: Scene, state: State, drawing: Drawing | None = None) -> str:
    """The MJCF text of a scene in a state; joints are called ``link.point``."""
    return _Writer(scene, state, drawing or Drawing()).text()


class _Writer:
    def __init__(self, scene: Scene, state: State, drawing: Drawing) -> None:
        self.scene, self.drawing = scene, drawing
        self.placed = frames(scene, state)
        self.chance = random.Random(drawing.askew)
        self.turn = np.eye(3) if drawing.turn is None else drawing.turn
        tree = plan(scene, state)
        self.limbs, self.pins = tree.limbs, list(tree.closures)
        if drawing.free:
            self.limbs, self.pins = tuple(self._freed()), list(self._all_pins())
        self.world = _Body("world", np.zeros(3), np.eye(3), [], [])
        self.made = {GROUND: self.world}

    def text(self) -> str:
        for limb in self.limbs:
            self._add(limb)
        closures = [self._closed(pin) for pin in self.pins]
        if self.drawing.cut is not None:
            closures.append(self._halved(self.drawing.cut))
        if self.drawing.askew is not None:
            self.chance.shuffle(closures)
        gravity = self._vector(self.turn[:, :2] @ np.array(self.scene.gravity_m_s2))
        unit = "degree" if self.drawing.degrees else "radian"
        return "\n".join(
            [
                "<mujoco>",
                f'  <compiler angle="{unit}"/>',
                f'  <option gravity="{gravity}"/>',
                "  <worldbody>",
                *self._written(self.world, "    "),
                "  </worldbody>",
                "  <equality>",
                *(f"    {closure}" for closure in closures),
                "  </equality>",
                "</mujoco>\n",
            ]
        )

    def _freed(self) -> Iterator[Limb]:
        """Every body on the world, the driver with its hinge, blocks and sliding links with their
        slide, the others with all three freedoms of the plane."""
        tree = {limb.body: limb for limb in self.limbs}
        for name in bodies(self.scene):
            frame = self.placed[name]
            if tree[name].parent == GROUND and len(tree[name].freedoms) == 1:
                slides = tree[name].freedoms[0].kind == "slide"
                if slides or name == self.scene.driver.link:
                    yield tree[name]
                    continue
            freedoms = (
                Freedom(f"{name}.x", "slide", (0.0, 0.0), -frame.theta, 0.0, 0.0),
                Freedom(f"{name}.y", "slide", (0.0, 0.0), np.pi / 2 - frame.theta, 0.0, 0.0),
                Freedom(f"{name}.turn", "hinge", (0.0, 0.0), 0.0, 0.0, 0.0),
            )
            yield Limb(name, GROUND, frame.origin, frame.theta, freedoms)

    def _all_pins(self) -> Iterator[LoopPin]:
        for pin in joints(self.scene).pins:
            for body in pin.bodies[1:]:
                if pin.point != self.scene.driver_pivot:
                    yield LoopPin(pin.point, (pin.bodies[0], body))

    def _add(self, limb: Limb) -> None:
        made = self._at(limb.body, self.placed[limb.body])
        made.inside += [self._joint(made, limb, freedom) for freedom in limb.freedoms]
        mass, inertia = mass_of(self.scene, limb.body)
        if limb.body == self.drawing.cut:
            mass, inertia = mass / 2, inertia / 2
        made.inside.append(self._inertial(made, limb.body, mass, inertia))
        self.made[limb.body] = made
        self.made[limb.parent].children.append(made)

    def _at(self, name: str, frame: Frame) -> _Body:
        """A body that is drawn at a frame of the plane; askew, its own frame is anywhere."""
        origin, axes = self._space(frame.origin), self.turn
        if self.drawing.askew is not None:
            origin = origin + np.array([self.chance.uniform(-1.0, 1.0) for _ in range(3)])
            axes = rotation(self.chance)
        return _Body(name, origin, axes, [], [])

    def _joint(self, made: _Body, limb: Limb, freedom: Freedom) -> str:
        frame = self.placed[limb.body]
        hinge = freedom.kind == "hinge"
        anchor = self._local(made, frame.at(freedom.anchor))
        if hinge:
            axis = self.turn[:, 2]
            turns = self.drawing.askew is not None and limb.body != self.scene.driver.link
            axis = -axis if turns and self.chance.random() < 0.5 else axis
        else:
            angle = frame.theta + freedom.axis_rad
            axis = self.turn[:, :2] @ np.array([np.cos(angle), np.sin(angle)])
        ref = self.drawing.reads
        ref = float(np.degrees(ref)) if hinge and self.drawing.degrees else ref
        kind = "hinge" if hinge else "slide"
        return (
            f'<joint name={quoteattr(freedom.name)} type="{kind}" pos="{anchor}" '
            f'axis="{self._vector(made.axes.T @ axis)}" ref="{ref!r}"/>'
        )

    def _inertial(self, made: _Body, body: str, mass: float, inertia: float) -> str:
        centre = centre_of(self.scene, body)
        if self.drawing.balanced and body == self.scene.driver.link:
            centre = local_point(self.scene, body, self.scene.driver_pivot)
        place = self.placed[body].at(centre)
        # About other axes it is less: only that across the plane is the scene's.
        across = " ".join(repr(part * inertia) for part in (0.6, 0.7, 1.0))
        axes = self._axes(made.axes.T @ self.turn)
        return (
            f'<inertial pos="{self._local(made, place)}" xyaxes="{axes}" '
            f'mass="{mass!r}" diaginertia="{across}"/>'
        )

    def _closed(self, pin: LoopPin) -> str:
        one, other = pin.bodies if pin.bodies[0] != GROUND else pin.bodies[::-1]
        if self.drawing.sites:
            for body in (one, other):
                place = self._local(self.made[body], self._own(body, pin.point))
                self.made[body].inside.append(
                    f'<site name={quoteattr(f"{body}.{pin.point}")} pos="{place}"/>'
                )
            names = [quoteattr(f"{body}.{pin.point}") for body in (one, other)]
            return f"<connect site1={names[0]} site2={names[1]}/>"
        anchor = self._local(self.made[one], self._own(one, pin.point))
        name = quoteattr(f"{pin.point}: {one} to {other}")
        second = "" if other == GROUND else f" body2={quoteattr(other)}"
        return f'<connect name={name} body1={quoteattr(one)}{second} anchor="{anchor}"/>'

    def _own(self, body: str, point: str) -> Point:
        return self.placed[body].at(local_point(self.scene, body, point))

    def _halved(self, link: str) -> str:
        """Move all that hangs on a link, but for its own joints, to a second half; weld the two."""
        first = self.made[link]
        half = self._at(link + HALF, self.placed[link])
        mass, inertia = mass_of(self.scene, link)
        half.inside = [
            f'<joint name="{link}.{axis}" type="{kind}" axis="{self._vector(half.axes.T @ way)}"/>'
            for axis, kind, way in (
                ("x", "slide", self.turn[:, 0]),
                ("y", "slide", self.turn[:, 1]),
                ("turn", "hinge", self.turn[:, 2]),
            )
        ]
        half.inside.append(self._inertial(half, link, mass / 2, inertia / 2))
        sites = [row for row in first.inside if row.startswith("<site")]
        assert not self.drawing.askew or not sites, "sites are not moved to another frame"
        first.inside = [row for row in first.inside if row not in sites]
        half.inside += sites
        half.children, first.children = first.children, []
        self.world.children.append(half)
        return f"<weld body1={quoteattr(link)} body2={quoteattr(half.name)}/>"

    def _written(self, body: _Body, pad: str) -> Iterator[str]:
        yield from (pad + row for row in body.inside)
        children = list(body.children)
        if self.drawing.askew is not None:
            self.chance.shuffle(children)
        for child in children:
            place = self._vector(body.axes.T @ (child.origin - body.origin))
            axes = self._axes(body.axes.T @ child.axes)
            yield f'{pad}<body name={quoteattr(child.name)} pos="{place}" xyaxes="{axes}">'
            yield from self._written(child, pad + "  ")
            yield f"{pad}</body>"

    def _space(self, place: Point) -> Array:
        shift = np.array(self.drawing.shift_m, dtype=np.float64)
        return np.asarray(self.turn @ np.array([*place, 0.0]) + shift)

    def _local(self, body: _Body, place: Point) -> str:
        return self._vector(body.axes.T @ (self._space(place) - body.origin))

    def _axes(self, matrix: Array) -> str:
        """A rotation, by its first two columns."""
        return self._vector(matrix[:, :2].T.ravel())

    @staticmethod
    def _vector(vector: Array) -> str:
        return " ".join(repr(float(part)) for part in vector)


def rotation(chance: random.Random) -> Array:
    matrix, _ = np.linalg.qr(np.array([[chance.gauss(0.0, 1.0) for _ in "xyz"] for _ in "xyz"]))
    return np.asarray(matrix * np.sign(np.linalg.det(matrix)))
