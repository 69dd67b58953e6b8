"""Runs all that a page of documentation shows, in a folder, as its reader would: first what its
examples start from, then its commands, then its Python; and compares what is printed.

A line of ``...`` stands for any lines, and ``...`` in a line for any words. Words and numbers must
be the same, but for the rows of a verdict: their numbers, which processors may move a little, must
agree to 10 %.
"""

import contextlib
import math
import os
import re
import shlex
import subprocess
from collections.abc import Sequence
from pathlib import Path

from typer.testing import CliRunner

from reports.cli import app
from tests.worlds.command import COMMAND, PYTHON, VARIABLE

IN_PARTS = ("tour", "reference/tolerances")
"""Pages of docs that tests/test_readme.py tries part by part, and tests/test_docs.py leaves out."""
NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
ANY = "..."


def blocks(page: str, language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", page, flags=re.DOTALL)


def commands(page: str) -> list[tuple[str, list[str], int]]:
    """Each command with the lines that should follow, and the exit code stated by ``$ echo $?``."""
    found: list[tuple[str, list[str], int]] = []
    for block in blocks(page, "console"):
        for part in re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]:
            command, *lines = part.rstrip("\n").split("\n")
            if command == "echo $?":
                last = found.pop()
                found.append((last[0], last[1], int(lines[0])))
            else:
                found.append((command, lines, 0))
    return found


def scripts(page: str) -> list[tuple[str, list[str] | None]]:
    """Each block of Python, and the lines of the block of ``text`` right below it, if there is
    one."""
    found = re.findall(r"```python\n(.*?)```(?:\n\n```text\n(.*?)```)?", page, flags=re.DOTALL)
    return [(code, text.rstrip("\n").split("\n") if text else None) for code, text in found]


def parts(page: str) -> dict[str, str]:
    """The page taken apart: pages of those examples that share a file, by the first of them. Each
    runs without the others."""
    shown = {command: _console(command, lines, code) for command, lines, code in commands(page)}
    told, code = list(shown), []
    for script, text in scripts(page):
        code.append(script)
        shown[script] = f"```python\n{script}```\n"
        if text is not None:
            shown[script] += "\n```text\n{}\n```\n".format("\n".join(text))
    return {steps[0]: "\n".join(shown[step] for step in steps) for steps in threads(told, code)}


def _console(command: str, lines: Sequence[str], code: int) -> str:
    ended = ["$ echo $?", str(code)] if code else []
    return "\n".join(["```console", f"$ {command}", *lines, *ended, "```", ""])


def threads(told: Sequence[str], code: Sequence[str]) -> list[list[str]]:
    """Commands, then scripts, in the order of the page; those together that share a file, which
    stands behind ``-o`` of a command and in others too. Each thread runs without the others."""
    steps = (*told, *code)
    found: list[set[int]] = []
    for at, step in enumerate(steps):
        shared = [
            one for one in found if any(_uses(step, file) for i in one for file in _made(steps[i]))
        ]
        found = [one for one in found if one not in shared]
        found.append({at}.union(*shared))
    return [[steps[i] for i in sorted(one)] for one in sorted(found, key=min)]


def _made(step: str) -> list[str]:
    return re.findall(r"-o (\S+)", step)


def _uses(step: str, file: str) -> bool:
    """Whether a command names a file, or a script does between quotes."""
    return re.search(rf"(?<![\w.]){re.escape(file)}(?=$|[ /\"'])(?! =)", step) is not None


def words(command: str) -> list[str]:
    name, *rest = shlex.split(command)
    programs = {"crankcheck": COMMAND, "python": PYTHON}
    return [programs.get(name, name), *rest]


def ran(command: Sequence[str], folder: Path) -> subprocess.CompletedProcess[str]:
    """What came of a command. Ours is called in this process, as most take no longer than a start;
    that of a wheel and every other one is started."""
    if command[0] != COMMAND or VARIABLE in os.environ:
        return started(command, folder)
    with contextlib.chdir(folder):
        done = CliRunner().invoke(app, list(command[1:]), catch_exceptions=False)
    return subprocess.CompletedProcess(command, done.exit_code, done.stdout, done.stderr)


def started(command: Sequence[str], folder: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(command, capture_output=True, text=True, cwd=folder, check=False)


def same(shown: str, printed: str) -> bool:
    """The same words, and numbers that agree."""
    if ANY in shown:
        parts = [re.escape(" ".join(part.split())) for part in shown.split(ANY)]
        return re.fullmatch(r"\s*" + ".*".join(parts), " ".join(printed.split())) is not None
    ours, theirs = NUMBER.split(shown), NUMBER.split(printed)
    if [" ".join(w.split()) for w in ours] != [" ".join(w.split()) for w in theirs]:
        return False
    tolerance = 0.1 if shown.lstrip().startswith(("ok ", "OUT ")) else 0.0
    pairs = zip(NUMBER.findall(shown), NUMBER.findall(printed), strict=True)
    return all(a == b or math.isclose(float(a), float(b), rel_tol=tolerance) for a, b in pairs)


def follows(shown: Sequence[str], printed: Sequence[str]) -> str:
    """Empty where ``printed`` reads as ``shown``; else the first line that does not."""
    at, free = 0, False
    for line in shown:
        if line.strip() == ANY:
            free = True
            continue
        ahead = range(at, len(printed)) if free else range(at, min(at + 1, len(printed)))
        hit = next((i for i in ahead if same(line, printed[i])), None)
        if hit is None:
            near = printed[at] if at < len(printed) else "(end)"
            return f"the page says\n  {line}\nwhat is printed\n  {near}"
        at, free = hit + 1, False
    return ""


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
