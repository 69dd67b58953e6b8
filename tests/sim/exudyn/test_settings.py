"""exudyn's settings: as-shipped is a bare simulation, and all of them reach the engine."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import exudyn as exu
import numpy as np
import pytest

from analytic.kinematics import solve
from models.files import load_scene
from sim.engine import Facts, SettingValue
from sim.exudyn.engine import ENGINE
from sim.exudyn.solver import simulation
from sim.settings import SettingError, resolved

SCENE = load_scene("fourbar-lecture-1")
OF_A_RUN = {
    "solution.file.write",
    "solution.sensors.writePeriod",
    "timeIntegration.endTime",
    "timeIntegration.numberOfSteps",
}
"""What has to do with the length of a run, and with what is kept of it."""


def facts(**settings: SettingValue) -> Facts:
    asked = resolved(ENGINE.profiles["tuned"], settings)
    return ENGINE.open(SCENE, solve(SCENE, np.zeros(1)).state(), asked, 1e-3, "prescribed").facts()


def leaves(values: Mapping[str, Any], path: str = "") -> Iterator[tuple[str, Any]]:
    for name, value in values.items():
        if isinstance(value, dict):
            yield from leaves(value, f"{path}{name}.")
        else:
            yield f"{path}{name}", value


def test_as_shipped_differs_from_a_bare_simulation_by_what_a_run_is_asked_for() -> None:
    asked = simulation(resolved(ENGINE.profiles["as-shipped"], None), 1e-4)
    own, bare = (dict(leaves(each.GetDictionary())) for each in (asked, exu.SimulationSettings()))
    assert len(bare) > 100
    assert {name for name in bare if str(own[name]) != str(bare[name])} == OF_A_RUN
    assert exu.SimulationSettings().timeIntegration.solverType.name == "GeneralizedAlpha"


def test_our_trapezoidal_rule_is_that_of_exudyn() -> None:
    """`SolveDynamic` sets two flags for it, which a solver of one's own has to be given."""
    asked = simulation(
        resolved(ENGINE.profiles["tuned"], {"integrator": "TrapezoidalIndex2"}), 1e-3
    )
    assert asked.timeIntegration.generalizedAlpha.useNewmark
    assert asked.timeIntegration.generalizedAlpha.useIndex2Constraints
    held = facts(integrator="TrapezoidalIndex2").settings
    assert held["integrator"] == "TrapezoidalIndex2"


@pytest.mark.parametrize(
    ("setting", "value"),
    [
        ("integrator", "TrapezoidalIndex2"),
        ("spectral_radius", 0.75),
        ("relative_tolerance", 1e-6),
        ("absolute_tolerance", 1e-7),
        ("iterations", 17),
        ("jacobian", "each-iteration"),
        ("jacobian", "as-needed"),
        ("adaptive_step", "disable"),
        ("ignore_singular", "disable"),
    ],
)
def test_a_setting_reaches_the_engine(setting: str, value: SettingValue) -> None:
    assert facts(**{setting: value}).settings[setting] == value
    assert facts().settings[setting] != value


@pytest.mark.parametrize("name", ["EXUdense", "EigenDense", "EigenSparse"])
def test_so_does_a_linear_solver(name: str) -> None:
    assert facts(linear_solver=name).settings["linear_solver_used"] == name


@pytest.mark.parametrize(
    ("setting", "value"),
    [
        ("integrator", "RK44"),
        ("spectral_radius", 1.5),
        ("relative_tolerance", -1.0),
        ("iterations", 0),
        ("jacobian", "never"),
        ("linear_solver", "LAPACK"),
    ],
)
def test_a_value_that_it_does_not_take_is_refused(setting: str, value: SettingValue) -> None:
    with pytest.raises(SettingError, match=f"setting {setting}: found"):
        facts(**{setting: value})
