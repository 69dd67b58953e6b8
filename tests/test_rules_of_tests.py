"""What holds of the tests themselves: no verdict by a clock, slow ones for a reason, names once.

A verdict must be the same on a machine of any speed. What is meant by "at once" or "bounded" is
held by counts (calls, bytes, steps); seconds stand in `benchmarks/`, as ratios.
"""

import ast
import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

HERE = Path(__file__)
TESTS = HERE.parent
CLOCKS = re.compile(
    r"\b(perf_counter|process_time|thread_time|monotonic|default_timer|getrusage|cpu_times"
    r"|clock_gettime|timeit|time\.time|os\.times)(_ns)?\b"
)
MINUTE_S = 60.0
READING: Mapping[str, str] = {
    "worlds/programs.py": "gives up waiting for a child after five minutes",
}
"""Where clocks are read, and what for: never for a verdict."""


def faults_of(text: str) -> Iterator[str]:
    """Clocks that a text names, in strings too, as those may be scripts; and limits of children
    that a slow machine could reach."""
    for number, line in enumerate(text.splitlines(), 1):
        if clock := CLOCKS.search(line):
            yield f"{number}: {clock[0]}"
    for node in ast.walk(ast.parse(text)) if "timeout" in text else ():
        if isinstance(node, ast.keyword) and node.arg == "timeout":
            limit = node.value.value if isinstance(node.value, ast.Constant) else None
            if isinstance(limit, int | float) and 0 < limit < MINUTE_S:
                yield f"{node.value.lineno}: a limit of {limit:g} s; give minutes"


def test_no_test_reads_a_clock_or_ends_a_child_in_seconds() -> None:
    faults, seen = [], set()
    for path in sorted(TESTS.rglob("*.py")):
        file = path.relative_to(TESTS).as_posix()
        found = [] if path == HERE else list(faults_of(path.read_text(encoding="utf-8")))
        seen |= {file} if found else set()
        faults += [] if file in READING else [f"tests/{file}:{each}" for each in found]
    assert not faults, "\n".join(faults)
    assert set(READING) <= seen


def test_a_clock_is_seen_and_dates_counts_and_limits_of_minutes_are_none() -> None:
    for text, fault in (
        ("began = time.process_time()\nassert time.process_time() - began < 1.0", "1: process_"),
        ("from time import perf_counter_ns as now", "1: perf_counter_ns"),
        ("SCRIPT = '''\nimport time\nprint(time.monotonic())\n'''", "3: monotonic"),
        ("assert psutil.Process().cpu_times().user < 2", "1: cpu_times"),
        ("done = subprocess.run(command, timeout=5)", "1: a limit of 5 s; give minutes"),
    ):
        assert next(faults_of(text)).startswith(fault)
    text = "import datetime\ndone.communicate(timeout=300)\nLock(path, timeout=0)\ntime_s = 3.0"
    assert not list(faults_of(text))


def test_what_is_slow_says_why() -> None:
    bare = re.compile(r"mark\.(slow|long)\b(?!\(reason=)")
    faults = [
        f"{path.relative_to(TESTS)}: {line.strip()}"
        for path in sorted(TESTS.rglob("*.py"))
        if path != HERE
        for line in path.read_text(encoding="utf-8").splitlines()
        if bare.search(line)
    ]
    assert not faults, "\n".join(["write @slow(reason) of tests.worlds.tiers:", *faults])


def given_twice(body: Sequence[ast.stmt]) -> list[str]:
    """Names of a module or class that a later definition or assignment replaces in silence."""
    names: Counter[str] = Counter()
    within: list[str] = []
    for each in body:
        if isinstance(each, ast.FunctionDef | ast.ClassDef):
            names[each.name] += 1
            within += given_twice(each.body) if isinstance(each, ast.ClassDef) else []
        elif isinstance(each, ast.Assign | ast.AnnAssign):
            targets = each.targets if isinstance(each, ast.Assign) else [each.target]
            bound = [x for target in targets for x in ast.walk(target) if isinstance(x, ast.Name)]
            names.update({x.id for x in bound if isinstance(x.ctx, ast.Store)})
    return [name for name, count in names.items() if count > 1] + within


def test_no_module_gives_a_name_twice() -> None:
    text = "A = 1\nB: int = 2\nA, C = 3, 4\nB += 1\nclass D:\n def t(): 0\n def t(): 0\ndef C(): 0"
    assert given_twice(ast.parse(text).body) == ["A", "C", "t"]
    found = {path: given_twice(ast.parse(path.read_text()).body) for path in TESTS.rglob("*.py")}
    assert not {path: names for path, names in found.items() if names}


def test_the_page_of_the_worlds_names_every_world() -> None:
    page = (TESTS / "worlds" / "README.md").read_text(encoding="utf-8")
    named = set(re.findall(r"^\| .*?(?= \| )", page, flags=re.MULTILINE))
    listed = {name.rstrip("/") for row in named for name in re.findall("`(.*?)`", row)}
    there = {path.name for path in (TESTS / "worlds").iterdir()}
    assert there - {"README.md", "__pycache__"} == listed
