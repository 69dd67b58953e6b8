"""The engine of examples/engine as a user has it: in a folder, or installed; and with faults."""

import sys
import tomllib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

import pytest

from sim.own_engine import known

EXAMPLE = Path(__file__).parents[2] / "examples" / "engine"
CODE = (EXAMPLE / "penalty_engine.py").read_text(encoding="utf-8")
PROJECT = tomllib.loads((EXAMPLE / "pyproject.toml").read_text(encoding="utf-8"))["project"]
ENTRY_POINTS: Mapping[str, str] = PROJECT["entry-points"]["crankcheck.engines"]


def installed(
    folder: Path, entry_points: Mapping[str, str] = ENTRY_POINTS, package: str = PROJECT["name"]
) -> None:
    """What pip leaves of the example in a folder, but for what nobody reads."""
    (folder / "penalty_engine.py").write_text(CODE)
    info = folder / f"{package.replace('-', '_')}-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {package}\nVersion: 1.0\n")
    lines = [f"{name} = {value}" for name, value in entry_points.items()]
    (info / "entry_points.txt").write_text("\n".join(["[crankcheck.engines]", *lines, ""]))


def with_faults(changes: Mapping[str, str]) -> str:
    """The code of the example with some of it replaced."""
    code = CODE
    for old, new in changes.items():
        assert old in code
        code = code.replace(old, new)
    return code


@contextmanager
def fresh(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """A process that works in a folder and has met no engine of a user's own, nor will have."""
    monkeypatch.chdir(folder)
    monkeypatch.setattr(sys, "path", [*sys.path])
    monkeypatch.setattr(known, "_known", {})
    monkeypatch.setattr(known, "_told", {})
    before = set(sys.modules)
    yield
    for name in set(sys.modules) - before:
        if str(getattr(sys.modules[name], "__file__", "")).startswith(str(folder)):
            del sys.modules[name]
