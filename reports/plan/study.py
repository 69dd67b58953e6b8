"""A study: the grid of scenes, engine settings and steps that a sweep runs, from TOML or YAML.

::

    scenes = ["fourbar-lecture-1", "my-scene.toml"]   # all shipped ones if left out
    steps_per_turn = [90, 180, 360, 720]
    turns = 2
    forces = false                     # reactions and torque too, of engines that report them

    segments = [4, 8, 16, 32]          # of each elastic link; 16 if left out
    springs = ["plain", "corrected"]   # between them, or "beam"; plain if left out
    times_held = [1, 2, 4]             # steps over the fewest for the segments

    # or, for free motion, in place of steps_per_turn and turns:
    free = true
    dt_s = [2e-3, 1e-3, 5e-4]
    duration_s = 10                    # the scene's own if left out

    [[variants]]
    name = "stiff"                     # its name in tables and legends
    engine = "mujoco"
    profile = "as-shipped"             # the basis of its settings
    settings = { solref_timeconst_steps = [2, 4], solimp_dmin = 0.9999 }

A list of values makes a variant for each of them, or for each combination of several lists.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any, Literal

import yaml
from pydantic import BaseModel, ConfigDict, Field, StrictFloat, StrictInt
from yaml.constructor import ConstructorError

from models.errors import CrankcheckError, cut, listed
from models.files.faults import table_of
from models.files.inputs import DEEPEST, UnreadableError, refuse_extreme, regular_text, tables
from sim.engine import SettingValue

DEFAULT = Path(__file__).parent / "studies" / "default.toml"
StudyValue = StrictInt | StrictFloat | str
UNITS = {"steps_per_turn": " in a turn", "dt_s": ""}
"""Unit of the steps of a study, by its field."""
VariantName = Annotated[str, Field(min_length=1, max_length=80)]


class Variant(BaseModel):
    """An engine with settings: a profile, and its overrides, by one value or several."""

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
        """Values of each setting."""
        return {k: v if isinstance(v, list) else [v] for k, v in self.settings.items()}

    def each(self) -> list[Variant]:
        """Return one variant per combination of the listed values, named after them."""
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
        """Overrides of a variant with one value each."""
        return {k: v for k, v in self.settings.items() if not isinstance(v, list)}


class Study(BaseModel):
    """Content of a sweep; ``times_held`` gives elastic links steps for their segments."""

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
    facets: list[StrictInt] = Field(default_factory=list)

    @property
    def lists(self) -> tuple[str, ...]:
        """Field with the steps of its scenes, and the one of other scenes."""
        return tuple(UNITS)[:: -1 if self.free else 1]

    @property
    def steps(self) -> list[float]:
        """Steps of the cells of a line: steps in a turn, or of free motion seconds."""
        return list(getattr(self, self.lists[0]))


def load_study(path: Path | None) -> Study:
    """Return the study of a file, by its ending, or the shipped one for None. Raises
    CrankcheckError for a file that can not be read, is neither TOML nor YAML, or has other keys and
    values than a study."""
    path = path or DEFAULT
    kind = path.suffix.lower()
    if kind not in (".toml", ".yaml", ".yml"):
        raise CrankcheckError(
            f"study {path}: found {kind or 'no ending'}; use .toml, .yaml or .yml"
        )
    place = f"study {path}"
    try:
        text = regular_text(path)
        raw = tables(text) if kind == ".toml" else value(text)
    except UnreadableError as error:
        raise CrankcheckError(f"{place}: {error}") from None
    if not isinstance(raw, dict):
        raise CrankcheckError(f"{place}: a table of scenes, variants and steps_per_turn is needed")
    study = table_of(raw, Study, place)
    if faults := list(_unsaid(study)):
        raise CrankcheckError(listed(place, faults))
    return study


def _unsaid(study: Study) -> Iterator[str]:
    """Yield the missing fields of driven or free scenes, and fields that belong to the other."""
    needed, other = study.lists
    if not study.steps:
        yield f"{needed}: missing; add it"
    if getattr(study, other):
        yield f"{other}: found it with free = {str(study.free).lower()}; give {needed}"
    if study.duration_s is not None and not study.free:
        yield "duration_s: found it with free = false; give turns"
    if study.free and study.drive != "prescribed":
        yield f"drive: found {study.drive!r} with free = true; leave it out"


def _short(value: object) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value)


MOST_VALUES = 5_000
"""Most values, each counted per alias: ten lines can stand for a billion values."""
LONG = 40
"""Characters of a text that count as one value more."""
DIGITS = 100
"""Most characters of a number. A number to the base 60 takes time with the square of them."""
TOO_MANY = f"more than {MOST_VALUES} values, those of an alias counted each time; leave some out"
TOO_DEEP = f"values nested more than {DEEPEST} deep; a study nests them 5 deep"
IN_ITSELF = "an alias of the part that holds it; refer to an earlier part"
KINDS = ("bool", "float", "int", "map", "merge", "null", "seq", "str")


def value(text: str) -> object:
    """Parse YAML text. Raises UnreadableError, with the line, for text that is no YAML, or has too
    many values, too deep ones, or numbers of too many digits."""
    loader = None
    try:
        loader = _Loader(text)  # which looks for control characters
        found: object = loader.get_single_data()
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        where = f"line {mark.line + 1}, column {mark.column + 1}: " if mark else ""
        why = " ".join(filter(None, (error.context, error.problem)))
        raise UnreadableError(f"not valid YAML: {where}{cut(why, 200)}") from None
    except yaml.YAMLError as error:
        raise UnreadableError(f"not valid YAML: {' '.join(str(error).split())[:200]}") from None
    except (ValueError, OverflowError):  # of `chr` and `int`, by mere scanning
        assert loader is not None
        mark = loader.get_mark()
        raise UnreadableError(
            f"not valid YAML: line {mark.line + 1}, column {mark.column + 1}: an escape that is no "
            "character, or a number of too many digits; write another"
        ) from None
    refuse_extreme(found)
    return found


class _Loader(yaml.SafeLoader):
    """A loader with limits on size, and values of few kinds."""

    def __init__(self, text: str) -> None:
        super().__init__(text)
        self.yaml_implicit_resolvers = {
            first: [(tag, shape) for tag, shape in kinds if tag.rpartition(":")[2] in KINDS]
            for first, kinds in self.yaml_implicit_resolvers.items()
        }
        self.yaml_constructors = {  # type: ignore[misc]  # of this reader alone
            tag: construct
            for tag, construct in self.yaml_constructors.items()
            if tag is None or tag.rpartition(":")[2] in KINDS  # None: the fault of any other
        }
        self.depth = self.values = 0
        self.values_of: dict[int, int] = {}

    def compose_node(self, parent: Any, index: Any) -> Any:
        """Override of the parser: called for each value, and within for its inner values."""
        mark = self.peek_event().start_mark  # type: ignore[no-untyped-call]  # as all of it is
        alias, before = self.check_event(yaml.AliasEvent), self.values
        self.depth += 1
        if self.depth > DEEPEST:
            raise ConstructorError(None, None, TOO_DEEP, mark)
        node = super().compose_node(parent, index)
        self.depth -= 1
        if alias and id(node) not in self.values_of:
            raise ConstructorError(None, None, IN_ITSELF, mark)
        own = 1 + (len(node.value) // LONG if isinstance(node, yaml.ScalarNode) else 0)
        self.values += self.values_of[id(node)] if alias else own
        self.values_of.setdefault(id(node), self.values - before)
        if self.values > MOST_VALUES:
            raise ConstructorError(None, None, TOO_MANY, mark)
        return node

    def construct_scalar(self, node: Any) -> Any:
        """Return the text of a value, from which a number is made if it is short."""
        text: str = super().construct_scalar(node)
        if node.tag.rpartition(":")[2] in ("int", "float") and len(text) > DIGITS:
            why = f"found {cut(text)}, a number of {len(text)} characters; use at most {DIGITS}"
            raise ConstructorError(None, None, why, node.start_mark)
        text.encode()  # half a character raises ValueError
        return text

    def construct_object(self, node: Any, deep: bool = False) -> Any:
        """Return a value; a text that its tag does not fit is a fault of the file."""
        try:
            return super().construct_object(node, deep)
        except (ValueError, LookupError):
            kind = node.tag.rpartition(":")[2]
            why = f"found {cut(str(node.value))}; it can not be read as {kind}, write another"
            raise ConstructorError(None, None, why, node.start_mark) from None
