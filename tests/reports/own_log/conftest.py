"""Judge a stranger's log as a user does: a file, perhaps a map beside it, and the command."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from reports.cli import app

Judge = Callable[..., Result]
TARGET = ("--target", "1e-3")


@pytest.fixture
def judge(tmp_path: Path) -> Judge:
    """Run ``crankcheck judge`` on a log with these bytes, or one that is there already."""
    runner = CliRunner()

    def run(
        scene: str,
        log: bytes | Path,
        *options: str,
        mapped: str = "",
        name: str = "log.csv",
        target: Sequence[str] = TARGET,
    ) -> Result:
        path = log if isinstance(log, Path) else tmp_path / name
        if isinstance(log, bytes):
            path.write_bytes(log)
        if mapped:
            (tmp_path / "map.toml").write_text(mapped, encoding="utf-8")
            options = (*options, "--map", str(tmp_path / "map.toml"))
        arguments = ["judge", scene, str(path), *target, *options]
        return runner.invoke(app, arguments, catch_exceptions=False)

    return run
