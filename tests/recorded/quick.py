"""`make quick`: the tests that reach what differs from main, or FILES; `make record`: the record.

    make quick                         # what differs from main, committed or not
    make quick FILES="reports/page"    # these files and folders

Which test reaches which file is recorded once (`make record`, in `.recorded/`), by running what
`make test` runs: twice its time. Tests that are new or changed since are run whole.
"""

import ast
import functools
import os
import shutil
import subprocess
import sys
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from tests.recorded import chosen, recording
from tests.recorded.reached import Reached
from tests.recorded.recording import OURS, ROOT

FOLDER = ROOT / ".recorded"
DONE = FOLDER / "done"
TIER = "not slow and not long"
DOCUMENTS = {
    "README.md": ["tests/test_readme.py", "tests/docs/test_pages.py"],
    "docs": ["tests/test_readme.py", "tests/test_docs.py", "tests/docs"],
}
"""What no line of code stands for, and its tests."""


def record(
    folder: Path = FOLDER, root: Path = ROOT, *, tier: str = TIER, files: Iterable[str] = ()
) -> None:
    """Run a tier of the tests of a checkout, and note what each reaches, of all our files or of
    these."""
    files = list(files)
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    settings = recording.settings(folder, root, files)
    variables = {"COVERAGE_PROCESS_START": str(settings), "PYTHONPATH": str(root)}
    if _pytest(["-p", "tests.recorded.recording", "-m", tier], root, variables) not in (0, 1):
        raise SystemExit(f"{root}: the tests could not be run; nothing was recorded")
    (folder / DONE.name).write_text("\n".join(files), encoding="utf-8")


def _pytest(arguments: Sequence[str], root: Path, variables: dict[str, str]) -> int:
    command = [sys.executable, "-m", "pytest", "-q", "-n", "2", "--dist", "worksteal", *arguments]
    own = {**os.environ, "OPENBLAS_NUM_THREADS": "1", **variables}  # a thread each: see Makefile
    own.pop("PYTEST_CURRENT_TEST", None)  # of a test that records others
    return subprocess.call(command, cwd=root, env=own)


def differing() -> list[str]:
    """The files that differ from where this branch left main, those not committed included."""
    base = _git("merge-base", "HEAD", "main")[0]
    return [*_git("diff", "--name-only", base), *_git("ls-files", "-o", "--exclude-standard")]


def _git(*arguments: str) -> list[str]:
    return subprocess.check_output(["git", *arguments], cwd=ROOT, text=True).splitlines()


def expanded(files: Iterable[str]) -> list[str]:
    """The files themselves, and those below what is a folder. Raises SystemExit for no file."""
    found: list[str] = []
    for name in files:
        path = ROOT / name
        if not path.exists():
            raise SystemExit(f"make quick: {name}: no file or folder of this checkout")
        below = [path, *path.rglob("*")] if path.is_dir() else [path]
        found += [each.relative_to(ROOT).as_posix() for each in below if each.is_file()]
    return [name for name in found if "__pycache__" not in name]


def tests_of(files: Iterable[str], reached: Reached) -> tuple[set[str], set[str]]:
    """The recorded tests that reach any of the files, and the tests that are to be run whole."""
    tests, whole = set[str](), set[str]()
    for file in files:
        top = file.partition("/")[0]
        if file.startswith("tests/") and Path(file).name.startswith("test_"):
            whole.add(file)
        elif top in DOCUMENTS:
            whole.update(DOCUMENTS[top])
        elif top in OURS:
            found = _reach(file, reached)
            tests |= found
            if not found:
                whole.add(_mirrored(file))
    return tests, {name for name in whole if (ROOT / name).exists()}


def _reach(file: str, reached: Reached) -> set[str]:
    """The tests that run lines of a file; of what has none that run (constants, templates, scenes),
    those of what imports it, or of the code beside it."""
    if own := reached.by_file(file):
        return own
    name = file.removesuffix(".py").removesuffix("/__init__").replace("/", ".")
    beside = sorted((ROOT / file).parent.glob("*.py")) if not file.endswith(".py") else []
    others = [path.relative_to(ROOT).as_posix() for path in beside] or importers(name)
    return set().union(*map(reached.by_file, others))


def importers(module: str, root: Path = ROOT) -> list[str]:
    """The files of the packages and of the tests that import from a module."""
    return sorted(_importers(root)[module])


@functools.cache
def _importers(root: Path) -> Mapping[str, set[str]]:
    """The files that import from each module."""
    found = defaultdict[str, set[str]](set)
    for path in (path for top in OURS for path in (root / top).rglob("*.py")):
        file = path.relative_to(root).as_posix()
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and node.module:
                for name in (node.module, *(f"{node.module}.{each.name}" for each in node.names)):
                    found[name].add(file)
    return found


def _mirrored(file: str) -> str:
    """The nearest folder of tests for a file that no test was seen to reach."""
    folder = Path("tests", file).parent
    while not (ROOT / folder).exists():
        folder = folder.parent
    return folder.as_posix()


def main() -> int:
    if sys.argv[1:] == ["record"]:
        record()
        return 0
    files = expanded(sys.argv[1:]) if sys.argv[1:] else expanded(filter(_there, differing()))
    if not files:
        print("make quick: nothing differs from main; name FILES, or run make test")
        return 0
    if not DONE.exists():
        print("make quick: recording what each test reaches, once; it takes twice `make test`")
        record()
    reached = Reached(FOLDER)
    tests, whole = tests_of(files, reached)
    tests -= {name for name in tests if name.partition("::")[0] in whole}
    seconds = sum(reached.seconds[name] for name in tests) / 2
    print(
        f"make quick: {len(tests)} recorded tests reach {len(files)} files "
        f"(some {seconds:.0f} s on two cores); whole: {' '.join(sorted(whole)) or 'none'}",
        flush=True,
    )
    if not tests and not whole:
        return 0
    lists = FOLDER / "chosen"
    named = chosen.write([*sorted(whole), *sorted(tests)], lists)
    plugin = ["-p", "tests.recorded.chosen", "-m", TIER, *named]
    return _pytest(plugin, ROOT, {chosen.VARIABLE: str(lists)})


def _there(name: str) -> bool:
    """Whether a file that differs is still there: no test reaches one that is gone."""
    return (ROOT / name).exists()


if __name__ == "__main__":
    sys.exit(main())
