"""Make another beam of the one that an engine is given: stiffness, mass, damping, start."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from analytic.elastic.engine_start import node_start
from models.cut_scenes import BeamedScene
from models.elastic import Beam, Shape
from models.motion import State
from models.scene import Scene
from reports.judge.cell import CellRunner
from reports.selftest.elastic_runs import truth_of_given
from reports.selftest.fault import Plant
from sim.engine import Run
from sim.run import run

BeamChange = Callable[[Beam, float], Beam]


def in_beam(change: BeamChange) -> Plant:
    """The engine is given another beam, which starts where the right one does."""

    def plant(size: float) -> CellRunner:
        def runner(scene: Scene, state: State, *args: Any, **options: Any) -> Run:
            beams = {name: change(beam, size) for name, beam in scene.beams.items()}
            links = dict(scene.links)
            for name, beam in beams.items():
                more = beam.density_kg_m / scene.beams[name].density_kg_m
                for node in beam.nodes:
                    links[node] = replace(links[node], mass_kg=more * links[node].mass_kg)
            return run(replace(scene, links=links, beams=beams), state, *args, **options)

        return runner

    return plant


def begun(shape: Shape) -> Plant:
    """The right beam starts with another shape, or as it should with a size of 0."""

    def plant(size: float) -> CellRunner:
        def runner(scene: Scene, state: State, *args: Any, **options: Any) -> Run:
            cut = truth_of_given(scene).cut
            assert isinstance(cut, BeamedScene)
            return run(scene, node_start(cut, shape) if size else state, *args, **options)

        return runner

    return plant


def stiffer(beam: Beam, share: float) -> Beam:
    return replace(beam, flexural_n_m2=(1.0 + share) * beam.flexural_n_m2)


def stretchier(beam: Beam, share: float) -> Beam:
    return replace(beam, axial_n=beam.axial_n / (1.0 + share))


def heavier(beam: Beam, share: float) -> Beam:
    return replace(beam, density_kg_m=(1.0 + share) * beam.density_kg_m)


def damped(beam: Beam, time_s: float) -> Beam:
    return replace(beam, damping_s=beam.damping_s + time_s)
