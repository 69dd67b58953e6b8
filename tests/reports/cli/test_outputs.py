"""What a command reads is never written over, no output takes the place of another, and none goes
through a symbolic link to what it leads to."""

import re
import shutil
from pathlib import Path

import pandas as pd
import pytest
from matplotlib.figure import Figure

from models.files.reading import shipped
from reports.figures.style import saved
from reports.output.formats import write_frame
from reports.output.write import check_file, write
from tests.worlds.command_line import crank, crank_alone, flat
from tests.worlds.tiers import few
from tests.worlds.without_pdf import without_pdf


def files(place: Path) -> dict[Path, bytes]:
    return {path: path.read_bytes() for path in place.rglob("*") if path.is_file()}


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a scene, a log and a map."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    Path("sub").mkdir()
    Path("out", "mujoco-3.7.0").mkdir(parents=True)
    named = ("mine.toml", "mine.csv", "mine.xml", "mine.gif", "fourbar-lecture-1.gif", "mine.db")
    kept = ("manifest.json", "history.csv", "verify.csv", "mujoco-3.7.0/verify.json")
    for name in (*named, *(f"out/{name}" for name in kept)):
        shutil.copy(shipped()["fourbar-lecture-1"], name)
    Path("x.csv").write_text("time_s,rocker_deg\n0,110\n0.01,111\n0.02,112\n0.03,113\n")
    Path("link.csv").symlink_to("x.csv")
    Path("map.toml").write_text('[time]\ncolumn = "time_s"\n')
    return tmp_path


JUDGE = "judge mine.toml x.csv --target 1e-3"
COARSE = "--steps-per-turn 90 --turns 1"
ADVISE = "--dt 0.01 --speed 10 --target 0.1"
HISTORY = "history mujoco 3.7.0 -o out --scene"
REFUSED = {
    f"{JUDGE} --map map.toml --write-map sub/../map.toml":
        "--write-map sub/../map.toml: that is map.toml, which is read",
    f"{JUDGE} --junit ./sub/../x.csv": "--junit .*: that is x.csv",
    "judge mine.toml link.csv --target 1e-3 --json x.csv": "--json x.csv: that is link.csv",
    f"{JUDGE} --json a --junit sub/../a": "--json and --junit: both name",
    f"run mine.csv {COARSE} -o mine.csv": "-o mine.csv: .* is read",
    f"advise mine.toml {ADVISE} --json mine.toml": "--json mine.toml: .* is read",
    f"verify out/verify.csv {COARSE} -o out":
        "-o out/verify.csv: that is out/verify.csv, which is read",
    "solve mine.csv -o mine.csv": "-o mine.csv: .* is read",
    "flywheel mine.toml --delta 0.02 --write sub/../mine.toml":
        "--write .*: that is mine.toml, which is read",
    "export mine.xml -o sub/../mine.xml": "-o .*: that is mine.xml",
    "view mine.gif -o mine.gif": "-o mine.gif: .* is read",
    "tune mine.db --engine mujoco --target 1e-3 -o mine.db": "-o mine.db: holds something else",
    "sweep out/manifest.json -o out": "out",
    "sweep --study mine.toml -o mine.toml": "mine.toml",
    f"{HISTORY} out/history.csv": "-o out/history.csv: .* is read",
    f"{HISTORY} out/mujoco-3.7.0/verify.json": "-o out/mujoco-3.7.0/verify.json: .* is read",
    "diff out out -o out/manifest.json": "-o .*: .* is read",
    f"advise {ADVISE} --study out --json out/manifest.json":
        "--json out/manifest.json: .* is read",
    f"verify mine.toml {COARSE} --baseline out --json out/verify.csv":
        "--json out/verify.csv: .* is read",
}  # fmt: skip


@pytest.mark.parametrize("line", REFUSED)
def test_a_file_that_is_read_or_written_twice_is_refused(line: str, place: Path) -> None:
    before = files(place)
    result = crank(*line.split())
    assert result.exit_code == 2, result.output
    assert re.search(REFUSED[line], flat(result.stderr)), result.stderr
    assert files(place) == before


SHORT = "fourbar-lecture-1 --engine pymunk --profile tuned"
VERIFY = f"verify {SHORT} --turns 0.2 --no-convergence"
FOREIGN = {
    f"{VERIFY} --json mine.toml": "--json mine.toml: there is a file that crankcheck did not write",
    f"{VERIFY} --csv map.toml": "--csv map.toml: there is a file",
    f"{VERIFY} --write-known map.toml": "--write-known map.toml: there is a file",
    f"{VERIFY} --junit x.csv": "--junit x.csv: there is a file",
    f"{VERIFY} --json other.json": "--json other.json: there is a file",
    f"advise mine.toml {ADVISE} --json map.toml": "--json map.toml: there is a file",
    "selftest --fault drive-other --json map.toml": "--json map.toml: there is a file",
    f"{JUDGE} --junit map.toml": "--junit map.toml: there is a file",
    "diff out out --junit map.toml": "--junit map.toml: there is a file",
    "report out -o mine.html": "-o mine.html: there is a file",
    f"run mine.toml {COARSE} -o mine.parquet": "-o mine.parquet: there is a file",
    "view mine.toml": "view fourbar-lecture-1.gif: there is a file",
    "view mine.toml -o mine.png": "-o mine.png: there is a file",
    "export mine.toml -o mine.xml": "-o mine.xml: there is a file",
    "recipe forces --engine mujoco -o mine.py": "-o mine.py: there is a file",
    "solve mine.toml -o mine.xlsx": "-o mine.xlsx: there is a file",
    "cycle mine.toml -o mine.csv": "-o mine.csv: there is a file",
    "positions mine.toml -o mine.pdf": "-o mine.pdf: there is a file",
}


@pytest.mark.parametrize("line", FOREIGN)
def test_a_file_that_no_command_wrote_is_not_written_over(line: str, place: Path) -> None:
    Path("other.json").write_text('{"name": "a package"}')
    heads = {"html": "<!doctype html>", "parquet": "PAR1", "png": "\x89PNG", "pdf": "%PDF-1.4"}
    for ending, head in (heads | {"py": '"""Mine."""', "xlsx": "PK\x03\x04"}).items():
        Path(f"mine.{ending}").write_text(head + " of mine", encoding="latin-1")
    before = files(place)
    result = crank(*line.split())
    assert result.exit_code == 2, result.output
    assert FOREIGN[line] in flat(result.stderr)
    assert files(place) == before


AGAIN = [
    "flywheel mine.toml --delta 0.02 -o fly.csv --write fly.toml",
    f"run mine.toml {COARSE} -o log.csv",
    f"run mine.toml {COARSE} --engine pymunk -o of_pymunk.csv",
    "export mine.toml -o loop.xml",
    "recipe forces --engine mujoco -o forces.py",
]


def test_a_document_of_a_command_and_an_empty_file_are_written_over(place: Path) -> None:
    outputs = ("--json", "a.json", "--junit", "b.xml", "--csv", "cells")
    Path("cells").touch()
    for _ in range(2):
        assert crank_alone(*VERIFY.split(), *outputs).exit_code == 0
    assert Path("cells").read_text().startswith("scene,")
    for line in AGAIN * 2:
        assert crank_alone(*line.split()).exit_code == 0, line


def test_pictures_tables_and_workbooks_have_a_mark_and_are_written_over(tmp_path: Path) -> None:
    for kind in ("svg", "pdf", "png"):
        write(tmp_path / f"a.{kind}", saved(Figure(), kind, "title"))
    for ending in (".parquet", ".xlsx"):
        write_frame(tmp_path / f"a{ending}", pd.DataFrame({"time_s": [0.0]}), "log", {})
    for path in tmp_path.iterdir():
        check_file(path, "-o")


SWEEP = f"sweep {SHORT} --steps-per-turn 90 --no-timing"
COMMANDS = {
    f"{VERIFY} -o out": 0,
    f"{VERIFY} --csv out.csv --json out.json --junit out.xml": 2,
    f"{SWEEP} -o out": 0,
    f"{SWEEP} -o out --keep-trajectories --again": 0,
    "report kept -o out.html": 2,
    "diff kept kept -o out.md --junit out.xml": 2,
    "figures kept -o out --only convergence": 0,
    "view fourbar-lecture-1 -o out.png": 2,
    "flywheel shaper --delta 0.02 -o out.json --write out.toml": 2,
    "tune fourbar-lecture-1 --engine pymunk --target 1e-2 --budget 1 --no-timing -o out.db": 2,
}
"""Each with its exit code where its files are links: those in a folder are replaced."""


def ran(line: str) -> int:
    with without_pdf():
        return crank_alone(*line.split()).exit_code


@pytest.fixture(scope="module")
def kept(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("kept")
    assert ran(f"{SWEEP} -o {folder}") == 0
    return folder


TUNE = [*COMMANDS][-1]
QUICK = (f"{VERIFY} -o out", f"{SWEEP} -o out", "report kept -o out.html")


@pytest.mark.parametrize("line", few(COMMANDS, QUICK, "all write by one function: 5 s"))
def test_what_links_lead_to_stays(
    line: str, kept: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    work, others = tmp_path / "work", tmp_path / "others"
    work.mkdir()
    monkeypatch.chdir(work)
    Path("kept").symlink_to(kept)
    assert ran(line) == 0
    found = (*work.glob("out.*"), *work.rglob("out/**/*"))
    written = [path for path in found if path.is_file() and not path.name.startswith(".")]
    for path in written:
        other = others / path.relative_to(work)
        other.parent.mkdir(parents=True, exist_ok=True)
        path.rename(other)
        other.write_bytes(b"of another" + other.read_bytes()[10:])
        path.symlink_to(other)
    before = files(others)
    assert len(before) == len(written)
    assert ran(line) == COMMANDS[line]
    assert files(others) == before


@pytest.mark.parametrize(
    ("line", "lock"), [(f"{SWEEP} -o out", "out/.lock"), (TUNE, ".out.db.lock")]
)
def test_a_lock_that_is_a_link_is_refused(
    line: str, lock: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("other").write_text("of another")
    Path(lock).parent.mkdir(exist_ok=True)
    Path(lock).symlink_to(tmp_path / "other")
    assert ran(line) == 2
    assert Path("other").read_text() == "of another"


@pytest.mark.parametrize("name", ["cells", "timings", "trajectories", "damaged"])
def test_a_folder_of_a_store_that_is_a_link_is_refused(name: str, tmp_path: Path) -> None:
    (tmp_path / "other").mkdir()
    (tmp_path / "store").mkdir()
    (tmp_path / "store" / name).symlink_to(tmp_path / "other")
    assert ran(f"{SWEEP} -o {tmp_path / 'store'}") == 2
    assert not list((tmp_path / "other").iterdir())
