"""Which mutants the tests kill: the power of `make test`, of `make slow`, and of the tests before.

    python -m benchmarks.mutants run     # hours in the background; resumes after a cut
    python -m benchmarks.mutants table   # counts by folder, and the survivors

Each mutant of `benchmarks/mutants.json` runs against the tests that reach its line, in the nearest
folder first, until one fails. What `make test` misses runs in `make slow` and in the tests at the
tag `tests-before`, or commit BEFORE where there is no tag. A mutant follows its line where that
moves. All stands in `out/mutants`: three records of what tests reach (`tests/recorded`), checkouts
to spoil, and a line for each verdict.
"""

import ast
import json
import os
import resource
import shutil
import subprocess
import sys
import time
from collections import defaultdict
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from threading import Lock

from benchmarks.mutants_drawn import BEFORE, Mutant, followed, listed
from tests.recorded import chosen, quick
from tests.recorded.reached import Reached
from tests.recorded.recording import OURS, ROOT

HOME = ROOT / "out" / "mutants"
VERDICTS = HOME / "verdicts.jsonl"
WORKERS = 2
FIRST = 200
"""Tests of a first run, the nearest: to collect all that reach a line may take longer."""
MOST_BYTES = 8 * 10**9
"""Of the data of a process; a test needs a fourth."""
KILLED, SURVIVED, UNREACHED = "killed", "survived", "unreached"
_writing = Lock()


@dataclass(frozen=True)
class Suite:
    """Tests of one commit and tier, and the checkout that they were recorded in."""

    name: str
    commit: str
    tier: str

    @property
    def tree(self) -> Path:
        return HOME / f"tree-{self.commit}"

    @property
    def record(self) -> Path:
        return HOME / f"record-{self.name}-{self.commit}"

    def mutants(self) -> list[Mutant]:
        """The list, where it stands in this commit; without those whose line is gone."""
        if self.name == "before":
            return listed()
        checkout(self.commit, self.tree)
        found = (followed(mutant, self.tree) for mutant in listed())
        return [mutant for mutant in found if mutant is not None]


def suites() -> dict[str, Suite]:
    """The three, with the commits that they stand for."""
    now = _git("log", "-1", "--format=%h", "--", *OURS)  # other commits change no verdict
    tag = subprocess.run(["git", "rev-parse", "--short", "tests-before"], cwd=ROOT,
                         capture_output=True, text=True, check=False)  # fmt: skip
    before = tag.stdout.strip() or BEFORE
    return {
        "test": Suite("test", now, quick.TIER),
        "slow": Suite("slow", now, "slow and not long"),
        "before": Suite("before", before, "not slow"),
    }


def _git(*arguments: str) -> str:
    return subprocess.check_output(["git", *arguments], cwd=ROOT, text=True).strip()


def checkout(commit: str, folder: Path) -> Path:
    """A clone at a commit, with today's way of recording; one that is there stays."""
    if not folder.exists():
        folder.parent.mkdir(parents=True, exist_ok=True)
        _git("clone", "--quiet", "--shared", str(ROOT), str(folder))
        subprocess.check_call(["git", "checkout", "--quiet", commit], cwd=folder)
        shutil.copytree(
            ROOT / "tests" / "recorded", folder / "tests" / "recorded", dirs_exist_ok=True
        )
    return folder


def reached(suite: Suite, mutants: Iterable[Mutant]) -> Reached:
    """The record of a suite for the lines of these mutants, made where there is none."""
    checkout(suite.commit, suite.tree)
    files = {file for each in mutants for file in _files(each, suite.tree)}
    done = suite.record / quick.DONE.name
    if not done.exists() or not files <= set(done.read_text(encoding="utf-8").splitlines()):
        print(f"recording {suite.name} at {suite.commit}: {len(files)} files", flush=True)
        quick.record(suite.record, suite.tree, tier=suite.tier, files=sorted(files))
    return Reached(suite.record, suite.tree)


def _files(mutant: Mutant, root: Path) -> list[str]:
    """The files whose tests may find the mutant. A line that runs when its file is imported counts
    as run by whatever runs a line of the file or of one that imports it."""
    if statement(root / mutant.file, mutant.line)[2]:
        return [mutant.file]
    module = mutant.file.removesuffix(".py").removesuffix("/__init__").replace("/", ".")
    return [mutant.file, *quick.importers(module, root)]


def reaching(mutant: Mutant, record: Reached) -> list[str]:
    """The tests that run the line, in the nearest folder first, then the cheapest."""
    first, last, in_function = statement(record.root / mutant.file, mutant.line)
    if in_function:
        by_line = record.by_line(mutant.file)
        tests = {t for line in range(first, last + 1) for t in by_line.get(line, ())}
    else:
        tests = set().union(*map(record.by_file, _files(mutant, record.root)))
    good = tests - record.failed
    return sorted(good, key=lambda name: (-_near(mutant.file, name), record.seconds[name], name))


def _near(file: str, test: str) -> int:
    """How many folders the test shares with the place that mirrors the file."""
    there = Path("tests", file).parent.parts
    here = Path(test.partition("::")[0]).parent.parts
    return sum(1 for k in range(len(there)) if here[: k + 1] == there[: k + 1])


def statement(path: Path, line: int) -> tuple[int, int, bool]:
    """The lines of the innermost statement, of a compound one its head, and whether it stands in a
    function."""
    found, in_function = (line, line), False
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if not isinstance(node, ast.stmt) or not node.lineno <= line <= (node.end_lineno or 0):
            continue
        body = getattr(node, "body", None)
        last = body[0].lineno - 1 if body else node.end_lineno or line
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) and last < line:
            in_function = True
        if node.lineno <= line <= last:
            found = (node.lineno, last)
    return *found, in_function


def verdict(mutant: Mutant, tests: list[str], record: Reached, tree: Path) -> tuple[str, str]:
    """Whether a test fails on the mutant, and which is the first."""
    path = tree / mutant.file
    text = path.read_text(encoding="utf-8")
    path.write_text(mutant.applied(text), encoding="utf-8")
    try:
        for some in filter(None, (tests[:FIRST], tests[FIRST:])):
            seconds = 600.0 + 5.0 * sum(record.seconds[name] for name in some)
            if killer := _failing(some, tree, seconds):
                return KILLED, killer
    finally:
        path.write_text(text, encoding="utf-8")
    return (SURVIVED, f"{len(tests)} tests") if tests else (UNREACHED, "")


def _failing(tests: list[str], tree: Path, most_s: float) -> str:
    """The test that fails first; empty if all pass."""
    listing = tree.with_suffix(".chosen")
    files = chosen.write(tests, listing, tree)
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", "--tb=no"]
    variables = {
        chosen.VARIABLE: str(listing),
        "PYTHONPATH": str(tree),
        "OPENBLAS_NUM_THREADS": "1",
    }
    done = subprocess.Popen(
        [*command, "-p", "tests.recorded.chosen", *files],
        cwd=tree,
        env={**os.environ, **variables},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        start_new_session=True,
    )
    # A mutant that asks for all memory is refused it.
    resource.prlimit(done.pid, resource.RLIMIT_DATA, (MOST_BYTES, MOST_BYTES))
    try:
        output, _ = done.communicate(timeout=most_s)
    except subprocess.TimeoutExpired:
        os.killpg(done.pid, 9)
        done.communicate()
        return "no end"
    if done.returncode in (0, 5):
        return ""
    lines = [line for line in output.splitlines() if line.startswith(("FAILED", "ERROR"))]
    return lines[0].partition(" - ")[0] if lines else f"exit {done.returncode}"


def known() -> dict[tuple[int, str], dict[str, str]]:
    """The verdicts so far, by mutant and suite, of the commits that stand now."""
    rows = map(json.loads, VERDICTS.read_text().splitlines()) if VERDICTS.exists() else []
    now = suites()
    return {(r["number"], r["suite"]): r for r in rows if r["commit"] == now[r["suite"]].commit}


def run(names: Iterable[str] = ("test", "slow", "before")) -> None:
    """All verdicts that are missing."""
    began, own = time.perf_counter(), suites()
    for name in names:
        seen = known()
        every = own[name].mutants()
        missing = [
            m
            for m in every
            if (m.number, name) not in seen
            and (name == "test" or seen.get((m.number, "test"), {}).get("verdict") != KILLED)
        ]
        if not missing:
            continue
        record = reached(own[name], every if name == "test" else missing)
        trees = [
            checkout(own[name].commit, HOME / f"{own[name].commit}-{k}") for k in range(WORKERS)
        ]
        with ThreadPoolExecutor(WORKERS) as pool:
            shares = [missing[k::WORKERS] for k in range(WORKERS)]
            list(pool.map(_share, shares, [record] * WORKERS, [own[name]] * WORKERS, trees))
    print(f"{time.perf_counter() - began:.0f} s")


def _share(mutants: list[Mutant], record: Reached, suite: Suite, tree: Path) -> None:
    for mutant in mutants:
        with _writing:  # one query of the record at a time
            tests = reaching(mutant, record)
        began = time.perf_counter()
        how, which = verdict(mutant, tests, record, tree)
        row = {
            "number": mutant.number,
            "suite": suite.name,
            "commit": suite.commit,
            "verdict": how,
            "by": which,
            "seconds": round(time.perf_counter() - began, 1),
        }
        with _writing, VERDICTS.open("a", encoding="utf-8") as stream:
            stream.write(json.dumps(row) + "\n")
        print(suite.name, mutant.number, mutant.file, how, which, row["seconds"], flush=True)


def table() -> None:
    """Counts by folder: the mutants, those that `make test` kills, and of those that it misses the
    ones that the other two suites kill; then who survives what."""
    seen, by_folder = known(), defaultdict[str, list[Mutant]](list)
    for mutant in listed():
        by_folder["/".join(mutant.file.split("/")[:-1][:2])].append(mutant)
    by_folder["all"] = listed()

    def kills(mutant: Mutant, name: str) -> bool:
        return seen.get((mutant.number, name), {}).get("verdict") == KILLED

    print("folder                      mutants  make test  missed, but make slow  but before")
    for folder, some in by_folder.items():
        missed = [m for m in some if not kills(m, "test")]
        slow, before = (sum(kills(m, name) for m in missed) for name in ("slow", "before"))
        print(f"{folder:28}{len(some):7}{len(some) - len(missed):11}{slow:23}{before:12}")
    for mutant in listed():
        if not kills(mutant, "test"):
            rows = {n: seen.get((mutant.number, n), {}) for n in ("test", "slow", "before")}
            said = "  ".join(
                f"{name}: {row.get('verdict', 'gone, or not run')} {row.get('by', '')}"
                for name, row in rows.items()
            )
            print(f"{mutant.number} {mutant.file}:{mutant.line} {mutant.old} -> {mutant.new}")
            print(f"    {said}")


if __name__ == "__main__":
    {"run": run, "table": table}[sys.argv[1] if len(sys.argv) > 1 else "run"]()
