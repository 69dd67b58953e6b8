"""Stores that are made up: cells whose errors and costs a test chooses."""

import json
import math
from collections.abc import Iterable, Mapping
from pathlib import Path

import pandas as pd

from reports.store.manifest import Manifest
from reports.store.reader import Stored

PERIOD_S = 0.5
Row = dict[str, object]


def cell(scene: str, variant: str, steps: float, error: float, us: float, **other: object) -> Row:
    """A cell with its timing; its halves a and b are both ``us`` unless told otherwise."""
    engine = str(other.get("engine", "mujoco"))
    version = str(other.get("version", "4.0.0"))
    asked = other.pop("asked", {"name": variant})
    line = f"{scene} {engine} {variant} {version} {json.dumps(asked)} {other.get('drive', '')}"
    return {
        "key": f"{line} {steps:g}", "line": line, "scene": scene, "engine": engine,
        "variant": variant, "version": version, "profile": "tuned", "drive": "prescribed",
        "asked": json.dumps(asked), "dt_s": PERIOD_S / steps, "steps_per_turn": float(steps),
        "status": "ok", "place_pure": error, "drive_pure": 0.0,
        "us_per_step": us, "us_per_step_median": 1.1 * us, "us_per_step_a": us, "us_per_step_b": us,
        "s_per_turn": 1e-6 * us * steps, "processor": "abacus", "made": "2026-01-01",
    } | other  # fmt: skip


def table(text: str, **other: object) -> list[Row]:
    """Cells with their scene, variant, steps, error and cost, a comma between two."""
    words = map(str.split, text.split(","))
    return [cell(scene, name, *map(float, numbers), **other) for scene, name, *numbers in words]


def untimed(row: Row) -> Row:
    times = {name: math.nan for name in row if name.startswith("us_") or name == "s_per_turn"}
    return row | times | {"processor": None, "made": None}


def stored(
    rows: Iterable[Row], scenes: Iterable[str] = (), runs: tuple[Mapping[str, object], ...] = ()
) -> Stored:
    manifest = Manifest(dict.fromkeys(scenes, ""), runs)
    return Stored(Path("made-up"), manifest, pd.DataFrame(list(rows)), pd.DataFrame())
