"""Torques in balance, powers in balance, efficiencies of textbooks, self-locking."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from analytic.gears.torques import TrainTorques, torques
from analytic.gears.trains import Train
from models.errors import CrankcheckError
from models.scene.pairs import Gear
from tests.analytic.gears.trains import BOOK, KNOWN, chain, mesh, planetary


def loss_w(found: TrainTorques) -> float:
    return sum(mesh.loss_w for mesh in found.meshes)


def faults_of_balance(found: TrainTorques) -> float:
    """The largest fault of any balance: of a body, a mesh, the whole, and of the powers."""
    on = dict(found.torques_n_m)
    for one in found.meshes:
        assert abs(sum(one.on_n_m.values())) <= 1e-13 * max(map(abs, one.on_n_m.values()))
        for body, torque in one.on_n_m.items():
            on[body] += torque
    torque = max(abs(t) for one in found.meshes for t in one.on_n_m.values())
    power = max(one.rolling_w for one in found.meshes)
    power = max(power, *map(abs, found.powers_w.values()))
    whole = abs(sum(found.torques_n_m.values()))
    lost = abs(sum(found.powers_w.values()) - loss_w(found))
    return max(max(map(abs, on.values())) / torque, whole / torque, lost / power)


def test_torques_and_powers_are_in_balance_on_random_trains() -> None:
    rng = np.random.default_rng(42)
    worst, solved = 0.0, 0
    for _ in range(4):
        for known in KNOWN.values():
            lossy = tuple(replace(g, efficiency=rng.uniform(0.95, 1.0)) for g in known.gears)
            train = Train(lossy)
            inputs = {b: rng.normal() for b in (known.source, *known.held)}
            loads = {b: rng.normal() for b in train.bodies if b not in inputs}
            for gears in (known.gears, lossy):
                try:
                    found = torques(Train(gears), inputs, loads)
                except CrankcheckError:
                    assert gears is lossy  # it locks itself
                    continue
                solved += 1
                worst = max(worst, faults_of_balance(found))
                assert loss_w(found) >= -1e-12 * max(m.rolling_w for m in found.meshes)
    assert solved > 170
    assert worst < 1e-12


def test_torque_of_an_input_is_that_of_virtual_work() -> None:
    train = Train(KNOWN["aod 2"].gears)
    found = torques(train, {"small": 3.0, "large": 0.0}, {"ring": -7.0})
    assert found.torques_n_m["small"] == pytest.approx(7.0 * 15 / 22, rel=1e-13)
    assert found.efficiency == pytest.approx(1.0)


def test_efficiency_of_a_planetary_train_is_that_of_its_formula() -> None:
    """Sun drives, ring held: (1 - i0 eta0)/(1 - i0), i0 = -z_r/z_s; two meshes of 0.98."""
    gears = tuple(replace(g, efficiency=0.98) for g in planetary("sun", "ground", 20, 80))
    found = torques(Train(gears), {"sun": 100.0}, {"arm": -50.0})
    assert found.efficiency == pytest.approx((1 + 4 * 0.98**2) / 5, rel=1e-12)
    back = torques(Train(gears), {"arm": 20.0}, {"sun": -10.0})
    assert back.efficiency == pytest.approx(5 / (1 + 4 / 0.98**2), rel=1e-12)
    assert not found.circulating


HIGH = (mesh("ground", "planet", 100, 99, "arm"), mesh("out", "planet", 99, 100, "arm"))


def test_a_train_of_high_ratio_wastes_power_circulates_it_and_locks_itself_backwards() -> None:
    """1 : 9801/-199 by four gears that are nearly equal, whose teeth roll far more power than
    goes in; with i0 = (99/100)^2 and eta0 = 0.98^2, (1 - i0)/(1 - i0 eta0) or so is left."""
    gears = tuple(replace(g, efficiency=0.98) for g in HIGH)
    train = Train(gears)
    assert train.influence(["arm"])["out"][0] == 1 - Fraction(100 * 100, 99 * 99)
    down = torques(train, {"arm": 100.0}, {"out": 10.0})
    assert 0.2 < down.efficiency < 0.4
    assert min(down.circulating.values()) > 10.0
    with pytest.raises(CrankcheckError, match="the train locks itself"):
        torques(train, {"out": 1.0}, {"arm": 10.0})
    assert torques(Train(HIGH), {"out": 1.0}, {"arm": 10.0}).efficiency == pytest.approx(1)


def test_tooth_force_is_torque_over_radius() -> None:
    """Shigley, example 13-7: 2.5 kW at 1750 rev/min, 20 teeth of 2.5 mm: W_t = 0.546 kN."""
    omega = 1750 * 2 * np.pi / 60
    train = Train(chain(("2", "3", 20, 50), ("3", "4", 50, 30)))
    found = torques(train, {"4": omega * 20 / 30}, {"2": 2500.0 / omega})
    first, _ = found.meshes
    assert first.tangential_n(0.0025) == pytest.approx(546.0, rel=1e-3)


def test_equal_planets_share_the_load() -> None:
    pairs = [Gear(f"{kind}{n}", ("sun", n) if kind == "s" else (n, "ground"),
                  (20, 40) if kind == "s" else (40, 100), "arm", kind == "r")
             for n in "123" for kind in "sr"]  # fmt: skip
    found = torques(Train(tuple(pairs)), {"sun": 10.0}, {"arm": -6.0})
    assert [one.on_n_m["sun"] for one in found.meshes[::2]] == pytest.approx([-1 / 3] * 3)


def test_loads_on_other_bodies_are_refused() -> None:
    for loads, message in (
        ({"sun": 1.0}, "torque on sun: it closes the balance; use planet, ring"),
        ({"moon": 1.0}, "torque on moon: it is no moving body of the train"),
    ):
        with pytest.raises(CrankcheckError, match=message):
            torques(Train(tuple(BOOK)), {"sun": 1.0, "arm": 0.0}, loads)
