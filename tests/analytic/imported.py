"""The modules of `analytic` that a module imports, so that two computations are shown to be two."""

from __future__ import annotations

import ast
from pathlib import Path

import analytic


def reached(module: str) -> set[str]:
    root, found, todo = Path(str(analytic.__file__)).parents[1], set(), [module]
    while todo:
        name = todo.pop()
        path = root.joinpath(*name.split(".")).with_suffix(".py")
        if name in found or not path.is_file():
            continue
        found.add(name)
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.ImportFrom) and str(node.module).startswith("analytic"):
                todo += [str(node.module), *(f"{node.module}.{a.name}" for a in node.names)]
    return found
