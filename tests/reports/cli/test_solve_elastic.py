"""`crankcheck solve` of a scene with elastic links: tables, files, figures, a page, mistakes."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from analytic.elastic.discretisation import REFERENCE
from analytic.elastic.elastic_motion import DrivenElasticMotion
from analytic.kinematics import solve
from models.files import load_scene
from tests.worlds.command_line import crank, flat
from tests.worlds.tiers import slow
from tests.worlds.without_pdf import without_pdf

NAME = "fourbar-elastic"


@pytest.fixture(scope="module")
def motion() -> DrivenElasticMotion:
    """The motion of the shipped scene over a turn."""
    scene = load_scene(NAME)
    return DrivenElasticMotion(
        scene, scene.driver.law.period_s, REFERENCE, "periodic", stiffened=True
    )


def test_it_tells_how_links_bend_and_how_far_that_is_to_be_trusted(
    motion: DrivenElasticMotion,
) -> None:
    result = crank("solve", NAME, "--steps-per-turn", "4")
    assert result.exit_code == 0
    assert max(len(line.rstrip()) for line in result.output.splitlines()) <= 100
    told = flat(result.output)
    assert "bends with EI = 4.725 N m^2, from 77.3704 rad/s on (10.5 times the speed" in told
    assert "elastic links by 8 polynomials across each, with the shortening of bent links" in told
    assert "Starts on the periodic motion: it comes back after a period" in told
    assert re.search(r"deflections are off by about \d.\de-\d\d of the largest", told)
    assert "Near resonance" not in told
    quarter = motion.at(np.array([0.25 * motion.until_s]))
    middle = float(quarter.elastic["coupler"].middle[0])
    row, *_ = re.findall(r"^ *0\.2131743 +180 +(\S+)", result.output, flags=re.MULTILINE)
    assert float(row) == pytest.approx(middle, rel=1e-5)
    (largest,) = re.findall(r"deflection of its middle +(\S+) +m +(\S+) deg", result.output)
    fine = motion.at(np.linspace(0.0, motion.until_s, 721)).elastic["coupler"].middle
    assert float(largest[0]) == pytest.approx(float(np.max(np.abs(fine))), rel=1e-4)


def test_the_linear_theory_says_what_it_leaves_out() -> None:
    """ELASTIC: 1.28 % of the largest deflection at a frequency ratio of 10.5."""
    told = flat(crank("solve", NAME, "--linear", "--modes", "3", "--steps-per-turn", "2").output)
    assert "by 3 sines across each, without the shortening of bent links (linear" in told
    (percent,) = re.findall(r"changes deflections by (\S+) % of the largest", told)
    assert float(percent) == pytest.approx(1.28, abs=0.05)


def test_a_file_has_both_motions_to_the_last_bit(
    motion: DrivenElasticMotion, tmp_path: Path
) -> None:
    path = tmp_path / "out.csv"
    done = crank("solve", NAME, "-o", str(path), "--steps-per-turn", "9", "--forces")
    assert done.exit_code == 0
    frame = pd.read_csv(path)
    time_s = frame["time_s"].to_numpy()
    whole, rigid = motion.at(time_s), solve(motion.scene, time_s, bound=False)
    assert whole.forces is not None
    np.testing.assert_allclose(
        frame["coupler_deflection_m"], whole.elastic["coupler"].middle, rtol=0, atol=1e-15
    )
    np.testing.assert_allclose(
        frame["coupler_extension_m"], whole.elastic["coupler"].extension, rtol=0, atol=1e-15
    )
    np.testing.assert_allclose(
        frame["rocker_theta_rad"], whole.links["rocker"].theta, rtol=0, atol=1e-13
    )
    np.testing.assert_array_equal(frame["rocker_theta_rigid_rad"], rigid.links["rocker"].theta)
    np.testing.assert_allclose(frame["torque_n_m"], whole.forces.torque, rtol=0, atol=1e-11)
    assert "torque_rigid_n_m" in frame


def test_figures_are_written(tmp_path: Path) -> None:
    folder = tmp_path / "figures"
    with without_pdf():
        assert crank("solve", NAME, "--figures", folder).exit_code == 0
    names = {each.name for each in folder.iterdir()}
    every = ("deflection", "extension", "torque", "angles", "positions")
    assert names == {f"{n}.{k}" for n in every for k in ("svg", "pdf")}
    positions = (folder / "positions.svg").read_text(encoding="utf-8")
    assert "magnified 50 times" in positions


@slow("a second, for the figures of above in one page; tests/reports/page looks at such a page")
def test_a_page_is_written(tmp_path: Path) -> None:
    page = tmp_path / "page.html"
    assert crank("solve", NAME, "-o", page).exit_code == 0
    text = page.read_text(encoding="utf-8")
    assert text.count("data:image/svg+xml;base64,") == 5
    assert "Starts on the periodic motion" in text


SHORT = ("solve", "fourbar-elastic-pulse", "--duration", "0.1", "--modes", "1")
"""A tenth of the pulse, on one sine."""


def test_what_is_let_go_keeps_its_energy(tmp_path: Path) -> None:
    path = tmp_path / "out.csv"
    assert crank(*SHORT, "-o", path).exit_code == 0
    frame = pd.read_csv(path)
    assert len(frame) == 1001
    energy = frame["kinetic_j"] + frame["potential_j"] - frame["work_j"]
    assert np.max(np.abs(energy - energy[0])) < 1e-9 * frame["kinetic_j"].max()
    apart = frame["crank_theta_rad"] - frame["crank_theta_rigid_rad"]
    assert 0.0 < np.max(np.abs(apart)) < 1e-2
    shorter = (*SHORT[:3], "0.02", *SHORT[4:])
    told = flat(crank(*shorter, "--steps", 2).output)
    assert "driver crank, let go at rest at 90 deg, for 5 s" in told
    assert re.search(r"As the next finer description has it, deflections are off by about ", told)


@slow("figures and a page: two seconds, as those of what is driven, whose drawing they share")
def test_what_is_let_go_has_the_figures_of_the_thesis(tmp_path: Path) -> None:
    """Crank and rocker, rigid beside elastic, deflection of the middle, displacement of the end."""
    folder, page = tmp_path / "figures", tmp_path / "page.html"
    assert crank(*SHORT, "--figures", folder).exit_code == 0
    assert {each.stem for each in folder.iterdir()} == {
        "deflection", "extension", "angles", "positions"
    }  # fmt: skip
    angles = (folder / "angles.svg").read_text(encoding="utf-8")
    assert all(f"{name} [deg]" in angles for name in ("crank", "rocker"))
    assert crank(*SHORT, "-o", page).exit_code == 0
    assert "the lines between the pins; coloured: the links" in flat(page.read_text("utf-8"))


def test_a_driver_that_is_controlled_gives_way() -> None:
    told = flat(
        crank("solve", "fourbar-elastic-controlled", "--turns", "0.004", "--modes", "1",
              "--steps-per-turn", "500").output
    )  # fmt: skip
    assert "crank, elastic less rigid" in told
    assert "driving torque, elastic" in told
