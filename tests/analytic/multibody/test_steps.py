"""Steps of the multibody form: what Baumgarte's terms let decay, cost, and where they fail; and a
motion that comes to an infinite speed in a finite time, with what is said of it."""

from __future__ import annotations

import math
import re
from collections.abc import Callable

import numpy as np
import pytest

from analytic.free.free_motion import FreeMotion
from analytic.free.release import release
from analytic.multibody.baumgarte_table import STABLE, baumgarte_table
from analytic.multibody.multibody_motion import Baumgarte, MultibodyMotion
from analytic.multibody.release_multibody import release_multibody
from models.errors import CrankcheckError
from models.scene import Scene
from tests.analytic.multibody.scenes import ROTOR, ROTOR_J, SLIDER_CRANK, THESIS, by_bodies, scene
from tests.worlds.tiers import few, slowly

SWING = scene(THESIS.replace("start_deg", "speed_rad_s = 6.0\nstart_deg"))


@pytest.mark.parametrize("until_s", [0.15, slowly(0.3, reason="errors that grow with time")])
def test_without_error_of_the_steps_there_is_nothing_to_decay(until_s: float) -> None:
    time_s = np.linspace(0.0, until_s, 11)
    free = release_multibody(SWING, until_s, Baumgarte(20.0, 20.0))
    other = release_multibody(SWING, until_s)
    assert free.gap(time_s).max() < 1e-11
    for link, motion in free.at(time_s).links.items():
        assert motion.theta == pytest.approx(other.at(time_s).links[link].theta, abs=1e-10)


def test_the_table_shows_the_order_the_best_and_where_it_fails() -> None:
    step_s = 4e-3
    rows = baumgarte_table(SWING, 0.3, (0.0, 20.0, 800.0), (2 * step_s, step_s))
    errors = {(row.alpha, row.step_s): row.error for row in rows}
    assert 10.0 < errors[0.0, 2 * step_s] / errors[0.0, step_s] < 26.0  # order 4
    gaps = {(row.alpha, row.step_s): row.gap for row in rows}
    assert gaps[20.0, step_s] < 0.5 * gaps[0.0, step_s]
    for row in rows:
        assert row.stable == (row.alpha * row.step_s <= STABLE)
        assert math.isinf(row.error) == (not row.stable)


@pytest.mark.parametrize("wrong", [(-1.0, 0.0, None), (1.0, 1.0, 0.0), (math.nan, 0.0, 1e-3)])
def test_numbers_that_let_nothing_decay_are_refused(wrong: tuple[float, float, float]) -> None:
    with pytest.raises(CrankcheckError, match=r"give rates .* of 0 or more, and a step"):
        Baumgarte(*wrong)


SQUARE = (
    "start_deg = 60.0\nspeed_rad_s = 5.0\n"
    '[loads.motor]\nlink = "{}"\nlaw = "polynomial"\nover = "omega"\ntorque_n_m = [0.0, 0.0, {}]\n'
)
CUBE = SQUARE.replace("[0.0", "[0.0, 0.0")
ROTOR_LOST_S = 0.2
"""omega' = c omega^2 has 1 / omega = 1 / 5 - c t, here with c = 1; omega' = c omega^3 has
1 / omega^2 = 1 / 25 - 2 c t, here with c = 0.1."""


OTHER_WAY = "a second: each way and each load is quick with another"
LetGo = Callable[[Scene, float], FreeMotion | MultibodyMotion]


@pytest.mark.parametrize(
    ("let_go", "load"),
    [
        (by_bodies, SQUARE.format("rod", ROTOR_J)),
        (release, CUBE.format("rod", 0.1 * ROTOR_J)),
        slowly(by_bodies, CUBE.format("rod", 0.1 * ROTOR_J), reason=OTHER_WAY),
        slowly(release, SQUARE.format("rod", ROTOR_J), reason=OTHER_WAY),
    ],
)
def test_one_that_runs_away_is_told_until_when(let_go: LetGo, load: str) -> None:
    with pytest.raises(CrankcheckError, match=r"loads\.motor over omega drives it") as told:
        let_go(scene(ROTOR + load, 0.0), 2.0).at(np.array([2.0]))
    lost_s = re.search(r"runs away: at about (\S+) s", str(told.value))
    assert float(lost_s[1]) == pytest.approx(ROTOR_LOST_S, rel=1e-3)
    assert "give a time of 0.18 s or less" in str(told.value)


def test_one_that_turns_ever_faster_is_refused_soon(monkeypatch: pytest.MonkeyPatch) -> None:
    """By a load that grows with the angle its turns never end, in less and less time."""
    monkeypatch.setattr("analytic.free.window_count.MOST_WINDOWS", 1_000)
    steep = CUBE.replace('"omega"', '"angle"')
    with pytest.raises(CrankcheckError, match=r"loads\.motor over angle drives it"):
        release(scene(SLIDER_CRANK + steep.format("crank", 0.1)), 2.0).at(np.array([2.0]))


def crowd_of_rows(about_s: float) -> str:
    """A load of next to nothing, as a table with many rows in a tenth of a millisecond."""
    at_s = [0.0, *(about_s + 5e-5 * np.linspace(-1.0, 1.0, 400)).tolist(), 20.0]
    torque = [0.0, *(1e-6 * (np.arange(400) % 2)).tolist(), 0.0]
    return (
        '[loads.rattle]\nlink = "rod"\nlaw = "table"\nover = "time"\ninterpolation = "linear"\n'
        f"at_s = {at_s}\ntorque_n_m = {torque}\n"
    )


RAISED = ROTOR + "start_deg = 40.0\n"


@pytest.fixture(scope="module")
def reversal_s() -> float:
    """When the rotor first stands still after it was let go [s]."""
    motion = release(scene(RAISED), 2.0)
    looks, k = np.linspace(0.1, 2.0, 200), 0
    for _ in range(4):
        forward = motion.at(looks).links["rod"].omega > 0.0
        k = int(np.argmax(forward != forward[0]))
        looks = np.linspace(looks[k - 1], looks[k], 200)
    return float(looks[0])


few_ways = pytest.mark.parametrize(
    "let_go", few([by_bodies, release], {release}, "all bodies: a second of steps")
)


@few_ways
@pytest.mark.parametrize("share", few([1.0, 0.9], {0.9}, "while it stands, not just before"))
def test_what_has_turned_back_does_not_run_away(
    let_go: LetGo, share: float, reversal_s: float
) -> None:
    """Many rows of a table make many windows, and what turns back is slow for a while."""
    let_go(scene(RAISED + crowd_of_rows(reversal_s / share)), 2.0).at(np.array([2.0]))


@few_ways
def test_one_that_leaves_its_rest_does_not_run_away(let_go: LetGo) -> None:
    let_go(scene(ROTOR + crowd_of_rows(0.5), 0.0), 2.0).at(np.array([2.0]))
