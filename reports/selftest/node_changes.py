"""Change what an engine has logged of the nodes of its segments."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from analytic.elastic.discretisation import REFERENCE, Discretisation
from analytic.elastic.elastic_motion import DrivenElasticMotion
from models.array import Array
from models.cut_links import CutScene
from models.motion import Motion
from models.scene import Scene
from reports.compare.elastic.elastic_truth import ElasticTruth
from reports.judge.cell import CellRunner
from reports.selftest.elastic_runs import sound_run, truth_of_given
from reports.selftest.fault import Plant
from reports.selftest.logs import WHEN, moved
from sim.engine import Run

NodeChange = Callable[[ElasticTruth, Motion, float], Motion]


def in_chain_log(change: NodeChange) -> Plant:
    """The engine runs the chain as ever; what it has logged is changed afterwards."""

    def plant(size: float) -> CellRunner:
        def runner(scene: Scene, _: object, name: str, profile: str, **options: Any) -> Run:
            asked = {key: value for key, value in options.items() if key != "settings"}
            done = sound_run(scene, name, profile, tuple(sorted(asked.items())))
            if not size:
                return done
            return replace(done, motion=change(truth_of_given(scene), moved(done), size))

        return runner

    return plant


def bent_by(change: Callable[[Array, float], Array]) -> NodeChange:
    """All nodes, as far from the line between the pins as the change has it."""

    def changed(truth: ElasticTruth, motion: Motion, size: float) -> Motion:
        name = next(iter(truth.scene.elastic))
        nodes = truth.cut.nodes(name)
        first, across = _line(motion, nodes)
        for node in nodes[1:-1]:
            off = ((motion.points[node].position - first) * across).sum(axis=1)
            motion = _moved(motion, node, (change(off, size) - off)[:, None] * across)
        return motion

    return changed


def at_next_node(truth: ElasticTruth, motion: Motion, _: float) -> Motion:
    """The middle is logged where the node before it is, of which it has the deflection."""
    name = next(iter(truth.scene.elastic))
    nodes = truth.cut.nodes(name)
    first, across = _line(motion, nodes)
    middle = len(nodes) // 2
    off, near = (
        ((motion.points[nodes[k]].position - first) * across).sum(axis=1)
        for k in (middle, middle - 1)
    )
    return _moved(motion, nodes[middle], (near - off)[:, None] * across)


def at_quarter(truth: ElasticTruth, motion: Motion, share: float) -> Motion:
    """The first node, away from the middle, is elsewhere by a share of the deflection there, once
    the start has been looked at."""
    name = next(iter(truth.scene.elastic))
    nodes = truth.cut.nodes(name)
    first, across = _line(motion, nodes)
    off = ((motion.points[nodes[1]].position - first) * across).sum(axis=1)
    off[:WHEN] = 0.0
    return _moved(motion, nodes[1], share * off[:, None] * across)


def of_beam(*, stiffened: bool, by: Discretisation = REFERENCE) -> NodeChange:
    """Links, points and the middle of another theory, in the engine's place."""

    def changed(truth: ElasticTruth, motion: Motion, _: float) -> Motion:
        scene = truth.scene
        theory = DrivenElasticMotion(scene, 1.0, by, truth.theory.shape, stiffened)
        return _given_back(truth.cut, motion, theory.at(motion.time_s))

    return changed


def of_exact_chain(truth: ElasticTruth, motion: Motion, _: float) -> Motion:
    """The exact chain, in the engine's place."""
    exact = truth.exact_at(motion.time_s)
    assert exact is not None
    return _given_back(truth.cut, motion, exact)


def _given_back(chain: CutScene, own: Motion, other: Motion) -> Motion:
    """The log with the links, the points and the deflections of another motion."""
    links = {**own.links, **{n: each for n, each in other.links.items() if n in own.links}}
    motion = replace(own, links=links, points={**own.points, **other.points})
    for name in chain.scene.elastic:
        nodes = chain.nodes(name)
        first, across = _line(motion, nodes)
        middle = nodes[chain.count // 2]
        off = ((motion.points[middle].position - first) * across).sum(axis=1)
        by = other.elastic[name].middle - off
        motion = _moved(motion, middle, by[:, None] * across)
    return motion


def _line(motion: Motion, nodes: tuple[str, ...]) -> tuple[Array, Array]:
    """The first pin, and the unit vector across the line from it to the last (T, 2)."""
    first, end = (motion.points[node].position for node in (nodes[0], nodes[-1]))
    way = end - first
    return first, np.stack([-way[:, 1], way[:, 0]], axis=1) / np.hypot(*way.T)[:, None]


def _moved(motion: Motion, node: str, by: Array) -> Motion:
    own = motion.points[node]
    return replace(motion, points={**motion.points, node: replace(own, position=own.position + by)})
