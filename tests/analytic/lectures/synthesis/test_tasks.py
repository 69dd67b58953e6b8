"""Random tasks are met at every position; tolerances by closed forms and a Monte Carlo."""

import cmath
import functools
import math
from dataclasses import replace

import numpy as np
import pytest

from analytic.lectures.synthesis import solutions
from analytic.lectures.synthesis.design import AskedSlide
from analytic.lectures.synthesis.examine import IN_LINE, Examined, examine
from analytic.lectures.synthesis.sensitivity import is_measured, monte_carlo, sensitivity
from analytic.lectures.synthesis.slider_crank_strokes import readable_ratio, stroke_proposals
from analytic.lectures.synthesis.solutions import Solutions, followed, solutions_of
from analytic.mechanism.cycle import travel
from models.lectures.shipped_tables import TaskTable
from models.lectures.tasks import load_task
from models.lectures.tasks.curves import FunctionTable
from models.lectures.tasks.positions import CouplerTask, QuickReturnTask, RockerTask, StrokeTask
from tests.analytic.lectures.synthesis.random_tasks import (
    HEAD,
    TASKS,
    hold,
    passed,
    random_solutions,
)
from tests.worlds.tiers import slow, slowly

FIRST = {"three_positions": 2, "given_pivots": 3, "four_positions": 1, "five_positions": 3}
"""The first task with a solution without a defect, and if it can be one with: of others, all of
which have a defect, the nearest task is looked for, which takes a second."""
ELSEWHERE = {
    "path": "test_path.py finds paths by the reference",
    "crank_rocker": "0.7 s: its time ratio is measured below",
    "stroke_and_ratio": "0.6 s: its time ratio is measured below",
}


@pytest.mark.parametrize(
    ("kind", "numbers"),
    [
        *(
            slowly(kind, range(1), reason=ELSEWHERE[kind])
            if kind in ELSEWHERE
            else (kind, range(FIRST.get(kind, 0), FIRST.get(kind, 0) + 1))
            for kind in TASKS
        ),
        *(slowly(kind, range(100), reason="of forty, some are near a limit") for kind in TASKS),
    ],
    ids=lambda one: one if isinstance(one, str) else str(len(one)),
)
def test_solutions_do_what_is_said_of_them(kind: str, numbers: range) -> None:
    sound = [hold(kind, number) for number in numbers]
    assert sum(some for some, _ in sound) > 0.05 * sum(every for _, every in sound)


LINE = [0.0, 70.0, 140.0]
LINEAR = {**HEAD, "x": LINE, "y": [0.0, 40.0, 80.0], "range_of_x": (0.0, 140.0), "ground_m": 4.0}
FORTH = {"input_range_deg": 140.0, "output_range_deg": 80.0} | {
    "input_start_deg": 40.0, "output_start_deg": 100.0
}  # fmt: skip
BACK = {"input_range_deg": -140.0, "output_range_deg": -80.0} | {
    "input_start_deg": 180.0, "output_start_deg": 180.0
}  # fmt: skip


def carried(lengths: tuple[float, ...], angles: tuple[float, ...]) -> CouplerTask:
    """A coupler AB in its positions at angles of the crank [rad]."""
    a, b, c, d = lengths
    positions = []
    for theta in angles:
        pin = cmath.rect(a, theta)
        arm = d - pin
        cosine = (abs(arm) ** 2 + b**2 - c**2) / (2.0 * abs(arm) * b)
        turn = cmath.phase(arm) + math.acos(max(-1.0, min(1.0, cosine)))
        ends = {"A": pin, "B": pin + cmath.rect(b, turn)}
        positions.append({"points": {key: [z.real, z.imag] for key, z in ends.items()}})
    return CouplerTask(**HEAD, positions=positions, driver="first")


CHANGING, LIMITED = (0.1, 0.25, 0.15, 0.3), (0.3, 0.2, 0.25, 0.4)
LIMIT = math.acos((0.3**2 + 0.4**2 - 0.45**2) / (2.0 * 0.3 * 0.4))


@pytest.mark.parametrize(
    ("task", "where"),
    [
        (FunctionTable(**LINEAR, **FORTH, points=LINE), "position 3"),
        slowly(FunctionTable(**LINEAR, **BACK, points=LINE), "position 1", reason="as forth"),
        (FunctionTable(**LINEAR, **FORTH, points=[0.0, 70.0, 130.0]), "an end of its range"),
        (carried(CHANGING, (1.5, 2.3, math.pi)), "position 3"),
        slowly(carried(CHANGING, (math.pi, 3.6, 4.2)), "position 1", reason="as the last one"),
        (carried(LIMITED, (0.6, 1.0, LIMIT)), "position 3"),
    ],
)
def test_a_position_at_a_change_point_is_a_defect(
    task: TaskTable, where: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(solutions, "nearest", lambda *_: ("", []))  # its search is tested below
    *_, one = solutions_of(task).examined
    assert one.fault.startswith(f"{where} is at a change point or limit"), one.defects
    assert "assembled" not in one.proposal.doubt


def placed(*poses: tuple[complex, float], **given: object) -> CouplerTask:
    """A body with its point P in places [m] at angles [deg]."""
    positions = [{"point_m": [z.real, z.imag], "angle_deg": angle} for z, angle in poses]
    return CouplerTask(**HEAD, positions=positions, **given)


PINS = [[0.0, 0.1], [0.1, 0.0]]
ABOUT, ANGLES = 0.3 + 0.1j, (0.0, 30.0, 70.0, 100.0, 160.0)
TURNED = [(ABOUT + cmath.rect(0.2, math.radians(a)), a) for a in ANGLES]
HALF = placed((0j, 0.0), (0.1 + 0.02j, 180.0), moving_m=[[0.0, 0.0], [0.15, 0.0]])
HALF_BY = HALF.model_copy(update={"distances_m": (0.05, 0.05), "driver": "first"})
ROUNDED = [(complex(round(z.real, 6), round(z.imag, 6)), a) for z, a in TURNED]
CIRCLE = [(z, 15.0) for z, _ in TURNED]
ON_A_LINE = [(x * (1.0 + 0.5j), 20.0) for x in (0.0, 0.1, 0.3, 0.4, 0.2)]
CRANK = [cmath.rect(0.1, t) for t in (0.3, 1.0, 1.8, 2.4, 2.9)]
RODS = [(pin, -math.degrees(math.asin(pin.imag / 0.3))) for pin in CRANK]
ROD_END = [CRANK[0].real + math.sqrt(0.09 - CRANK[0].imag ** 2), 0.0]
TRAMMEL = [(complex(0.3 * math.cos(t)), 180.0 - math.degrees(t)) for t in (0.3, 0.7, 1.2)]
TRAMMEL_PINS = [[0.3 * math.cos(0.3), 0.0], [0.0, 0.3 * math.sin(0.3)]]
LEVER = [(pin, math.degrees(cmath.phase(0.4 - pin))) for pin in CRANK[:3]]


@pytest.mark.parametrize(
    ("task", "word"),
    [
        (placed(*TURNED[:3], moving_m=PINS), "the body is a crank"),
        (placed(*((ABOUT, angle) for angle in ANGLES)), "the body is a crank"),
        (placed(*TURNED[:2], moving_m=[[0.3, 0.1], [0.5, 0.1]]), "the body is a crank"),
        slowly(HALF, "the body is a crank", reason="of 72 with a defect"),
        (placed(*ROUNDED), "positions met to"),
        slowly(placed(*CIRCLE[:3], moving_m=PINS), "driven at", reason="three positions"),
        slowly(placed(*CIRCLE[:4]), "parallelogram", reason="its engines do so in test_proof.py"),
        (placed(*ON_A_LINE[:3], moving_m=PINS), "the body is a slider"),
        slowly(placed(*ON_A_LINE), "the body is a slider", reason="five positions, as three"),
        (placed(*RODS[:3], moving_m=[[CRANK[0].real, CRANK[0].imag], ROD_END]), "slider B"),
        slowly(placed(*RODS), "slider", reason="five positions, as three"),
        slowly(placed(*TRAMMEL, moving_m=TRAMMEL_PINS), "slider P", reason="half a second: as O4"),
        (placed(*LEVER, fixed_m=[[0.0, 0.0], [0.4, 0.0]]), "slider O4"),
    ],
)
def test_positions_of_a_pivot_a_circle_or_a_line_have_their_mechanism(
    task: CouplerTask, word: str
) -> None:
    found = solutions_of(task)
    assert any(
        word in " ".join(f"{key} {value}" for key, value in one.proposal.chosen.items())
        and passed(one)[0] < max(1e-9, one.proposal.allowed)
        for one in found.sound
    ), [(one.defects, one.proposal.chosen) for one in found.examined]


TURNING = {"mechanism": "whitworth", "time_ratio": 1.5, "stroke_m": 0.3, "rod_m": 0.1}
PARABOLA = [(complex(x, x * x), 5.0) for x in (0.0, 0.1, 0.3, 0.4)]
IN_LINE_AT_END = FunctionTable(**LINEAR, **FORTH, points=LINE)
DEFECTS, BETWEEN = "every mechanism has a defect", {"form": "offset", "time_ratio": 1.5}
LATE = {"form": "offset", "time_ratio": 2.9}
NEAREST: list[tuple[TaskTable, str, str]] = [
    (load_task("coupler", "five-positions"), DEFECTS, "position "),
    (placed(*PARABOLA), "four positions are so special", "position 2, passed by 0.00349 m"),
    (
        StrokeTask(**HEAD, stroke_m=0.1, rod_m=0.04),
        "would not turn",
        "rod_m = 0.04, and has 0.0500",
    ),
    (
        StrokeTask(**HEAD, stroke_m=0.1, offset_m=1.0, **BETWEEN),
        "it lies between 0 and",
        "offset_m = 1, and has 0.137",
    ),
    (
        RockerTask(**HEAD, swing_deg=60.0, rocker_m=0.2, distance_m=0.05),
        "take more than 0.1 m",
        "distance_m = 0.05, and has 0.1000",
    ),
    (StrokeTask(**HEAD, stroke_m=0.1, rod_m=0.3, **LATE), "between 0.05", "rod_m = 0.3, and has"),
    (HALF_BY, DEFECTS, "distances_m"),
    (placed(*(ON_A_LINE[k] for k in (0, 2, 1, 3))), DEFECTS, "position 2, passed in another order"),
    (QuickReturnTask(**HEAD, **TURNING), "0.15 m from O4, which", "rod_m = 0.1, and has 0.15"),
    (IN_LINE_AT_END, DEFECTS, "input_start_deg"),
]


@pytest.mark.parametrize(
    ("task", "reason", "gives_up"),
    [case if case in NEAREST[5:8] else slowly(*case, reason="each search takes up to 3 s")
     for case in NEAREST],
)  # fmt: skip
def test_a_task_without_a_solution_has_the_nearest_one_that_has_some(
    task: TaskTable, reason: str, gives_up: str
) -> None:
    found = solutions_of(task)
    assert reason in found.without
    assert not found.sound
    (fault,) = found.examined[0].defects
    assert fault.startswith(f"gives up {gives_up}")
    assert passed(found.examined[0])[0] < 1e-9


RATIOS = ("stroke_and_ratio", "slotted_lever", "whitworth", "crank_rocker")


@pytest.mark.parametrize("kind", RATIOS)
def test_the_reference_measures_the_time_ratio_that_was_asked_for(kind: str) -> None:
    found = random_solutions(kind, 0)
    assert found.sound
    for one in found.sound[:3]:
        measured = travel(one.scene, one.proposal.turns_back).time_ratio
        assert measured == pytest.approx(found.task.time_ratio, rel=1e-8)
        assert f"time ratio {readable_ratio(measured)}" in one.notes[-1]


def test_a_turn_that_is_claimed_wrongly_is_a_fault() -> None:
    """Two places of a slider that it passes, and does not turn back in."""
    (proposal,) = stroke_proposals(StrokeTask(**HEAD, stroke_m=0.2, rod_m=0.5))
    first, last = proposal.positions
    passed = 0.1 * math.cos(0.3) + math.sqrt(0.25 - (0.1 * math.sin(0.3)) ** 2) - 0.4
    short = replace(last, driver_rad=0.3, asked=(AskedSlide("B", passed),))
    one = followed(examine(replace(proposal, positions=(first, short))))
    assert max(one.off) < 1e-14
    assert one.defects == ["goes 0.2 m, time ratio 1: take a longer rod"]


def offset_by(**given: float) -> Solutions:
    return solutions_of(StrokeTask(**HEAD, stroke_m=0.1, form="offset", **given))


@slow("a second: digits near limits of tasks that are met above")
def test_near_their_limits_ratios_and_offsets_keep_their_digits_and_beyond_are_refused() -> None:
    found = offset_by(time_ratio=2.995)
    assert found.sound == [one for one in found.examined if one.least_sine >= IN_LINE]
    assert len(found.sound) == 6  # of the others the rod is square to the line at the inner end
    assert len(found.examined) == 12
    for one in found.examined:
        assert max(one.off) < 1e-15 / one.least_sine**2
        folded, stretched = (position.driver_rad for position in one.positions)
        low, high = sorted(((stretched - folded) % math.tau, (folded - stretched) % math.tau))
        assert high / low == pytest.approx(2.995, rel=1e-13)
    beyond = offset_by(time_ratio=2.9999, offset_m=1e-6)
    assert beyond.without.startswith("time_ratio is 2.9999: a slider-crank whose crank turns has")
    assert "above 2.9956: give 1 to this" in beyond.without
    assert [readable_ratio(ratio) for ratio in (2.9999999, 2.5, 3.0)] == ["2.9999999", "2.5", "3"]
    (one,) = offset_by(time_ratio=1.0001, offset_m=1e-9).sound
    assert -one.scene.sliders["B"].through_m[1] == pytest.approx(1e-9, rel=1e-12)
    assert max(one.off) < 1e-14


@functools.cache
def best(kind: str, name: str) -> Examined:
    return solutions_of(load_task(kind, name)).examined[0]


@functools.cache
def central_stroke() -> Examined:
    task = StrokeTask(name="x", source="a test", stroke_m=0.1, rod_m=0.3)
    return solutions_of(task).examined[0]


def test_slopes_and_the_largest_clearance_of_a_central_slider_crank_are_known() -> None:
    """At the ends of its stroke s = l +- r: a length goes in whole, the pivot's height not at
    all."""
    found = sensitivity(central_stroke())
    slope = {one.words: abs(found.slopes[:, k]) for k, one in enumerate(found.dimensions)}
    for words in ("crank A x", "rod B x", "ground O2 x"):
        assert slope[words] == pytest.approx([1.0, 1.0], abs=1e-8)
    assert slope["ground O2 y"] == pytest.approx([0.0, 0.0], abs=1e-6)
    # The crank's pin moved across it: the rod is in line with the crank, the slider stays.
    assert slope["crank A y"] == pytest.approx([0.0, 0.0], abs=1e-6)
    assert found.worst(1e-4) == pytest.approx([3e-4, 3e-4], rel=1e-6)
    assert found.usual(1e-4) == pytest.approx([math.sqrt(3.0) * 1e-4] * 2, rel=1e-6)
    clearance, row = found.largest_clearance([3e-4, 6e-4])
    assert clearance == pytest.approx(1e-4, rel=1e-6)  # three pins in line
    assert row == 0
    measured = [one.words for one in found.dimensions if is_measured(central_stroke(), one)]
    assert measured == ["ground O2 x", "ground O2 y", "crank A x", "rod B x"]  # one of each bar


@pytest.mark.parametrize(
    ("kind", "name"),
    [("coupler", "three-positions"), slowly("quick-return", "whitworth", reason="a slower one")],
)
def test_a_monte_carlo_stays_within_the_worst_case_and_comes_near(kind: str, name: str) -> None:
    one = best(kind, name)
    found, small = sensitivity(one), 1e-6
    worst = found.worst(small)
    spread = monte_carlo(one, small, (0.3 * worst).tolist(), 40)
    moves = worst > 1e-9
    assert np.all(spread.largest <= worst * 1.001 + 1e-12)
    assert np.all(spread.largest[moves] > 0.25 * worst[moves])
    assert 0.0 < spread.share_within < 1.0
    assert spread.lost == 0


def test_the_same_seed_gives_the_same() -> None:
    one = central_stroke()
    first, second, other = (monte_carlo(one, 1e-4, [1e-4] * 2, 10, seed=k) for k in (0, 0, 1))
    assert first.largest.tolist() == second.largest.tolist()
    assert other.largest.tolist() != first.largest.tolist()


def test_mechanisms_that_can_not_be_assembled_are_counted() -> None:
    one = best("coupler", "three-positions")
    assert monte_carlo(one, 0.1, [1.0] * 9, 12).lost > 2
