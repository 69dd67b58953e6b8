"""An environment per version: what makes it, what may not leak into it, and why it failed."""

import os
import re
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pytest
from filelock import FileLock
from packaging.version import Version

from models.errors import CrankcheckError
from reports.history import environments
from reports.history.verification import alone, user_cache
from reports.workers.signals import Ended, run_child

ONE = environments.EngineVersion("mujoco", Version("3.6.0"))


class FakeInstaller:
    """Answers as an installer would; remembers what it was told to do."""

    def __init__(self, fails: str = "", finds: str = "3.6.0") -> None:
        self.fails, self.finds = fails, finds
        self.commands: list[list[str]] = []
        self.variables: list[dict[str, str]] = []

    def __call__(self, command: Sequence[str], variables: Mapping[str, str], _: object) -> Ended:
        self.commands.append([*command])
        self.variables.append({**variables})
        if "venv" in command:
            python = environments.python_of(Path(command[-1]))
            python.parent.mkdir(parents=True)
            python.touch()
            return Ended(0, "", "")
        if "install" in command:
            return Ended(1 if self.fails else 0, "", self.fails)
        return Ended(0, f"{self.finds}\n", "")

    @property
    def installs(self) -> int:
        return sum("install" in command for command in self.commands)


def test_versions_are_taken_once_and_the_oldest_first_and_no_other_text() -> None:
    found = environments.wanted("mujoco", ["3.10.0", "3.9", "3.9.0", "3.10.0rc1"])
    assert [one.name for one in found] == ["mujoco-3.9", "mujoco-3.10.0rc1", "mujoco-3.10.0"]
    for text in ("3.x; rm", "", "--index-url", "3.6.0/.."):
        with pytest.raises(CrankcheckError, match="not a version number"):
            environments.wanted("mujoco", ["3.6.0", text])


def test_uv_makes_the_environment_or_else_pip_and_what_is_missing_ends_it(tmp_path: Path) -> None:
    env, python = str(tmp_path / "env"), str(environments.python_of(tmp_path / "env"))
    make, install = environments.commands("/bin/uv", tmp_path / "env", ONE, tmp_path / "held.txt")
    assert (make[:2], make[-1]) == (["/bin/uv", "venv"], env)
    assert make[make.index("--python") + 1] == sys.executable
    assert (install[:3], install[-1]) == (["/bin/uv", "pip", "install"], "mujoco==3.6.0")
    assert install[install.index("--python") + 1] == python
    make, install = environments.commands(None, tmp_path / "env", ONE, tmp_path / "held.txt")
    assert make == [sys.executable, "-m", "venv", env]
    assert (install[:4], install[-1]) == ([python, "-m", "pip", "install"], "mujoco==3.6.0")
    ended = run_child([str(tmp_path / "none")], os.environ)
    assert ended.code
    assert "none: No such file" in ended.complaint


def test_only_a_complete_environment_of_the_version_is_kept(tmp_path: Path) -> None:
    installer = FakeInstaller()
    first = environments.ready(tmp_path, ONE, None, installer)
    assert environments.ready(tmp_path, ONE, None, installer) == first
    assert installer.installs == 1
    (environments.place(tmp_path, ONE) / environments.COMPLETE).unlink()
    (environments.place(tmp_path, ONE) / "half").touch()
    environments.ready(tmp_path, ONE, None, installer)
    assert installer.installs == 2
    assert not (environments.place(tmp_path, ONE) / "half").exists()
    other = tmp_path / "other"
    with pytest.raises(environments.NotMeasuredError, match="not installed: no space left"):
        environments.ready(other, ONE, None, FakeInstaller(fails="ERROR: no space left"))
    assert not environments.place(other, ONE).exists()
    with pytest.raises(environments.NotMeasuredError, match=r"finds 4\.0\.0 in place of 3\.6\.0"):
        environments.ready(other, ONE, None, FakeInstaller(finds="4.0.0"))
    assert not (environments.place(other, ONE) / environments.COMPLETE).exists()


def test_another_version_numpy_or_python_has_another_environment(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    places = [
        environments.place(tmp_path, ONE),
        environments.place(tmp_path, environments.EngineVersion("mujoco", Version("3.7.0"))),
    ]
    for module, name in ((environments, "held_numpy"), (environments.platform, "python_version")):
        monkeypatch.setattr(module, name, lambda: "3.99.1")
        places.append(environments.place(tmp_path, ONE))
    assert len({*places}) == 4


@pytest.mark.parametrize("uv", [None, "/bin/uv"])
def test_only_wheels_and_numpy_as_it_runs_get_into_the_new_one_and_no_path_of_ours(
    uv: str | None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("PYTHONPATH", "VIRTUAL_ENV", "PYTHONHOME", "PIP_TARGET", "PIP_CONSTRAINT"):
        monkeypatch.setenv(name, "elsewhere")
    monkeypatch.setenv("PIP_INDEX_URL", "kept")
    installer = FakeInstaller()
    environments.ready(tmp_path, ONE, uv, installer)
    install = next(command for command in installer.commands if "install" in command)
    assert install[install.index("--only-binary") + 1] == ":all:"
    constraint = Path(install[install.index("--constraint") + 1])
    assert constraint.read_text(encoding="utf-8") == f"numpy=={np.__version__}\n"
    for variables in (*installer.variables, environments.clean_variables()):
        assert "elsewhere" not in variables.values()
        assert variables["PIP_INDEX_URL"] == "kept"


PIP_NO_VERSION = """\
ERROR: Could not find a version that satisfies the requirement mujoco==3.65.0 (from versions: \
2.3.7, 3.6.0, 3.7.0, 4.0.0)
"""
PIP_NO_NETWORK = """\
WARNING: Retrying after connection broken by 'NewConnectionError('Failed to establish a new \
connection: [Errno 111] Connection refused')': /simple/mujoco/
ERROR: Could not find a version that satisfies the requirement mujoco==3.6.0 (from versions: none)
"""
UV_NO_VERSION = """\
  \u2570\u2500\u25b6 Because there is no version of mujoco==9.9.9 and you require mujoco==9.9.9, \
we can
      conclude that your requirements are unsatisfiable.
"""
UV_NO_WHEEL = "  cause: Because mujoco==2.3.0 has no usable wheels and you require mujoco==2.3.0"
UV_NO_NETWORK = """\
  cause: Failed to fetch: https://packages.example.com/simple/mujoco/
  cause: dns error
  cause: failed to lookup address information: Name or service not known
"""
UV_CONFLICT = """\
  \u2570\u2500\u25b6 Because mujoco==3.6.0 depends on numpy<2 and numpy==2.4.6, we can conclude that
      mujoco==3.6.0 cannot be used.
"""
GONE = """\
Looking in indexes: https://user:secret@packages.example.com/simple
ERROR: HTTP error 410 for https://packages.example.com/simple/mujoco-3.6.0.whl (Gone)
"""


@pytest.mark.parametrize(
    ("output", "parts"),
    [
        (PIP_NO_VERSION, ["no mujoco 3.65.0 is offered", "near it: 3.6.0, 3.7.0, 4.0.0"]),
        (PIP_NO_NETWORK, ["could not be reached (Connection refused)"]),
        (UV_NO_VERSION, ["no mujoco 9.9.9 is offered as a wheel for Python 3."]),
        (UV_NO_WHEEL, ["no mujoco 2.3.0 is offered as a wheel for Python 3."]),
        (UV_NO_NETWORK, ["could not be reached (Name or service not known)"]),
        (UV_CONFLICT, ["Because mujoco==3.6.0 depends on numpy<2", "mujoco==3.6.0 cannot be"]),
        (GONE, ["HTTP error 410 for the package index (Gone)"]),
        ("", ["no reason"]),
    ],
)
def test_the_reason_is_one_line_that_names_no_host(output: str, parts: list[str]) -> None:
    told = environments.reason(output)
    assert [part for part in parts if part not in told] == []
    assert "\n" not in told
    assert len(told) <= 200
    assert not re.search("example|secret|https?:|/simple|file:", told)


@pytest.mark.parametrize(
    ("platform", "env", "ending"),
    [
        ("linux", {"XDG_CACHE_HOME": "/big/cache"}, "/big/cache/crankcheck"),
        ("linux", {"XDG_CACHE_HOME": "not/absolute"}, "/.cache/crankcheck"),
        ("darwin", {}, "/Library/Caches/crankcheck"),
        ("win32", {}, "/AppData/Local/crankcheck"),
        ("win32", {"LOCALAPPDATA": "/users/me/local"}, "/users/me/local/crankcheck"),
    ],
)
@pytest.mark.skipif(sys.platform == "win32", reason="paths are written as POSIX has them")
def test_the_cache_is_where_caches_are(platform: str, env: dict[str, str], ending: str) -> None:
    assert str(user_cache(platform, env)).endswith(ending)


def test_who_comes_second_waits_and_says_so(tmp_path: Path) -> None:
    (tmp_path / "locks").mkdir()
    first, told = FileLock(tmp_path / "locks" / "one.lock"), []

    def told_to_wait() -> None:
        told.append("waiting")
        first.release()

    with first, alone(tmp_path / "locks" / "one.lock", told_to_wait):
        assert not first.is_locked
    assert told == ["waiting"]
