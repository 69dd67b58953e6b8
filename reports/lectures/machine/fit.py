"""`fit`: lengths of a real mechanism from its log, with their uncertainty."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from rich.console import Console

from analytic.gradients.dimensions import dimension
from analytic.gradients.length_fit import LengthFit, LoggedSeries, fit_lengths
from models.array import Array
from models.errors import CrankcheckError, shown
from models.files.assemble import scene_text
from models.files.reading import find_scene, load_scene
from models.motion import Motion
from models.scene import GROUND, Scene
from reports.lectures.machine.engine_fit import FitEnd, fits
from reports.lectures.machine.gradient_table import chosen
from reports.logs.channel import Channel, OwnLog, Reading
from reports.output.console import grid, say
from reports.output.formats import json_text
from reports.output.numbers import readable
from reports.output.write import check_file, write
from reports.requests.any_log import log_of
from reports.requests.options import SceneName, argument, option
from reports.requests.options import given as given_options

ALIKE_S = 1e-9
"""Difference of instants that counts as none, over the length of a log."""


@dataclass(frozen=True)
class FitRequest:
    """Arguments of `fit`, as given."""

    scene: SceneName
    log: Annotated[Path, argument("LOG", "Your log: .csv, .tsv, .txt, .parquet or .xlsx.")]
    by: Annotated[
        Sequence[str], option("A dimension to fit; repeatable (default all lengths).", "LENGTH")
    ] = ()
    given: Annotated[
        Sequence[str],
        option("A known dimension: ground, or ground=0.3 [m, rad]; repeatable.", "LENGTH[=VALUE]"),
    ] = ()
    zeros: Annotated[bool, "Fit the zeros of the angle sensors as well."] = False
    noise_deg: Annotated[
        float | None, option("Known noise of angles, one standard deviation.", "DEG")
    ] = None
    engines: Annotated[
        Sequence[str], option("Fit by an engine's derivatives as well; repeatable.", "--engine")
    ] = ()
    profiles: Annotated[
        Sequence[str], option("Profile of the engines; repeatable (default tuned).", "--profile")
    ] = ()
    steps_per_turn: Annotated[float, option("Steps of engines in a turn.", min=24, max=1e6)] = 360.0
    map: Annotated[Path | None, option("TOML that says what columns mean.", "FILE")] = None
    json: Annotated[bool, "As JSON, not as tables."] = False
    written: Annotated[
        Path | None, option("Write the scene with the fitted lengths.", "--write FILE.toml")
    ] = None

    def run(self, console: Console, progress: Console) -> int:
        """Show the lengths; return 0 where they explain the log, else 1. Raises CrankcheckError for
        a log that can not be read, and for a faulty request."""
        if self.noise_deg is not None and not 0.0 < self.noise_deg < math.inf:
            raise CrankcheckError(f"--noise-deg: found {self.noise_deg:g}; give one above 0")
        inputs = [find_scene(self.scene), self.log, self.map]
        check_file(self.written, "--write", (".toml",), inputs=inputs)
        scene = load_scene(self.scene)
        given = dict(_given(scene, text) for text in self.given)
        log = log_of(scene, self.log, self.map)
        drive, readings = driven_readings(log)
        for each in given_options(self, "profiles", "steps_per_turn") if not self.engines else ():
            raise CrankcheckError(f"{each}: name an --engine")
        if self.engines and self.zeros:
            raise CrankcheckError("--zeros: an engine's fit takes sensors with a known zero")
        found = fit_lengths(scene, drive, readings, self.by, given, zeros=self.zeros)
        ends: list[FitEnd] = []
        if self.engines:
            choices = chosen(self.engines, self.profiles)
            fitted = scene, drive, readings, self.by, given
            ends = fits(*fitted, choices, self.steps_per_turn)
        checks = [_Check.of(found, number, self.noise_deg) for number in range(len(readings))]
        if self.json:
            console.file.write(json_text({**_document(found, checks, log), **_by_source(ends)}))
        else:
            _show(console, found, checks, log)
            _show_ends(console, ends)
        if self.written is not None:
            write(self.written, scene_text(found.scene))
            if not self.json:
                say(console, f"{self.written}: {scene.name} with these lengths")
        return int(not all(check.explained for check in checks))


def _given(scene: Scene, text: str) -> tuple[str, float]:
    name, equals, value = text.partition("=")
    own = dimension(scene, name).value
    try:
        return name, float(value) if equals else own
    except ValueError:
        raise CrankcheckError(
            f"--given {shown(text)}: write a dimension and its value in m or rad: ground=0.3"
        ) from None


def driven_readings(log: OwnLog) -> tuple[Array, list[LoggedSeries]]:
    """Return the driver's coordinate at the rows of a log, by the log or else by the scene's law,
    and its readings of angles and places. Raises CrankcheckError where there are none."""
    scene = log.scene
    every = [one for one in log.readings if one.channel.kind.order == 0]
    lead = next((one for one in every if _is_drive(one.channel, scene)), None)
    instants = log.time_s if lead is None else lead.instants
    others = [one for one in every if one is not lead and one.channel.kind.body_kind != "elastic"]
    if not others:
        raise CrankcheckError(
            f"{log.source}: no angle and no place beside that of {scene.driver.joint}; log another "
            "link's angle, a slider or a point"
        )
    for one in others:
        if np.abs(one.instants - instants).max() > ALIKE_S * np.ptp(instants):
            raise CrankcheckError(
                f"{log.source}, column {one.channel.column!r}: its instants are not those of the "
                "driver's; log both at the same ones"
            )
    drive = scene.driver.law.at(instants)[0] if lead is None else lead.values
    return drive, [_series(one) for one in others]


def _is_drive(channel: Channel, scene: Scene) -> bool:
    driver = scene.driver
    if driver.slider is not None:
        return channel.kind.body_kind == "slider" and channel.of == driver.slider
    base = "" if driver.base == GROUND else driver.base
    return channel.kind.turns and channel.of == driver.link and channel.relative_to == base


def _series(one: Reading) -> LoggedSeries:
    def expected(channel: Channel, motion: Motion) -> Array:
        return channel.expected(motion)

    channel = one.channel
    return LoggedSeries(channel.name, one.values, partial(expected, channel), channel.kind.turns)


@dataclass(frozen=True)
class _Check:
    """Residuals of a reading [deg or mm], and whether lengths explain it."""

    name: str
    unit: str
    rms: float
    orderly: float
    explained: bool

    @staticmethod
    def of(found: LengthFit, number: int, noise_deg: float | None) -> _Check:
        one = found.readings[number]
        unit, scale = ("deg", math.degrees(1.0)) if one.turns else ("mm", 1e3)
        rms, (part, _) = found.spread(number) * scale, found.orderly(number)
        explained = found.is_explained(number)
        if one.turns and noise_deg is not None:
            # A mean square of n readings deviates by sqrt(2 / n) of itself.
            explained = rms**2 <= noise_deg**2 * (1.0 + 4.0 * math.sqrt(2.0 / one.values.size))
        return _Check(one.name, unit, rms, part * scale, explained)


def _rows(found: LengthFit) -> list[dict[str, Any]]:
    """The unknowns: ratios, or in mm and deg."""
    rows: list[dict[str, Any]] = []
    unit_m = dimension(found.scene, found.unit_length).value if found.unit_length else 0.0
    for name, value in found.values.items():
        is_zero = name.startswith("zero of ")
        angle = is_zero or dimension(found.scene, name).unit == "rad"
        scale, unit = (math.degrees(1.0), "deg") if angle else (1e3, "mm")
        if unit_m and not angle:
            scale, unit = 1.0 / unit_m, f"of {found.unit_length}"
        numbers = (found.start[name], value, found.deviations[name])
        start, fitted, deviation = (number * scale for number in numbers)
        rows.append(
            {
                "name": name, "unit": unit,
                "scene": start, "fitted": fitted, "deviation": deviation,
            }
        )  # fmt: skip
    return rows


def _document(found: LengthFit, checks: Sequence[_Check], log: OwnLog) -> Mapping[str, object]:
    return {
        "scene": found.scene.name,
        "log": log.source,
        "samples": log.time_s.size,
        "determined": "ratios" if found.unit_length else "lengths",
        "dimensions": _rows(found),
        "held": dict(found.held),
        "readings": [vars(check) for check in checks],
        "explained": all(check.explained for check in checks),
    }


def _show(console: Console, found: LengthFit, checks: Sequence[_Check], log: OwnLog) -> None:
    scene = found.scene
    say(console, f"{scene.name}: lengths by {log.source}, {log.time_s.size} rows\n")
    heads = ("dimension", "scene:", "fitted:", "+-:", "unit")
    cells = [
        [str(row["name"]), *(f"{row[k]:.7g}" for k in ("scene", "fitted")),
         readable(row["deviation"], 2), str(row["unit"])]
        for row in _rows(found)
    ]  # fmt: skip
    console.print(grid(heads, cells, whole=("dimension",)), "")
    if found.unit_length:
        say(
            console,
            f"Angles determine ratios of lengths alone: each is over {found.unit_length}. Give its "
            f"length (--given {found.unit_length}=...), or log a place.",
        )
    for why in dict.fromkeys(found.held.values()):
        own = [n for n, each in found.held.items() if each == why and n != found.unit_length]
        if own:
            say(console, f"Held, as the log does not determine it: {', '.join(own)} ({why}).")
    for check in checks:
        line = f"{check.name}: residuals of {readable(check.rms)} {check.unit} rms"
        if check.explained:
            say(console, f"{line}, explained")
            continue
        part = f"of which {readable(check.orderly)} {check.unit} follow {scene.driver.joint}"
        say(console, f"NOT EXPLAINED  {line}, {part}", "bold red")
    if not all(check.explained for check in checks):
        say(
            console,
            "No lengths of this mechanism and assembly give this log: try --zeros, a start nearer "
            "to it, another branch, another mechanism.",
        )


def _by_source(ends: Sequence[FitEnd]) -> dict[str, object]:
    """Return the ends of fits by engines as the data of a JSON file."""
    own = ("source", "motions", "wall_s", "reason")
    rows = [
        {key: getattr(end, key) for key in own}
        | {"dimensions": _rows(end.found) if end.found else []}
        for end in ends
    ]
    return {"by_source": rows} if rows else {}


def _show_ends(console: Console, ends: Sequence[FitEnd]) -> None:
    """Print where the fits of the same rows end, as deviations from that of the reference."""
    if not ends:
        return
    assert ends[0].found is not None
    reference = {str(row["name"]): row for row in _rows(ends[0].found)}
    heads = ["by", "motions:", "time s:", *(f"{name}:" for name in reference), "residual:"]
    cells = []
    for end in ends:
        line = [end.source, str(end.motions), f"{end.wall_s:.3g}"]
        if end.found is None:
            cells.append([*line, *["none"] * (len(heads) - 3)])
            continue
        fitted = {str(row["name"]): row["fitted"] for row in _rows(end.found)}
        for name, row in reference.items():
            own = fitted[name]
            off = readable(own - row["fitted"], 2)
            line.append(f"{own:.7g} {row['unit']}" if end is ends[0] else f"{off} {row['unit']}")
        rms = max(float(np.sqrt(np.mean(r**2))) for r in end.found.residuals)
        cells.append([*line, readable(rms, 2)])
    rows = ends[0].found.residuals[0].size
    say(
        console,
        f"\nBy {rows} rows of a turn, and derivatives of the reference or of an engine; lengths of "
        "engines against those by the reference; residuals in rad or m, rms\n",
    )
    console.print(grid(heads, cells, whole=("by",), wraps=True))
    for end in ends:
        if end.reason:
            say(console, f"No lengths by {end.source}: {end.reason}")
