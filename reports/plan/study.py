"""A study: the grid of scenes, engine settings and steps that a sweep runs, from TOML or YAML.

::

    scenes = ["fourbar-lecture-1", "my-scene.toml"]   # all shipped ones if left out
    steps_per_turn = [90, 180, 360, 720]
    turns = 2
    forces = false                     # reactions and torque too, of engines that report them

    segments = [4, 8, 16, 32]          # of each elastic link; 16 if left out
    springs = ["plain", "corrected"]   # between them, or "beam"; plain if left out
    times_held = [1, 2, 4]             # steps of these, over the fewest that the segments hold with

    # or, of mechanisms that are let go, in place of steps_per_turn and turns:
    free = true
    dt_s = [2e-3, 1e-3, 5e-4]
    duration_s = 10                    # that of each scene if left out

    [[variants]]
    name = "stiff"                     # how tables and legends call it
    engine = "mujoco"
    profile = "as-shipped"             # the settings it starts from
    settings = { solref_timeconst_steps = [2, 4], solimp_dmin = 0.9999 }

A list of values makes a variant for each of them, or for each combination of several lists.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, StrictFloat, StrictInt, ValidationError
from pydantic_core import ErrorDetails

from models.errors import CrankcheckError, cut, listed, shown, suggestion
from models.regular import UnreadableError, regular_text
from models.toml_text import tables
from reports.plan.yaml_text import value
from sim.engine import SettingValue

DEFAULT = Path(__file__).parent / "studies" / "default.toml"
StudyValue = StrictInt | StrictFloat | str
UNITS = {"steps_per_turn": " in a turn", "dt_s": ""}
"""What the steps of a study are in, by its field."""
VariantName = Annotated[str, Field(min_length=1, max_length=80)]


class Variant(BaseModel):
    """An engine with settings: a profile, and what of it is overridden, by one value or several."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    engine: VariantName
    profile: VariantName
    name: str = Field(default="", max_length=80, pattern=r"^[^\x00-\x1f\x7f]*$")
    reason: str = ""
    settings: dict[str, StudyValue | Annotated[list[StudyValue], Field(min_length=1)]] = Field(
        default_factory=dict
    )

    @property
    def lists(self) -> dict[str, list[StudyValue]]:
        """The values of each setting."""
        return {k: v if isinstance(v, list) else [v] for k, v in self.settings.items()}

    def each(self) -> list[Variant]:
        """One variant per combination of the listed values, named after them."""
        lists = self.lists
        several = [name for name, values in lists.items() if len(values) > 1]
        variants = []
        for values in itertools.product(*lists.values()):
            chosen = dict(zip(lists, values, strict=True))
            named = several if self.name else list(chosen)
            parts = [self.name or self.profile, *(f"{k}={_short(chosen[k])}" for k in named)]
            variants.append(
                self.model_copy(update={"name": ", ".join(parts), "settings": dict(chosen)})
            )
        return variants

    @property
    def chosen(self) -> dict[str, SettingValue]:
        """The overrides of a variant with one value each."""
        return {k: v for k, v in self.settings.items() if not isinstance(v, list)}


class Study(BaseModel):
    """What a sweep runs, and how; with ``times_held`` scenes whose links bend have steps of their
    own, that their segments hold with."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    scenes: list[VariantName] = Field(default_factory=list)
    variants: list[Variant] = Field(min_length=1)
    steps_per_turn: list[float] = Field(default_factory=list)
    turns: float = 2.0
    drive: Literal["prescribed", "servo"] = "prescribed"
    forces: bool = False
    free: bool = False
    dt_s: list[float] = Field(default_factory=list)
    duration_s: float | None = None
    segments: list[StrictInt] = Field(default_factory=list)
    springs: list[Literal["plain", "corrected", "beam"]] = Field(default_factory=list)
    times_held: list[float] = Field(default_factory=list)

    @property
    def lists(self) -> tuple[str, ...]:
        """The field that has the steps of its scenes, and the one of other scenes."""
        return tuple(UNITS)[:: -1 if self.free else 1]

    @property
    def steps(self) -> list[float]:
        """What the cells of a line differ in: steps in a turn, or of free motion seconds."""
        return list(getattr(self, self.lists[0]))


def load_study(path: Path | None) -> Study:
    """The study of a file, by its ending, or the shipped one for None.

    Raises
    ------
    CrankcheckError
        Not to be read, neither TOML nor YAML, or with keys and values that a study has not.
    """
    path = path or DEFAULT
    kind = path.suffix.lower()
    if kind not in (".toml", ".yaml", ".yml"):
        raise CrankcheckError(
            f"study {path}: found {kind or 'no ending'}; use .toml, .yaml or .yml"
        )
    try:
        text = regular_text(path)
        raw = tables(text) if kind == ".toml" else value(text)
    except UnreadableError as error:
        raise CrankcheckError(f"study {path}: {error}") from None
    try:
        study = Study.model_validate(raw)
    except ValidationError as error:
        faults = list(dict.fromkeys(_fault(fault) for fault in error.errors()))
        if isinstance(raw, dict) and not {"steps_per_turn", "free"} & set(raw):
            faults.append("steps_per_turn: missing; add it")
        raise CrankcheckError(listed(f"study {path}", faults)) from None
    if faults := list(_unsaid(study)):
        raise CrankcheckError(listed(f"study {path}", faults))
    return study


def _unsaid(study: Study) -> Iterator[str]:
    """What is missing where scenes are driven or let go, and what belongs to the other."""
    needed, other = study.lists
    if not study.steps:
        yield f"{needed}: missing; add it"
    if getattr(study, other):
        yield f"{other}: found it with free = {str(study.free).lower()}; give {needed}"
    if study.duration_s is not None and not study.free:
        yield "duration_s: found it with free = false; give turns"
    if study.free and study.drive != "prescribed":
        yield f"drive: found {study.drive!r} with free = true; leave it out"


def _fault(fault: ErrorDetails) -> str:
    """One fault of a study file: key, what was found, what would work."""
    parts = [str(part) for part in fault["loc"] if not str(part).startswith(("list[", "constr"))]
    key, message = ".".join(map(cut, parts)) or "study", fault["msg"]
    if fault["type"] == "extra_forbidden":
        keys = Variant.model_fields if parts[0] == "variants" else Study.model_fields
        return f"{key}: unknown key; {suggestion(parts[-1], keys, 'known:', 1, 0.6)}"
    if fault["type"] == "missing":
        return f"{key}: missing; add it"
    if not parts:
        return "study: a table of scenes, variants and steps_per_turn is needed"
    return f"{key}: found {shown(fault['input'])}; {message[0].lower()}{message[1:]}"


def _short(value: object) -> str:
    """A value as short as it can be told."""
    return f"{value:g}" if isinstance(value, float) else str(value)
