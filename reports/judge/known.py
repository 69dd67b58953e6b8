"""Known failures: a TOML file of cells that fail for a known reason, so that a gate is green
(models/scenes/known-failures.toml). A log has the name of its file for an engine, and no profile.

A cell is known where it ends as it did, no other rule fails, and no error has grown by more than
half. Of a run that did not end well one rule counts: the others follow from its ending.
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, TypeVar

from pydantic import Field

from models.errors import CrankcheckError, shown, suggestion
from models.files.assemble import toml_value
from models.files.faults import read_table
from models.files.reading import SCENE_FOLDER, find_scenes, read_scene
from models.files.schema import Table
from reports.judge.rules import RULES, titled
from reports.judge.rules.rule import Evidence, Finding

SHIPPED = SCENE_FOLDER / "known-failures.toml"
"""Known failures of the shipped scenes."""
GROWTH = 1.5
"""Growth of an error up to which it is the known one."""
HEAD = "# Known failures: `crankcheck verify --known` and this file; say why in each reason."
Names = tuple[str, str, str, str]
"""Scene, engine, profile and drive."""


class KnownFailure(Table):
    """A cell with its status and the rules that it fails, each with its error, pure; infinite for
    no number."""

    scene: str
    engine: str
    profile: str = ""
    drive: str = "prescribed"
    status: str = "ok"
    reason: str
    rules: Annotated[Mapping[str, Annotated[float, Field(ge=0.0)]], Field(min_length=1)]

    @property
    def names(self) -> Names:
        return self.scene, self.engine, self.profile, self.drive


class _KnownFile(Table):
    known: tuple[KnownFailure, ...] = ()


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
        sizes = ((each.rule, each.number) for each in counted)
        return {rule: n if n is not None and math.isfinite(n) else math.inf for rule, n in sizes}

    @property
    def is_known(self) -> bool:
        return bool(self.known and self.failures and not self._other)

    @property
    def mended(self) -> list[str]:
        """The rules of the known failure that were judged and do not fail any more."""
        if self.known is None or self.status != "ok":
            return []
        right = {finding.rule for finding in self.findings} - self.sizes.keys()
        return [rule for rule in self.known.rules if rule in right]

    @property
    def _other(self) -> list[str]:
        """Differences from the known failure that make it another one, in words."""
        if not (self.known and self.failures):
            return []
        before, was = self.known.rules, self.known.status
        texts = [f"it ended {self.status}, the known failure {was}"] * (self.status != was)
        for rule, size in self.sizes.items():
            if rule not in before:
                texts.append(f"{rule} is not known to fail")
            elif size > GROWTH * before[rule]:
                texts.append(f"{rule} has grown from {before[rule]:.2g} to {size:.2g}")
        return texts

    @property
    def known_text(self) -> str:
        """What is known of it, and what is not, in words; "" where nothing is."""
        if self.known is None:
            return ""
        mended, other, reason = self.mended, self._other, self.known.reason
        rules = " ".join(rule for rule in self.known.rules if rule not in mended)
        texts = [f"{rules}, known: {reason}"] * self.is_known
        texts += [f"not the known failure ({reason}): {'; '.join(other)}"] * bool(other)
        right = f"{' '.join(mended)} known to fail, passed: remove from the file"
        return "; ".join(texts + [right] * bool(mended))


One = TypeVar("One", bound=Judged)


def marked(every: Sequence[One], known: Sequence[KnownFailure]) -> list[One]:
    """Return judged cells, each with its known failure."""
    by_name = {one.names: one for one in known}
    return [replace(one, known=by_name.get(one.names)) for one in every]


def known_of(path: Path | None, scenes: Sequence[str] = ()) -> Sequence[KnownFailure]:
    """Return the known failures of a file, by default the shipped one, which is for the shipped
    among the named ``scenes``. Raises CrankcheckError as `read_known`."""
    if path is not None:
        return read_known(path)
    files = [at for at in find_scenes(scenes) if not at.is_relative_to(SCENE_FOLDER)]
    own = {read_scene(at).name for at in files}
    return [one for one in read_known(SHIPPED) if one.scene not in own]


def read_known(path: Path, option: str = "--known") -> Sequence[KnownFailure]:
    """Read a file of known failures. Raises CrankcheckError with every fault."""
    place = f"{option} {path}"
    known = read_table(path, _KnownFile, place).known
    if other := [rule for one in known for rule in one.rules if rule not in RULES]:
        hint = suggestion(other[0], RULES, "use one of")
        raise CrankcheckError(f"{place}: {shown(other[0])} is no rule; {hint}")
    names = [" ".join(filter(None, one.names)) for one in known]
    if twice := [name for at, name in enumerate(names) if name in names[:at]]:
        raise CrankcheckError(f"{place}: {twice[0]} is there twice; name its rules in one entry")
    return known


def written_before(path: Path | None) -> Sequence[KnownFailure]:
    """Return the known failures of a file that is written over, none where it is not there.
    Raises CrankcheckError as `read_known`."""
    return read_known(path, "--write-known") if path and path.is_file() else ()


def known_file(every: Iterable[Judged], before: Iterable[KnownFailure] = ()) -> str:
    """Return the text of a file of the failures among judged cells; the reasons of those that were
    in it ``before``, and of known ones, are kept."""
    reasons, lines = {one.names: one.reason for one in before}, [HEAD]
    for one in every:
        if one.failures:
            found = one.known.reason if one.known else titled(one.failures)[0][1].partition(";")[0]
            rules = {rule: float(f"{size:.3g}") for rule, size in one.sizes.items()}
            values = *one.names, one.status, reasons.get(one.names, found), rules
            entry = zip(KnownFailure.model_fields, values, strict=True)
            lines += ["", "[[known]]", *(f"{key} = {toml_value(value)}" for key, value in entry)]
    return "\n".join(lines) + "\n"
