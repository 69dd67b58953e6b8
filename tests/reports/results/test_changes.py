"""What counts as worse, and what does not; both kinds of stored runs, and every folder that is
none."""

import json
import math
import os
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from models.errors import CrankcheckError
from models.files.reading import shipped
from reports.results.changes import compare, other_settings
from reports.results.runs import COMPARED, CellName, StoredCell, StoredRun, steps_told
from reports.results.stored_runs import read_run, scene_digests
from reports.store.reader import read_store
from sim.registry import engine

Make = Callable[..., StoredCell]
Group = Callable[..., StoredRun]


@pytest.mark.parametrize("quantity", COMPARED)
def test_growth_is_worse_past_the_factor_alone(quantity: str, cell: Make, run: Group) -> None:
    old = run(cell("a", **{quantity: 1e-3}), cell("b", **{quantity: 1e-3}))
    for growth, word in ((1.2, "worse"), (1.05, "equal"), (1 / 1.2, "better")):
        new = run(cell("a", **{quantity: 1e-3 * growth}), cell("b", **{quantity: 1e-3}))
        diff = compare(old, new)
        assert [pair.word for pair in diff.pairs] == [word, "equal"]
        assert diff.code() == (word == "worse")
    assert compare(old, run(cell("a", **{quantity: 1.2e-3})), factor=1.3).code() == 0


@pytest.mark.parametrize(
    ("quantity", "steps", "noise"),
    [("angle", 720, 0.9e-11), ("gap", 720, 0.9e-11), ("drive", 720, 0.9e-9),
     ("velocity-differenced", 5760, 0.9e-11 / (math.tau / 5760)),
     ("acceleration-differenced", 5760, 0.9e-11 / (math.tau / 5760) ** 2)],
)  # fmt: skip
def test_noise_of_the_size_of_rounding_is_no_alarm(
    quantity: str, steps: int, noise: float, cell: Make, run: Group
) -> None:
    for old in (0.0, noise):
        before = run(cell(steps=float(steps), **{quantity: old}))
        after = run(cell(steps=float(steps), **{quantity: old + noise}))
        assert compare(before, after).code() == 0
        far = run(cell(steps=float(steps), **{quantity: old * 1.1 + 1.2 * noise}))
        assert compare(before, far).those("worse"), "what exceeds rounding counts"
        assert compare(far, before).those("better"), "and it does in both directions"


def test_what_fails_is_worse_and_what_one_run_knows_is_left_out(cell: Make, run: Group) -> None:
    number, none = run(cell(angle=1e-3, gap=1e-3)), run(cell(angle=math.inf, gap=1e-3))
    (pair,) = compare(number, none).pairs
    assert (pair.word, pair.worst.quantity) == ("worse", "angle")
    assert compare(none, number).those("better")
    assert compare(none, none).those("equal")
    bad = run(cell(status="diverged", reason="came apart", angle=1e-9))
    lost = run(cell(status="crashed"))
    assert compare(number, bad).code() == 1
    assert compare(bad, number).those("better")
    assert compare(bad, lost).those("equal")
    assert compare(bad, lost).pairs[0].failed
    less, more = run(cell(angle=1e-3)), run(cell(angle=1e-3, gap=1.0))
    for old, new in ((less, more), (more, less)):
        (pair,) = compare(old, new).pairs
        assert [change.quantity for change in pair.changes] == ["angle"]


def test_the_worst_quantity_and_the_worst_cell_are_told_first(cell: Make, run: Group) -> None:
    old = run(*(cell(name, angle=1e-3, gap=1e-3, drive=1e-13) for name in "abc"))
    new = run(
        cell("a", angle=2e-3, gap=5e-3, drive=1e-9),
        cell("b", angle=1e-2, gap=1e-4, drive=1e-13),
        cell("c", status="locked"),
    )
    worse = compare(old, new).those("worse")
    told = [(pair.name.scene, pair.worst.quantity if pair.worst else "") for pair in worse]
    assert told == [("c", ""), ("b", "angle"), ("a", "gap")]


def test_missing_cells_and_changed_scenes_count_if_one_is_strict(cell: Make, run: Group) -> None:
    old, new = run(cell("a", angle=1e-3), cell("b", angle=1e-3)), run(cell("a", angle=1e-3))
    diff = compare(old, new)
    assert [c.name.scene for c in diff.missing] == ["b"]
    assert (diff.code(), diff.code(strict=True)) == (0, 1)
    assert [c.name.scene for c in compare(new, old).added] == ["b"]
    assert compare(new, old).code(strict=True) == 0
    old = run(cell("a", angle=1e-3, digest="1"), cell("b", angle=1e-3, digest="2"))
    new = run(cell("a", angle=1e-1, digest="9"), cell("b", angle=1e-3, digest="2"))
    diff = compare(old, new)
    assert [c.name.scene for c in diff.other_scene] == ["a"]
    assert [pair.name.scene for pair in diff.pairs] == ["b"]
    assert (diff.code(), diff.code(strict=True)) == (0, 1)
    unknown = run(cell("a", angle=1e-1))
    assert compare(old, unknown).code() == 1, "a run that does not tell its scenes is compared"


def test_nothing_in_common_and_a_factor_below_1_are_refused(cell: Make, run: Group) -> None:
    old, new = run(cell("a", steps=90.0), label="OLD"), run(cell("b"), label="NEW")
    with pytest.raises(CrankcheckError) as caught:
        compare(old, new)
    told = str(caught.value)
    assert told.startswith("no cell in common: OLD holds 1 cell: scenes a; mujoco tuned; 90 steps")
    assert "; NEW holds 1 cell: scenes b; mujoco tuned; 720 steps a turn; 2 turns" in told
    with pytest.raises(CrankcheckError, match="every scene of both changed in between"):
        compare(run(cell(digest="1")), run(cell(digest="2")))
    for factor in (0.99, math.inf, math.nan):
        with pytest.raises(CrankcheckError, match=r"--factor .* at least 1"):
            compare(run(cell()), run(cell()), factor)


def test_settings_that_the_engine_held_otherwise_are_told() -> None:
    name = CellName("a", "mujoco", "stiff", "prescribed", 720.0, 2.0)
    was, now = (
        StoredRun("x", {name: StoredCell(name, "1", "ok", "", {"angle": 1.0}, {"cone": 0} | held)})
        for held in ({"solver": "PGS"}, {"solver": "Newton"})
    )
    found = other_settings(compare(was, now).pairs)
    assert found == {("mujoco", "stiff"): {"solver": 'solver "PGS" -> "Newton"'}}
    assert other_settings(compare(was, was).pairs) == {}


def test_a_cell_of_free_motion_is_named_by_its_steps_and_not_by_turns() -> None:
    assert {"phase", "geometry", "energy", "momentum"} <= set(COMPARED)
    free = CellName("swing", "pymunk", "tuned", "free", 1250.0, 0.1)
    assert free.label == "swing, pymunk tuned, drive free, 1250 steps a second for 0.1 s"
    assert steps_told([free, replace(free, steps_per_turn=2000.0)]) == "1250, 2000 steps a second"
    driven = replace(free, drive="prescribed", turns=2.0)
    assert driven.label == "swing, pymunk tuned, 1250 steps a turn, 2 turns"


Copy = Callable[..., Path]
Change = Callable[[Path], None]


def test_a_verification_is_read_whole(stored: Copy, verified: tuple[pd.DataFrame, object]) -> None:
    found = read_run(stored("old"))
    frame = verified[0]
    names = [(cell.name.engine, cell.name.variant) for cell in found.cells.values()]
    assert names == list(zip(frame.engine, frame.profile, strict=True))
    wanted_of = zip(frame.angle_pure, frame.acceleration_pure, strict=True)
    for one, (angle, wanted) in zip(found.cells.values(), wanted_of, strict=True):
        assert one.errors["angle"] == angle
        assert one.errors["acceleration"] == (math.inf if np.isnan(wanted) else wanted)
        assert one.version == engine(one.name.engine).version()
        assert one.settings
        assert one.scene_digest
        assert one.cost is None
    assert found.facts["processor"]
    assert found.notes == ()


def test_a_store_is_read_with_costs_and_digests(store: Copy) -> None:
    folder = store("s", us=2.5, cpu="mine")
    found = read_run(folder)
    cells = read_store(folder).cells
    assert [c.name.steps_per_turn for c in found.cells.values()] == [90.0, 180.0]
    for one, (_, row) in zip(found.cells.values(), cells.iterrows(), strict=True):
        assert one.errors["position"] == row.position_pure
        assert one.scene_digest == row.scene_digest
        assert (one.cost.us_per_step, one.cost.noise, one.cost.processor) == (2.5, 0.0, "mine")
    assert found.facts["mujoco"] == "4.0.0"


def test_a_verification_and_a_store_are_compared_with_each_other(stored: Copy, store: Copy) -> None:
    text = shipped()["fourbar-lecture-1"].read_text(encoding="utf-8")
    swept = read_run(store("s"))
    diff = compare(swept, read_run(stored("v", text=text)))
    assert [pair.word for pair in diff.pairs] == ["equal"]
    assert (len(diff.missing), len(diff.added)) == (1, 3)
    (known,) = scene_digests(["fourbar-lecture-1"]).values()
    assert {c.scene_digest for c in swept.cells.values()} == {known}
    one = read_run(stored("w"), engine("mujoco").version())
    assert {c.name.engine for c in one.cells.values()} == {"mujoco", "pymunk"}


def test_of_several_versions_the_last_written_counts_unless_one_is_chosen(store: Copy) -> None:
    store("s", version="3.9.0")
    folder = store("s", version="3.7.0")
    found = read_run(folder, None, "--old-version")
    assert {c.version for c in found.cells.values()} == {"3.7.0"}
    assert len(found.notes) == 1
    assert "mujoco 3.9.0, 3.7.0: the last written of each cell counts" in found.notes[0]
    assert "--old-version chooses" in found.notes[0]
    chosen = read_run(folder, "3.9.0")
    assert {c.version for c in chosen.cells.values()} == {"3.9.0"}
    assert chosen.notes == ()
    with pytest.raises(CrankcheckError, match=r"--new-version 3\.8\.0: .* has mujoco 3\.9\.0, 3"):
        read_run(folder, "3.8.0", "--new-version")


def spoil(name: str, content: str) -> Change:
    return lambda folder: (folder / name).write_text(content, encoding="utf-8") and None


def column(name: str, value: object) -> Change:
    def change(folder: Path) -> None:
        frame = pd.read_csv(folder / "verify.csv")
        frame.assign(**{name: value}).to_csv(folder / "verify.csv", index=False)

    return change


def without(ending: str) -> Change:
    def change(folder: Path) -> None:
        frame = pd.read_csv(folder / "verify.csv")
        frame[[c for c in frame if not c.endswith(ending)]].to_csv(folder / "verify.csv")

    return change


def piped(name: str) -> Change:
    def change(folder: Path) -> None:
        (folder / name).unlink()
        os.mkfifo(folder / name)

    return change


SPOILT: dict[str, tuple[Change, str]] = {
    "empty file": (spoil("verify.csv", ""), "no cells in it"),
    "no column": (without("turns"), "no column 'turns'"),
    "no errors": (without("_pure"), "no errors in its cells"),
    "words": (column("angle_pure", "large"), "could not convert string to float: 'large'"),
    "no steps": (column("steps_per_turn", 0.0), "steps_per_turn '0.0'"),
    "negative": (column("gap_pure", -1.0), "an error of -1"),
    "settings": (column("settings", "[1]"), r"settings '\[1\]'"),
    "facts": (spoil("verify.json", "{"), "verify.json: not JSON"),
    "list of facts": (spoil("verify.json", "[]"), "verify.json: no facts"),
    "deep facts": (spoil("verify.json", "[" * 100_000), "verify.json: not JSON"),
    "facts from a pipe": (piped("verify.json"), "json: a pipe, not a plain file; verify again"),
    "cells from a pipe": (piped("verify.csv"), "no stored run there"),
    "two kinds": (spoil("manifest.json", "{}"), "holds a sweep .* and a verification"),
    "not text": (lambda f: (f / "verify.csv").write_bytes(b"\xff\xfe\x00") and None, "not a CSV"),
}


@pytest.mark.parametrize("name", SPOILT)
def test_a_spoilt_run_is_refused_with_its_place_and_fault(name: str, stored: Copy) -> None:
    folder = stored("v")
    change, fault = SPOILT[name]
    change(folder)
    with pytest.raises(CrankcheckError, match=fault) as caught:
        read_run(folder)
    assert str(caught.value).startswith(str(folder))


def test_cells_of_a_verification_that_were_cut_off_are_missed(stored: Copy) -> None:
    folder = stored("v")
    path, facts = folder / "verify.csv", folder / "verify.json"
    known = json.loads(facts.read_text(encoding="utf-8"))
    facts.write_text(json.dumps(known | {"cells": [{}] * 4}), encoding="utf-8")
    assert len(read_run(folder).cells) == 4
    text = path.read_text(encoding="utf-8")
    path.write_text(text[: text.rindex("\n", 0, -1) + 1], encoding="utf-8")
    with pytest.raises(CrankcheckError, match=r"verify\.csv: cut short \(3 of the 4 cells"):
        read_run(folder)
    path.write_text(text[: text.rindex("\n", 0, -1) + 60], encoding="utf-8")
    with pytest.raises(CrankcheckError, match=r"cut short \(its last row is not whole\)"):
        read_run(folder)
    facts.unlink()
    path.write_text(text, encoding="utf-8")
    found = read_run(folder)
    assert len(found.cells) == 4
    assert "no verify.json, so verify.csv can not be checked" in found.notice[0]


def test_what_is_no_run_is_refused_with_what_would_be(stored: Copy, tmp_path: Path) -> None:
    stored("inside")
    (tmp_path / "empty").mkdir()
    for path, text in {
        tmp_path / "nowhere": "no such folder; name one that `crankcheck sweep -o` or",
        tmp_path / "inside" / "verify.csv": "a file; name the folder",
        tmp_path / "empty": "no stored run there (no manifest.json, no verify.csv)",
        tmp_path: "in its folders: name one of inside",
    }.items():
        with pytest.raises(CrankcheckError) as caught:
            read_run(path)
        assert {part for part in (str(path), text) if part not in str(caught.value)} == set()
