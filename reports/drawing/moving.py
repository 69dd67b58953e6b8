"""A mechanism to be drawn by the page: shape, reference motion, and displacement of an engine.

The page draws ``reference + factor * displacement``; so the two are kept apart, each with its own
scale, and an error of 1e-9 can be magnified a millionfold. Nothing here knows of cells or sections:
any motion of a scene can be drawn with it. The drawing itself is ``assets/mechanism.js``.

A point is drawn at ``rigid + factor * (elastic - rigid)``, an elastic link bent by ``factor`` times
its deflection from the line between its pins.
"""

import base64
import hashlib
import json
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from markupsafe import Markup

from models.array import Array
from models.motion import Motion
from models.scene import GROUND, Scene
from models.scene.cut_links import line_of
from models.scene.driver import driver_axis, driver_course, driver_unit
from models.scene.laws import Oscillating
from reports.compare.last_turn import Trace
from reports.compare.tracks import angle_error
from reports.drawing.pair_curves import blocks_of, pair_curves, places_of
from reports.drawing.shape import true_motion
from reports.output.numbers import DIGITS, finite

LEVELS = 32767
MISSING = -32768
"""Integer for a sample that is not finite."""
ESCAPES = {
    "<": "\\u003c",
    ">": "\\u003e",
    "&": "\\u0026",
    "\u2028": "\\u2028",
    "\u2029": "\\u2029",
}


def embedded(value: object) -> Markup:
    """Return a value as JSON that may stand in a script element: no ``</script>``, no ``<!--``."""
    text = json.dumps(finite(value, DIGITS), allow_nan=False, separators=(",", ":"))
    for character, escape in ESCAPES.items():
        text = text.replace(character, escape)
    return Markup(text)


def packed(rows: Array) -> dict[str, object]:
    """Return rows of samples (R, T) as one text: 16-bit integers, little-endian, in base64.

    Every row has a scale of its own: sample = scale * integer, so that each is known to 1/65534 of
    the row's largest. Samples that are not finite are `MISSING`.
    """
    rows = np.atleast_2d(np.asarray(rows, dtype=np.float64))
    there = np.isfinite(rows)
    filled = np.where(there, rows, 0.0)
    scales = np.max(np.abs(filled), axis=1, initial=0.0) / LEVELS
    safe = np.where(scales > 0.0, scales, 1.0)
    # A row of subnormal numbers has too coarse a scale: its integers may come out beyond 16 bits.
    levels = np.clip(np.round(filled / safe[:, None]), -LEVELS, LEVELS)
    whole = np.where(there, levels, MISSING).astype("<i2")
    return {
        "samples": rows.shape[1],
        "scales": scales,
        "base64": _base64(whole.tobytes()),
    }


def singles(row: Array) -> dict[str, object]:
    """Return samples (T,) as one text: 32-bit floats, little-endian, in base64, for values that are
    read to their last digits; samples that are not finite stay so."""
    with np.errstate(over="ignore"):  # beyond 3.4e38 it has no end
        numbers = np.asarray(row, dtype=np.float64).astype("<f4")
    return {"samples": numbers.size, "singles": _base64(numbers.tobytes())}


def _base64(raw: bytes) -> str:
    return base64.b64encode(raw).decode("ascii")


def size_of(series: int, samples: int) -> int:
    """Return the characters of ``series`` packed rows of ``samples``."""
    return series * (samples * 8 // 3 + 12)


def policy(scripts: list[str]) -> str:
    """Return the content security policy of a page that runs only these scripts and loads nothing.
    Plotly writes styles as it draws, and makes pictures of diagrams out of blobs."""
    digests = (_base64(hashlib.sha256(script.encode()).digest()) for script in scripts)
    hashes = " ".join(f"'sha256-{digest}'" for digest in digests)
    return (
        f"default-src 'none'; script-src {hashes}; style-src 'unsafe-inline'; "
        "img-src data: blob:; media-src data:; base-uri 'none'; form-action 'none'"
    )


INSTANTS = 91
"""Instants over one period, both ends included, where no trace gives them."""
FARTHEST = 20.0
"""Lengths of the longest link at which displacements are cut off: a run that has come apart is far
out of the picture, and its first errors are to be seen."""


def instants(scene: Scene, turns: float = 1.0) -> Array:
    """Return instants in the last period of a run of some turns [s], shape (91,)."""
    period = scene.driver.law.period_s
    return np.linspace((turns - 1.0) * period, turns * period, INSTANTS)


def drawn_links(scene: Scene) -> list[str]:
    """Return the links whose angle a drawing needs: those that carry a guide or curves."""
    turning = [s.on for s in scene.sliders.values()] + [own.on for own in pair_curves(scene)]
    return list(dict.fromkeys(name for name in turning if name != GROUND))


def moving_points(scene: Scene) -> list[str]:
    """Return the points of the displacements, in their order."""
    return [name for name in scene.pins if name not in scene.ground] + [
        s.point for s in scene.sliders.values() if s.point not in scene.pins
    ]


def size_of_drawing(scene: Scene, samples: int, more: int = 0) -> int:
    """Return the characters of displacements at some samples, and of as many ``more`` rows."""
    return size_of(2 * len(moving_points(scene)) + len(drawn_links(scene)) + more, samples)


def drawing(scene: Scene, time_s: Array, truth: Motion | None = None) -> dict[str, object]:
    """Return the shape of a scene and the reference motion at some times [s], to be embedded.

    Series by point (x, then y), by link with a guide or curves (angle), by slider (displacement).
    ``truth`` replaces the driven reference, where there is another.
    """
    motion = true_motion(scene, time_s) if truth is None else truth
    points = {name: motion.points[name].position for name in moving_points(scene)}
    links = drawn_links(scene)
    places, curves = places_of(scene, motion), pair_curves(scene)
    return {
        "name": scene.name,
        "longest_m": scene.longest_m,
        "driver": scene.driver.link,
        "links": [{"name": x.name, "points": list(x.points)} for x in scene.links.values()],
        "ground": {name: list(place) for name, place in scene.ground.items()},
        "points": list(points),
        "guides": links,
        "sliders": [_slider(scene, name, motion) for name in scene.sliders],
        **({"curves": [vars(each) for each in curves]} if curves else {}),
        "box": [*places.min(axis=0), *places.max(axis=0)],
        "turning": goes_round(scene),
        "told": {
            "joint": scene.driver.joint,
            "axis": driver_axis(scene),
            "unit": driver_unit(scene),
            "at": told_places(scene, driver_course(scene, motion)[0]),
        },
        "places": packed(_rows(points.values(), len(time_s))),
        "angles": packed(_stacked([motion.links[name].theta for name in links], len(time_s))),
    }


def displacements(
    scene: Scene, trace: Trace, time_s: Array, truth: Motion | None = None
) -> dict[str, object] | None:
    """Return the displacement of a traced run from the reference, or from ``truth`` at the times of
    the trace, at the instants of a drawing.

    The rows are as the drawing's places and angles: x and y by point [m], then angles of the
    guide-bearing links [rad]. None for a trace without times, or of another motion.
    """
    own = trace.get("time_s")
    if own is None or any(f"x.{name}" not in trace for name in moving_points(scene)):
        return None
    motion = true_motion(scene, own) if truth is None else truth
    off = [
        np.column_stack([trace[f"x.{name}"], trace[f"y.{name}"]]) - motion.points[name].position
        for name in moving_points(scene)
    ]
    turned = [
        angle_error(trace[f"theta.{name}"], motion.links[name].theta) for name in drawn_links(scene)
    ]
    rows = np.vstack([_rows(off, len(own)), _stacked(turned, len(own))])
    period = scene.driver.law.period_s
    shift = period * round((time_s[0] - own[0]) / period)
    rows = np.array([_at(time_s, own + shift, row, period) for row in rows])
    reach = FARTHEST * scene.longest_m
    return packed(np.clip(rows, -reach, reach))


def _slider(scene: Scene, name: str, motion: Motion) -> dict[str, object]:
    slider = scene.sliders[name]
    travel = motion.sliders[name].displacement
    return {
        "point": slider.point,
        "on": slider.on,
        "angle": slider.direction_rad,
        "reach": [float(travel.min()), float(travel.max())],
        "along": packed(travel),
        **({} if slider in blocks_of(scene) else {"bare": True}),
    }


def goes_round(scene: Scene) -> bool:
    """True if the driver goes on turning: curves are over its place then, else over its period."""
    return scene.driver.slider is None and not isinstance(scene.driver.law, Oscillating)


def told_places(scene: Scene, place: Array) -> Array:
    """Return the driver's places [rad or m] as shown [deg or m], angles from the first turn on."""
    return place if scene.driver.slider is not None else np.degrees(first_turn(place))


def first_turn(angle_rad: Array) -> Array:
    """Return angles that start in the first turn: whole turns are taken off."""
    return np.asarray(angle_rad - math.tau * math.floor(float(angle_rad[0]) / math.tau + 1e-9))


def _rows(vectors: Iterable[Array], samples: int) -> Array:
    return _stacked([row for vector in vectors for row in vector.T], samples)


def _stacked(series: list[Array], samples: int) -> Array:
    return np.reshape(series, (-1, samples)) if series else np.zeros((0, samples))


def _at(time_s: Array, own_s: Array, row: Array, period_s: float) -> Array:
    """Return a row at other times: unchanged at equal times, else by straight lines between."""
    if len(own_s) == len(time_s) and np.allclose(own_s, time_s, rtol=0.0, atol=1e-9 * period_s):
        return row
    return np.interp(time_s, own_s, row, left=math.nan, right=math.nan)


SHOWN = 0.06
"""Drawn size of the largest displacement, roughly, over the size of the moving parts."""


def magnification(
    elastic: Motion, rigid: Motion, bent: Mapping[str, Array], size_m: float
) -> float:
    """Return the factor, 1, 2 or 5 times a power of ten and at least 1, to see displacements."""
    largest = largest_displacement(elastic, rigid, bent)
    return max(1.0, rounded(SHOWN * size_m / largest)) if largest > 0.0 else 1.0


def largest_displacement(elastic: Motion, rigid: Motion, bent: Mapping[str, Array]) -> float:
    """Return the largest displacement of a point, or deflection of a link [m]."""
    moved = [
        np.hypot(*(point.position - rigid.points[name].position).T).max()
        for name, point in elastic.points.items()
    ]
    return float(max([*moved, *(np.abs(each).max() for each in bent.values())]))


def rounded(value: float) -> float:
    """Return the next of 1, 2, 5, 10, ... below."""
    power = 10.0 ** math.floor(math.log10(value))
    return max(step for step in (1.0, 2.0, 5.0) if step * power <= value * (1 + 1e-9)) * power


@dataclass(frozen=True)
class Magnified:
    """Both motions at the same instants; ``bent`` are deflections (T, K) along each elastic link
    [m]."""

    scene: Scene
    elastic: Motion
    rigid: Motion
    bent: Mapping[str, Array]
    factor: float

    def place(self, point: str, index: int) -> Array:
        """Return a point at a sample [m], (2,)."""
        exact = self.rigid.points[point].position[index]
        moved = self.elastic.points[point].position[index] - exact
        return np.asarray(exact + self.factor * moved)

    def outline(self, link: str, index: int) -> Array:
        """Return the line or the corners of a link at a sample [m], (K, 2)."""
        if link not in self.bent:
            return np.array([self.place(p, index) for p in self.scene.links[link].points])
        start, end = (self.place(pin, index) for pin in line_of(self.scene, link).pins)
        along = end - start
        across = np.array([-along[1], along[0]]) / math.hypot(*along)
        off = self.factor * self.bent[link][index]
        shares = np.linspace(0.0, 1.0, off.size)
        return np.asarray(start + np.outer(shares, along) + np.outer(off, across))
