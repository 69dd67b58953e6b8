"""The arrows of the house: who may import whom, and what may be imported only where.

`FLOORS` is the plan: each line a floor, the highest first. A room imports itself and what stands on
lower floors, never a neighbour on its own; each package, only the packages that `ARROWS` gives it.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

from benchmarks.house import files, share_of_what, shared_names
from sim.registry import ENGINES, declaration

ROOT = Path(__file__).parents[1]
ARROWS: Mapping[str, set[str]] = {
    "models": set(),
    "analytic": {"models"},
    "sim": {"models"},
    "reports": {"models", "analytic", "sim"},
    "crankcheck": {"models", "analytic", "sim", "reports"},
}
ROOMS = {name: room.removeprefix("..") for name, room in ENGINES.items()}
BUILT_ON = ("mjx", "mujoco_warp")
"""Rooms of engines that step the models of another's compiler."""
FLOORS: Mapping[str, str] = {
    "reports": """
        cli lectures ways
        requests
        page figures
        own_model
        diff tune advise history verify selftest
        sweep stability own_log contract
        results
        store
        plan
        causes
        judge describe drawing logs
        protocol
        compare
        quantities
        workers output
    """,
    "analytic": """
        lectures
        elastic
        free gradients
        mechanism forces
        kinematics
        prepared
        assur higher_pairs
        result
        change_points
        dyads
        multibody cams gears
        structure
    """,
    "sim": f"""
        {" ".join(BUILT_ON)}
        {" ".join(room for room in ROOMS.values() if room not in BUILT_ON)}
        run
        registry
        own_engine
        engine
        compiling
    """,
}
"""A file that stands in `analytic` itself is a room of its own; elsewhere there is none."""
LOOSE = {"analytic"}
LECTURES = "lectures"
"""The room of each package on top of all others: no other room imports it, a table names it."""
HOMES = {declaration(name).package: f"sim.{room}" for name, room in ROOMS.items()}
"""Each engine's package, and the one room that imports it."""
NAMING = ("sim/registry/__init__.py", "models/mjcf/", *(f"sim/{room}/" for room in ROOMS.values()))
"""Where engines are named: the line of each, MuJoCo's own format, which others read too, and each
engine's folder."""
NAMED = {name for name in ENGINES if name != "newton"}
"""Engines whose name says nothing else: Newton has a method, laws and a unit."""
MENTIONING: Mapping[str, str] = {
    "reports/cli/commands.py": "whose viewer `view` opens",
    "reports/requests/options.py": "whose files --mjcf takes",
}
"""Where sentences mention engines, and why; an engine that is not mentioned works as well."""
BESIDE = {"tests", "benchmarks"}
"""What stands beside the packages, and may import any of them."""
BLOCKS = ("body", "orelse", "finalbody", "handlers", "cases")
REPORTS_ONLY = {"pandas", "matplotlib", "plotly", "rich", "typer", "openpyxl", "pyarrow"}


@dataclass(frozen=True)
class Import:
    """A module, by dotted name, that imports another."""

    by: str
    of: str


@cache
def parsed(text: str) -> ast.Module:
    """The tree of a text: that of all files takes seconds, and several tests look at it."""
    return ast.parse(text)


def imports(path: Path, root: Path = ROOT) -> Iterator[Import]:
    """What a file imports, also inside functions, and where only a type checker does."""
    by = ".".join(path.relative_to(root).with_suffix("").parts).removesuffix(".__init__")
    for node in _import_statements(parsed(path.read_text(encoding="utf-8"))):
        assert getattr(node, "level", 0) == 0, f"{path}: import by full name"
        for alias in node.names:
            whole = f"{node.module}.{alias.name}" if isinstance(node, ast.ImportFrom) else ""
            module = whole if _is_module(whole, root) else getattr(node, "module", alias.name)
            yield Import(by, module)


def _import_statements(block: ast.AST) -> Iterator[ast.Import | ast.ImportFrom]:
    """Those in a block and in the blocks within it; expressions hold none."""
    for node in (n for name in BLOCKS for n in getattr(block, name, ())):
        if isinstance(node, ast.Import | ast.ImportFrom):
            yield node
        else:
            yield from _import_statements(node)


def _is_module(name: str, root: Path) -> bool:
    path = root.joinpath(*name.split("."))
    return path.with_suffix(".py").is_file() or (path / "__init__.py").is_file()


def all_imports(root: Path = ROOT) -> list[Import]:
    files = [path for package in ARROWS for path in sorted((root / package).rglob("*.py"))]
    return [each for path in files for each in imports(path, root)]


def place(name: str) -> tuple[str, str]:
    """The package, and the room in it: empty for the package itself."""
    package, room, *_ = *name.split("."), ""
    return package, room


def floors() -> dict[tuple[str, str], int]:
    """The number of each room's floor, from the highest."""
    return {
        (package, room): number
        for package, plan in FLOORS.items()
        for number, line in enumerate(plan.strip().splitlines())
        for room in line.split()
    }


def up_arrows(found: list[Import]) -> list[str]:
    """Imports that the plan does not allow."""
    level, faults = floors(), []
    for each in found:
        (by, room), (of, other) = place(each.by), place(each.of)
        if of in BESIDE:
            faults.append(f"{each.by} imports {each.of}, which no user has")
        if of not in ARROWS or by not in ARROWS:
            continue
        if other == LECTURES != room and by != "crankcheck":
            faults.append(f"{each.by} imports {each.of}: lectures are found by name")
        if by != of:
            if of not in ARROWS[by]:
                faults.append(f"{each.by} imports {each.of}: {by} may not import {of}")
        elif by in FLOORS and room != other:
            own, below = level.get((by, room)), level.get((of, other))
            if own is None or below is None or own >= below:
                faults.append(f"{each.by} imports {each.of}: not on a lower floor")
    return faults


def circles(found: list[Import]) -> list[str]:
    """Files that import each other in a ring, at once or late: rings until none is left, each told
    and cut at one of its imports."""
    graph: dict[str, set[str]] = {}
    for each in found:
        if place(each.of)[0] in ARROWS:
            graph.setdefault(each.by, set()).add(each.of)
    rings: list[str] = []
    while True:
        try:
            TopologicalSorter(graph).prepare()
        except CycleError as error:
            imported, by, *_ = ring = error.args[1]
            graph[by].discard(imported)
            rings.append(" <- ".join(ring))
        else:
            return rings


def misplaced(root: Path = ROOT) -> list[str]:
    """Rooms that the plan does not know, rooms of it that are gone, and loose files."""
    faults = []
    for package in FLOORS:
        rooms = {path.stem for path in (root / package).glob("*.py")} - {"__init__"}
        if package not in LOOSE:
            faults += [f"{package}/{room}.py belongs into a room" for room in sorted(rooms)]
        rooms |= {path.parent.name for path in (root / package).glob("*/__init__.py")}
        planned = {room for own, room in floors() if own == package}
        faults += [f"{package}/{room} has no floor" for room in sorted(rooms - planned)]
        faults += [f"{package}/{room} is planned and gone" for room in sorted(planned - rooms)]
    return faults


def strangers(found: list[Import]) -> list[str]:
    """Engines outside their room, tables and plots outside reports."""
    faults = []
    for each in found:
        outside, _ = place(each.of)
        home = HOMES.get(outside)
        if home and not each.by.startswith(f"{home}."):
            faults.append(f"{each.by} imports {outside}, whose room is {home}")
        if outside in REPORTS_ONLY and not each.by.startswith("reports."):
            faults.append(f"{each.by} imports {outside}, which stays in reports")
    return faults


def words(path: Path) -> Iterator[tuple[int, str]]:
    """Identifiers and texts of a file with their lines, but for comments and docstrings."""
    every = list(ast.walk(parsed(path.read_text(encoding="utf-8"))))
    said = {id(node.value) for node in every if isinstance(node, ast.Expr)}
    for node in every:
        if id(node) not in said:
            fields = (getattr(node, name, None) for name in ("id", "attr", "arg", "name", "value"))
            for word in (getattr(node, "module", None), *fields):
                if isinstance(word, str):
                    yield getattr(node, "lineno", 0), word


def namings(root: Path = ROOT) -> list[str]:
    """Names of engines where nothing should know them, and permissions that nobody needs."""
    faults, used = [], set()
    for path in sorted(path for package in ARROWS for path in (root / package).rglob("*.py")):
        file = path.relative_to(root).as_posix()
        text = path.read_text(encoding="utf-8").lower()
        if file.startswith(NAMING) or not any(name in text for name in NAMED):
            continue
        for line, word in words(path):
            if any(name in word.lower() for name in NAMED):
                allowed = {each for each in MENTIONING if file.startswith(each) and " " in word}
                used |= allowed
                faults += [] if allowed else [f"{file}:{line} names an engine: {word[:60]!r}"]
    return faults + [f"{file} mentions no engine" for file in MENTIONING if file not in used]


def test_the_house_stands_as_planned_and_engines_are_named_in_their_rooms_alone() -> None:
    found = all_imports()
    assert len(found) > 1000
    faults = [*misplaced(), *up_arrows(found), *circles(found), *strangers(found), *namings()]
    assert not faults, "\n".join(faults)


def test_no_class_name_means_two_things_and_docstrings_say_nouns() -> None:
    trees = {file: parsed(text) for file, text in files(ROOT).items()}
    assert not shared_names(trees)
    assert share_of_what(trees) < 5.0
    doubled = {name: ast.parse("class Leg:\n    '''What a leg is.'''") for name in ("a", "b")}
    assert shared_names(doubled) == ["Leg"]
    assert share_of_what(doubled) == 2500.0


@pytest.fixture
def house(tmp_path: Path) -> Path:
    """A house with every room of the plan, and nothing in them."""
    for room in (*ARROWS, *("/".join(each) for each in floors())):
        (tmp_path / room).mkdir()
        (tmp_path / room / "__init__.py").touch()
    assert not [*misplaced(tmp_path), *all_imports(tmp_path)]
    return tmp_path


@pytest.mark.parametrize(
    ("file", "text"),
    [
        ("analytic/dyads/a.py", "import sim.run"),
        ("models/a.py", "def f():\n    from analytic import reach"),
        ("reports/page/a.py", "from reports.figures.drawing import marks"),
        ("reports/store/a.py", "if TYPE_CHECKING:\n    import reports.cli"),
        ("sim/engine/a.py", "from sim import run"),
        ("reports/judge/a.py", "import reports.unplanned"),
        ("models/a.py", "import models.lectures.scheme"),
        ("sim/mujoco/a.py", "from tests.worlds import driven"),
    ],
)
def test_an_up_arrow_is_seen(house: Path, file: str, text: str) -> None:
    (house / file).write_text(text + "\n")
    (fault,) = up_arrows(all_imports(house))
    assert fault.startswith(file.removesuffix(".py").replace("/", "."))


def test_every_circle_is_seen(house: Path) -> None:
    for ring in ("abc", "de", "f"):
        for name, other in zip(ring, ring[1:] + ring[:1], strict=True):
            late = "def f():\n    " if name == "c" else ""
            text = f"{late}from reports.judge.{other} import x\n"
            (house / "reports" / "judge" / f"{name}.py").write_text(text)
    assert not up_arrows(all_imports(house))
    faults = sorted(circles(all_imports(house)), key=len)
    rings = [sorted(set(fault.split(" <- "))) for fault in faults]
    assert rings == [[f"reports.judge.{name}" for name in ring] for ring in ("f", "de", "abc")]


def test_a_loose_file_an_unplanned_room_and_a_lost_one_are_seen(house: Path) -> None:
    (house / "reports" / "helpers.py").touch()
    (house / "analytic" / "attic").mkdir()
    (house / "analytic" / "attic" / "__init__.py").touch()
    (house / "reports" / "tune").rename(house / "reports" / "tuning")
    assert set(misplaced(house)) == {
        "reports/helpers.py belongs into a room",
        "reports/helpers has no floor",
        "analytic/attic has no floor",
        "reports/tuning has no floor",
        "reports/tune is planned and gone",
    }


def test_engines_and_tables_outside_their_rooms_are_seen_by_name_and_import(house: Path) -> None:
    (house / "reports" / "page" / "a.py").write_text(
        '"""About MuJoCo."""\nif name == "mujoco":\n    from sim import pymunk\n    pymunk_work()\n'
    )
    (house / "reports" / "requests" / "options.py").write_text('a = "of MuJoCo"\nb = "mujoco"\n')
    (house / "sim" / "pymunk" / "a.py").write_text('name = "pymunk"\n')
    seen = [fault.partition(" ")[0] for fault in namings(house) if " names " in fault]
    assert seen == [*(f"reports/page/a.py:{n}" for n in (2, 3, 4)), "reports/requests/options.py:2"]
    (house / "sim" / "mujoco" / "a.py").write_text("import mujoco\n")
    (house / "reports" / "page" / "a.py").write_text("import mujoco, pandas\n")
    (house / "analytic" / "dyads" / "a.py").write_text("def f():\n    import pandas\n")
    assert strangers(all_imports(house)) == [
        "analytic.dyads.a imports pandas, which stays in reports",
        "reports.page.a imports mujoco, whose room is sim.mujoco",
    ]
