"""The cells of a store as lines: a scene in one engine with one set of settings, at every step."""

import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, cast

import numpy as np
import pandas as pd
from pydantic import ValidationError

from reports.judge import halving
from reports.plan.study import Study
from reports.protocol.length import clock_of
from reports.protocol.way import ResultKind, Way, way_of_row
from reports.quantities import QUANTITIES
from reports.results.line_fit import LineFit, fit_line, words
from reports.store.manifest import Manifest
from reports.store.reader import Stored
from sim import registry
from sim.engine import AT_ROUNDING, Drive, SettingValue


@dataclass(frozen=True)
class Line:
    """Cells that differ in their step only.

    ``cells`` are rows of the store, from the coarse to the fine step; ``settings`` are the
    requested ones. ``fit`` and ``words`` describe one quantity.
    """

    scene: str
    engine: str
    variant: str
    version: str
    drive: Drive
    line: str
    settings: Mapping[str, SettingValue]
    cells: pd.DataFrame = field(repr=False, compare=False)
    fit: LineFit
    words: str

    @property
    def name(self) -> str:
        """Variant as a sentence calls it, without the engine."""
        return called(self.variant, self.drive)

    @cached_property
    def way(self) -> Way:
        """Way in which its cells were run and compared."""
        return way_of_row(self.cells.iloc[0].to_dict())

    @property
    def kind(self) -> ResultKind:
        """Kind of results of its cells."""
        return self.way.results

    @property
    def lasts_s(self) -> float:
        """Duration of each run [s]."""
        return self.period_s * float(self.cells.iloc[0]["turns"])

    @property
    def period_s(self) -> float:
        """Period of the driver [s]; a second in a free motion."""
        first = self.cells.iloc[0]
        return float(first["dt_s"] * first["steps_per_turn"])


Named = tuple[str, str, Drive]
"""Engine, variant and drive: the name of settings in tables, legends and looks."""


def named(line: Line) -> Named:
    """Return the name of the settings of a line."""
    return line.engine, line.variant, line.drive


def called(variant: str, drive: Drive) -> str:
    """Return the name of a variant, and its drive where that is not the usual one."""
    return variant if drive == "prescribed" else f"{variant}, {drive} drive"


def lines(stored: Stored, quantity: str = "place_pure") -> tuple[Line, ...]:
    """Return the lines of a store, by scene and variant in the order of its study.

    ``quantity`` is the column of ``stored.cells`` that is fitted. Only the newest of several lines
    of one scene, engine, variant and drive (of another version of the engine, with other settings
    under the same name, over other turns) is given: the highest version, and the last written of
    that. Times are from one processor (see `machines`).
    """
    cells = comparable(stored.cells)
    chosen = _newest(cells)
    every = [
        _line(rows.sort_values("dt_s", ascending=False).reset_index(drop=True), quantity)
        for key, rows in cells.groupby("line", sort=False)
        if key in chosen
    ]
    scenes, variants = list(stored.manifest.scenes), _variants(stored.manifest)

    def place(line: Line) -> tuple[int, int]:
        which = (line.engine, line.variant)
        return (
            scenes.index(line.scene) if line.scene in scenes else len(scenes),
            variants.index(which) if which in variants else len(variants),
        )

    return tuple(sorted(every, key=place))


def _variants(manifest: Manifest) -> list[tuple[str, str]]:
    """Return engine and name of the variants of all runs, in the order of their studies."""
    names: dict[tuple[str, str], None] = {}
    for run in manifest.runs:
        try:
            study = Study.model_validate(run.get("study"))
        except ValidationError:  # of another version of crankcheck: then as the cells come
            continue
        names |= {(one.engine, one.name): None for each in study.variants for one in each.each()}
    return list(names)


def _newest(cells: pd.DataFrame) -> set[str]:
    """Return the names of the lines that no newer one replaces."""
    names = ["scene", "engine", "variant", "drive"]
    found: dict[tuple[str, ...], tuple[tuple[tuple[int, ...], int], str]] = {}
    for at, row in enumerate(cells[[*names, "version", "line"]].itertuples(index=False)):
        *which, version, line = (str(value) for value in row)
        age = (numbers(version), at)
        if tuple(which) not in found or age > found[tuple(which)][0]:
            found[tuple(which)] = (age, line)
    return {line for _, line in found.values()}


def numbers(version: str) -> tuple[int, ...]:
    """Return a version as numbers, which compare as versions do."""
    return tuple(int(part) for part in re.findall(r"\d+", version))


def _line(rows: pd.DataFrame, quantity: str) -> Line:
    first = rows.iloc[0]
    fit = fit_line(
        [float(dt) for dt in rows["dt_s"]],
        [float(error) for error in rows[quantity]],
        rounding=_rounding(rows),
        statuses=[str(status) for status in rows["status"]],
    )
    return Line(
        scene=str(first["scene"]),
        engine=str(first["engine"]),
        variant=str(first["variant"]),
        version=str(first["version"]),
        drive=cast(Drive, str(first["drive"])),
        line=str(first["line"]),
        settings=json.loads(str(first["asked"])),
        cells=rows,
        fit=fit,
        words=words(
            fit,
            _unit(quantity, first.to_dict()),
            float(first["dt_s"] * first["steps_per_turn"]),
            clock_of(str(first["drive"])).name,
        ),
    )


def _unit(quantity: str, row: Mapping[Any, Any]) -> str:
    """Return the unit of a column of errors, in cells such as ``row``."""
    if quantity == "place_pure":
        return way_of_row(row).results.unit
    if quantity.endswith("_pure"):
        names = [n for n in QUANTITIES if quantity.startswith(f"{n.replace('-', '_')}_")]
        return QUANTITIES[names[0]].share if names else "rad"
    units = {measure.unit for entry in QUANTITIES.values() for measure in entry.measures}
    ends = {f"_{re.sub('[ /]', '_', unit).replace('^', '').lower()}": unit for unit in units}
    end = max((end for end in ends if quantity.lower().endswith(end)), key=len, default="")
    return ends.get(end, "")


def _rounding(rows: pd.DataFrame) -> float:
    """Return the pure error from rounding: of the crank, and of the bodies behind it."""
    drives = rows.get("drive_pure", ())  # a free motion has none
    drive = max((float(error) for error in drives if error <= halving.EXACT_DRIVE), default=0.0)
    return max(AT_ROUNDING, halving.BEHIND_DRIVE * drive)


TIMES = ("us_per_step", "us_per_step_median", "us_per_step_a", "us_per_step_b", "s_per_turn")
"""Columns of times; NaN where a cell was not timed."""


def machine(cells: pd.DataFrame) -> str | None:
    """Return the processor that timed last, None where nothing was timed."""
    timed = _timed(cells)
    return None if timed.empty else str(timed.sort_values("made")["processor"].iloc[-1])


def left_out(cells: pd.DataFrame) -> tuple[str, ...]:
    """Return the processors whose times are not compared."""
    names = {str(name) for name in _timed(cells)["processor"]}
    return tuple(sorted(names - {str(machine(cells))}))


def comparable(cells: pd.DataFrame) -> pd.DataFrame:
    """Return the cells with the times of the processor that timed last; other times are blanked.

    Processors are distinguished by name: two machines of one kind can not be.
    """
    cleared = cells.reindex(columns=[*cells.columns, *(c for c in TIMES if c not in cells.columns)])
    name = machine(cells)
    if name is not None:
        cleared.loc[cleared["processor"] != name, list(TIMES)] = np.nan
    return cleared


def _timed(cells: pd.DataFrame) -> pd.DataFrame:
    if "processor" not in cells.columns:  # a store without timings
        return cells.iloc[:0].assign(processor="", made="")
    return cells[cells["us_per_step"].notna()]


def registered(engine: str) -> registry.Declaration:
    """Return the declaration of an engine in a store, which need not be installed or known here."""
    return registry.declaration(engine) if engine in registry.ENGINES else registry.OWN


def label(name: Named) -> str:
    """Return the legend of a variant; with the drive where that is not the usual one."""
    engine, variant, drive = name
    return f"{engine} {called(variant, drive)}"


OWN = "every setting as the engine is shipped"


def usual(lines: Sequence[Line], engine: str) -> Line:
    """Return the line to compare others of an engine with: as shipped, or its first variant."""
    own = [line for line in lines if line.engine == engine]
    return next((line for line in own if line.variant == "as-shipped"), own[0])


def settings_told(lines: Sequence[Line]) -> Mapping[Named, str]:
    """Return the settings of each variant, by engine, variant and drive.

    Settings of an engine as shipped are not named; where it was not run so, its first variant is
    given in full, and the others by their differences from that.
    """
    return {named(line): _told(line, lines) for line in lines}


def value_text(value: SettingValue | None) -> str:
    """Return a value as text; empty for a missing setting."""
    if value is None:
        return ""
    return f"{value:g}" if isinstance(value, float) else str(value) or "none"


def _told(line: Line, lines: Sequence[Line]) -> str:
    first = usual(lines, line.engine)
    if first.variant == "as-shipped":
        return _words(_differing(line, first)) or OWN
    name = called(first.variant, first.drive)
    if (line.variant, line.drive) == (first.variant, first.drive):
        return _words(line.settings)
    differing = _words(_differing(line, first))
    return f"as {name}, but {differing}" if differing else f"as {name}"


def _differing(line: Line, other: Line) -> Mapping[str, SettingValue]:
    """Return the settings of a line that another one lacks, or has otherwise."""
    return {
        name: value
        for name, value in line.settings.items()
        if name not in other.settings or other.settings[name] != value
    }


def _words(settings: Mapping[str, SettingValue]) -> str:
    return ", ".join(f"{name} {value_text(value)}" for name, value in settings.items())
