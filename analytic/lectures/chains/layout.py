"""Layout of the joints of a chain as on a drawing: no link over another, bars of like length.

Many starts are improved at once, by chance but from a fixed seed: places by springs between all
joints, and with a loop of links outside and each other joint in the middle of its neighbours (W. T.
Tutte, How to draw a graph, 1963); then steps that lower the cost of a drawing.
"""

import itertools
from dataclasses import dataclass
from functools import cache

import numpy as np

from analytic.lectures.chains.chain import Chain, Joint
from models.array import Array

SEED, SPRUNG, PULLS, RINGS = 18, 24, 40, 48
"""Seed; numbers of starts by springs, of their pulls, and of starts with a loop outside."""
KEPT, TRIES, ROUNDS, REACH, GOOD = 20, 10, 240, (0.35, 0.012), 0.12
"""Improved starts; steps of each tried at once, their number, the length of the first and the last
[bars], and the cost for each joint above six that is as good as none."""
FINAL = 4
"""Divisor of the rounds, after which the starts are divided by it as well."""
CLEAR = 0.42
"""Sufficient distance [bars] from a bar to a joint that is not on it."""
SHARP = 0.5
"""Sufficient sine of an angle between two links at a joint."""
CROSSING, CLOSE, POINTED, UNEVEN, HOLLOW = 30.0, 12.0, 4.0, 1.0, 20.0
"""Costs: of two bars that cross, a joint too near a bar, a sharp angle, a bar of another length
than 1, and a plate with a false corner."""


@dataclass(frozen=True)
class Outline:
    """Chain's joints ``at`` places (p, 2), the bars being about 1 long; ``cost`` of the drawing,
    and the number ``crossings`` of bars."""

    at: Array
    cost: float
    crossings: int


class _Pattern:
    """Parts of a chain for the cost: edges of links, and pairs of these with each other and
    joints."""

    def __init__(self, chain: Chain) -> None:
        place = {joint: k for k, joint in enumerate(chain.joints)}
        self.links = [
            [place[joint] for joint in chain.joints_of(link)] for link in range(chain.links)
        ]
        self.plates = [own for own in self.links if len(own) > 2]
        edges = [
            (a, b, link)
            for link, own in enumerate(self.links)
            for a, b in itertools.combinations(own, 2)
        ]
        self.edges = np.array([edge[:2] for edge in edges])
        apart, corners = [], []
        for (i, (a, b, link)), (j, (c, d, other)) in itertools.combinations(enumerate(edges), 2):
            if link == other:
                continue
            shared = {a, b} & {c, d}
            if shared:
                own = shared.pop()
                corners.append((own, b if own == a else a, d if own == c else c))
            else:
                apart.append((i, j))
        self.apart, self.corners = np.array(apart).reshape(-1, 2), np.array(corners)
        off = [
            (point, k)
            for k, (_, _, link) in enumerate(edges)
            for point in range(len(chain.joints))
            if point not in self.links[link]
        ]
        self.off = np.array(off)
        self.joints = len(chain.joints)

    def cost(self, at: Array) -> tuple[Array, Array]:
        """Return the cost of places (k, p, 2), and the crossings, (k,) each."""
        a, b = at[:, self.edges[:, 0]], at[:, self.edges[:, 1]]
        along = b - a
        length = np.hypot(along[..., 0], along[..., 1])
        uneven = (np.log(np.maximum(length, 1e-9)) ** 2).sum(axis=1)
        crossings = self._crossings(a, b)
        close = (np.maximum(0.0, CLEAR - self._distances(at, a, along)) ** 2).sum(axis=1)
        pointed = (np.maximum(0.0, self._sharpness(at)) ** 2).sum(axis=1)
        hollow = sum((_hollow(at[:, own]) for own in self.plates), np.zeros(len(at)))
        cost = UNEVEN * uneven + CROSSING * crossings + CLOSE / CLEAR**2 * close
        return cost + POINTED * pointed + HOLLOW * hollow, crossings

    def _crossings(self, a: Array, b: Array) -> Array:
        if not len(self.apart):
            return np.zeros(len(a))
        i, j = self.apart.T
        one = _cross(b[:, i] - a[:, i], a[:, j] - a[:, i]) * _cross(
            b[:, i] - a[:, i], b[:, j] - a[:, i]
        )
        other = _cross(b[:, j] - a[:, j], a[:, i] - a[:, j]) * _cross(
            b[:, j] - a[:, j], b[:, i] - a[:, j]
        )
        return np.asarray(((one < 0.0) & (other < 0.0)).sum(axis=1))

    def _distances(self, at: Array, a: Array, along: Array) -> Array:
        """Return the distances of joints from the edges of links that they are not on."""
        point, edge = self.off.T
        to, way = at[:, point] - a[:, edge], along[:, edge]
        share = (to * way).sum(axis=2) / np.maximum((way * way).sum(axis=2), 1e-12)
        left = to - np.clip(share, 0.0, 1.0)[..., None] * way
        return np.asarray(np.hypot(left[..., 0], left[..., 1]))

    def _sharpness(self, at: Array) -> Array:
        """Return the excess of the cosine of angles at joints, between two links."""
        own, one, other = self.corners.T
        u, v = at[:, one] - at[:, own], at[:, other] - at[:, own]
        size = np.hypot(u[..., 0], u[..., 1]) * np.hypot(v[..., 0], v[..., 1])
        cosine = (u * v).sum(axis=2) / np.maximum(size, 1e-12)
        return np.asarray(cosine - np.sqrt(1.0 - SHARP**2))


def _cross(u: Array, v: Array) -> Array:
    return np.asarray(u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0])


def _hollow(corners: Array) -> Array:
    """Return the deviation of plates (k, c, 2) from convex ones with a joint at each corner."""
    middle = corners.mean(axis=1, keepdims=True)
    angle = np.arctan2(*np.moveaxis((corners - middle)[..., ::-1], -1, 0))
    order = np.argsort(angle, axis=1)
    ring = np.take_along_axis(corners, order[..., None], axis=1)
    before, after = ring - np.roll(ring, 1, axis=1), np.roll(ring, -1, axis=1) - ring
    size = np.hypot(*np.moveaxis(before, -1, 0)) * np.hypot(*np.moveaxis(after, -1, 0))
    turn = _cross(before, after) / np.maximum(size, 1e-12)
    return np.asarray((np.maximum(0.0, SHARP - turn) ** 2).sum(axis=1))


@cache
def layout(chain: Chain) -> Outline:
    """Return the places of the joints, ordered as ``chain.joints``, the longest side level."""
    pattern = _Pattern(chain)
    draw = np.random.default_rng(SEED)
    starts = np.concatenate([_sprung(pattern, draw), _with_loops_outside(chain, pattern, draw)])
    cost, _ = pattern.cost(starts)
    best = _improved(pattern, starts[np.argsort(cost, kind="stable")[:KEPT]], draw)
    value, crossings = pattern.cost(best[None])
    return Outline(_level(best), float(value[0]), int(crossings[0]))


def _sprung(pattern: _Pattern, draw: np.random.Generator) -> Array:
    """Place joints by springs from random starts, (k, p, 2): distances as along the links."""
    want = _steps_apart(pattern)
    at = draw.normal(size=(SPRUNG, pattern.joints, 2)) * np.sqrt(pattern.joints) / 2
    weight = 1.0 / want**2
    np.fill_diagonal(weight, 0.0)
    total = weight.sum(axis=1)[None, :, None]
    for _ in range(PULLS):
        apart = at[:, :, None] - at[:, None]
        size = np.maximum(np.hypot(apart[..., 0], apart[..., 1]), 1e-9)
        goal = at[:, None] + apart * (want / size)[..., None]
        at = (weight[..., None] * goal).sum(axis=2) / total
    return np.asarray(at)


def _steps_apart(pattern: _Pattern) -> Array:
    """Return the number of links from each joint to each other, (p, p); 1 on the diagonal."""
    p = pattern.joints
    steps = np.full((p, p), float(p))
    np.fill_diagonal(steps, 0.0)
    for a, b in pattern.edges:
        steps[a, b] = steps[b, a] = 1.0
    for k in range(p):
        steps = np.minimum(steps, steps[:, k, None] + steps[None, k])
    np.fill_diagonal(steps, 1.0)
    return np.asarray(steps)


def _with_loops_outside(chain: Chain, pattern: _Pattern, draw: np.random.Generator) -> Array:
    """Return places with one of the longest loops on a circle, each other joint in the middle of
    those that it shares links with, (k, p, 2), and a little chance."""
    place = {joint: k for k, joint in enumerate(chain.joints)}
    loops = sorted(_loops(chain), key=len, reverse=True)
    starts = []
    for loop, chance in zip(itertools.cycle(loops), np.linspace(0.05, 0.4, RINGS), strict=False):
        ring = [
            place[(min(pair), max(pair))] for pair in zip(loop, loop[1:] + loop[:1], strict=True)
        ]
        inner = [k for k in range(pattern.joints) if k not in ring]
        laplace = np.zeros((pattern.joints, pattern.joints))
        for a, b in pattern.edges:
            laplace[[a, b], [b, a]] -= 1.0
            laplace[[a, b], [a, b]] += 1.0
        at = np.zeros((pattern.joints, 2))
        angle = 2.0 * np.pi * np.arange(len(ring)) / len(ring)
        at[ring] = np.stack([np.cos(angle), np.sin(angle)], axis=1) / angle[1]
        if inner:
            pull = laplace[np.ix_(inner, ring)] @ at[ring]
            at[inner] = -np.linalg.solve(laplace[np.ix_(inner, inner)], pull)
        starts.append(at + draw.normal(scale=chance, size=at.shape))
    return np.array(starts)


def _loops(chain: Chain) -> list[list[int]]:
    """Return all closed ways over links, each once."""
    loops: list[list[int]] = []
    ways = [[link] for link in range(chain.links)]
    while ways:
        way = ways.pop()
        for link in chain.neighbours[way[-1]]:
            if link == way[0] and len(way) > 2 and way[1] < way[-1]:
                loops.append(way)
            elif link > way[0] and link not in way:
                ways.append([*way, link])
    return loops


def _improved(pattern: _Pattern, at: Array, draw: np.random.Generator) -> Array:
    """Return the best places from walks of ever shorter steps from (k, p, 2), (p, 2)."""
    value = pattern.cost(at)[0]
    for k, reach in enumerate(np.geomspace(*REACH, ROUNDS)):
        if k == ROUNDS // FINAL:
            first = np.argsort(value, kind="stable")[: KEPT // FINAL]
            at, value = at[first], value[first]
        each = np.arange(len(at))
        size = (len(at), TRIES, pattern.joints)
        moved = (draw.random(size) < 0.3)[..., None]
        tried = at[:, None] + moved * draw.normal(scale=reach, size=(*size, 2))
        costs = pattern.cost(tried.reshape(-1, pattern.joints, 2))[0].reshape(len(at), TRIES)
        chosen = np.argmin(costs, axis=1)
        better = costs[each, chosen] < value
        at = np.where(better[:, None, None], tried[each, chosen], at)
        value = np.where(better, costs[each, chosen], value)
        if value.min() < GOOD * max(pattern.joints - 6, 0.1):
            break
    return np.asarray(at[int(np.argmin(value))])


def _level(at: Array) -> Array:
    """Return the places about their middle, turned to be wide and low."""
    at = at - (at.max(axis=0) + at.min(axis=0)) / 2
    turns = np.linspace(0.0, np.pi, 181)
    wide = [np.ptp(_turned(at, turn)[:, 1]) for turn in turns]
    at = _turned(at, turns[int(np.argmin(wide))])
    return np.asarray(at - (at.max(axis=0) + at.min(axis=0)) / 2)


def _turned(at: Array, angle: float) -> Array:
    c, s = np.cos(angle), np.sin(angle)
    return np.asarray(at @ np.array([[c, s], [-s, c]]))


def joints_at(chain: Chain) -> dict[Joint, Array]:
    """Return the place of each joint."""
    return dict(zip(chain.joints, layout(chain).at, strict=True))
