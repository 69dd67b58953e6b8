"""`crankcheck solve --forces` of what rubs: what friction takes, and where it locks."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import crankcheck
from models.files import load_scene, shipped
from models.friction import CoulombFriction
from models.scene import Scene
from models.scene_text import scene_text
from tests.worlds.command_line import crank, flat, refused

LOCKING = "slider-crank-self-locking"


def helped() -> Scene:
    """The scene that locks itself, with loads that help."""
    scene = load_scene(LOCKING)
    loads = {
        name: replace(one, direction_rad=one.direction_rad + math.pi)
        for name, one in scene.loads.items()
    }
    return replace(scene, name="helped", loads=loads)


def written(scene: Scene, folder: Path) -> str:
    path = folder / f"{scene.name}.toml"
    path.write_text(scene_text(scene), encoding="utf-8")
    return str(path)


def row(output: str, start: str) -> list[float]:
    """The numbers of a row, dashes left out."""
    (words,) = re.findall(rf"^{start} +([-\d. ]+)$", output, flags=re.MULTILINE)
    return [float(each) for each in words.split() if each != "-"]


def test_an_angle_tells_what_friction_takes_of_the_power() -> None:
    output = crank("solve", LOCKING, "--at-deg", "60", "--forces").output
    drive, taken, efficiency = row(output[output.index("power of") :], "crank")
    force, watts = row(output, "piston block ground")[-2:]
    normal = row(
        output[output.index("slider, force on") : output.index("power of")], "piston block +ground"
    )[0]
    assert abs(force) == pytest.approx(0.3 * abs(normal), rel=1e-7)
    assert watts == taken < 0.0
    assert efficiency == pytest.approx(1.0 + taken / drive, rel=1e-6)
    told = flat(output)
    assert "from 80.5961 to 99.4039 deg and from 260.596 to 279.404 deg: there no finite" in told


def test_an_angle_that_is_locked_is_refused_in_one_message() -> None:
    result = crank("solve", LOCKING, "--at-deg", "90", "--forces")
    refused(result, "crank at 90 deg", "locks itself: friction in piston grows")
    assert result.stdout == ""
    assert result.stderr.count("crankcheck:") == 1


def test_locked_instants_of_a_turn_are_told_and_have_no_mean() -> None:
    output = crank("solve", LOCKING, "--forces").output
    assert "Dead point" not in output
    assert "Locked, crank at 81 deg, 81.5 deg, 82 deg" in output
    (torque,) = (line for line in output.splitlines() if line.startswith("driving torque"))
    assert torque.split()[-1] == "-"
    assert "in or near a dead point" not in output


def test_where_it_may_jam_the_numbers_stay_without_a_bound(tmp_path: Path) -> None:
    output = crank("solve", written(helped(), tmp_path), "--at-deg", "90", "--forces").output
    assert abs(row(output, "piston block ground")[-2]) > 100.0
    told = flat(output)
    assert "Two equilibria here, as the mechanism may jam: these forces, those of less" in told
    assert "It may jam with crank from 80.5961 to 99.4039 deg and from 260.596" in told
    assert "no useful work is done in it, so it has no efficiency." in told


def test_a_cycle_has_an_efficiency(tmp_path: Path) -> None:
    scene = load_scene(LOCKING)
    rubbing = {"piston": CoulombFriction("piston", 0.1), "B": CoulombFriction("B", 0.1, 0.02)}
    path = written(replace(scene, name="rubbing", friction=rubbing), tmp_path)
    solution = crankcheck.solve(path, forces=True)
    cycle = solution.efficiency
    assert 0.0 < cycle.cycle < 1.0
    output = flat(crank("solve", path, "--forces").output)
    assert f"Friction takes {cycle.wasted:.6g} J in a cycle; {cycle.useful:.6g} J of the" in output
    assert f"efficiency {cycle.cycle:.6g}." in output
    file = tmp_path / "out.csv"
    assert crank("solve", path, "--forces", "-o", str(file)).exit_code == 0
    frame = pd.read_csv(file)
    assert solution.forces is not None
    np.testing.assert_array_equal(
        frame["piston_slider_friction_n"], solution.forces.friction["piston"]
    )
    np.testing.assert_array_equal(frame["B_friction_n_m"], solution.forces.friction["B"])


def test_without_friction_nothing_is_said_of_it() -> None:
    output = crank("solve", "shaper", "--forces").output.lower()
    assert "friction" not in output
    assert "efficiency" not in output
    assert crankcheck.solve("shaper").efficiency is None


def test_parts_of_a_motion_are_shown_without_its_power() -> None:
    few = crankcheck.solve(LOCKING, [0.01], links="rod", sliders=(), forces=True)
    assert "power of" not in str(few)
    assert "piston block" in str(few)


FAULTS = {
    "below 0": ("mu = -0.1", "friction.piston.mu: found -0.1; use a number of at least 0"),
    "no number": ("mu = nan", "friction.piston.mu: found nan"),
    "nothing": ("", "friction.piston: found none of them; give one of mu"),
    "two kinds": ("mu = 0.1\nforce_n = 1.0", "friction.piston: found mu and force_n"),
    "a radius alone": ("radius_m = 0.1", "radius_m is that of a pin with mu, which is missing"),
    "of a pin": ("torque_n_m = 1.0", "friction.piston.torque_n_m: belongs to a pin"),
    "a pin without radius": ("mu = 0.1\n[friction.B]\nmu = 0.1", "friction.B.radius_m: missing"),
    "no joint": ("mu = 0.1\n[friction.Q]\ntorque_n_m = 1.0", "friction.Q: no joint of two bodies"),
}


@pytest.mark.parametrize("name", FAULTS)
@pytest.mark.parametrize("command", [["solve", "--forces"], ["verify", "--forces"]])
def test_a_fault_of_friction_ends_with_2_and_one_message(
    name: str, command: list[str], tmp_path: Path
) -> None:
    friction, words = FAULTS[name]
    text = shipped("forces")[LOCKING].read_text(encoding="utf-8").replace("mu = 0.3", friction)
    path = tmp_path / "faulty.toml"
    path.write_text(text, encoding="utf-8")
    result = crank(command[0], str(path), *command[1:])
    refused(result, words)
    assert result.stdout == ""
    assert result.stderr.count("crankcheck:") == 1


def test_engines_are_not_given_what_rubs_with_mu() -> None:
    result = crank("verify", LOCKING, "--forces", "--no-convergence", "--profile", "tuned")
    refused(result, "mujoco is given no such friction (friction.piston)")
