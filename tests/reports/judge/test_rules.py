"""Every rule is seen to pass, and to fail; and what is said of an error when the step is halved."""

import math
from dataclasses import replace

import pytest

from reports.compare.errors import Error, Errors, SceneFacts, largest
from reports.judge.rules import RULES, judge
from reports.judge.rules.rule import Evidence, Finding
from reports.judge.three_steps import Convergence, convergence
from reports.judge.tolerance import Limit
from reports.quantities.limits import DEFAULTS
from tests.worlds.facts import with_facts

KINDS = {
    "drive": "driver",
    "angle": "link",
    "displacement": "slider",
    "position": "point",
    "gap": "point",
    "velocity": "link",
    "acceleration": "link",
}


def row(
    quantity: str, source: str = "reported", maximum: float = 1e-4, kind: str = "total"
) -> Error:
    return Error(
        quantity=quantity,
        body_kind=KINDS[quantity],  # type: ignore[arg-type]  # a plain text is one of the literals
        body="rocker",
        source=source,  # type: ignore[arg-type]  # as above
        kind=kind,  # type: ignore[arg-type]  # as above
        unit="rad",
        scale=1.0,
        maximum=maximum,
        rms=maximum / 2,
        final=0.0,
        time_of_maximum_s=0.25,
        driver_at_maximum_rad=math.pi,
        bound=1e-14,
        samples=100,
    )


RATES = [
    (rate, how) for rate in ("velocity", "acceleration") for how in ("reported", "differenced")
]
ROWS = (
    *(row(quantity) for quantity in KINDS),
    *(row(rate, "differenced") for rate, _ in RATES[::2]),
)
START = tuple(row(*rate, kind="start") for rate in RATES)


def halved(*error: float, **known: object) -> Convergence:
    return convergence((1e-3, 5e-4, 2.5e-4), error, "rad", **known)  # type: ignore[arg-type]


SECOND_ORDER = 16e-5, 4e-5, 1e-5
FLAT = halved(8e-4, 7.6e-4, 7.5e-4)
HEALTHY = Evidence(
    status="ok",
    reason="",
    stopped_at_s=1.0,
    errors=Errors((*ROWS, *START), (), (), SceneFacts(1.0, 0.8, 0.01, jolt=0.5)),
    limits={name: Limit(1e-3, "default") for name in DEFAULTS},
    convergence=halved(*SECOND_ORDER),
    unasked=(),
    absent=(),
)


def with_errors(**changed: object) -> Evidence:
    """The healthy evidence with something else in its errors."""
    return replace(HEALTHY, errors=with_facts(HEALTHY.errors, **changed))


def with_row(new: Error, **changed: object) -> Evidence:
    """The healthy evidence with one row in place of the one of its kind."""
    rows = tuple(
        new if (old.quantity, old.source) == (new.quantity, new.source) else old for old in ROWS
    )
    return replace(with_errors(rows=(*rows, *START)), **changed)


def by_rule(evidence: Evidence) -> dict[str, Finding]:
    return {finding.rule: finding for finding in judge(evidence)}


def failing(evidence: Evidence) -> set[str]:
    return {finding.rule for finding in judge(evidence) if finding.level == "fail"}


def test_a_healthy_run_passes_every_rule_and_is_told_no_cure() -> None:
    findings = judge(HEALTHY)
    # From CC120 on they have something to say where forces were asked for.
    assert [finding.rule for finding in findings] == [name for name in RULES if name < "CC120"]
    assert {(finding.level, finding.cure) for finding in findings} == {("pass", "")}


@pytest.mark.parametrize(
    ("id_", "quantity", "source"),
    [
        ("CC102", "drive", "reported"),
        ("CC103", "angle", "reported"),
        ("CC104", "displacement", "reported"),
        ("CC105", "gap", "reported"),
        ("CC106", "velocity", "reported"),
        ("CC107", "velocity", "differenced"),
        ("CC108", "acceleration", "reported"),
        ("CC113", "position", "reported"),
        ("CC114", "acceleration", "differenced"),
    ],
)
@pytest.mark.parametrize("size", [1e-3, 1.01e-3, math.nan, math.inf])
def test_every_limit_has_its_own_rule(id_: str, quantity: str, source: str, size: float) -> None:
    evidence = with_row(row(quantity, source, size))
    found = by_rule(evidence)[id_]
    failed = set() if size == 1e-3 else {id_} if math.isfinite(size) else {id_, "CC109"}
    assert failing(evidence) == failed
    assert found.limit == 1e-3
    assert "rocker" in found.text


def test_a_number_that_is_missing_is_worse_than_any_other() -> None:
    missing, other = row("angle", maximum=math.nan), row("angle", maximum=1e300)
    for rows in ((missing, other), (other, missing)):
        assert math.isnan(largest(rows).maximum)


def test_a_run_without_a_whole_log_is_judged_by_its_status() -> None:
    findings = judge(Evidence("unsupported", "no mass", 0.0, None, {}))
    assert [(f.rule, f.level) for f in findings] == [("CC101", "fail")]
    assert by_rule(Evidence("ok", "", 1.0, None, {}))["CC115"].level == "fail"
    # One that is not whole is no fault of a run that ended early.
    assert "CC115" not in by_rule(replace(with_errors(incomplete="50 samples"), status="diverged"))


NO_NUMBER = row("velocity", maximum=math.nan, kind="start")
UNSURE = "reference not certain: angle of rocker"


@pytest.mark.parametrize(
    ("evidence", "rule", "text"),
    [
        (with_errors(rows=(*ROWS, NO_NUMBER)), "CC109", "velocity of rocker"),
        (with_errors(missing=("link rocker", "gap of C")), "CC109", "link rocker, gap of C"),
        (with_errors(incomplete="50 samples, not the 721"), "CC115", "50 samples, not the 721"),
        (with_row(replace(row("angle"), bound=2e-4)), "CC112", UNSURE),
        (with_row(replace(row("angle"), bound=math.nan)), "CC112", UNSURE),
    ],
)
def test_what_no_limit_holds_has_rules_of_its_own(evidence: Evidence, rule: str, text: str) -> None:
    found = by_rule(evidence)[rule]
    assert found.level == "fail"
    assert text in found.text
    assert rule != "CC115" or found.text == text


@pytest.mark.parametrize("status", ["ok", "diverged"])
def test_a_pin_that_holds_nothing_leaves_the_mechanism_two_freedoms_more(status: str) -> None:
    torn = replace(with_row(row("gap", maximum=0.06)), status=status, gated=False)
    found = by_rule(torn)["CC135"]
    assert found.level == "fail"
    assert "loop not enforced: pin rocker open by up to 0.06" in found.text
    assert "2 freedoms more" in found.text
    assert found.cure.startswith("Look at whether the solver enforces joints that close loops")
    for held in (0.04, math.nan):
        assert "CC135" not in by_rule(with_row(row("gap", maximum=held)))


def test_an_error_that_does_not_shrink_is_advice_that_names_the_floor() -> None:
    found = by_rule(replace(HEALTHY, convergence=FLAT))["CC110"]
    assert found.level == "advice"
    assert "does not shrink: floor 7.5e-4 rad" in found.text
    assert "CC110" not in by_rule(replace(HEALTHY, convergence=None))


@pytest.mark.parametrize("gated", [True, False])
@pytest.mark.parametrize(
    "seen",
    [
        halved(1e-6, 2e-6, 4e-6),
        halved(1e-6, math.nan, 1e-7),
        halved(*SECOND_ORDER, faults=["it diverged"]),
        halved(*SECOND_ORDER, over=["angle too large"]),
    ],
)
def test_worse_finer_steps_fail_where_the_cell_is_gated(seen: Convergence, gated: bool) -> None:
    found = by_rule(replace(HEALTHY, convergence=seen, gated=gated))["CC110"]
    assert found.level == ("fail" if gated else "advice")
    assert all(fault in found.text for fault in (*seen.faults, *seen.over))


@pytest.mark.parametrize("index", range(len(START)))
@pytest.mark.parametrize("size", [0.1, math.nan])
def test_rates_of_the_first_samples_have_a_limit_of_their_own(index: int, size: float) -> None:
    name = START[index].tolerance
    size *= 20.0 if name == "acceleration-differenced" else 1.0
    wild = [replace(row, maximum=size) if row is START[index] else row for row in START]
    evidence = with_errors(rows=(*ROWS, *wild))
    assert {"CC116"} <= failing(evidence) <= {"CC116", "CC109"}
    assert name in by_rule(evidence)["CC116"].text


def test_the_start_may_be_off_by_half_a_steps_acceleration_and_not_without_end() -> None:
    half_a_step = HEALTHY.errors.of_scene.step_rad / 2
    late = [replace(START[0], maximum=half_a_step), replace(START[3], maximum=0.5)]
    assert {f.level for f in judge(with_errors(rows=(*ROWS, *late)))} == {"pass"}
    wild = (*ROWS, replace(START[0], maximum=0.2))
    assert "CC116" in failing(with_errors(rows=wild, conditioning=1e-9, jolt=1e9))  # singular


TRIED = "Tried: it helps."
FLOOR = {n: replace(HEALTHY, convergence=FLAT, profile=n) for n in ("as-shipped", "tuned")}


@pytest.mark.parametrize(
    ("evidence", "rule", "said", "not_said"),
    [
        (FLOOR["as-shipped"], "CC110", "use profile tuned", "nothing else"),
        (FLOOR["tuned"], "CC110", "change the model of the engine", "profile tuned"),
        (with_row(row("angle", maximum=3.0), remedy=TRIED), "CC103", TRIED, "servo"),
        (with_row(row("drive", maximum=3.0), remedy=TRIED), "CC102", "servo", TRIED),
        (replace(HEALTHY, status="diverged", profile="tuned"), "CC101", "shorter step", "tuned"),
    ],
)
def test_a_cure_is_what_was_tried_and_does_not_send_a_cell_where_it_is(
    evidence: Evidence, rule: str, said: str, not_said: str
) -> None:
    cure = by_rule(evidence)[rule].cure
    assert cure == said if said == TRIED else said in cure
    assert not_said not in cure


def test_a_run_that_did_not_end_well_fails_with_its_reason_and_is_told_one_cure() -> None:
    ended = with_row(row("angle", maximum=3.0), status="diverged", reason="it came apart")
    found = by_rule(ended)
    assert found["CC101"].level == "fail"
    assert "diverged" in found["CC101"].text
    assert "it came apart" in found["CC101"].text
    assert (found["CC103"].level, found["CC103"].cure) == ("fail", "")


def over(floor: float, error: float) -> list[float]:
    return [floor + error / 4**k for k in range(3)]


NONE = math.nan
TRUTH = {"known": 4e-5}
"""What the truth may be off by, or what solves the joints."""


@pytest.mark.parametrize(
    ("errors", "known", "trend", "floor"),
    [
        (over(7.5e-4, 1e-4), {}, "does not shrink", 7.5e-4),
        (over(1e-4, 1e-3), {}, "levels off", 1e-4),
        (over(1e-8, 1e-3), {}, "shrinks", NONE),  # a small floor far below the error
        ((7e-4, 7e-4, 7e-4), {}, "does not shrink", 7e-4),
        ((7.5e-4, 8.3e-4, 8.7e-4), {}, "does not shrink", 8.7e-4),  # wanders a little upwards
        ((3e-10, 4e-13, 6e-13), {}, "at rounding", NONE),
        ((8e-5, 4e-5, 3e-5), TRUTH, "as the reference", NONE),  # all of it may be the truth's
        ((3e-4, 1.0e-4, 5e-5), TRUTH, "shrinks", NONE),  # down to a floor that may be
        ((3e-4, 2.5e-4, 2.4e-4), TRUTH, "does not shrink", 2.375e-4),
        ((1e-3, 1e-4, math.nan), {}, "diverges", NONE),
        ((1e-3, 1e-4, math.inf), {"known": 1.0}, "diverges", NONE),
        ((1e-9, 2e-10, 3e-9), {"solved": 4e-9}, "as solved", NONE),
        ((1e-9, 2e-10, 3e-9), {"solved": 2e-9}, "grows", NONE),
        ((5.8e-4, 5.4e-5, 1.5e-5), {}, "levels off", 1.5e-5 - 3.9e-5 / (526 / 39 - 1)),
        ((5.8e-4, 5.4e-5, 1.5e-5), {"cancels": True}, "shrinks", NONE),
        ((5.8e-4, 5.4e-5, 5.0e-5), {"cancels": True}, "levels off", 5e-5 - 4e-6 / (526 / 4 - 1)),
    ],
)
def test_three_errors_have_a_trend_and_a_floor(
    errors: tuple[float, ...], known: dict[str, float], trend: str, floor: float
) -> None:
    found = halved(*errors, **known)
    assert found.trend == trend
    assert found.floor == pytest.approx(floor, rel=1e-9, nan_ok=True)
    if known is TRUTH and trend != "grows":
        assert halved(*errors).trend in ("levels off", "shrinks", "does not shrink")


def test_words_tell_an_order_a_floor_and_growth_and_two_steps_are_too_few_for_them() -> None:
    found = halved(*(1e-3 / 2 ** (1.5 * k) for k in range(3)))
    assert found.words == "order 1.5"
    assert found.order == pytest.approx(1.5)
    assert halved(*over(7.5e-4, 1e-4)).words == "does not shrink: floor 7.5e-4"
    assert halved(1e-6, 2e-6, 4e-6).words == "does not shrink: it grows"
    with pytest.raises(ValueError, match="a floor needs three"):
        convergence((1e-3, 5e-4), (1e-3, 1e-3), "rad")
