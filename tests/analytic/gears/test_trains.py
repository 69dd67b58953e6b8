"""Ratios of published trains by the null space and by Willis, and trains that are refused."""

from fractions import Fraction

import numpy as np
import pytest

from analytic.gears.trains import Train, elementary_trains
from models.errors import CrankcheckError
from tests.analytic.gears import willis
from tests.analytic.gears.trains import BOOK, KNOWN, RAVIGNEAUX, SIMPSON, Known, chain, mesh


@pytest.mark.parametrize("known", KNOWN.values(), ids=KNOWN)
def test_ratio_is_the_published_one_by_the_null_space(known: Known) -> None:
    train = Train(known.gears)
    assert train.mobility == 1 + len(known.held)
    assert train.influence((known.source, *known.held))[known.body][0] == known.ratio
    # A second null space, of numpy's singular values.
    inputs = {known.source: 1.0, **dict.fromkeys(known.held, 0.0)}
    speeds = train.speeds(inputs)
    rows = [[gear.relation.get(body, 0) for body in speeds] for gear in known.gears]
    assert np.abs(np.array(rows) @ np.array(list(speeds.values()))).max() < 1e-12


@pytest.mark.parametrize("known", KNOWN.values(), ids=KNOWN)
def test_ratio_is_the_published_one_by_willis(known: Known) -> None:
    inputs = {known.source: Fraction(1), **dict.fromkeys(known.held, Fraction(0))}
    if known.coupled:
        with pytest.raises(CrankcheckError, match="coupled trains have their relations solved"):
            willis.speeds(known.gears, inputs)
        # Turned round, the same train is one elementary train after the other.
        inputs = {known.body: Fraction(1), **dict.fromkeys(known.held, Fraction(0))}
        assert 1 / willis.speeds(known.gears, inputs)[known.source] == known.ratio
        return
    assert willis.speeds(known.gears, inputs)[known.body] == known.ratio


def test_basic_ratios_are_those_with_the_carrier_at_rest() -> None:
    front, rear = elementary_trains(SIMPSON)
    assert front.carrier == "out"
    assert front.values["front"] / front.values["sun"] == Fraction(-30, 66)
    assert rear.values["out"] / rear.values["planet2"] == Fraction(18, 66)
    (whole,) = elementary_trains(RAVIGNEAUX)
    assert whole.values["ring"] / whole.values["small"] == Fraction(30, 72)
    assert whole.values["ring"] / whole.values["large"] == Fraction(-36, 72)


def test_two_inputs_of_a_differential_add_up() -> None:
    """Norton, example 9-5: sun -100, arm -200 rpm."""
    assert Train(tuple(BOOK)).speeds({"sun": -100.0, "arm": -200.0})["ring"] == -250.0


def test_equal_planets_are_passive() -> None:
    several = tuple(
        g for n in "123" for g in (mesh("sun", n, 20, 40, "arm"), mesh("ring", n, 100, 40, "arm"))
    )
    train = Train(several)
    assert (train.mobility, train.passive) == (2, 2)


TRIANGLE = chain(("a", "b", 20, 20), ("b", "c", 20, 20), ("c", "a", 20, 20))


@pytest.mark.parametrize(("gears", "message"), [
    ((), "one pair of gears or more; found none"),
    (TRIANGLE + chain(("c", "d", 20, 20)), "gears a-b, b-c, c-a: an "
     "over-constrained train, and the train does not move; their relations contradict"),
    (TRIANGLE + chain(("x", "y", 20, 20)), "gears a-b, b-c, c-a: an "
     "over-constrained train; their relations contradict"),
    ((*chain(("a", "b", 20, 40)), mesh("b", "a", 40, 21)), "gears a-b, b-a: an over-constrained"),
])  # fmt: skip
def test_pairs_that_lock_each_other_are_named_and_no_others(gears: tuple, message: str) -> None:
    with pytest.raises(CrankcheckError) as error:
        Train(gears)
    assert message in str(error.value)


@pytest.mark.parametrize(("inputs", "message"), [
    ({"sun": 1.0}, "speeds of sun: the train has mobility 2, and they leave planet, arm, ring "
     "open; give 1 more"),
    ({}, "speeds of no body: the train has mobility 2"),
    ({"moon": 1.0}, "moon: no body of the train; use sun, planet, arm, ring"),
    ({"sun": 1.0, "arm": 0.0, "ring": 0.0}, "speeds of sun and arm and ring: "
     "not independent, as + 1 omega_sun - 3 omega_arm + 2 omega_ring = 0"),
])  # fmt: skip
def test_inputs_that_are_too_few_or_depend_on_each_other_are_refused(
    inputs: dict[str, float], message: str
) -> None:
    with pytest.raises(CrankcheckError) as error:
        Train(tuple(BOOK)).speeds(inputs)
    assert message in str(error.value)
