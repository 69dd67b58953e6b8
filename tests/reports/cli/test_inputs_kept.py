"""What a command reads is never written over, and no output takes the place of another."""

from __future__ import annotations

import re
import shutil
from collections.abc import Sequence
from pathlib import Path

import pytest

from models.files import shipped
from tests.worlds.command_line import crank, flat

LOG = "time_s,rocker_deg\n0,110\n0.01,111\n0.02,112\n0.03,113\n"
COARSE = ["--steps-per-turn", "90", "--turns", "1"]


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a scene, a log and a map."""
    monkeypatch.chdir(tmp_path)
    shutil.copy(shipped()["fourbar-lecture-1"], "mine.toml")
    shutil.copy("mine.toml", "mine.csv")
    Path("x.csv").write_text(LOG)
    Path("map.toml").write_text('[time]\ncolumn = "time_s"\n')
    for name in ("mine.xml", "mine.gif", "fourbar-lecture-1.gif", "mine.db"):
        shutil.copy("mine.toml", name)
    Path("link.csv").symlink_to("x.csv")
    Path("out", "mujoco-3.7.0").mkdir(parents=True)
    for name in ("manifest.json", "history.csv", "verify.csv", "mujoco-3.7.0/verify.json"):
        shutil.copy("mine.toml", Path("out", name))
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    Path("sub").mkdir()
    return tmp_path


JUDGE = ["judge", "mine.toml", "x.csv", "--target", "1e-3"]
CASES: dict[str, tuple[Sequence[str], str]] = {
    "scene by its map": ([*JUDGE, "--write-map", "mine.toml"], "--write-map mine.toml: .* read"),
    "map by its map": (
        [*JUDGE, "--map", "map.toml", "--write-map", "sub/../map.toml"],
        "--write-map sub/../map.toml: that is map.toml, which is read",
    ),
    "log by json": ([*JUDGE, "--json", "x.csv"], "--json x.csv: that is x.csv, which is read"),
    "log by junit": ([*JUDGE, "--junit", "./sub/../x.csv"], "--junit .*: that is x.csv"),
    "log behind a link": (
        ["judge", "mine.toml", "link.csv", "--target", "1e-3", "--json", "x.csv"],
        "--json x.csv: that is link.csv",
    ),
    "one of two": ([*JUDGE, "-o", "a.html", "--json", "a.html"], "-o and --json: both name a.html"),
    "two of two": ([*JUDGE, "--json", "a", "--junit", "sub/../a"], "--json and --junit: both name"),
    "scene by run": (["run", "mine.csv", *COARSE, "-o", "mine.csv"], "-o mine.csv: .* is read"),
    "scene by advise": (
        ["advise", "mine.toml", "--dt", "0.01", "--speed", "10", "--target", "0.1", "--json",
         "mine.toml"],
        "--json mine.toml: .* is read",
    ),
    "scene by verify": (["verify", "mine.toml", *COARSE, "--csv", "mine.toml"], "--csv .* is read"),
    "scene by a folder of verify": (
        ["verify", "out/verify.csv", *COARSE, "-o", "out"],
        "-o out/verify.csv: that is out/verify.csv, which is read",
    ),
    "scene by solve": (["solve", "mine.csv", "-o", "mine.csv"], "-o mine.csv: .* is read"),
    "scene by cycle": (["cycle", "mine.csv", "-o", "mine.csv"], "-o mine.csv: .* is read"),
    "scene by flywheel": (
        ["flywheel", "mine.toml", "--delta", "0.02", "--write", "sub/../mine.toml"],
        "--write .*: that is mine.toml, which is read",
    ),
    "scene by export": (["export", "mine.xml", "-o", "sub/../mine.xml"], "-o .*: that is mine.xml"),
    "scene by view": (["view", "mine.gif", "-o", "mine.gif"], "-o mine.gif: .* is read"),
    "scene by view without -o": (["view", "fourbar-lecture-1.gif"], "view four.*gif: .* is read"),
    "scene by tune": (
        ["tune", "mine.db", "--engine", "mujoco", "--target", "1e-3", "-o", "mine.db"],
        "-o mine.db: holds something else",
    ),
    "scene by sweep": (["sweep", "out/manifest.json", "-o", "out"], "out"),
    "study by sweep": (["sweep", "--study", "mine.toml", "-o", "mine.toml"], "mine.toml"),
    "scene by history": (
        ["history", "mujoco", "3.7.0", "--scene", "out/history.csv", "-o", "out"],
        "-o out/history.csv: .* is read",
    ),
    "scene by a version's folder": (
        ["history", "mujoco", "3.7.0", "--scene", "out/mujoco-3.7.0/verify.json", "-o", "out"],
        "-o out/mujoco-3.7.0/verify.json: .* is read",
    ),
    "run by diff": (["diff", "out", "out", "-o", "out/manifest.json"], "-o .*: .* is read"),
    "run by junit of diff": (["diff", "sub", "out", "--junit", "out/verify.csv"], "--junit .*read"),
    "study by advise": (
        ["advise", "--dt", "0.01", "--speed", "10", "--target", "0.1", "--study", "out", "--json",
         "out/manifest.json"],
        "--json out/manifest.json: .* is read",
    ),
    "baseline by verify": (
        ["verify", "mine.toml", *COARSE, "--baseline", "out", "--json", "out/verify.csv"],
        "--json out/verify.csv: .* is read",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", CASES)
def test_a_file_that_is_read_or_written_twice_is_refused(name: str, place: Path) -> None:
    arguments, message = CASES[name]
    before = files(place)
    result = crank(*arguments)
    assert result.exit_code == 2, result.output
    told = flat(result.stderr)
    assert re.search(message, told), told
    assert files(place) == before


def files(place: Path) -> dict[Path, bytes]:
    """All that there is below a folder."""
    return {path: path.read_bytes() for path in place.rglob("*") if path.is_file()}
