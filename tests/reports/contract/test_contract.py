"""Every clause is seen to break by a fault of its own; what comes of an engine that ends its
process, hangs or raises; and what is printed of the clauses."""

from dataclasses import replace
from pathlib import Path

import pytest
from rich.console import Console

from models.errors import EngineError
from reports.contract.clauses import CLAUSES
from reports.contract.ruling import SCENES, Ruling, named, put_to, refuses_all, show
from reports.workers.isolated import Limits
from sim.engine import Unreported
from sim.registry import engine
from tests.worlds.own_engines import fresh
from tests.worlds.tiers import few, slow, slowly
from tests.worlds.wrong_engines import (
    FAULTS,
    forces_of_some,
    late_accelerations,
    rounded_to_single,
)

FOURBAR = ("fourbar-lecture-1",)
ONE_EACH = {clause: name for name, (clause, *_) in FAULTS.items()}.values()
"""The last fault of each clause."""


@pytest.mark.parametrize("name", few(FAULTS, ONE_EACH, "another fault of its clause"))
def test_a_fault_breaks_its_clause(name: str) -> None:
    clause, words, fault = FAULTS[name]
    breaches = put_to(fault(engine("pymunk")), CLAUSES[clause], FOURBAR).breaches
    assert any(words in text for text in breaches), breaches


def test_accelerations_of_another_instant_are_seen() -> None:
    ruling = put_to(late_accelerations(engine("mujoco")), CLAUSES["EC42"], FOURBAR)
    assert "-1.00 steps from its sample, and acceleration_shift is +0.00" in ruling.breaches[0]


def test_single_precision_that_is_declared_breaks_nothing() -> None:
    single = rounded_to_single(engine("pymunk"))
    single = replace(single, precision="single", floor=2e-6)
    for name in ("EC14", "EC15", "EC21", "EC22", "EC33", "EC51", "EC52", "EC53", "EC56", "EC61"):
        ruling = put_to(single, CLAUSES[name], FOURBAR)
        assert (ruling.breaches, ruling.scenes) == ((), FOURBAR), name


@slow("0.7 s: six clauses, which are broken above")
def test_forces_of_some_joints_break_nothing_where_the_others_are_declared() -> None:
    some = forces_of_some(Unreported(pins=frozenset("A"), torque=True))
    for name in ("EC81", "EC82", "EC83", "EC84", "EC85", "EC86"):
        ruling = put_to(some, CLAUSES[name], FOURBAR)
        assert (ruling.breaches, ruling.scenes) == ((), FOURBAR), name


def test_the_reason_for_no_forces_is_told() -> None:
    silent = replace(engine("pymunk"), forces_of="nothing", no_forces="its joints are soft")
    ruling = put_to(silent, CLAUSES["EC82"], FOURBAR)
    assert ruling.untried[0].endswith("reports no forces: its joints are soft")


def test_every_clause_has_a_fault_and_says_all_that_it_has_to() -> None:
    assert {clause for clause, *_ in FAULTS.values()} == set(CLAUSES)
    for clause in CLAUSES.values():
        assert clause.title
        assert [text[-1:] for text in (clause.why, clause.cure)] == [".", "."]


def told(*rulings: Ruling) -> str:
    console = Console(width=100, record=True, force_terminal=False)
    with console.capture() as heard:
        show(console, "mine 1.0", rulings, SCENES)
    return "\n".join(line.rstrip() for line in heard.get().splitlines())


def test_what_is_broken_is_told_with_its_reason_and_its_cure() -> None:
    breaches = tuple(f"{name}: it is off" for name in SCENES)
    text = told(Ruling("EC11", SCENES[:1]), Ruling("EC41", breaches=breaches))
    assert "ok  EC11  profiles as-shipped" in text
    assert "OUT EC41  velocities belong" in text
    assert "          sixbar-watt: it is off\n" in text
    assert "          and 2 more\n          why: A velocity changes" in text
    assert "          cure: Set Facts.velocity_shift" in text
    assert "BREAKS THE CONTRACT: mine 1.0, 1 clause of 2: EC41" in text


def test_what_was_refused_is_told_once_and_holds_nothing() -> None:
    untried = tuple(f"{name}: it has no sliders" for name in SCENES[2:])
    text = told(*(Ruling(name, SCENES[:2], untried=untried) for name in ("EC21", "EC31")))
    assert "HOLDS THE CONTRACT: mine 1.0, 2 of 2 clauses" in text
    assert "Tried on fourbar-lecture-1, sixbar-watt." in text
    assert text.count("Refused: shaper: it has no sliders") == 1
    refused = Ruling("EC21", untried=tuple(f"{name}: no" for name in SCENES))
    rulings = [Ruling("EC11", SCENES[:1]), refused, Ruling("EC71", SCENES[:1])]
    assert refuses_all(rulings)
    nothing = told(*rulings)
    assert "-   EC21" in nothing
    assert "NOTHING COULD BE TRIED: mine 1.0 refuses every scene" in nothing
    assert not refuses_all([Ruling("EC11", SCENES[:1])])
    assert not refuses_all([Ruling("EC21", SCENES[:1]), Ruling("EC54", untried=("shaper: no",))])


@pytest.mark.parametrize(
    ("code", "limit_s", "reason"),
    [
        ("import os\nos._exit(3)\n", 600.0, "the engine ended its process (exit code 3)"),
        slowly("while True: pass\n", 0.5, "no end within 0.5 s", reason="a limit on an import"),
    ],
)
def test_what_ends_or_hangs_when_it_is_imported_is_said(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, code: str, limit_s: float, reason: str
) -> None:
    (tmp_path / "dire.py").write_text(code)
    with fresh(tmp_path, monkeypatch), pytest.raises(EngineError) as told_of:
        named("dire:ENGINE", Limits(limit_s, 4.0))
    assert reason in str(told_of.value)
    assert "correct that first" in str(told_of.value)
