"""A study with a user's choices in place of its own."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from models.errors import CrankcheckError, shown
from reports.plan.requirements import chosen_engines, free_names
from reports.plan.steps import FREE_STEPS_S, TIMES_HELD
from reports.plan.study import Study, StudyValue, Variant
from sim.engine.settings import profile_of
from sim.registry import engine

Overrides = Mapping[str, Mapping[str, StudyValue | list[StudyValue]]]
"""Values of settings by engine, one or several of each."""


@dataclass(frozen=True)
class StudyChoice:
    """Choices in place of a study's own; an empty one, or None, leaves the study's own."""

    scenes: Sequence[str] = ()
    engines: Sequence[str] = ()
    profiles: Sequence[str] = ()
    steps_per_turn: Sequence[float] = ()
    turns: float | None = None
    overrides: Overrides = field(default_factory=dict)
    forces: bool = False
    free: bool = False
    dt_s: Sequence[float] = ()
    duration_s: float | None = None
    segments: Sequence[int] = ()
    springs: Sequence[str] = ()
    facets: Sequence[int] = ()

    def command(self, folder: object, study: object = None) -> list[str]:
        """Return the words of the equivalent `crankcheck sweep`."""
        numbers = {"--steps-per-turn": self.steps_per_turn, "--dt": self.dt_s}
        numbers |= {"--segments": self.segments, "--facets": self.facets}
        numbers |= {"--turns": [self.turns or 0.0], "--duration": [self.duration_s or 0.0]}
        words = {name: ",".join(f"{n:.12g}" for n in own if n) for name, own in numbers.items()}
        words |= {"--springs": ",".join(self.springs), "--study": str(study or "")}
        options = [(name, text) for name, text in words.items() if text]
        options += [("--engine", name) for name in self.engines]
        options += [("--profile", name) for name in self.profiles]
        for owner, chosen in self.overrides.items():
            for name, values in chosen.items():
                several = values if isinstance(values, list) else [values]
                options.append(("--set", f"{owner}.{name}={','.join(map(str, several))}"))
        flags = ["--forces"] * self.forces + ["--free"] * self.free
        own = [*self.scenes, *flags, *(word for option in options for word in option)]
        return ["crankcheck", "sweep", "-o", str(folder), *own]


def chosen_study(study: Study, choice: StudyChoice, *, is_shipped: bool) -> Study:
    """Return the study with a choice in place of its own values.

    Settings are varied in every variant of their engine; of the shipped study, in profile tuned
    alone, or in the named profiles. A named engine without a variant in the shipped study is there
    with all its profiles. Raises CrankcheckError for an unknown engine or profile, and for an
    engine of which another study has no variant.
    """
    engines = chosen_engines(choice.engines, notes=bool(choice.engines))
    variants = [_by_name(variant) for variant in study.variants]
    if choice.engines and is_shipped:
        there = {variant.engine for variant in variants}
        added = [(e, p) for e in engines if e not in there for p in engine(e).profiles]
        variants += [Variant(engine=e, profile=p) for e, p in added]
    if choice.profiles or (choice.overrides and is_shipped):
        profiles = list(dict.fromkeys(choice.profiles or ("tuned",)))
        named = [(e, profile_of(engine(e), p).name) for p in profiles for e in engines]
        variants = [Variant(engine=e, profile=p) for e, p in named]
    if choice.engines:  # variants of a study are named
        variants = [variant for variant in variants if variant.engine in engines]
    for name, overrides in choice.overrides.items():
        variants = [
            v.model_copy(update={"settings": {**v.settings, **overrides}})
            if v.engine == name
            else v
            for v in variants
        ]
    there = {variant.engine for variant in variants}
    if lost := [name for name in engines if choice.engines and name not in there]:
        raise CrankcheckError(
            f"--engine {', '.join(lost)}: the study has no variant of it; add --profile"
        )
    if not choice.engines:  # once it is known which of the study's own run
        chosen_engines([variant.engine for variant in variants])
    return study.model_copy(
        update={
            "variants": variants,
            "forces": study.forces or choice.forces,
            "segments": list(choice.segments) or study.segments,
            "springs": list(choice.springs) or study.springs,
            "facets": list(choice.facets) or study.facets,
            **(_free_lines(study, choice) if study.free or choice.free else _driven(study, choice)),
        }
    )


def _driven(study: Study, choice: StudyChoice) -> dict[str, object]:
    """Return the fields for driven scenes. Raises CrankcheckError for options of free motion."""
    for option, value in (("--dt", choice.dt_s), ("--duration", choice.duration_s)):
        if value:
            raise CrankcheckError(f"{option}: this option is for free motion; add --free")
    return {
        "scenes": list(choice.scenes) or study.scenes,
        "steps_per_turn": list(choice.steps_per_turn) or study.steps_per_turn,
        "times_held": [] if choice.steps_per_turn else study.times_held,
        "turns": study.turns if choice.turns is None else choice.turns,
    }


def _free_lines(study: Study, choice: StudyChoice) -> dict[str, object]:
    """Return the fields for free motion: the shipped free scenes, where the study is driven and
    none is named. Raises CrankcheckError for turns."""
    if choice.steps_per_turn or choice.turns is not None:
        option = "--steps-per-turn" if choice.steps_per_turn else "--turns"
        raise CrankcheckError(
            f"{option}: free motion has no turns; give --dt and --duration, in seconds"
        )
    held = study.times_held or ([] if study.dt_s else list(TIMES_HELD))
    return {
        "free": True,
        "drive": "prescribed",
        "steps_per_turn": [],
        "scenes": free_names(choice.scenes or (study.scenes if study.free else ())),
        "dt_s": list(choice.dt_s) or study.dt_s or list(FREE_STEPS_S),
        "times_held": [] if choice.dt_s else held,
        "duration_s": study.duration_s if choice.duration_s is None else choice.duration_s,
    }


def study_engines(study: Study, named: Sequence[str]) -> list[str]:
    """Return the named engines, or else the usual ones and the study's own."""
    own = [] if named else [_by_name(variant).engine for variant in study.variants]
    return list(dict.fromkeys([*chosen_engines(named, notes=False), *own]))


def _by_name(variant: Variant) -> Variant:
    """Return the variant with the name of its engine, also if given as module and attribute."""
    if ":" not in variant.engine:
        return variant
    return variant.model_copy(update={"engine": engine(variant.engine).name})


def refuse_other_engine(owner: str, engines: Sequence[str], place: str) -> None:
    """Refuse settings of an engine that is not in ``engines``. Raises CrankcheckError."""
    if owner not in engines:
        raise CrankcheckError(
            f"{place}: {shown(owner)} is no engine of this sweep; it has {', '.join(engines)}"
        )
