"""No column that names a body or a known quantity is passed over: it is judged, or refused with the
cure; what names neither is listed, and changes nothing."""

from random import Random

import numpy as np
import pandas as pd
import pytest

import crankcheck
from analytic.kinematics import solve
from models.array import Array
from models.errors import CrankcheckError
from models.files.reading import load_scene
from reports.compare.compare import Truth
from reports.logs.columns import columns_of
from reports.logs.meanings import understood
from tests.reports.own_log.conftest import Judge
from tests.worlds.headers import FOREIGN, Header, header
from tests.worlds.stranger_log import Dress
from tests.worlds.tiers import slow, slowly

SCENE = load_scene("fourbar-lecture-1")
TIME_S = np.linspace(0.0, 0.6, 60)
MOTION, TRUTH = solve(SCENE, TIME_S), Truth(SCENE)
C, ROCKER = MOTION.points["C"], MOTION.links["rocker"]
WRONG = 0.3 * np.sin(5.0 * TIME_S) + 1e-3


def numbers(one: Header) -> Array:
    """The column of a header; of no body, that of the rocker or of C."""
    if one.what in ("theta", "omega", "alpha"):
        series = getattr(MOTION.links[one.of or "rocker"], one.what)
        return np.asarray(one.per * series)
    point = MOTION.points[one.of or "C"]
    rates = {"x": point.position, "v": point.velocity, "a": point.acceleration}
    vectors = rates[one.what[0]]
    return one.per * (vectors[:, 0] if "x" in one.what else np.hypot(*vectors.T))


def outcome(name: str, values: Array) -> str:
    """Within, out or refused, for a log of the times and that column."""
    try:
        log = understood(columns_of(pd.DataFrame({"t": TIME_S, name: values})), SCENE)
    except CrankcheckError:
        return "refused"
    if log.unjudged:
        return "refused"
    (read,) = log.readings
    expected = read.expected(TRUTH)
    off = float(np.max(np.abs(read.error(TRUTH))))
    return "within" if off <= 1e-6 * max(1.0, float(np.max(np.abs(expected)))) else "out"


@pytest.mark.parametrize("count", [75, slowly(5000, reason="rare mixtures of words and orders")])
def test_no_spoilt_named_column_passes_and_no_right_one_fails(count: int) -> None:
    random = Random(count)
    for one in (header(random) for _ in range(count)):
        right = numbers(one)
        spoilt = right + WRONG * np.max(np.abs(right), initial=one.per)
        said = outcome(one.text, right), outcome(one.text, spoilt)
        readable = one.known and one.of
        assert said == (("within", "out") if readable else ("refused", "refused")), one


SPEED = np.hypot(*C.velocity.T)
OTHER: list[tuple[dict[str, Array], str]] = [
    ({"C_v_m_s": SPEED}, "within"),
    ({"C_v_m_s": 1.5 * SPEED}, "out"),
    ({"C_vx_m_s": C.velocity[:, 0], "C_vy_m_s": C.velocity[:, 1], "C_v_m_s": SPEED}, "within"),
    ({"C_vx_m_s": C.velocity[:, 0], "C_vy_m_s": C.velocity[:, 1], "C_v_m_s": SPEED + 0.1}, "out"),
    ({"Angular Velocity rocker (deg/blip)": ROCKER.omega}, "'deg/blip' is not a known unit"),
    ({"Angular Velocity (deg/sec)": ROCKER.omega}, "it names no link, point or slider"),
    ({"rocker_deg_filtered": ROCKER.omega}, "is not a kind of reading of a link"),
    ({"rocker_temperature": TIME_S}, "rocker_temperature"),
    ({"rocker/pose/orientation/z": np.sin(ROCKER.theta / 2.0)}, "a component of a quaternion"),
    ({"torque_n_m": TIME_S}, "a force, which is judged with --?forces"),
    ({"rocker_gap_m": TIME_S}, "a gap is of a pin or a slider"),
    ({"A_x_m": 0.0 * TIME_S, "A_vx_m_s": 0.0 * TIME_S, "D_x_m": 0.3 + 0.0 * TIME_S}, "within"),
    ({"D_x_m": 0.31 + 0.0 * TIME_S}, "out"),
    ({"rockertheta_filtered": ROCKER.theta}, "rockertheta_filtered"),
    ({"C.position.z": 0.5 + 0.0 * TIME_S, "rocker/twist/angular/x": 0.0 * TIME_S}, "within"),
    ({"rocker/twist/angular/x": TIME_S}, "out of the plane"),
    ({"rocker foo": np.array([f"{n} deg" for n in TIME_S])}, "'foo' is not a kind of reading"),
    ({"load u (N)": TIME_S}, "it may be a force"),
    (dict.fromkeys(FOREIGN, TIME_S), "within"),
]  # fmt: skip


@pytest.mark.parametrize(
    ("columns", "said"),
    [
        pytest.param(*case, marks=slow("other columns beside it") if number % 2 else ())
        for number, case in enumerate(OTHER)
    ],
    ids=[", ".join(case) for case, _ in OTHER],
)
def test_a_column_beside_a_right_one_is_judged_or_refused_with_the_cure(
    columns: dict[str, Array], said: str
) -> None:
    log = {"t": TIME_S, "rocker_rad": ROCKER.theta + 1e-9, **columns}
    if said in ("within", "out"):
        assert crankcheck.judge(SCENE, log, target=1e-5).verdict == said
        return
    with pytest.raises(CrankcheckError, match=said) as refused:
        crankcheck.judge(SCENE, log, target=1e-5)
    assert "ignore = true" in str(refused.value)
    ignored = {"channel": [{"column": name, "ignore": True} for name in columns]}
    assert crankcheck.judge(SCENE, log, target=1e-5, map=ignored).verdict == "within"


def test_a_rate_that_is_judged_without_times_is_not_said_to_be_not_judged(judge: Judge) -> None:
    log = {"crank_rad": MOTION.links["crank"].theta, "rocker_rad_s": 2.0 * ROCKER.omega}
    said = " ".join(judge(SCENE.name, Dress().text(log), code=1).stdout.split())
    assert "OUT OF TOLERANCE: 1 of 1 error over 60 samples of fourbar-lecture-1 L" in said


def test_what_names_neither_is_on_the_line_of_the_verdict_and_utf_16_is_read(judge: Judge) -> None:
    log = {"TimeSteps": TIME_S, "rocker angVel": ROCKER.omega, "C Vx_0": C.velocity[:, 0]}
    text = Dress().text({**log, "rocker angAccel": ROCKER.alpha, "temperature_C": TIME_S}).decode()
    for code in ("utf-16", "utf-16-be"):
        said = " ".join(judge(SCENE.name, text.encode(code)).stdout.split())
        assert "WITHIN TOLERANCE: 3 errors over 60 samples" in said
        assert "; not judged: temperature_C" in said
