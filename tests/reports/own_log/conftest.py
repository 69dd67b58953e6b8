"""Judge a stranger's log as a user does: a file, perhaps a map beside it, and the command."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import pytest
from typer.main import get_command
from typer.testing import CliRunner

from reports.cli import app


@dataclass(frozen=True)
class Said:
    """How a command ended, and what it said."""

    exit_code: int
    output: str
    stderr: str


Judge = Callable[..., Said]
TARGET = ("--target", "1e-3")


@cache
def command() -> Callable[[Sequence[str]], object]:
    """The command line, built once: that takes nearly as long as to judge a small log."""
    return get_command(app)


def said(arguments: Sequence[str]) -> Said:
    """Run the command in this process."""
    code: object = 0
    with CliRunner().isolation() as (output, errors, _):
        try:
            command()(arguments)
        except SystemExit as end:
            code = end.code or 0
        texts = [stream.getvalue().decode() for stream in (output, errors)]
    assert isinstance(code, int), code
    return Said(code, *texts)


@pytest.fixture
def judge(tmp_path: Path) -> Judge:
    """Run ``crankcheck judge`` on a log with these bytes, or one that is there already."""

    def run(
        scene: str,
        log: bytes | Path,
        *options: str,
        mapped: str = "",
        name: str = "log.csv",
        target: Sequence[str] = TARGET,
    ) -> Said:
        path = log if isinstance(log, Path) else tmp_path / name
        if isinstance(log, bytes):
            path.write_bytes(log)
        if mapped:
            (tmp_path / "map.toml").write_text(mapped, encoding="utf-8")
            options = (*options, "--map", str(tmp_path / "map.toml"))
        return said(["judge", scene, str(path), *target, *options])

    return run
