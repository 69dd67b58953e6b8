"""Every rule is seen to pass, and to fail."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import pytest

from models.scene import Scene
from reports.compare.errors import Error, Errors, largest
from reports.judge.rules import RULES, judge
from reports.judge.rules.rule import Evidence, Finding
from reports.judge.three_steps import Convergence, convergence
from reports.judge.tolerance import DEFAULTS, Limit

LIMITS = {name: Limit(1e-3, "default") for name in DEFAULTS}
KINDS = {
    "drive": "driver",
    "angle": "link",
    "displacement": "slider",
    "position": "point",
    "gap": "point",
    "velocity": "link",
    "acceleration": "link",
}


def row(quantity: str, source: str = "reported", maximum: float = 1e-4) -> Error:
    return Error(
        quantity=quantity,
        body_kind=KINDS[quantity],  # type: ignore[arg-type]  # a plain text is one of the literals
        body="rocker",
        source=source,  # type: ignore[arg-type]  # as above
        kind="total",
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


ROWS = (
    *(row(quantity) for quantity in KINDS),
    row("velocity", "differenced"),
    row("acceleration", "differenced"),
)
START = (
    replace(row("velocity"), kind="start"),
    replace(row("velocity", "differenced"), kind="start"),
    replace(row("acceleration"), kind="start"),
    replace(row("acceleration", "differenced"), kind="start"),
)
OF_FORCES = "CC120"
"""The first of the rules that have something to say where forces were asked for."""
HEALTHY = Evidence(
    status="ok",
    reason="",
    stopped_at_s=1.0,
    errors=Errors((*ROWS, *START), (), (), 1.0, 0.8, 0.01, jolt=0.5),
    limits=LIMITS,
    convergence=convergence((4e-3, 2e-3, 1e-3), (16e-5, 4e-5, 1e-5), "rad"),
    unasked=(),
    absent=(),
)


def with_errors(**changed: object) -> Evidence:
    """The healthy evidence with something else in its errors."""
    return replace(HEALTHY, errors=replace(HEALTHY.errors, **changed))


def with_row(new: Error) -> Evidence:
    """The healthy evidence with one row in place of the one of its kind."""
    rows = tuple(
        new if (old.quantity, old.source) == (new.quantity, new.source) else old for old in ROWS
    )
    return with_errors(rows=(*rows, *START))


def by_rule(evidence: Evidence) -> dict[str, Finding]:
    return {finding.rule: finding for finding in judge(evidence)}


def test_a_healthy_run_passes_every_rule() -> None:
    findings = judge(HEALTHY)
    assert [finding.rule for finding in findings] == [name for name in RULES if name < OF_FORCES]
    assert {finding.level for finding in findings} == {"pass"}


def test_every_rule_says_what_why_and_what_to_do() -> None:
    for id_, rule in RULES.items():
        assert rule.id == id_
        assert rule.title
        assert rule.explanation.endswith(".")
        assert rule.cure.endswith((".", ")."))


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
@pytest.mark.parametrize("size", [1.01e-3, 1.0, math.nan, math.inf])
def test_an_error_over_its_limit_fails_its_own_rule(
    id_: str, quantity: str, source: str, size: float
) -> None:
    found = by_rule(with_row(row(quantity, source, size)))
    failed = {id_} if math.isfinite(size) else {id_, "CC109"}
    if math.isnan(size) or math.isinf(size):
        failed |= {rule for rule in found if found[rule].level == "fail"} & {"CC111"}
    assert {rule for rule, finding in found.items() if finding.level == "fail"} == failed
    assert found[id_].limit == 1e-3
    assert "rocker" in found[id_].text


@pytest.mark.parametrize("first", [True, False])
def test_a_number_that_is_missing_is_worse_than_any_other(first: bool) -> None:
    rows = [row("angle", maximum=math.nan), row("angle", maximum=1e300)]
    worst = largest(rows if first else reversed(rows))
    assert math.isnan(worst.maximum)


def test_an_error_at_its_limit_passes() -> None:
    found = {f.rule: f.level for f in judge(with_row(row("angle", maximum=1e-3)))}
    assert found["CC103"] == "pass"


@pytest.mark.parametrize("status", ["diverged", "locked", "branch-changed", "crashed", "timeout"])
def test_a_run_that_did_not_end_well_fails_with_its_reason(status: str) -> None:
    (finding, *_) = judge(replace(HEALTHY, status=status, reason="it came apart"))
    assert (finding.rule, finding.level) == ("CC101", "fail")
    assert status in finding.text
    assert "it came apart" in finding.text


def test_a_run_without_a_log_is_judged_by_its_status_alone() -> None:
    findings = judge(Evidence("unsupported", "no mass", 0.0, None, {}))
    assert [(f.rule, f.level) for f in findings] == [("CC101", "fail")]


def test_a_number_that_is_missing_outside_the_limits_still_fails() -> None:
    start = replace(row("velocity", maximum=math.nan), kind="start")
    found = by_rule(with_errors(rows=(*ROWS, start)))
    assert found["CC109"].level == "fail"
    assert "velocity of rocker" in found["CC109"].text


def test_an_error_that_does_not_shrink_is_advice_that_names_the_floor() -> None:
    flat = convergence((4e-3, 2e-3, 1e-3), (8e-4, 7.6e-4, 7.5e-4), "rad")
    found = by_rule(replace(HEALTHY, convergence=flat))
    assert found["CC110"].level == "advice"
    assert "does not shrink: floor 7.5e-04 rad" in found["CC110"].text


@pytest.mark.parametrize("gated", [True, False])
@pytest.mark.parametrize(
    "seen",
    [
        convergence((4e-3, 2e-3, 1e-3), (1e-6, 2e-6, 4e-6), "rad"),
        convergence((4e-3, 2e-3, 1e-3), (1e-6, math.nan, 1e-7), "rad"),
        convergence((4e-3, 2e-3, 1e-3), (16e-5, 4e-5, 1e-5), "rad", faults=["it diverged"]),
        convergence((4e-3, 2e-3, 1e-3), (16e-5, 4e-5, 1e-5), "rad", over=["angle too large"]),
    ],
    ids=["grows", "no number", "finer run ended badly", "over the finer limit"],
)
def test_finer_steps_that_do_worse_fail_where_the_cell_is_gated(
    seen: Convergence, gated: bool
) -> None:
    found = by_rule(replace(HEALTHY, convergence=seen, gated=gated))
    assert found["CC110"].level == ("fail" if gated else "advice")
    assert all(fault in found["CC110"].text for fault in (*seen.faults, *seen.over))


def test_a_log_that_is_not_whole_fails_a_run_that_claims_to_be_well() -> None:
    found = by_rule(with_errors(incomplete="50 samples, not the 721"))
    assert (found["CC115"].level, found["CC115"].text) == ("fail", "50 samples, not the 721")
    diverged = replace(with_errors(incomplete="50 samples, not the 721"), status="diverged")
    assert "CC115" not in by_rule(diverged)


def test_a_run_that_is_well_and_logged_nothing_fails() -> None:
    found = {f.rule: f.level for f in judge(Evidence("ok", "", 1.0, None, {}))}
    assert found["CC115"] == "fail"


def test_what_is_missing_from_the_log_is_named() -> None:
    found = by_rule(with_errors(missing=("link rocker", "gap of C")))
    assert found["CC109"].level == "fail"
    assert "link rocker, gap of C" in found["CC109"].text


@pytest.mark.parametrize("index", range(len(START)))
@pytest.mark.parametrize("size", [0.1, math.nan])
def test_rates_of_the_first_samples_have_a_limit_of_their_own(index: int, size: float) -> None:
    size *= 20.0 if START[index].tolerance == "acceleration-differenced" else 1.0
    wild = [replace(row, maximum=size) if row is START[index] else row for row in START]
    found = by_rule(with_errors(rows=(*ROWS, *wild)))
    assert found["CC116"].level == "fail"
    assert START[index].tolerance in found["CC116"].text
    assert {f.rule for f in found.values() if f.level == "fail"} <= {"CC116", "CC109"}


def test_the_start_may_be_off_by_half_a_steps_acceleration() -> None:
    half_a_step = HEALTHY.errors.step_rad / 2
    late = [replace(START[0], maximum=half_a_step), replace(START[3], maximum=0.5)]
    assert {f.level for f in judge(with_errors(rows=(*ROWS, *late)))} == {"pass"}


def test_no_singular_position_excuses_a_start_without_end() -> None:
    late = [replace(START[0], maximum=0.2)]
    singular = with_errors(rows=(*ROWS, *late), conditioning=1e-9, jolt=1e9)
    found = {rule: finding.level for rule, finding in by_rule(singular).items()}
    assert found["CC116"] == "fail"


FLAT = convergence((4e-3, 2e-3, 1e-3), (8e-4, 7.6e-4, 7.5e-4), "rad")


@pytest.mark.parametrize(
    ("profile", "said", "not_said"),
    [
        ("as-shipped", "use profile tuned", "nothing else"),
        ("tuned", "change what the engine models", "profile tuned"),
    ],
)
def test_a_cure_does_not_send_a_cell_where_it_is(profile: str, said: str, not_said: str) -> None:
    evidence = replace(HEALTHY, convergence=FLAT, profile=profile)
    cure = next(f.cure for f in judge(evidence) if f.rule == "CC110")
    assert said in cure
    assert not_said not in cure


def test_what_was_tried_is_the_cure_of_all_that_settings_can_mend() -> None:
    evidence = replace(with_row(row("angle", maximum=3.0)), remedy="Tried: it helps.")
    cures = {f.rule: f.cure for f in judge(evidence) if f.level == "fail"}
    assert cures["CC103"] == "Tried: it helps."
    late = replace(with_row(row("drive", maximum=3.0)), remedy="Tried: it helps.")
    cures = {f.rule: f.cure for f in judge(late) if f.level == "fail"}
    assert "servo" in cures["CC102"]


def test_a_run_that_did_not_end_well_is_told_one_cure() -> None:
    evidence = replace(with_row(row("angle", maximum=3.0)), status="diverged", profile="tuned")
    cures = {f.rule: f.cure for f in judge(evidence) if f.level == "fail"}
    assert cures["CC103"] == ""
    assert "shorter step" in cures["CC101"]
    assert "profile tuned" not in cures["CC101"]


def test_only_what_fails_or_is_advised_has_a_cure() -> None:
    assert {finding.cure for finding in judge(HEALTHY)} == {""}


def test_convergence_is_not_judged_where_it_was_not_asked_for() -> None:
    assert "CC110" not in {f.rule for f in judge(replace(HEALTHY, convergence=None))}


def test_the_reference_handed_back_is_too_good() -> None:
    same = tuple(
        replace(r, maximum=0.0) if r.quantity in ("angle", "displacement", "position") else r
        for r in ROWS
    )
    found = by_rule(with_errors(rows=same))
    assert found["CC111"].level == "fail"


@pytest.mark.parametrize("bound", [2e-4, math.inf, math.nan])
def test_a_reference_that_does_not_know_better_than_the_limit_can_not_judge(bound: float) -> None:
    unsure = replace(row("angle"), bound=bound)
    found = by_rule(with_row(unsure))
    assert found["CC112"].level == "fail"
    assert "reference not certain: angle of rocker" in found["CC112"].text


def test_a_healthy_fake_run_passes_all_rules_but_is_it_two_computations(
    fourbar: Scene, errors_of: Callable[..., Errors]
) -> None:
    from reports.judge.tolerance import limits

    errors = errors_of(fourbar)
    evidence = Evidence("ok", "", 1.0, errors, limits(fourbar, errors, {}))
    assert {f.rule for f in judge(evidence) if f.level == "fail"} <= {"CC111"}
