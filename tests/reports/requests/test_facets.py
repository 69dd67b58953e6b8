"""Facets on the command line: cams by contact beside those held as a relation."""

import math
from dataclasses import replace
from pathlib import Path

import pytest

import crankcheck
from models.files.assemble import scene_text
from models.files.reading import load_scene
from reports.results.overview import Report
from reports.store.reader import read_store
from tests.worlds.command_line import crank_alone, flat, refused
from tests.worlds.touching_cams import sprung


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    path = tmp_path / "sprung.toml"
    path.write_text(scene_text(sprung()), encoding="utf-8")
    return path


def test_both_ways_are_named_in_tables(scene: Path) -> None:
    words = ["verify", scene, "--engine", "mujoco", "--profile", "tuned", "--turns", "0.5"]
    words += ["--no-convergence", "--steps-per-turn", "360"]
    relation, contact = (crank_alone(*words, *more) for more in ((), ("--facets", "90")))
    assert "sprung, cam disc: as a relation." in flat(relation.output)
    assert "sprung-90-facets, cam disc: by contact, 90 facets." in flat(contact.output)
    assert contact.exit_code == 0


def test_a_sweep_over_facets_has_a_scene_for_each_number_and_their_order(
    scene: Path, tmp_path: Path
) -> None:
    done = crankcheck.sweep(
        str(scene), tmp_path / "store", engines="mujoco", profiles="tuned", facets=[24, 48, 96],
        steps_per_turn=[90, 120], turns=1, timing=False, jobs=1,
    )  # fmt: skip
    every = {f"sprung-{count}-facets": count for count in (24, 48, 96)}
    assert set(done.frame()["scene"]) == set(every)
    stored = read_store(tmp_path / "store")
    sides = [every[str(name)] for name in stored.cells["scene"]]
    coarse = [float(number) < 120.0 for number in stored.cells["steps_per_turn"]]
    sagittas = [(math.tau / count) ** 2 / 8.0 for count in sides]
    cells = stored.cells.assign(place_pure=[a + b for a, b in zip(sagittas, coarse, strict=True)])
    over = Report(replace(stored, cells=cells)).over_facets
    assert over is not None
    (line,) = over.lines
    assert line.scene == "sprung at 120 steps a turn"
    assert list(line.cells["steps_per_turn"]) == [24, 48, 96]
    assert line.fit.order == pytest.approx(2.0, abs=1e-6)
    one = cells[cells["scene"] == "sprung-24-facets"]
    assert Report(replace(stored, cells=one)).over_facets is None


def test_facets_of_a_file_are_kept_and_run(scene: Path) -> None:
    text = scene.read_text(encoding="utf-8").replace("[cams.disc]", "[cams.disc]\nfacets = 60")
    scene.write_text(text, encoding="utf-8")
    assert "facets = 60" in scene_text(load_scene(scene))
    done = crankcheck.run(scene, "pymunk", turns=0.1)
    assert done.status == "ok"
    assert done.settings["collision_slop_of_cams"] == 0.0


@pytest.mark.parametrize(
    ("name", "facets", "message"),
    [
        ("fourbar-lecture-1", 90, "--facets: no scene has a cam"),
        ("", 9, "--facets: found 9; a cam by contact has 12 to 10000"),
    ],
)
def test_facets_that_mean_nothing_are_refused(
    scene: Path, name: str, facets: int, message: str
) -> None:
    refused(crank_alone("verify", name or scene, "--facets", facets), message)
