"""No output of any command goes through a symbolic link to what it leads to."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.worlds.command_line import crank_alone
from tests.worlds.tiers import few
from tests.worlds.without_pdf import without_pdf

SHORT = "fourbar-lecture-1 --engine pymunk --profile tuned"
VERIFY = f"verify {SHORT} --turns 0.2 --no-convergence"
SWEEP = f"sweep {SHORT} --steps-per-turn 90 --no-timing"
COMMANDS = {
    f"{VERIFY} -o out": 0,
    f"{VERIFY} --csv out.csv --json out.json --junit out.xml": 2,
    f"{SWEEP} -o out": 0,
    f"{SWEEP} -o out --keep-trajectories --again": 0,
    "report kept -o out.html": 2,
    "diff kept kept -o out.md --junit out.xml": 2,
    "figures kept -o out --only convergence": 0,
    "solve fourbar-lecture-1 -o out.csv": 2,
    "export fourbar-lecture-1 -o out.xml": 2,
    "view fourbar-lecture-1 -o out.png": 2,
    "cycle shaper -o out.csv": 2,
    "cycle shaper --figures out": 0,
    "flywheel shaper --delta 0.02 -o out.json --write out.toml": 2,
    "selftest --engine pymunk --fault nan-at-end -o out": 0,
    "tune fourbar-lecture-1 --engine pymunk --target 1e-2 --budget 1 --no-timing -o out.db": 2,
}
"""Each with its exit code where its files are links: those in a folder are replaced."""


def ran(line: str) -> int:
    with without_pdf():
        return crank_alone(*line.split()).exit_code


@pytest.fixture(scope="module")
def kept(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A store of one cell."""
    folder = tmp_path_factory.mktemp("kept")
    assert ran(f"{SWEEP} -o {folder}") == 0
    return folder


@pytest.mark.parametrize(
    "line",
    few(
        COMMANDS,
        [line for line in COMMANDS if not line.startswith(("cycle shaper --fig", "tune"))],
        "a second each, for what writes as the others do",
    ),
)
def test_what_links_lead_to_stays(
    line: str, kept: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    work, others = tmp_path / "work", tmp_path / "others"
    work.mkdir()
    monkeypatch.chdir(work)
    Path("kept").symlink_to(kept)
    assert ran(line) == 0
    written = [
        path
        for path in (*work.glob("out.*"), *work.rglob("out/**/*"))
        if path.is_file() and not path.name.startswith(".")
    ]
    for path in written:
        other = others / path.relative_to(work)
        other.parent.mkdir(parents=True, exist_ok=True)
        path.rename(other)
        other.write_bytes(b"of another" + other.read_bytes()[10:])
        path.symlink_to(other)
    before = {path: path.read_bytes() for path in others.rglob("*") if path.is_file()}
    assert len(before) == len(written)
    assert ran(line) == COMMANDS[line]
    assert {path: path.read_bytes() for path in others.rglob("*") if path.is_file()} == before


@pytest.mark.parametrize(
    ("line", "lock"), [(f"{SWEEP} -o out", "out/.lock"), ([*COMMANDS][-1], ".out.db.lock")]
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
