"""The modules of `analytic`, and second opinions, that a module imports, so that two computations
are shown to be two."""

import ast
from pathlib import Path

ROOT = Path(__file__).parents[2]
OURS = ("analytic", "tests.second_opinions")


def reached(module: str) -> set[str]:
    found, todo = set[str](), [module]
    while todo:
        name = todo.pop()
        path = ROOT.joinpath(*name.split(".")).with_suffix(".py")
        if name in found or not path.is_file():
            continue
        found.add(name)
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.ImportFrom) and str(node.module).startswith(OURS):
                todo += [str(node.module), *(f"{node.module}.{a.name}" for a in node.names)]
    return found
