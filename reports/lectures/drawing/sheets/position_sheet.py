"""The sheet of positions, and sheets of schemes, each in a field with its name below.

Every pin of a group is found as in a drawing: arcs about its neighbour pins, or a ray along a line,
cross in it (lecture "Phan tich dong hoc", part II); the first position is drawn in full.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Arc, Circle
from matplotlib.patches import Polygon as Patch

from analytic.kinematics import solve_driven
from analytic.lectures.chains.chain import Chain, Joint
from analytic.lectures.chains.layout import joints_at
from analytic.lectures.drawings.polygon import DriverState, PlacedMechanism, quarter_turn
from analytic.structure.groups import Group
from models.array import Array
from models.errors import CrankcheckError
from models.scene import Scene
from reports.figures.style import INK, QUIET, SMALL, TINY
from reports.lectures.drawing.sheets import scheme
from reports.lectures.drawing.sheets.letters import NUMBER, Letter, write_letters
from reports.lectures.drawing.sheets.paper import (
    SIZES,
    Box,
    Canvas,
    Paper,
    ToScale,
    headed,
    inner_box,
    line,
    write_middle,
)
from reports.lectures.drawing.sheets.scheme import draw_block, draw_scheme, extent_of, point_letters

PADDING = 12.0
LEAST_APART_MM = 2.5
"""Least distance of divisions of the crank circle that can be numbered."""
LOCUS, LOCUS_PLACES = 361, 36
"""Number of places along a locus, and of those considered for its name."""
LEAST_WAY_MM = 0.1
"""Least path of a moving point."""
ARC_MM, DOT_MM = 4.0, 0.45
"""Half the length of the arcs of the construction, and the radius of a position's mark."""
FAINT, LOCI = "#a9b3bf", "#b7791f"


@dataclass(frozen=True)
class PositionSheet(ToScale):
    """The mechanism at ``angles`` of the driver (n,), its points there and along the loci [m]."""

    scene: Scene
    placement: PlacedMechanism
    angles: Array
    points: dict[str, Array]
    loci: dict[str, Array]
    paper: Paper


def positions(scene: Scene, divisions: int, paper: Paper) -> PositionSheet:
    """The scene with its crank circle in so many parts, from the driver's angle at time 0 on; a
    slider, or a driver that does not turn fully, is drawn from end to end of its range. The
    positions are numbered in the sense in which the driver starts.

    Raises CrankcheckError where the parts are too small to be distinguished on the paper.
    """
    start = float(scene.driver.law.at(np.zeros(1))[0][0])
    low, high = scheme.range_of_law(scene)
    sense = scheme.sense_of_law(scene)
    whole = scene.driver.slider is None and high - low >= math.tau - 1e-9
    if whole:
        angles = start + sense * math.tau * np.arange(divisions) / divisions
        dense = np.linspace(start, start + math.tau, LOCUS)
    else:
        first, last = (low, high) if sense > 0.0 else (high, low)
        angles, dense = np.linspace(first, last, divisions), np.linspace(first, last, LOCUS)
    points, loci = (_points(scene, each) for each in (angles, dense))
    placement = PlacedMechanism.of(scene, DriverState(float(angles[0]), sense))
    places = np.concatenate([*loci.values(), scheme.extent_of(placement)])
    box = inner_box(paper)
    fitted = box.fitted(places, PADDING)
    sheet = PositionSheet(box, *fitted, scene, placement, angles, points, loci, paper)
    _check_apart(sheet, divisions)
    return sheet


def _points(scene: Scene, angles: Array) -> dict[str, Array]:
    """All points at driver angles [m], (n, 2) each."""
    ones = np.ones_like(angles)
    motion = solve_driven(scene, angles, ones, 0.0 * ones, links=(), sliders=(), bound=False)
    return {name: point.position for name, point in motion.points.items()}


def _check_apart(sheet: PositionSheet, divisions: int) -> None:
    apart = max(
        float(np.hypot(*np.diff(sheet.at(sheet.points[name])[:2], axis=0)[0]))
        for name in _driven(sheet.scene)
    )
    if apart < LEAST_APART_MM:
        fit = max(2, int(divisions * apart / LEAST_APART_MM))
        joint, paper = sheet.scene.driver.joint, sheet.paper
        raise CrankcheckError(
            f"--divisions {divisions}: the positions of {joint} are {apart:.2g} mm apart on "
            f"{paper.width:g} x {paper.height:g} mm; at most {fit} fit, or take larger paper"
        )


def _driven(scene: Scene) -> tuple[str, ...]:
    """The points that the driver moves: of a crank, the point of a slider, a pin of two links."""
    driver = scene.driver
    if driver.slider is not None:
        return (scene.sliders[driver.slider].point,)
    return (driver.pin,) if driver.pin is not None else tuple(scene.links[driver.link].points)


def draw_positions(sheet: PositionSheet, note: str) -> Canvas:
    """Draw the sheet, in layers: loci, positions, construction, the mechanism, letters."""
    joint, count = sheet.scene.driver.joint, len(sheet.angles)
    title = f"{sheet.scene.name}: {count} positions of {joint}, K_l = {sheet.scale:g} m/mm"
    canvas, _ = headed(sheet.paper, title, note, sheet.box)
    loci = canvas.layer("loci")
    for name, way in _ways(sheet):
        loci.plot(way[:, 0], way[:, 1], color=LOCI, lw=0.8, gid=f"locus-{name}")
    _positions(canvas.layer("positions"), sheet)
    _construction(canvas.layer("construction"), sheet)
    scheme.draw_scheme(canvas.layer("mechanism"), sheet.placement, sheet.at)
    write_letters(canvas, canvas.layer("letters"), _letters(sheet), sheet.box)
    return canvas


def _ways(sheet: PositionSheet) -> Iterator[tuple[str, Array]]:
    """The paths of all points that move [mm], (n, 2) each."""
    for name, way in sheet.loci.items():
        places = sheet.at(way)
        if np.ptp(places, axis=0).max() > LEAST_WAY_MM:
            yield name, places


def _positions(axes: Axes, sheet: PositionSheet) -> None:
    for k in range(len(sheet.angles)):
        places = {name: sheet.at(at[k]) for name, at in sheet.points.items()}
        scheme.draw_outline(axes, sheet.scene.links.values(), places, FAINT, 0.5)
    for name in _driven(sheet.scene):
        for at in sheet.at(sheet.points[name]):
            axes.add_patch(Circle(tuple(at), DOT_MM, fc=FAINT, ec="none"))


def _construction(axes: Axes, sheet: PositionSheet) -> None:
    """Draw the arcs about outer pins that cross in the inner pin of each group."""
    for part in sheet.placement.structure.order:
        if not isinstance(part, Group) or part.kind not in ("RRR", "RRP"):
            continue
        outer = [part.outer1, part.outer2] if part.kind == "RRR" else [part.outer1]
        inner = sheet.at(sheet.points[part.inner])
        for pin in outer:
            about = sheet.at(sheet.points[pin])
            for centre, end in zip(about, inner, strict=True):
                _arc(axes, centre, end)


def _arc(axes: Axes, centre: Array, through: Array) -> None:
    """Draw a short arc about a centre on both sides of a place [mm]."""
    away = through - centre
    radius = float(np.hypot(*away))
    angle, half = math.degrees(math.atan2(away[1], away[0])), math.degrees(ARC_MM / radius)
    ends = {"theta1": angle - half, "theta2": angle + half}
    axes.add_patch(Arc(tuple(centre), 2 * radius, 2 * radius, color=INK, lw=0.5, **ends))


def _letters(sheet: PositionSheet) -> list[Letter]:
    spots = {name: sheet.at(at[0]) for name, at in sheet.points.items()}
    letters = scheme.point_letters(sheet.placement, spots)
    pivot = sheet.scene.driver_pivot if sheet.scene.driver.is_crank else ""
    pin, *others = _driven(sheet.scene)
    if pivot:
        pin = max((pin, *others), key=lambda name: float(np.hypot(*(spots[name] - spots[pivot]))))
    for k, at in enumerate(sheet.at(sheet.points[pin])):
        radius = scheme.symbol_radius(sheet.placement, pin) if k == 0 else DOT_MM
        letters.append(Letter(str(k), at, radius, NUMBER, QUIET))
    for name, places in _ways(sheet):
        few = places[:: max(1, len(places) // LOCUS_PLACES)]
        letters.append(Letter(f"locus of {name}", few, 0.2, NUMBER, LOCI))
    return letters


PIN_MM, BLOCK_MM = 0.75, (3.4, 2.2)
HATCH_MM, EVERY_MM = 1.1, 1.1
"""Length of the strokes beside a bar of the ground, and their distance."""
PLATE, GROUND_PLATE = "#dfe6ee", "white"
FRONT = 6


def draw_chain(
    axes: Axes, chain: Chain, at: Mapping[Joint, Array], ground: int | None = None
) -> None:
    """Draw the chain with its joints at places [mm]; the ground, if there is one, hatched."""
    for link in range(chain.links):
        corners = _around(np.array([at[joint] for joint in chain.joints_of(link)]))
        if len(corners) == 2:
            line(axes, corners[0], corners[1], linewidth=1.5)
            if link == ground:
                _strokes(axes, corners, np.mean(list(at.values()), axis=0))
        else:
            _plate(axes, corners, is_ground=link == ground)
    for joint in chain.joints:
        if joint in chain.sliders:
            place, along = at[joint], _along(chain, joint, at)
            draw_block(axes, place, along, BLOCK_MM, FRONT)
            half = 0.5 * BLOCK_MM[0] * along
            line(axes, place - half, place + half, linewidth=0.5, zorder=FRONT)
        else:
            axes.add_patch(
                Circle(tuple(at[joint]), PIN_MM, fc="white", ec=INK, lw=0.7, zorder=FRONT)
            )


def _around(corners: Array) -> Array:
    """The corners in order around their centroid."""
    to = corners - corners.mean(axis=0)
    return np.asarray(corners[np.argsort(np.arctan2(to[:, 1], to[:, 0]))])


def _plate(axes: Axes, corners: Array, *, is_ground: bool) -> None:
    look = {"hatch": "///////", "fc": GROUND_PLATE} if is_ground else {"fc": PLATE}
    plate = Patch(corners, closed=True, ec=INK, lw=1.3, joinstyle="round", **look)
    plate.set_hatch_linewidth(0.45)
    axes.add_patch(plate)


def _strokes(axes: Axes, ends: Array, middle: Array) -> None:
    """Draw the strokes of a bar of the ground, on its side away from the chain's middle."""
    along = ends[1] - ends[0]
    length = float(np.hypot(*along))
    unit = along / length
    side = quarter_turn(unit)
    if side @ (middle - ends[0]) > 0.0:
        side = -side
    stroke = HATCH_MM * (side - unit) / np.sqrt(2)
    for share in np.linspace(0.0, 1.0, max(int(length / EVERY_MM), 2) + 1)[1:-1]:
        at = ends[0] + share * along
        line(axes, at, at + stroke, linewidth=0.45)


def _along(chain: Chain, joint: Joint, at: Mapping[Joint, Array]) -> Array:
    """The direction of a slider: along an edge of its link with fewer joints, as of a bar."""
    link = min(joint, key=lambda one: chain.degrees[one])
    others = [one for one in chain.joints_of(link) if one != joint]
    way = np.asarray(at[others[0]] - at[joint])
    return np.asarray(way / np.hypot(*way))


LEAST_MM = (24.0, 24.0)
"""Least readable field: width and height [mm]."""
WORDS_MM, LINE_MM, PAD_MM = 8.5, 2.7, 3.5
"""Height of the words below a scheme, of a line of them, and the margin around it [mm]."""
BAR_MM = 22.0
"""Greatest length of a bar of common length [mm]."""
NAME = 6.5
ASPECT = 1.25
"""Approximate width over height of a field."""


@dataclass(frozen=True)
class DrawnChain:
    """A chain to draw: its name, a second line of words, and its ground if it has one."""

    chain: Chain
    name: str
    words: str
    ground: int | None = None


def check_room(many: int, paper: Paper) -> None:
    """Refuse paper on which so many fields can not be read. Raises CrankcheckError."""
    if _is_enough(many, paper):
        return
    field = _fields(many, paper)[0]
    fit = [name for name, size in SIZES.items() if _is_enough(many, Paper(*size))]
    cure = f"--paper {fit[0]} would do" if fit else "use fewer, or give a larger WIDTHxHEIGHT"
    raise CrankcheckError(
        f"{many} schemes do not fit on {paper.width:g} x {paper.height:g} mm: a field would be "
        f"{field.width:.0f} x {field.height:.0f} mm, and one that can be read is "
        f"{LEAST_MM[0]:g} x {LEAST_MM[1]:g} mm; {cure}"
    )


def _is_enough(many: int, paper: Paper) -> bool:
    field = _fields(many, paper)[0]
    return field.width >= LEAST_MM[0] and field.height >= LEAST_MM[1]


def _fields(many: int, paper: Paper) -> list[Box]:
    inner = inner_box(paper)
    columns = max(1, math.ceil(math.sqrt(many * inner.width / (inner.height * ASPECT))))
    return _grid(many, min(columns, many), inner)


def _grid(many: int, columns: int, inner: Box) -> list[Box]:
    """The fields of so many columns, row by row from the top."""
    wide, tall = inner.width / columns, inner.height / math.ceil(many / columns)
    return [
        Box(inner.left + (k % columns) * wide, inner.top - (k // columns + 1) * tall, wide, tall)
        for k in range(many)
    ]


def draw_chains(chains: Sequence[DrawnChain], title: str, note: str, paper: Paper) -> Canvas:
    """Draw the sheet, in layers; all chains with bars of one length."""
    check_room(len(chains), paper)
    canvas, _ = headed(paper, title, note)
    schemes, letters = canvas.layer("chains"), canvas.layer("letters")
    fields = _fields(len(chains), paper)
    places = [joints_at(one.chain) for one in chains]
    room = np.array([fields[0].width, fields[0].height - WORDS_MM]) - 2 * PAD_MM
    sizes = [np.ptp(np.array(list(at.values())), axis=0) for at in places]
    bar = min(BAR_MM, *(float(np.min(room / np.maximum(size, 0.3))) for size in sizes))
    for one, field, at in zip(chains, fields, places, strict=True):
        low = field.bottom + WORDS_MM
        middle = np.array([field.middle[0], low + (field.height - WORDS_MM) / 2])
        there = {joint: middle + bar * way for joint, way in at.items()}
        draw_chain(schemes, one.chain, there, one.ground)
        write_middle(letters, field, low - LINE_MM, one.name, NAME, color="black")
        write_middle(letters, field, low - LINE_MM - LINE_MM, one.words, TINY, color=QUIET)
    return canvas


FIELD_PADDING, NAME_MM = 11.0, 7.0
LEAST_SIDE_MM = 34.0
"""Least width and height of a readable field [mm]."""


def draw_assemblies(
    drawn: Sequence[tuple[PlacedMechanism, str, bool]], title: str, note: str, paper: Paper
) -> Canvas:
    """Draw the sheet of placements, each with its words, and True for the scene's own.

    Raises CrankcheckError for paper on which they can not be read.
    """
    fields = _square_fields(len(drawn), paper)
    if min(fields[0].width, fields[0].height) < LEAST_SIDE_MM:
        raise CrankcheckError(
            f"{len(drawn)} assemblies do not fit on {paper.width:g} x {paper.height:g} mm; take a "
            "larger --paper, such as A2"
        )
    canvas, frame = headed(paper, title, note, *fields)
    schemes, letters = canvas.layer("mechanism"), canvas.layer("letters")
    boxes = [Box(one.left, one.bottom + NAME_MM, one.width, one.height - NAME_MM) for one in fields]
    everything = np.concatenate([extent_of(placement) for placement, _, _ in drawn])
    fitted = boxes[0].fitted(everything, FIELD_PADDING)
    views = [ToScale(box, *fitted) for box in boxes]
    for (placement, words, is_own), field, view in zip(drawn, fields, views, strict=True):
        draw_scheme(schemes, placement, view.at)
        look = {"weight": "bold", "color": INK} if is_own else {"color": QUIET}
        write_middle(frame, field, field.bottom + 2.5, words, SMALL, margin=2.0, **look)
    for (placement, _, _), view in zip(drawn, views, strict=True):
        places = {name: view.at(place) for name, place in placement.points.items()}
        write_letters(canvas, letters, point_letters(placement, places), view.box)
    return canvas


def _square_fields(many: int, paper: Paper) -> list[Box]:
    """The fields, side by side and then below, about as wide as high."""
    inner = inner_box(paper)
    columns = min(range(1, many + 1), key=lambda n: _unlike(many, n, inner))
    return _grid(many, columns, inner)


def _unlike(many: int, columns: int, inner: Box) -> float:
    """Deviation of a layout from fields as wide as high, none of them blank."""
    rows = math.ceil(many / columns)
    aspect = inner.width / columns * rows / inner.height
    return abs(math.log(aspect)) + (rows * columns - many) / many
