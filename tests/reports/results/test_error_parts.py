"""The parts of an error over the crank angle, on lines whose parts are known."""

import math
from collections.abc import Callable, Mapping

import numpy as np
import pytest

from models.array import Array
from reports.results.error_parts import SHARED, CurveBody, Split, shared, split, worst_body
from reports.results.lines import Line, lines
from tests.reports.results.made import PERIOD_S, cell, stored

LENGTH = 0.25
BODY = CurveBody("angle.rocker", 1.0)
STEPS = (90, 180, 360, 720)
Trace = Mapping[str, Array]
Traces = dict[str, Trace]


def line_of(error: Callable[[float], float], steps: tuple[int, ...] = STEPS) -> Line:
    (found,) = lines(stored([cell("s", "v", n, error(PERIOD_S / n), 1.0) for n in steps]))
    return found


def traces_of(line: Line, geometric: Callable[[Array, float], Array], drive: float = 0.0) -> Traces:
    """Traces with a geometric error over the phase of the turn and the step, and a drive's."""
    found: Traces = {}
    for key, dt_s in zip(line.cells["key"], line.cells["dt_s"], strict=True):
        phase = np.linspace(0.0, 2 * np.pi, 91)
        at = geometric(phase, dt_s)
        found[str(key)] = {
            "time_s": PERIOD_S * (1.0 + phase / (2 * np.pi)),
            "driver_rad": phase,
            "gap": np.full_like(phase, 1e-6),
            "geometric.angle.rocker": at,
            "angle.rocker": at + drive * np.cos(phase),
        }
    return found


def of(traces: Traces) -> Callable[[str], Trace]:
    return lambda key: traces.get(key, {})


def waves(floor: float, harmonic: int = 1) -> Callable[[Array, float], Array]:
    """A floor in the phase, and a step's error of order 2 with another shape."""
    return lambda phase, dt: floor * np.sin(phase) + 40.0 * dt**2 * np.cos(harmonic * phase)


def split_of(line: Line, geometric: Callable[[Array, float], Array], drive: float = 0.0) -> Split:
    return split(line, of(traces_of(line, geometric, drive)), BODY, LENGTH)


def second_order(floor: float) -> Line:
    return line_of(lambda dt_s: floor + 40.0 * dt_s**2)


def test_floor_and_discretisation_are_told_apart_instant_by_instant() -> None:
    floor = 1e-4
    line = second_order(floor)
    found = split_of(line, waves(floor, 2), drive=3e-9)
    assert found.why == ""
    for key, dt_s in zip(line.cells["key"], line.cells["dt_s"], strict=True):
        parts = found.cells[key]
        # the fit of the largest error tells the order to some digits only
        room = {"atol": found.doubt + 1e-12}
        np.testing.assert_allclose(parts.floor, floor * np.sin(parts.driver_rad), **room)
        step = 40.0 * dt_s**2 * np.cos(2 * parts.driver_rad)
        np.testing.assert_allclose(parts.discretisation, step, **room)
        np.testing.assert_allclose(parts.drive, 3e-9 * np.cos(parts.driver_rad), atol=1e-17)
        total = parts.drive + parts.floor + parts.discretisation
        np.testing.assert_allclose(total, parts.total, atol=1e-18)
        np.testing.assert_allclose(parts.gap, 1e-6 / LENGTH)
    assert found.doubt < 0.1 * floor  # of four steps, of which floor and step may partly oppose
    traces = traces_of(line, waves(floor, 2))
    slid = split(line, of(traces), CurveBody("angle.rocker", LENGTH), LENGTH)
    np.testing.assert_allclose(slid.cells[key].floor, parts.floor / LENGTH, rtol=1e-9)


def test_what_coarser_steps_tell_otherwise_is_doubt() -> None:
    """A phase at which the error falls with another order leaves something behind at dt = 0."""
    line = second_order(1e-4)
    found = split_of(line, lambda phase, dt: waves(1e-4)(phase, dt) + 0.05 * dt)
    parts = found.cells[str(line.cells["key"].iloc[0])]
    off = np.max(np.abs(parts.floor - 1e-4 * np.sin(parts.driver_rad)))
    assert 1e-5 < off < 1.2 * found.doubt
    assert found.seen


def test_a_line_that_falls_throughout_has_no_floor_whatever_is_left() -> None:
    """What is far below the finest error is nothing to be told from so few curves."""
    line = second_order(0.0)
    assert line.fit.kind == "order"
    found = split_of(line, waves(1e-6))
    assert found.floor == pytest.approx(1e-6, rel=0.1)
    assert found.doubt >= found.floor
    assert not found.seen


def test_an_order_that_is_not_well_known_is_doubt() -> None:
    """Also where the third step can not be asked, as it was logged at other instants."""
    line = line_of(lambda dt_s: 1e-4 + 40.0 * dt_s**2 * (1.0 + 0.05 * math.sin(1e4 * dt_s)))
    traces = traces_of(line, waves(1e-4))
    third = str(line.cells["key"].iloc[-3])
    traces[third] = {**traces[third], "time_s": traces[third]["time_s"] + 1e-3}
    found = split(line, of(traces), BODY, LENGTH)
    parts = found.cells[str(line.cells["key"].iloc[-1])]
    assert parts.discretisation is not None
    off = np.max(np.abs(parts.floor - 1e-4 * np.sin(parts.driver_rad)))
    assert 0.0 < off < found.doubt
    assert found.cells[third].floor is None
    assert found.seen


def test_an_error_that_follows_no_order_is_not_extrapolated() -> None:
    errors = iter((1e-3, 3e-3, 5e-4, 4e-3))
    line = line_of(lambda dt_s: next(errors))
    found = split_of(line, lambda phase, dt: 1e-3 * np.sin(phase))
    assert found.why == "the error follows no order of the step"
    assert math.isnan(found.floor)
    assert not found.seen
    for parts in found.cells.values():
        assert (parts.floor, parts.geometric is None) == (None, False)


def test_steps_that_were_logged_at_other_instants_or_not_at_all_are_not_extrapolated() -> None:
    line = second_order(1e-3)
    traces = traces_of(line, waves(1e-3))
    finest = str(line.cells["key"].iloc[-1])
    moved = traces[finest]["time_s"] + 0.3 * PERIOD_S / 90
    traces[finest] = {**traces[finest], "time_s": moved}
    found = split(line, of(traces), BODY, LENGTH)
    assert found.why == "the two finest steps were logged at different instants"
    assert split(line, of({}), BODY, LENGTH).why == "no fitted run was logged"


def test_a_crank_that_left_its_reach_leaves_the_total() -> None:
    line = second_order(1e-3)
    traces = {
        key: {name: a for name, a in trace.items() if not name.startswith("geometric")}
        for key, trace in traces_of(line, waves(1e-3)).items()
    }
    found = split(line, of(traces), BODY, LENGTH)
    assert found.why == "the logged crank left the range of the mechanism"
    for key, parts in found.cells.items():
        assert parts.drive is parts.geometric is None
        np.testing.assert_array_equal(parts.total, traces[key]["angle.rocker"])


@pytest.mark.parametrize(("bad", "told"), [(0, True), (-1, False)])
def test_a_run_that_ended_badly_is_split_but_not_extrapolated_from(bad: int, told: bool) -> None:
    rows = [cell("s", "v", n, 40.0 * (PERIOD_S / n) ** 2, 1.0) for n in STEPS]
    rows[bad]["status"] = "branch-changed"
    (line,) = lines(stored(rows))
    found = split_of(line, waves(0.0))
    assert len(found.cells) == 4
    assert math.isfinite(found.floor) == told
    assert all((parts.floor is not None) == told for parts in found.cells.values())


def test_runs_at_rounding_are_not_extrapolated_from() -> None:
    """The fit leaves them out; what they would tell is the noise of the finest three."""
    rows = [cell("s", "v", n, max((45 / n) ** 4 * 1e-7, 5e-12), 1.0) for n in (*STEPS, 1440)]
    (line,) = lines(stored(rows))
    assert list(line.fit.used) == [True, True, True, False, False]
    traces = traces_of(line, lambda phase, dt: 1e-7 * (45 * dt / PERIOD_S) ** 4 * np.cos(phase))
    for key in line.cells["key"].iloc[-2:]:
        noise = 5e-12 * np.sign(np.sin(40.0 * np.arange(91)))
        traces[str(key)] = {**traces[str(key)], "geometric.angle.rocker": noise}
    found = split(line, of(traces), BODY, LENGTH)
    third = line.cells["dt_s"].iloc[2]
    parts = found.cells[str(line.cells["key"].iloc[2])]
    most = float(np.max(np.abs(parts.discretisation)))
    assert most == pytest.approx(1e-7 * (45 * third / PERIOD_S) ** 4, rel=1e-3)


def test_the_worst_body_is_not_decided_by_one_line_that_is_far_off() -> None:
    rows = [cell("s", v, n, 1e-3, 1.0) for v in ("a", "b", "c") for n in (90, 180)]
    found = lines(stored(rows))
    traces: Traces = {}
    for line in found:
        wild = 1e3 if line.variant == "c" else 1.0
        for key in line.cells["key"]:
            traces[str(key)] = {
                "time_s": np.zeros(3),
                "angle.rocker": np.array([0.0, -2e-3, 1e-4]),
                "displacement.C": np.array([0.0, 1e-4 * LENGTH * wild, 0.0]),
                "geometric.angle.coupler": np.array([9.0, 9.0, 9.0]),
            }
    body = worst_body(found, of(traces), LENGTH)
    assert (body, body.name) == (BODY, "angle of rocker")
    rows = [cell("s", "v", n, math.nan, 1.0, status="diverged") for n in (90, 180)]
    assert worst_body(lines(stored(rows)), of({}), LENGTH) is None, "no run ended well"


def test_shared_instants_are_found_whatever_the_steps() -> None:
    a, b = np.linspace(1.0, 2.0, 91), np.linspace(1.0, 2.0, 46)
    here, there = shared(a, b, 1.0)
    assert len(here) == 46
    np.testing.assert_allclose(a[here], b[there])
    assert len(shared(a, b + 1e-3, 1.0)[0]) < SHARED
    for one, other, number in ((a, a[:0], 0), (a[:0], a, 0), (a, a[:1], 1)):
        assert len(shared(one, other, 1.0)[0]) == number
