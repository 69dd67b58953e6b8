"""The command line, in the process of the tests."""

import re
from pathlib import Path

from typer.testing import CliRunner, Result

from models.files.reading import shipped
from reports.cli import app
from tests.worlds.in_process import in_this_process


def crank(*arguments: object) -> Result:
    """What comes of the command `crankcheck`; an exception that it lets out is raised here."""
    return CliRunner().invoke(app, [str(each) for each in arguments], catch_exceptions=False)


def crank_alone(*arguments: object) -> Result:
    """As `crank`; what works in children elsewhere, as sweeps do, works in this process."""
    with in_this_process():
        return crank(*arguments)


def flat(text: str) -> str:
    """The text in one line, without the frames of tables, whatever the width that it is set to."""
    return " ".join(text.replace("│", " ").split())


def refused(result: Result, *parts: str) -> None:
    """The command ended with exit code 2 and a message that has all the parts."""
    assert result.exit_code == 2, result.output
    assert "Traceback" not in result.output
    message = flat(result.stderr)
    assert [part for part in parts if part not in message] == [], message


def told(line: str, *more: object, code: int = 0) -> str:
    """What the command of a line, with more arguments, prints before it ends with this code."""
    result = crank(*line.split(), *more)
    assert result.exit_code == code, result.output
    return result.output


def edited(folder: Path, name: str, *changes: tuple[str, str]) -> Path:
    """A shipped scene with some of its text, as regular expressions, changed, as a file."""
    text = shipped()[name].read_text(encoding="utf-8")
    for old, new in changes:
        text, count = re.subn(old, new, text)
        assert count
    path = folder / "edited.toml"
    path.write_text(text, encoding="utf-8")
    return path
