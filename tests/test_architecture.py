"""The arrows of the house: who may import whom, and what may be imported only where."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
ALLOWED = {
    "models": {"models"},
    "analytic": {"models", "analytic"},
    "sim": {"models", "sim"},
    "reports": {"models", "analytic", "sim", "reports"},
}
ENGINES = {
    "mujoco": "sim/mujoco",
    "pymunk": "sim/pymunk",
}
REPORTS_ONLY = {"pandas", "matplotlib", "plotly", "rich", "typer", "openpyxl", "pyarrow"}


def modules() -> list[Path]:
    return [path for package in ALLOWED for path in sorted((ROOT / package).rglob("*.py"))]


def imported(path: Path) -> Iterator[tuple[str, bool]]:
    """The modules that a file imports, and whether it does so when it is imported itself."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    late = {
        id(inner)
        for node in ast.walk(tree)
        if isinstance(node, ast.FunctionDef | ast.Lambda)
        or (isinstance(node, ast.If) and "TYPE_CHECKING" in ast.dump(node.test))
        for inner in ast.walk(node)
    }
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from ((alias.name, id(node) not in late) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: import by full name"
            yield node.module or "", id(node) not in late


def package_of(path: Path) -> str:
    return path.relative_to(ROOT).parts[0]


def name_of(path: Path) -> str:
    return str(path.relative_to(ROOT))


@pytest.mark.parametrize("path", modules(), ids=name_of)
def test_imports_follow_the_arrows(path: Path) -> None:
    for module, _ in imported(path):
        root = module.split(".")[0]
        if root in ALLOWED:
            assert root in ALLOWED[package_of(path)], f"imports {module}"


@pytest.mark.parametrize("path", modules(), ids=name_of)
def test_engines_stay_in_their_adapter_and_builder(path: Path) -> None:
    for module, _ in imported(path):
        home = ENGINES.get(module.split(".")[0])
        assert home is None or name_of(path.parent) == home, f"imports {module}"


@pytest.mark.parametrize("path", modules(), ids=name_of)
def test_tables_and_plots_stay_in_reports(path: Path) -> None:
    for module, _ in imported(path):
        assert module.split(".")[0] not in REPORTS_ONLY or package_of(path) == "reports"


def test_walk_sees_imports_inside_functions(tmp_path: Path) -> None:
    path = tmp_path / "probe.py"
    path.write_text("import sim.run\n\ndef f():\n    from analytic import reach\n")
    assert list(imported(path)) == [("sim.run", True), ("analytic", False)]
