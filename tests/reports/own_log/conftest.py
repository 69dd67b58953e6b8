"""Judge a stranger's log as a user does: a file, perhaps a map beside it, and the command."""

from collections.abc import Callable, Sequence
from pathlib import Path

import pytest
from typer.testing import Result

from tests.worlds.command_line import crank

Judge = Callable[..., Result]


@pytest.fixture
def judge(tmp_path: Path) -> Judge:
    """Run ``crankcheck judge`` on these bytes, or a log that is there; it has to end with
    ``code``."""

    def run(
        scene: str,
        log: bytes | Path,
        *options: object,
        code: int = 0,
        mapped: str = "",
        name: str = "log.csv",
        target: Sequence[str] = ("--target", "1e-3"),
    ) -> Result:
        path = log if isinstance(log, Path) else tmp_path / name
        if isinstance(log, bytes):
            path.write_bytes(log)
        if mapped:
            (tmp_path / "map.toml").write_text(mapped, encoding="utf-8")
            options = (*options, "--map", tmp_path / "map.toml")
        result = crank("judge", scene, path, *target, *options)
        assert result.exit_code == code, result.output + mapped
        return result

    return run
