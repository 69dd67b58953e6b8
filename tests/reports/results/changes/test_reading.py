"""Both kinds of stored runs, and every folder that is none."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from models.errors import CrankcheckError
from models.files import shipped
from reports.results.changes.changes import compare
from reports.results.changes.reading import read_run, scene_digests
from reports.store.reader import read_store
from sim.registry import engine

Copy = Callable[..., Path]
Change = Callable[[Path], None]


def test_a_verification_is_read_with_every_number(
    stored: Copy, verified: tuple[pd.DataFrame, object]
) -> None:
    found = read_run(stored("old"))
    frame = verified[0]
    names = [(cell.name.engine, cell.name.variant) for cell in found.cells.values()]
    assert names == list(zip(frame.engine, frame.profile, strict=True))
    for one, angle, wanted in zip(
        found.cells.values(), frame.angle_pure, frame.acceleration_pure, strict=True
    ):
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
    diff = compare(read_run(store("s")), read_run(stored("v", text=text)))
    assert [pair.word for pair in diff.pairs] == ["equal"]
    assert (len(diff.missing), len(diff.added)) == (1, 3)


def test_of_several_versions_the_last_written_counts_unless_one_is_chosen(store: Copy) -> None:
    store("s", version="3.9.0")
    folder = store("s", version="3.7.0")
    found = read_run(folder, None, "--old-version")
    assert {c.version for c in found.cells.values()} == {"3.7.0"}
    assert len(found.notes) == 1
    assert "mujoco 3.9.0, 3.7.0: of each cell the last written counts" in found.notes[0]
    assert "--old-version chooses" in found.notes[0]
    chosen = read_run(folder, "3.9.0")
    assert {c.version for c in chosen.cells.values()} == {"3.9.0"}
    assert chosen.notes == ()
    with pytest.raises(CrankcheckError, match=r"--new-version 3\.8\.0: .* has mujoco 3\.9\.0, 3"):
        read_run(folder, "3.8.0", "--new-version")


def test_a_version_of_one_engine_leaves_the_other_engines_whole(stored: Copy) -> None:
    found = read_run(stored("v"), engine("mujoco").version())
    assert {c.name.engine for c in found.cells.values()} == {"mujoco", "pymunk"}


def test_the_digest_of_a_shipped_scene_is_that_of_a_store(store: Copy) -> None:
    wanted = {c.scene_digest for c in read_run(store("s")).cells.values()}
    assert {scene_digests(["fourbar-lecture-1"])["fourbar-lecture-1"]} == wanted
    assert scene_digests([]).keys() == set(shipped())


def spoil(name: str, content: str) -> Change:
    return lambda folder: (folder / name).write_text(content, encoding="utf-8") and None


def column(name: str, value: object) -> Change:
    """Replace a column of the cells."""

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
    "other table": (spoil("verify.csv", "a,b\n1,2\n"), "no column 'engine'"),
    "no column": (without("turns"), "no column 'turns'"),
    "no errors": (without("_pure"), "no errors in its cells"),
    "words": (column("angle_pure", "large"), "could not convert string to float: 'large'"),
    "no steps": (column("steps_per_turn", 0.0), "steps_per_turn '0.0'"),
    "negative": (column("gap_pure", -1.0), "an error of -1"),
    "settings": (column("settings", "[1]"), r"settings '\[1\]'"),
    "facts": (spoil("verify.json", "{"), "verify.json: not JSON"),
    "list of facts": (spoil("verify.json", "[]"), "verify.json: no facts"),
    "deep facts": (spoil("verify.json", "[" * 100_000), "verify.json: not JSON"),
    "facts from a pipe": (piped("verify.json"), "verify.json: a pipe, no plain file; verify again"),
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


def test_a_verification_without_its_facts_is_enough_and_told(stored: Copy) -> None:
    folder = stored("v")
    (folder / "verify.json").unlink()
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
        tmp_path: "in folders of it: name one of inside",
    }.items():
        with pytest.raises(CrankcheckError) as caught:
            read_run(path)
        assert {part for part in (str(path), text) if part not in str(caught.value)} == set()
