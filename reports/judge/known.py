"""Known failures: a TOML file of cells that fail for a known reason, so that a gate is green
(models/scenes/known-failures.toml). A log has the name of its file for an engine, and no profile.

A cell is known where no other rule fails, and no error has grown by more than half. Of a run that
did not end well only the status counts: the rest follows from it.
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, TypeVar

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from models.errors import CrankcheckError, listed, shown, suggestion
from models.files.assemble import toml_value
from models.files.inputs import UnreadableError, regular_text, tables
from models.files.reading import SCENE_FOLDER, find_scenes, read_scene
from reports.judge.rules import RULES, titled
from reports.judge.rules.rule import Evidence, Finding

SHIPPED = SCENE_FOLDER / "known-failures.toml"
"""Known failures of the shipped scenes."""
GROWTH = 1.5
"""Growth of an error up to which it is the known one."""
Names = tuple[str, str, str, str]
"""Scene, engine, profile and drive."""


class KnownFailure(BaseModel):
    """A cell with the rules that it fails, each with its error, pure; infinite for no number."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    scene: str
    engine: str
    profile: str = ""
    drive: str = "prescribed"
    reason: str
    rules: Annotated[Mapping[str, Annotated[float, Field(ge=0.0)]], Field(min_length=1)]

    @property
    def names(self) -> Names:
        return self.scene, self.engine, self.profile, self.drive


class _KnownFile(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)
    known: list[KnownFailure] = []


@dataclass(frozen=True, kw_only=True)
class Judged(Evidence):
    """Evidence with the findings of the rules, and with its known failure, None without one."""

    findings: tuple[Finding, ...] = ()
    known: KnownFailure | None = None

    @property
    def names(self) -> Names:
        raise NotImplementedError

    @property
    def failures(self) -> tuple[Finding, ...]:
        return tuple(finding for finding in self.findings if finding.level == "fail")

    @property
    def sizes(self) -> dict[str, float]:
        """Errors by failing rule, as pure numbers; infinite where there is no number."""
        counted = self.failures if self.status == "ok" else self.failures[:1]
        numbers = {f.rule: math.nan if f.number is None else f.number for f in counted}
        return {rule: n if math.isfinite(n) else math.inf for rule, n in numbers.items()}

    @property
    def is_known(self) -> bool:
        return bool(self.known and self.failures and not self.spoilt)

    @property
    def spoilt(self) -> list[str]:
        """Differences from the known failure that make it another one, in words."""
        if self.known is None:
            return []
        before, sizes = self.known.rules, self.sizes
        grown = [rule for rule in sizes if sizes[rule] > GROWTH * before.get(rule, math.inf)]
        return [
            *(f"{rule} is not known to fail" for rule in sizes if rule not in before),
            *(f"{rule} has grown from {before[rule]:.2g} to {sizes[rule]:.2g}" for rule in grown),
        ]

    @property
    def mended(self) -> list[str]:
        """The rules of the known failure that were judged and do not fail any more."""
        if self.known is None or self.status != "ok":
            return []
        right = {finding.rule for finding in self.findings} - self.sizes.keys()
        return [rule for rule in self.known.rules if rule in right]

    @property
    def known_text(self) -> str:
        """What is known of it, and what is not, in words; "" where nothing is."""
        if self.known is None:
            return ""
        rules = " ".join(rule for rule in self.known.rules if rule not in self.mended)
        texts = [f"{rules}, known: {self.known.reason}"] if self.is_known else []
        other = f"not the known failure ({self.known.reason}): {'; '.join(self.spoilt)}"
        right = f"{' '.join(self.mended)} known to fail, is right by now: take it out of the file"
        return "; ".join([*texts, *[other] * bool(self.spoilt), *[right] * bool(self.mended)])


One = TypeVar("One", bound=Judged)


def marked(every: Sequence[One], known: Sequence[KnownFailure]) -> list[One]:
    """Return judged cells, each with its known failure."""
    found = {one.names: one for one in known}
    return [replace(one, known=found.get(one.names)) for one in every]


def known_of(path: Path | None, scenes: Sequence[str] = ()) -> list[KnownFailure]:
    """Return the known failures of a file, by default the shipped one, which is for the shipped
    among the named ``scenes``. Raises CrankcheckError as `read_known`."""
    if path is not None:
        return read_known(path)
    files = [at for at in find_scenes(scenes) if not at.is_relative_to(SCENE_FOLDER)]
    own = {read_scene(at).name for at in files}
    return [one for one in read_known(SHIPPED) if one.scene not in own]


def read_known(path: Path) -> list[KnownFailure]:
    """Read a file of known failures. Raises CrankcheckError with every fault."""
    place = f"--known {path}"
    try:
        known = _KnownFile.model_validate(tables(regular_text(path))).known
    except UnreadableError as error:
        raise CrankcheckError(f"{place}: {error}") from None
    except ValidationError as error:
        faults = [
            f"{'.'.join(map(str, each['loc']))}: found {shown(each['input'])}; {each['msg']}"
            for each in error.errors()
        ]
        raise CrankcheckError(listed(place, faults)) from None
    if other := [rule for one in known for rule in one.rules if rule not in RULES]:
        hint = suggestion(other[0], RULES, "use one of")
        raise CrankcheckError(f"{place}: {shown(other[0])} is no rule; {hint}")
    names = [" ".join(filter(None, one.names)) for one in known]
    if twice := [name for at, name in enumerate(names) if name in names[:at]]:
        raise CrankcheckError(f"{place}: {twice[0]} is there twice; name its rules in one entry")
    return known


def known_file(every: Iterable[Judged]) -> str:
    """Return the text of a file of the failures among judged cells; known reasons are kept."""
    lines = ["# Known failures: `crankcheck verify --known` and this file; say why in each reason."]
    for one in every:
        if one.failures:
            reason = one.known.reason if one.known else titled(one.failures)[0][1].partition(";")[0]
            rules = {rule: float(f"{size:.3g}") for rule, size in one.sizes.items()}
            entry = zip(KnownFailure.model_fields, (*one.names, reason, rules), strict=True)
            lines += ["", "[[known]]", *(f"{key} = {toml_value(value)}" for key, value in entry)]
    return "\n".join(lines) + "\n"
