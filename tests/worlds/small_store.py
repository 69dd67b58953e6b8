"""A small store of real runs, with times that are made up: figures of it are always the same."""

from pathlib import Path

from models.files.reading import find_scene, load_scene, read_text
from reports.judge.cell import Cell
from reports.store.manifest import Manifest
from reports.store.writer import Writer
from reports.sweep.measured import measured
from sim.engine import SettingValue
from sim.engine.settings import profile_of, resolved
from sim.registry import engine as load

SCENES = ("fourbar-lecture-1", "slotted-lever")
STEPS = (90, 180, 360, 720)
VARIANTS: tuple[tuple[str, str, str, dict[str, SettingValue]], ...] = (
    ("mujoco", "as-shipped", "as-shipped", {}),
    ("mujoco", "tuned", "tuned", {}),
    ("pymunk", "as-shipped", "as-shipped", {}),
    ("pymunk", "no bias", "as-shipped", {"error_bias": 0.0}),
)
COST = {"mujoco": 2.5, "pymunk": 1.0}
FACTS = {"numpy": "2.0", "processor": "abacus", "system": "Linux", "made": "2026-01-01T00:00:00"}


def filled(folder: Path) -> Path:
    """The folder, now a store; the finest cell of pymunk "no bias" on the lever is said to have
    diverged."""
    texts = {name: read_text(find_scene(name)) for name in SCENES}
    with Writer(folder, Manifest(texts, ({"provenance": FACTS},))) as writer:
        for scene in SCENES:
            for variant in VARIANTS:
                for steps in STEPS:
                    _add(writer, scene, variant, steps)
    return folder


def _add(
    writer: Writer, scene: str, named: tuple[str, str, str, dict[str, SettingValue]], steps: int
) -> None:
    engine, variant, profile, settings = named
    one = load_scene(scene)
    dt_s = one.driver.law.period_s / steps
    cell = Cell(
        one, engine, profile, dt_s, steps, profile == "tuned", settings=settings, converge=False
    )
    found = measured(cell, keep_run=False)
    line = f"{scene} {engine} {variant}"
    names = {
        "key": f"{line} {steps}",
        "line": line,
        "variant": variant,
        "asked": resolved(profile_of(load(engine), profile), settings),
        "crankcheck": "0.0.0",
    }
    row = {**found.row, **names}
    failed = (scene, variant, steps) == ("slotted-lever", "no bias", STEPS[-1])
    if failed:
        row |= {"status": "diverged", "reason": "came apart | `at` 1 s"}
    writer.cell(row, found.errors, found.trace)
    us = COST[engine] * (1.5 if profile == "tuned" else 1.0)
    times = dict.fromkeys(
        ("us_per_step", "us_per_step_median", "us_per_step_a", "us_per_step_b"), us
    )
    if not failed:
        writer.timing(
            {"key": names["key"], **times, "s_per_turn": 1e-6 * us * steps}
            | {"processor": "abacus", "made": "2026-01-01"}
        )
