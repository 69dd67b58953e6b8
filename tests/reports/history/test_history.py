"""`crankcheck history` as a whole: with an installer and versions made up here, and for real."""

import csv
import io
import os
import shutil
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest
from packaging.version import Version
from rich.console import Console

from models.errors import CrankcheckError
from models.files.reading import shipped
from reports.history import verification
from reports.history.environments import EngineVersion, NotMeasuredError
from reports.requests.history import HistoryRequest
from reports.workers.signals import Ended
from tests.worlds.command import shadows
from tests.worlds.command_line import flat
from tests.worlds.fake_installer import fake_installer

posix = pytest.mark.skipif(sys.platform == "win32", reason="the installer is a POSIX script")

SCENE = "fourbar-lecture-1"


@pytest.fixture(scope="module")
def installer(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return fake_installer(tmp_path_factory.mktemp("installer"))


History = Callable[..., tuple[int, str, str]]


@pytest.fixture
def history(installer: Path, monkeypatch: pytest.MonkeyPatch) -> History:
    """Run the command; exit code, output with single spaces, complaint."""
    monkeypatch.setenv("PATH", f"{installer}{os.pathsep}{os.environ['PATH']}")
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(filter(None, sys.path)))
    code = verification.code_key()  # the same for all, also where somebody edits the code meanwhile
    monkeypatch.setattr(verification, "code_key", lambda: code)

    def run(*versions: str, **options: object) -> tuple[int, str, str]:
        usual = {"scenes": [SCENE], "turns": 1.0, "steps_per_turn": 360.0}
        streams = io.StringIO(), io.StringIO()
        request = HistoryRequest(
            "mujoco", versions, **{**usual, "cache": installer / "cache"} | options
        )
        code = request.run(*[Console(file=stream, width=100) for stream in streams])
        return code, flat(streams[0].getvalue()), streams[1].getvalue()

    return run


@posix
def test_versions_are_installed_run_and_kept(
    history: History, installer: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    cache, log = installer / "cache", installer / "log"
    monkeypatch.chdir(shadows(tmp_path / "mine"))  # packages of our names, which change nothing
    shutil.rmtree(cache / "history", ignore_errors=True)
    log.unlink(missing_ok=True)
    code, output, complaint = history("3.7.0", "9.9.9", folder=tmp_path / "out")
    assert code == 2
    reason = "not installed: no mujoco 9.9.9 is offered as a wheel for Python"
    assert complaint.startswith(f"crankcheck: mujoco 9.9.9: {reason}")
    assert f"9.9.9 - - - - {reason}" in output
    assert log.read_text().count("pip install") == 2
    folder = tmp_path / "out" / "mujoco-3.7.0"
    with (folder / "verify.csv").open(encoding="utf-8") as lines:
        assert {row["version"] for row in csv.DictReader(lines)} == {"3.7.0"}
    assert (folder / "errors.parquet").is_file()
    assert not (tmp_path / "out" / "mujoco-9.9.9").exists()

    code, output, complaint = history("3.7.0")
    assert (code, complaint) == (0, "")
    assert "kept from before" in output
    assert f"Results: {cache.resolve()}" in output.replace("- ", "-")

    folders: list[Path] = []
    measure = "reports.history.verification.measure"
    monkeypatch.setattr(measure, lambda folder, *_: folders.append(folder))
    _, output, _ = history("3.7.0", again=True)
    assert len(folders) == 1
    assert "kept from before" not in output
    assert log.read_text().count("pip install") == 2
    assert not list(cache.glob("history/results/.*"))


def test_a_new_result_takes_the_place_of_the_old_one_whole(tmp_path: Path) -> None:
    def run(command: Sequence[str], *_: object) -> Ended:
        aside = Path(command[command.index("-o") + 1])
        aside.mkdir()
        (aside / command[-1]).write_text("1")
        (aside / "verify.csv").write_text(command[-1])
        return Ended(0, "", "")

    version = EngineVersion("mujoco", Version("3.6.0"))
    for name in ("one", "other"):
        verification.measure(tmp_path / "of it", version, Path("python"), [name], run)
        assert {path.name for path in (tmp_path / "of it").iterdir()} == {"verify.csv", name}
        assert [path.name for path in tmp_path.iterdir()] == ["of it"]


@pytest.fixture
def measured(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> list[Path]:
    """The folders that were measured, with nothing installed or run for it."""
    folders: list[Path] = []
    columns = "scene,engine,version,profile,drive,steps_per_turn,turns,status,reason"

    def measure(folder: Path, asked: EngineVersion, *_: object) -> None:
        name = str(asked.version)
        if name == "9.9.9":
            raise NotMeasuredError("not installed: no such version")
        gap = 1e-2 if name == "3.6.0" else 1e-3
        row = f"{SCENE},mujoco,{name},as-shipped,prescribed,360,1,ok,,{gap},1e-3"
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "verify.csv").write_text(f"{columns},gap_pure,pin_gap_m\n{row}\n")
        folders.append(folder)

    monkeypatch.setattr("reports.history.verification.measure", measure)
    monkeypatch.setattr("reports.requests.history.ready", lambda *_: tmp_path / "python")
    return folders


def test_two_versions_are_compared(history: History, measured: list[Path], tmp_path: Path) -> None:
    versions = ("3.7.0", "9.9.9", "3.6.0")
    code, output, _ = history(*versions, folder=tmp_path / "out", cache=tmp_path / "cache")
    assert (code, len(measured)) == (2, 2)
    assert "3.7.0 is better than 3.6.0 by" in output
    assert f"on the pin gap of {SCENE} as shipped" in output
    with (tmp_path / "out" / "history.csv").open(encoding="utf-8") as lines:
        assert {row["version"] for row in csv.DictReader(lines)} == {*versions}
    assert "## 3.7.0 against 3.6.0" in (tmp_path / "out" / "history.md").read_text()


def test_another_request_or_text_of_a_scene_is_not_answered_from_the_cache(
    history: History, measured: list[Path], tmp_path: Path
) -> None:
    for _ in range(2):
        assert history("3.7.0", cache=tmp_path)[0] == 0
    assert len(measured) == 1
    by_time = {"dt_s": 2e-3, "steps_per_turn": None}
    for other in ({"turns": 2.0}, {"profiles": ["tuned"]}, {"scenes": ["shaper"]}, by_time):
        assert "kept from before" not in history("3.7.0", cache=tmp_path, **other)[1]
    assert len(measured) == 5
    path, text = tmp_path / "mine.toml", shipped()[SCENE].read_text(encoding="utf-8")
    bar = 'bar = ["B", "C"], length_m = 0.25'
    longer = text.replace("length_m = 0.25", "length_m = 0.26")
    said_otherwise = text.replace(bar, "points = { B = [0.0, 0.0], C = [0.25, 0.0] }")
    for content, count in ((text, 1), (f"{text}# a word", 1), (longer, 2), (said_otherwise, 3)):
        path.write_text(content, encoding="utf-8")
        history("3.7.0", scenes=[str(path)], cache=tmp_path / "texts")
        assert len(measured) == 5 + count


def test_another_code_has_another_key(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (package := tmp_path / "probe_of_history").mkdir()
    (package / "__init__.py").touch()
    monkeypatch.setattr(verification, "ROOMS", tmp_path)
    keys = []
    for text in ("A = 1\n", "A = 2\n"):
        (package / "inner.py").write_text(text, encoding="utf-8")
        keys.append((verification.code_key(), verification.key_of(["cell"])))
    assert not set(keys[0]) & set(keys[1])


@posix
def test_a_run_that_dies_has_its_reason(history: History, monkeypatch: pytest.MonkeyPatch) -> None:
    for code, reason in (
        ("import os, signal; os.kill(os.getpid(), signal.SIGKILL)", "ended by signal 9"),
        ("import sys; print('crankcheck: out of luck', file=sys.stderr)", "not run: out of luck"),
        ("pass", "not run: exit code 0"),
    ):
        monkeypatch.setattr(verification, "LAUNCH", code)
        ended, output, complaint = history("3.7.0", again=True)
        assert (ended, reason in output, reason in complaint) == (2, True, True)


def test_a_mistake_is_told_before_anything_is_installed(
    history: History, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("reports.requests.history.ready", None)  # nothing may be installed
    (tmp_path / "file").touch()
    for versions, options, message in (
        ("8.8.8", {"profiles": ["tund"]}, "did you mean tuned"),
        ("8.8.8", {"turns": -1.0}, "--turns"),
        (
            "8.8.8",
            {"scenes": ["fourbar-swing"], "turns": 1.0},
            "free motion has no turns",
        ),
        ("8.8.8", {"cache": tmp_path / "file"}, "--cache"),
        ("8.8.8", {"folder": tmp_path / "file"}, "-o"),
        ("3.6.0 3.x;rm", {}, "not a version number"),
        ("", {}, "name versions"),
    ):
        with pytest.raises(CrankcheckError, match=message):
            history(*versions.split(), **options)
    with pytest.raises(CrankcheckError, match="did you mean mujoco"):
        HistoryRequest("mujocco", ["3.6.0"]).run(Console(), Console())
