"""The pages of docs are true: their examples run from top to bottom, and every name of the face is
shown."""

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest

import crankcheck
from crankcheck import engine, testing
from tests.worlds.command import PYTHON
from tests.worlds.documents import blocks, commands, follows, ran, scripts, started, words

DOCS = Path(__file__).parents[1] / "docs"
PAGE = (DOCS / "python.md").read_text(encoding="utf-8")
OWN_LOG = (DOCS / "how-to" / "judge-my-log.md").read_text(encoding="utf-8")
OWN_ENGINE = (DOCS / "how-to" / "add-an-engine.md").read_text(encoding="utf-8")
OWN_MODEL = (DOCS / "how-to" / "own-model.md").read_text(encoding="utf-8")
FORCES = (DOCS / "forces.md").read_text(encoding="utf-8")
ELASTIC = (DOCS / "elastic.md").read_text(encoding="utf-8")
FREE = (DOCS / "free.md").read_text(encoding="utf-8")
DRAWINGS = (DOCS / "drawings.md").read_text(encoding="utf-8")
Run = Callable[[Sequence[str], Path], "subprocess.CompletedProcess[str]"]
END = "--- end of example {} ---"


def test_every_example_prints_what_stands_below_it(tmp_path: Path) -> None:
    """One after the other in one process, as a reader would in a notebook."""
    examples = scripts(PAGE)
    assert len(examples) >= 10
    faults = printed_otherwise(examples, tmp_path)
    assert not faults, "\n\n".join(faults)


def printed_otherwise(examples: Sequence[tuple[str, list[str] | None]], folder: Path) -> list[str]:
    """The examples that print something else than what stands below them."""
    parts = [f"{code}\nprint({END.format(at)!r})" for at, (code, _) in enumerate(examples)]
    done = ran([PYTHON, "-P", "-c", "\n".join(parts)], folder)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr
    assert done.stderr == ""
    faults, rest = [], done.stdout
    for at, (code, shown) in enumerate(examples):
        printed, _, rest = rest.partition(f"{END.format(at)}\n")
        if shown is None:
            assert not printed, code
        elif fault := follows(shown, [line.rstrip() for line in printed.splitlines()]):
            faults.append(f"{code}\n{fault}")
    return faults


def test_what_is_said_of_own_logs_is_true(tmp_path: Path) -> None:
    assert not told_otherwise(OWN_LOG, tmp_path)


def test_what_is_said_of_forces_is_true(tmp_path: Path) -> None:
    """Of scenes that stand on the page: a command's start each, some 20 s in all."""
    for text in blocks(FORCES, "toml"):
        name = re.search('name = "(.+)"', text)
        assert name is not None
        (tmp_path / f"{name[1]}.toml").write_text(text)
    assert not told_otherwise(FORCES, tmp_path)
    assert not printed_otherwise(scripts(FORCES), tmp_path)
    drawn = {path.stem for path in (tmp_path / "figs").iterdir()}
    assert drawn == {name for name in drawn if f"`{name}`" in FORCES}


def test_what_is_said_of_free_motion_is_true(tmp_path: Path) -> None:
    """Of a scene that stands on the page: a command's start each, some 10 s in all."""
    (text,) = (each for each in blocks(FREE, "toml") if each.startswith("name"))
    (tmp_path / "dropped.toml").write_text(text)
    assert not told_otherwise(FREE, tmp_path)


def test_what_is_said_of_drawings_is_true(tmp_path: Path) -> None:
    """Each sheet and table of the page: a command's start each, some 15 s in all."""
    assert not told_otherwise(DRAWINGS, tmp_path)


def test_what_is_said_of_elastic_links_is_true(tmp_path: Path) -> None:
    """Of a scene that stands on the page: a command's start each, some 10 s in all."""
    (text,) = (each for each in blocks(ELASTIC, "toml") if each.startswith("name"))
    (tmp_path / "whip.toml").write_text(text)
    assert not told_otherwise(ELASTIC, tmp_path)
    drawn = {path.stem for path in (tmp_path / "figs").iterdir()}
    assert drawn == {name for name in drawn if f"`{name}`" in ELASTIC}


def test_what_is_said_of_own_engines_is_true(tmp_path: Path) -> None:
    """In the folder of the example, which a process of its own finds its engine in: some 10 s, most
    of them for the whole contract."""
    for path in (DOCS.parent / "examples" / "engine").glob("*.*"):
        (tmp_path / path.name).write_bytes(path.read_bytes())
    assert not told_otherwise(OWN_ENGINE, tmp_path, started)


def test_what_is_said_of_own_models_is_true(tmp_path: Path) -> None:
    """What the commands print of a model that stands on the page, before and after the diff."""
    if shutil.which("patch") is None:
        pytest.skip("no patch: apt-get install patch")
    (model,) = blocks(OWN_MODEL, "xml")
    (tmp_path / "engine.xml").write_text(model)
    assert not told_otherwise(OWN_MODEL, tmp_path)
    written = {path.name for path in (tmp_path / "out").iterdir()}
    assert written == {name for name in written if f"`{name}`" in OWN_MODEL}


def told_otherwise(page: str, folder: Path, run: Run = ran) -> str:
    """The commands of a page that end or print otherwise, "" where there are none."""
    faults = []
    for command, shown, code in commands(page):
        done = run(words(command), folder)
        printed = [line.rstrip() for line in done.stdout.splitlines()]
        fault = follows([line.rstrip() for line in shown], printed)
        if done.returncode != code or fault:
            faults.append(f"$ {command}\nexit {done.returncode}\n{fault}\n{done.stderr}")
    return "\n\n".join(faults)


def test_every_name_for_engines_stands_on_its_page() -> None:
    prose = re.sub(r"```.*?```", "", OWN_ENGINE, flags=re.DOTALL)
    told = set(re.findall(r"\w+", " ".join(re.findall(r"`[^`]+`", prose))))
    assert not set(engine.__all__) - told


def test_every_name_of_the_face_stands_on_the_page() -> None:
    code = " ".join(blocks(PAGE, "python"))
    prose = re.sub(r"```.*?```", "", PAGE, flags=re.DOTALL)
    shown = set(re.findall(r"\w+", " ".join([code, *re.findall(r"`[^`]+`", prose)])))
    missing = {*crankcheck.__all__, *testing.__all__} - shown
    assert not missing
