"""A user's own system in exudyn beside the four-bar, and what a snippet does to it.

A pendulum, a mass on a spring with a damper, and a body that flies. The mechanism touches none of
them, but all are one system of equations, so that Newton's method ends for all at once.
"""

from __future__ import annotations

import math
from functools import cache
from typing import Any

import exudyn as exu
import exudyn.itemInterface as items  # noqa: N813 - a module
import numpy as np

from models.array import Array
from tests.worlds.bare_exudyn import exudyn_fourbar, simulated

SPEED = 10.0
LASTS_S = 1.0


def exudyn_disturbance(snippet: str) -> float:
    """The largest difference [m, rad] over a second to the system without the snippet, stepped as
    that says that all is: with its integrator and step."""
    simulation = _simulation()
    exec(snippet, {"simulationSettings": simulation, "exu": exu})
    stepping = simulation.timeIntegration
    integrator, radius = stepping.solverType, stepping.generalizedAlpha.spectralRadius
    try:
        same = _same_steps(stepping.numberOfSteps, integrator, radius)
        found = _rest(simulation)
    except exu.SolverError:
        return math.inf
    return float(np.max(np.abs(found - same)))


def _simulation() -> Any:
    """A user's own settings, by which Newton's method ends near rounding."""
    simulation = exu.SimulationSettings()
    simulation.timeIntegration.endTime = LASTS_S
    simulation.timeIntegration.newton.relativeTolerance = 1e-12
    simulation.timeIntegration.newton.absoluteTolerance = 1e-13
    return simulation


@cache
def _same_steps(steps: int, integrator: Any, radius: float) -> Array:
    """The rest of the system without a snippet, stepped so."""
    simulation = _simulation()
    simulation.timeIntegration.numberOfSteps = steps
    simulation.timeIntegration.solverType = integrator
    simulation.timeIntegration.generalizedAlpha.spectralRadius = radius
    return _rest(simulation)


def _rest(simulation: Any) -> Array:
    """The coordinates of the rest over a second."""
    container = exu.SystemContainer()
    system = container.AddSystem()
    exudyn_fourbar(system, SPEED)
    ground = system.AddObject(items.ObjectGround())
    swings, bounces, _ = bodies = [
        _body(system, x, rates)
        for x, rates in ((2.0, [0.0] * 3), (4.0, [0.5, 0.0, 1.0]), (6.0, [1.0, 3.0, 2.0]))
    ]
    hinge = [
        system.AddMarker(items.MarkerBodyRigid(bodyNumber=body, localPosition=place))
        for body, place in ((ground, [1.7, 0.0, 0.0]), (swings[1], [-0.3, 0.0, 0.0]))
    ]
    system.AddObject(items.ObjectJointRevolute2D(markerNumbers=hinge))
    ends = [
        system.AddMarker(items.MarkerBodyPosition(bodyNumber=body, localPosition=place))
        for body, place in ((ground, [4.0, 1.0, 0.0]), (bounces[1], [0.0, 0.0, 0.0]))
    ]
    system.AddObject(
        items.ObjectConnectorCartesianSpringDamper(
            markerNumbers=ends, stiffness=[20.0, 20.0, 0.0], damping=[0.5, 0.5, 0.0]
        )
    )
    rows = simulated(system, simulation, [node for node, _ in bodies])
    return np.concatenate([row[:, 1:] for row in rows], axis=1)


def _body(system: Any, x: float, rates: list[float]) -> tuple[Any, Any]:
    """A body of 1 kg that falls; its node and itself."""
    node = system.AddNode(
        items.NodeRigidBody2D(referenceCoordinates=[x, 0.0, 0.0], initialVelocities=rates)
    )
    body = system.AddObject(items.ObjectRigidBody2D(mass=1.0, inertia=0.03, nodeNumber=node))
    marker = system.AddMarker(items.MarkerBodyMass(bodyNumber=body))
    system.AddLoad(items.LoadMassProportional(markerNumber=marker, loadVector=[0.0, -9.81, 0.0]))
    return node, body
