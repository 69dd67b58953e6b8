"""Linearised equations of all joints of a scene: those of pins, sliders, gears, cams, the driver.

Each is the derivative of a joint's equation by a dimension, linear in those of the coordinates of
bodies; none knows of dyads. They are solved group by group, in the order of the structure. A
redundant link takes its direction from two of its pins, as in the motion
(`analytic.dyads.redundant`); its other equations hold at the solution, or the dimension cannot
change while the mechanism moves.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from analytic.dyads.chunk import Chunk
from analytic.dyads.plane import EPS
from analytic.gradients.cam_terms import follower_form
from analytic.gradients.certified import LinearSystem
from analytic.gradients.dimensions import Dimension
from analytic.gradients.forms import DerivativeForm, Places, Unknown
from analytic.gradients.varying import Varying
from analytic.structure.mobility import analyse
from models.errors import StructureError
from models.scene import Scene
from models.scene.joints import joined_at, sliding_body

FITS = 1e-6
"""Largest misfit of a redundant link after a change of a dimension by 1 m or rad, over lengths."""


@dataclass(frozen=True)
class Linearised:
    """Derivatives of the first points and angles of all bodies by each dimension, (3, P, T)."""

    places: Places
    known: Mapping[Unknown, Varying]
    locked: frozenset[str]

    def at(self, form: DerivativeForm) -> Varying:
        """Return the value of a form, as far as its bodies are known, (3, P, T)."""
        found = form.value(self.known, len(self.places.wanted))
        shape = (*found.value.shape[:2], len(self.places.chunk.theta))
        return Varying(np.broadcast_to(found.value, shape), np.broadcast_to(found.error, shape))


@np.errstate(all="ignore")  # nothing is certain in singular positions
def linearised(scene: Scene, chunk: Chunk, wanted: Mapping[str, Dimension]) -> Linearised:
    """Solve the linearised equations on a chunk. ``locked`` are the dimensions that redundant links
    do not let change. Raises StructureError for passive constraints of other kinds."""
    stages = _stages(scene)
    places = Places(scene, chunk, wanted, [body for stage in stages for body in stage])
    joints = _Joints(places)
    rows: list[list[Row]] = [[] for _ in stages]
    for form, across in joints.rows():
        held = {body for _, body in form.terms}
        rows[max(i for i, stage in enumerate(stages) if held & set(stage))].append((form, across))
    found = Linearised(places, {}, frozenset())
    for stage, own in zip(stages, rows, strict=True):
        found = replace(found, known={**found.known, **_solved(found, stage, own)})
    return _without_locked(found, joints.kept)


def _stages(scene: Scene) -> list[tuple[str, ...]]:
    """Return the bodies of the driver, and of each group, in solving order."""
    structure = analyse(scene)
    groups = [part.bodies for part in structure.order]
    if (two := structure.compound) is None:
        return [(scene.driver.link,), *groups]
    each = {two.name: (two.base, two.link)}
    return [tuple(b for body in own for b in each.get(body, (body,))) for own in groups]


def _solved(found: Linearised, stage: tuple[str, ...], rows: list[Row]) -> dict[Unknown, Varying]:
    """Return the derivatives of the first points and angles of the bodies of a group."""
    places = found.places
    angles = [("turn", body) for body in stage if ("turn", body) in places.angle(body).terms]
    unknowns = [("z", body) for body in stage]
    points, size = 2 * len(unknowns), 2 * len(unknowns) + len(angles)
    if len(rows) != size:
        raise StructureError(
            f"{places.scene.name}: {len(rows)} equations of joints for the {size} coordinates of "
            f"{', '.join(stage)}; derivatives by dimensions need as many of each: remove a passive "
            "constraint"
        )
    samples, count = len(places.chunk.theta), len(places.wanted)
    matrix, f = np.zeros((3, samples, size, size)), np.zeros((3, samples, size, count))
    off_matrix, off_f = np.zeros_like(matrix), np.zeros_like(f)
    for i, (form, across) in enumerate(rows):
        axis = 1j if across else 1.0  # the imaginary part of c is the real part of c / i
        for j, key in enumerate(unknowns):
            if (one := form.terms.get(key)) is not None:
                c = one.value / axis
                matrix[:, :, i, 2 * j], matrix[:, :, i, 2 * j + 1] = c.real, -c.imag
                off_matrix[:, :, i, 2 * j : 2 * j + 2] = one.error[:, :, None]
        for j, key in enumerate(angles, points):
            if (one := form.terms.get(key)) is not None:
                matrix[:, :, i, j] = (one.value / axis).real
                off_matrix[:, :, i, j] = one.error
        given = found.at(form)
        f[:, :, i] = (given.value / axis).real.swapaxes(1, 2)
        off_f[:, :, i] = given.error.swapaxes(1, 2)
    units = np.repeat([places.scene.longest_m, 1.0], [points, len(angles)])
    solution = LinearSystem(matrix, off_matrix, f, off_f, units).solved()
    x, e = (each.transpose(2, 0, 3, 1) for each in solution)  # (n, 3, P, T)
    known = {}
    for j, key in zip(range(0, points, 2), unknowns, strict=True):
        known[key] = Varying(x[j] + 1j * x[j + 1], np.hypot(e[j], e[j + 1]))
    for j, key in enumerate(angles, points):
        known[key] = Varying(x[j].astype(complex), e[j])
    return known


def _without_locked(found: Linearised, kept: list[tuple[DerivativeForm, bool]]) -> Linearised:
    locked = set()
    for form, across in kept:
        value = found.at(form).value[0]
        misfit = np.abs(value.imag if across else value.real)
        for number, (name, one) in enumerate(found.places.wanted.items()):
            scale = found.places.scene.longest_m if one.unit == "rad" else 1.0
            if np.nanmax(misfit[number], initial=0.0) > FITS * scale:
                locked.add(name)
    return replace(found, locked=frozenset(locked))


Row = tuple[DerivativeForm, bool]
"""Complex form, of which the imaginary part (True) or the real part is 0."""


class _Joints:
    """Equations of the joints; ``kept`` are those that hold besides."""

    def __init__(self, places: Places) -> None:
        self.places, self.scene = places, places.scene
        self.bridges = {one.link: one for one in analyse(self.scene).redundant}
        self.kept: list[Row] = []

    def rows(self) -> Iterator[Row]:
        scene, places = self.scene, self.places
        for point, held in joined_at(scene).items():
            first, *others = sorted(held, key=places.order.index)
            for body in others:
                gap = places.point(body, point) - places.point(first, point)
                yield from self._pin(body, point, gap)
        for slider in scene.sliders.values():
            yield places.ride(slider), True
            if slider.name not in places.tied:
                ends = places.angle(sliding_body(slider)), places.angle(slider.on)
                yield ends[0] - ends[1] - places.lean(slider), False
        for gear in scene.gears.values():
            form = DerivativeForm()
            for body, factor in gear.relation.items():
                share = factor / gear.teeth[0]
                form += places.angle(body).times(Varying.constant(share, EPS * abs(share)))
            yield form, False
        for pair in scene.cams.values():
            yield follower_form(places, pair), False
        driver = scene.driver
        moved = places.angle(driver.link) - places.angle(driver.base)
        if driver.slider is not None:
            moved = places.ride(scene.sliders[driver.slider])
        yield moved - places.shifted("driver"), False

    def _pin(self, body: str, point: str, gap: DerivativeForm) -> Iterator[Row]:
        """Yield the equations of a pin; of a redundant link both only at the first of the two pins
        that are farthest apart, and at the second the one across the line of the two."""
        bridge = self.bridges.get(body)
        if bridge is None or point not in bridge.pins:
            yield from ((gap, False), (gap, True))
            return
        at = self.scene.links[body].points
        places = {pin: complex(*at[pin]) for pin in bridge.pins}
        one, other = max(
            ((a, b) for a in places for b in places if a < b),
            key=lambda pair: abs(places[pair[0]] - places[pair[1]]),
        )
        if point == one:
            yield from ((gap, False), (gap, True))
            return
        line = (places[other] - places[one]) / abs(places[other] - places[one])
        turned = gap.times((self.places.turns[body] * Varying.constant(line, 2 * EPS)).conj())
        self.kept.append((turned, False))
        if point == other:
            yield turned, True
        else:
            self.kept.append((turned, True))
