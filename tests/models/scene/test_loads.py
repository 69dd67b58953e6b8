"""Loads and friction: what a scene file says of them, what they give, and what is refused."""

import math
from dataclasses import replace

import numpy as np
import pytest

from models.errors import CrankcheckError
from models.files.assemble import scene_text
from models.files.reading import load_scene, parse_scene
from models.scene.characteristics import Characteristic, Constant, Polynomial, Sine, Staircase
from models.scene.loads import ConstantFriction, CoulombFriction, Load
from models.scene.tabulated import Tabulated, slopes, spline

PRESS = """
name = "press"
source = "a test"
[ground]
points = { A = [0.0, 0.0] }
[links]
crank = { bar = ["A", "B"], length_m = 0.1 }
rod = { bar = ["B", "C"], length_m = 0.3 }
[sliders.C]
on = "ground"
mass_kg = 0.5
[driver]
link = "crank"
speed_rad_s = 10.0
[loads.work]
block = "C"
direction_deg = 180.0
force_n = 500.0
slider = "C"
stroke = "forward"
[loads.gas]
link = "rod"
point = "C"
frame = "body"
law = "table"
over = "displacement"
slider = "C"
at_m = [0.15, 0.2, 0.45]
force_n = [900.0, 300.0, 0.0]
interpolation = "pchip"
[loads.valve]
link = "crank"
law = "table"
over = "angle"
at_deg = [0.0, 90.0, 270.0]
period_deg = 720.0
interpolation = "linear"
torque_n_m = [0.0, 2.0, -1.0]
[loads.hum]
link = "rod"
point = "B"
direction_deg = 30.0
law = "sine"
over = "time"
period_s = 0.02
phase_deg = 90.0
force_n = 3.0
[loads.drag]
link = "crank"
law = "polynomial"
over = "angle"
torque_n_m = [1.0, -0.5, 0.25]
"""


def test_every_law_of_a_load_is_read_and_reads_back_as_itself_and_no_other_has_words() -> None:
    scene = parse_scene(PRESS, "press")
    again, loads = parse_scene(scene_text(scene), "again"), scene.loads
    assert (again, list(again.loads)) == (scene, list(loads))
    assert loads["work"] == Load(
        "work", "block C", "C", Constant(500.0), "time", "C", "forward", math.pi
    )
    gas = Tabulated((0.15, 0.2, 0.45), (900.0, 300.0, 0.0), "pchip")
    assert loads["gas"] == Load("gas", "rod", "C", gas, "displacement", "C", frame="body")
    quarter = math.pi / 2
    valve = Tabulated((0.0, quarter, 3 * quarter), (0.0, 2.0, -1.0), "linear", 4 * math.pi)
    assert loads["valve"] == Load("valve", "crank", None, valve, "angle")
    hum = Load("hum", "rod", "B", Sine(3.0, 0.02, quarter), direction_rad=math.radians(30.0))
    assert loads["hum"] == hum
    assert loads["drag"] == Load("drag", "crank", None, Polynomial((1.0, -0.5, 0.25)), "angle")
    light = parse_scene(PRESS.replace("mass_kg = 0.5", ""), "press")  # of a block without mass
    assert parse_scene(scene_text(light), "press").loads == loads

    class Own(Characteristic):
        at = steepest = rounding = carried = lambda *_: 0.0  # type: ignore[assignment]

    scene = load_scene("fourbar-lecture-1")
    with pytest.raises(CrankcheckError, match="load x: a scene file can not state a Own"):
        scene_text(replace(scene, loads={"x": Load("x", "crank", None, Own())}))


def test_a_load_acts_over_the_period_the_table_and_the_stroke_that_it_has() -> None:
    """Over two turns here; between the last row and the first of the next period too."""
    loads = parse_scene(PRESS, "press").loads
    valve, gas, work = loads["valve"], loads["gas"], loads["work"]
    deg = np.array([45.0, 90.0, 495.0, 495.0 + 720.0, 495.0 - 7200.0, -225.0])
    assert valve.magnitude(np.radians(deg)) == pytest.approx([1.0, 2.0, -0.5, -0.5, -0.5, -0.5])
    assert gas.magnitude(np.array([0.15, 0.45 + 1e-11])) == pytest.approx([900.0, 0.0])
    with pytest.raises(CrankcheckError, match=r"loads.gas: over the displacement \[m\] the table"):
        gas.magnitude(np.array([0.2, 0.46]))
    speed = np.array([-1.0, 0.0, 1.0])
    assert work.magnitude(np.zeros(3), speed).tolist() == [0.0, 0.0, 500.0]
    back = replace(work, stroke="backward")
    assert back.magnitude(np.zeros(3), speed).tolist() == [500.0, 0.0, 0.0]


@pytest.mark.parametrize("own", [
    Polynomial((1.0, -0.3, 0.07)),
    Polynomial((4.0,)),
    Sine(2.0, 0.3, 0.1),
    Staircase((0.1, 0.7), (1.0, 0.0)),
    Tabulated((-0.3, 0.1, 0.4, 1.5), (1.0, -2.0, 0.3, 0.7)),
    Tabulated((-0.3, 0.1, 0.4, 1.5), (1.0, -2.0, 0.3, 0.7), "pchip"),
    Tabulated((-0.3, 0.1, 0.4, 1.5), (1.0, -2.0, 0.3, 0.7), "pchip", 2.1),
    Tabulated((0.0, 0.1, 0.4), (1.0, -2.0, 1.0), "linear", 0.4),
], ids=repr)  # fmt: skip
def test_one_value_is_that_of_an_array_to_the_bit(own: Characteristic) -> None:
    reach = 9.0 if getattr(own, "period", None) else 1.5
    chance = np.random.default_rng(1)
    inner = chance.uniform(-0.3, 1.5, 500)
    places = np.concatenate([inner, reach * inner, [-0.3, 0.0, 0.1, 0.4, 1.5]])
    if isinstance(own, Tabulated) and own.period is None:
        places = np.clip(places, -0.3, 1.5)
    assert [own.at_one(float(x)) for x in places] == own.at(places).tolist()


def test_one_value_past_the_end_of_a_table_is_refused_as_in_an_array() -> None:
    table = Tabulated((0.0, 1.0), (2.0, 3.0))
    assert table.at_one(1.0 + 1e-10) == 3.0  # where rounding has it
    with pytest.raises(ValueError, match=r"from 0 to 1, and 1\.5 is requested"):
        table.at_one(1.5)
    with pytest.raises(ValueError, match=r"1\.000002 is requested, 2e-06 beyond"):
        table.at_one(1.000002)
    load = Load("valve", "crank", None, table, "angle")
    with pytest.raises(CrankcheckError, match=r"loads\.valve: over the angle \[rad\] the table"):
        load.size(0.0, -1.0, {}, 0.0)


def test_interpolation_without_overshoot_worked_by_hand_and_of_any_table() -> None:
    """Steps 1, 1, 2 and chords 1, 3, 0: (3 + 3) / (3/1 + 3/3) = 3/2, flat where a chord is, and at
    the first row the parabola's (3 1 - 1 3) / 2 = 0."""
    x, y = np.array([0.0, 1.0, 2.0, 4.0]), np.array([0.0, 1.0, 4.0, 4.0])
    slope = slopes(x, y, closed=False)
    assert slope == pytest.approx([0.0, 1.5, 0.0, 0.0])
    # Hermite in the middle of a step: (y0 + y1) / 2 + h (d0 - d1) / 8.
    middles = [0.5 - 1.5 / 8, 2.5 + 1.5 / 8, 4.0]
    assert spline(np.array([0.5, 1.5, 3.0]), x, y, slope) == pytest.approx(middles)
    x, y = np.array([0.0, 1.0, 2.0, 3.0]), np.array([0.0, 1.0, -1.0, 0.0])
    assert slopes(x, y, closed=True)[[0, -1]].tolist() == [1.0, 1.0]  # it goes on smoothly
    assert slopes(x, y, closed=False) == pytest.approx([2.5, 0.0, 0.0, 2.5])  # (3 1 + 2) / 2
    assert slopes(x, np.array([0.0, 1.0, -4.0, 0.0]), closed=False)[0] == 3.0  # (3 1 + 5) / 2 is 4
    # It rises only where its table rises.
    rng = np.random.default_rng(5)
    for _ in range(20):
        x, y = np.cumsum(rng.uniform(0.1, 3.0, 8)), rng.uniform(-1.0, 1.0, 8)
        fine = np.linspace(x[0], x[-1], 4001)
        found = spline(fine, x, y, slopes(x, y, closed=False))
        assert spline(x, x, y, slopes(x, y, closed=False)) == pytest.approx(y, abs=1e-14)
        k = np.clip(np.searchsorted(x, fine, side="right") - 1, 0, 6)
        assert np.all(found >= np.minimum(y[k], y[k + 1]) - 1e-12)
        assert np.all(found <= np.maximum(y[k], y[k + 1]) + 1e-12)


@pytest.mark.parametrize("own", [
    Sine(3.0, 0.7, 0.2),
    Polynomial((1.0, -2.0, 0.5, 3.0)),
    Polynomial((2.0,)),
    Tabulated((-2.0, -1.0, 0.3, 2.1), (1.0, -4.0, 2.0, 2.0)),
    Tabulated((-2.0, -1.0, 0.3, 2.1), (1.0, -4.0, 2.0, 2.0), "pchip"),
    Tabulated((0.0, 0.2, 0.7), (1.0, -4.0, 2.0), "pchip", 1.0),
    Constant(4.0),
], ids=str)  # fmt: skip
def test_no_characteristic_is_steeper_than_it_says(own: Characteristic) -> None:
    x = np.linspace(-2.0, 2.0, 4001)
    chord = np.abs(np.diff(own.at(x))) / np.diff(x)
    assert np.all(chord <= np.asarray(own.steepest(x[:-1], 1e-3)) * (1.0 + 1e-9) + 1e-12)


@pytest.mark.parametrize(("make", "words"), [
    (lambda: Sine(1.0, 0.0), "found a period of 0"),
    (lambda: Polynomial(()), "found no coefficient"),
    (lambda: Tabulated((0.0,), (1.0,)), "found 1 rows"),
])  # fmt: skip
def test_a_characteristic_without_magnitude_is_refused(make: object, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        make()  # type: ignore[operator]


@pytest.mark.parametrize("last_row", [0.03, 0.05], ids=["open period", "closed period"])
def test_a_table_repeats_its_kinks(last_row: float) -> None:
    table = Tabulated((0.0, 0.02, last_row), (1.0, -1.0, 1.0), period=0.05)
    wanted = [0.0, 0.02, 0.03, 0.05, 0.07, 0.08] if last_row < 0.05 else [0.0, 0.02, 0.05, 0.07]
    assert list(table.kinks_between(0.0, 0.09)) == pytest.approx(wanted)
    before = list(table.kinks_between(-0.05, 0.0))
    assert before[0] == -0.05
    assert before[-1] == 0.0
    # Steps that happen once are told within alone.
    assert list(Staircase((0.1, 0.2, 0.3), (1.0, 0.0, 2.0)).kinks_between(0.15, 0.3)) == [0.2, 0.3]


RUBBING = f"""{PRESS[: PRESS.index("[sliders.C]")]}[sliders.piston]
point = "C"
on = "ground"
mass_kg = 0.5
[driver]
link = "crank"
speed_rad_s = 10.0
[friction.A]
torque_n_m = 0.2
[friction.B]
mu = 0.1
radius_m = 0.01
[friction.C]
mu = 0.0
radius_m = 0.02
[friction.piston]
force_n = 3.0
"""


def test_every_kind_of_friction_is_read() -> None:
    """The pin C and the slider on it have names of their own."""
    scene = parse_scene(RUBBING, "rubbing")
    assert parse_scene(scene_text(scene), "again") == scene
    assert dict(scene.friction) == {
        "A": ConstantFriction("A", 0.2),
        "B": CoulombFriction("B", 0.1, 0.01),
        "C": CoulombFriction("C", 0.0, 0.02),
        "piston": ConstantFriction("piston", 3.0),
    }
    slides = parse_scene(RUBBING.replace("force_n = 3.0", "mu = 0.3"), "rubbing")
    assert slides.friction["piston"] == CoulombFriction("piston", 0.3)
    assert parse_scene(scene_text(slides), "again") == slides
