"""A kind of scene is a folder and a line: the bead of `tests.worlds.bead` is compared, judged,
stored and shown as all others are.

The house is copied by links, with the folder's name in `WAYS`; all commands run in one process.
"""

import json
import os
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
HERE = Path("reports/protocol/way.py")
BEFORE, AFTER = "WAYS = (", 'WAYS = ("tests.worlds.bead", '
ENGINE = "--engine tests.worlds.bead.engine:ENGINE"
COMMANDS = {
    "verify": f"verify bead.toml {ENGINE} --profile tuned --json verdict.json",
    "refused": f"verify fast.toml {ENGINE}",
    "run": f"run bead.toml {ENGINE} --duration 0.75 -o log.csv",
    "judge": "judge bead.toml log.csv --step 0.0004 --json log.json",
    "sweep": f"sweep bead.toml {ENGINE} --profile tuned --free --duration 0.75 --dt 1e-3 -o study "
    "--no-timing --jobs 1",
    "report": "report study -o page.html",
    "figures": "figures study -o figs",
    "stability": f"stability bead-top {ENGINE} --profile tuned --jobs 1",
    "selftest": f"selftest --fault bead-ahead {ENGINE} --jobs 1",
}
PROGRAM = """
import contextlib, io, json, shlex, sys
from crankcheck.__main__ import main
from tests.worlds.in_process import in_this_process
from tests.worlds.without_pdf import without_pdf
told = {}
with in_this_process(), without_pdf():
    for name, text in json.loads(sys.argv[1]).items():
        out, sys.argv = io.StringIO(), ["crankcheck", *shlex.split(text)]
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(out):
            try:
                code = main()
            except SystemExit as end:
                code = end.code
        told[name] = [code or 0, out.getvalue()]
print(json.dumps(told))
"""


@dataclass(frozen=True)
class House:
    """What each command printed, by name, after its exit code; and the folder they ran in."""

    told: dict[str, tuple[int, str]]
    folder: Path


@pytest.fixture(scope="module")
def house(tmp_path_factory: pytest.TempPathFactory) -> House:
    """The house with one kind of scene more."""
    root, folder = tmp_path_factory.mktemp("house"), tmp_path_factory.mktemp("work")
    for path in ROOT.iterdir():
        if path.is_dir() and path.name not in {"reports", ".git", ".venv"}:
            (root / path.name).symlink_to(path)
    (root / "reports").mkdir()
    for path in (ROOT / "reports").iterdir():
        if path.name != HERE.parent.name:
            (root / "reports" / path.name).symlink_to(path)
    shutil.copytree(ROOT / HERE.parent, root / HERE.parent)
    text = (ROOT / HERE).read_text(encoding="utf-8")
    assert text.count(BEFORE) == 1
    (root / HERE).write_text(text.replace(BEFORE, AFTER), encoding="utf-8")
    bead = (ROOT / "tests/worlds/bead/bead.toml").read_text(encoding="utf-8")
    (folder / "bead.toml").write_text(bead)
    (folder / "fast.toml").write_text(f"{bead}speed_rad_s = 1.0\n")
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM, json.dumps(COMMANDS)],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(root), "COLUMNS": "100"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return House(json.loads(done.stdout.splitlines()[-1]), folder)


SAID = {
    "verify": "beads, profile tuned | off by | order 2.0 | swing in elliptic functions",
    "refused": "the bead starts with 1 rad/s | leave speed_rad_s out",
    "judge": "phase of spoke, the driver | WITHIN TOLERANCE | energy of bead",
    "sweep": "1 cell: 1 run now",
    "report": "page.html: 1 cell",
    "figures": "each as .svg and .pdf",
    "stability": "BEADS | bead-top | holds all | a bead, rad or over the spoke",
    "selftest": "caught bead-ahead | beads on wires | beads: 1 ms, 1 s",
}


@pytest.mark.parametrize("name", SAID)
def test_it_goes_through(house: House, name: str) -> None:
    code, text = house.told[name]
    assert code == (2 if name == "refused" else 0), text
    told = " ".join(text.split())
    assert [words for words in SAID[name].split(" | ") if words not in told] == []


def test_it_has_columns_a_section_and_a_figure_of_its_own(house: House) -> None:
    (cell,) = json.loads((house.folder / "verdict.json").read_text())["cells"]
    assert abs(cell["period_off"]) < 1e-6
    assert "drive_error_rad" not in cell
    page = (house.folder / "page.html").read_text(encoding="utf-8")
    assert "<th>period off by</th>" in page
    assert "against the swing" in page
    assert (house.folder / "figs" / "bead-bead.svg").is_file()
