"""What advice chooses from."""

from __future__ import annotations

from dataclasses import replace

from reports.advise.choices import OWN, Choice, choices
from reports.plan.study import load_study
from sim.registry import engine, usual
from sim.settings import resolved


def test_all_profiles_and_the_variants_of_the_shipped_study_are_there() -> None:
    every = choices(usual(), ())
    labels = [choice.label for choice in every]
    for name in usual():
        assert {f"{name} {profile}" for profile in engine(name).profiles} <= set(labels)
    variants = [one for each in load_study(None).variants for one in each.each()]
    assert sorted(labels) == sorted(f"{one.engine} {one.name}" for one in variants)
    for choice in every:
        assert choice.settings.keys() == engine(choice.engine).profiles["tuned"].settings.keys()


def test_only_the_engines_asked_for_are_told_of() -> None:
    assert {choice.engine for choice in choices(["pymunk"], ())} == {"pymunk"}


def test_a_variant_like_another_choice_is_left_out_and_one_of_its_name_told_apart() -> None:
    settings = resolved(engine("pymunk").profiles["tuned"], {"iterations": 77})
    same = Choice("pymunk", "alias", "tuned", resolved(engine("pymunk").profiles["tuned"], None))
    mine = Choice("pymunk", "no bias", "tuned", settings)
    plain = choices(["pymunk"], ())
    every = choices(["pymunk"], (same, mine, replace(mine, name="twice")))
    (added,) = [choice for choice in every if choice not in plain]
    assert (added.name, added.settings) == ("no bias (study)", settings)


def test_words_tell_what_is_not_as_shipped() -> None:
    words = {choice.label: choice.words for choice in choices(["pymunk"], ())}
    assert words["pymunk as-shipped"] == OWN
    assert words["pymunk no bias"] == "error_bias 0"
