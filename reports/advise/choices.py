"""The settings that advice chooses from: profiles of the engines, and variants of studies."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace

from models.errors import EngineError
from reports.plan.study import load_study
from reports.results.variants import OWN, value_text
from sim.engine import SettingValue
from sim.registry import engine
from sim.settings import profile_of, resolved

USUAL = "as-shipped"
"""The profile of an engine's own defaults."""


@dataclass(frozen=True)
class Choice:
    """Complete settings of an engine, by the name of a profile or of a study's variant; ``profile``
    is what they were derived from."""

    engine: str
    name: str
    profile: str
    settings: Mapping[str, SettingValue] = field(repr=False)

    @property
    def label(self) -> str:
        return f"{self.engine} {self.name}"

    @property
    def words(self) -> str:
        """What is set otherwise than the engine is shipped."""
        profiles = engine(self.engine).profiles
        own = resolved(profiles[USUAL], None) if USUAL in profiles else {}
        differing = [f"{n} {value_text(v)}" for n, v in self.settings.items() if own.get(n) != v]
        return ", ".join(differing) or OWN

    @property
    def in_seconds(self) -> tuple[str, ...]:
        """The settings that make errors depend on the speed."""
        return engine(self.engine).in_seconds(self.settings)

    @property
    def key(self) -> str:
        """What it is told by, whatever it is called."""
        return key_of(self.engine, self.settings)


def key_of(name: str, settings: Mapping[str, object]) -> str:
    """An engine with complete settings, as a text."""
    return f"{name} {json.dumps(dict(settings), sort_keys=True)}"


def choices(engines: Sequence[str], others: Iterable[Choice]) -> tuple[Choice, ...]:
    """All profiles of the engines, the variants of the shipped study, and what others there are.

    Variants with the settings of another choice are left out, whatever they are called.
    """
    every = [
        Choice(name, profile.name, profile.name, resolved(profile, None))
        for name in engines
        for profile in engine(name).profiles.values()
    ]
    for choice in (*_shipped(), *others):
        if choice.engine in engines and choice.key not in [each.key for each in every]:
            taken = any(choice.label == other.label for other in every)
            every.append(replace(choice, name=f"{choice.name} (study)") if taken else choice)
    return tuple(sorted(every, key=lambda choice: engines.index(choice.engine)))


def _shipped() -> Iterator[Choice]:
    """The variants of the shipped study, of the engines that are installed."""
    for variant in (one for several in load_study(None).variants for one in several.each()):
        with suppress(EngineError):
            settings = resolved(profile_of(engine(variant.engine), variant.profile), variant.chosen)
            yield Choice(variant.engine, variant.name, variant.profile, settings)
