"""Runs all that a page of documentation shows, in a folder, as its reader would: first what its
examples start from, then its commands, then its Python."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

from tests.worlds.command import PYTHON
from tests.worlds.documents import blocks, commands, follows, ran, scripts, started, words

ROOT = Path(__file__).parents[2]
OWN_ENGINE = "penalty_engine:ENGINE"
EXAMPLE = ROOT / "examples" / "engine"
END = "--- end of example {} ---"


def faults_of(page: str, folder: Path) -> str:
    """What a page shows otherwise than it is, "" where there is nothing. Files are left in the
    folder."""
    prepare(page, folder)
    return "\n\n".join(
        each for each in (told_otherwise(page, folder), *printed_otherwise(page, folder)) if each
    )


def prepare(page: str, folder: Path) -> None:
    """Write what the examples of a page start from: its scenes (blocks of ``toml`` that begin with
    a name), its model (the block of ``xml``, called as the first command has it), and the engine of
    the example where the page is about that."""
    for text in blocks(page, "toml"):
        if name := re.match('name = "(.+)"', text):
            (folder / f"{name[1]}.toml").write_text(text, encoding="utf-8")
    for text in blocks(page, "xml")[:1]:
        name = re.search(r"[\w-]+\.xml", " ".join(command for command, _, _ in commands(page)))
        assert name is not None, "a model that no command of the page names"
        (folder / name[0]).write_text(text, encoding="utf-8")
    if OWN_ENGINE in page:
        for path in EXAMPLE.glob("*.*"):
            (folder / path.name).write_bytes(path.read_bytes())


def told_otherwise(page: str, folder: Path) -> str:
    """The commands of a page that end or print otherwise, "" where there are none. Where the folder
    has an engine of its own each is a process of its own, as only that finds it."""
    run = started if OWN_ENGINE in page else ran
    faults = []
    for command, shown, code in commands(page):
        try:
            done = run(words(command), folder)
        except FileNotFoundError as missing:
            faults.append(f"$ {command}\nneeds {missing.filename}, which this machine has not")
            continue
        printed = [line.rstrip() for line in done.stdout.splitlines()]
        fault = follows([line.rstrip() for line in shown], printed)
        if done.returncode != code or fault:
            faults.append(f"$ {command}\nexit {done.returncode}\n{fault}\n{done.stderr}")
    return "\n\n".join(faults)


def printed_otherwise(page: str, folder: Path) -> list[str]:
    """The blocks of Python that print something else than what stands below them: one after the
    other in one process, as a reader would in a notebook. Where nothing stands below any block of
    the page, they only have to run."""
    examples: Sequence[tuple[str, list[str] | None]] = scripts(page)
    if not examples:
        return []
    parts = [f"{code}\nprint({END.format(at)!r})" for at, (code, _) in enumerate(examples)]
    done = ran([PYTHON, "-P", "-c", "\n".join(parts)], folder)
    if done.returncode != 0 or done.stderr:
        return [done.stdout[-2000:] + done.stderr]
    faults, rest = [], done.stdout
    for at, (code, shown) in enumerate(examples):
        printed, _, rest = rest.partition(f"{END.format(at)}\n")
        if shown is None:
            if printed and any(told for _, told in examples):
                faults.append(f"{code}\nprints, and the page does not say what\n{printed}")
        elif fault := follows(shown, [line.rstrip() for line in printed.splitlines()]):
            faults.append(f"{code}\n{fault}")
    return faults
