"""What a command reads is never written over, and no output takes the place of another."""

from __future__ import annotations

import re
import shutil
from collections.abc import Sequence
from pathlib import Path

import pytest
from typer.testing import CliRunner

from models.files import shipped
from reports.cli import app

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
    Path("link.csv").symlink_to("x.csv")
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
}  # fmt: skip


@pytest.mark.parametrize("name", CASES)
def test_a_file_that_is_read_or_written_twice_is_refused(name: str, place: Path) -> None:
    arguments, message = CASES[name]
    before = {path: path.read_bytes() for path in place.iterdir() if path.is_file()}
    result = CliRunner().invoke(app, list(arguments), catch_exceptions=False)
    assert result.exit_code == 2, result.output
    told = " ".join(result.stderr.split())
    assert re.search(message, told), told
    assert {path: path.read_bytes() for path in place.iterdir() if path.is_file()} == before
