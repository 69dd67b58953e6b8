"""The build step that gives the wheel its one name.

In the checkout `models`, `analytic`, `sim` and `reports` are packages of their own; the wheel has
them in `crankcheck`: ``sources`` in pyproject.toml says so, and here their imports are written to
match. An editable install is the checkout itself, and needs none of that.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Sequence, Set
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from hatchling.builders.config import BuilderConfig
from hatchling.builders.hooks.plugin.interface import BuildHookInterface

SCRIPT = re.compile(r"(?:\bimport|\bfrom(?=\s+\S+\s+import\b))\s+([\w.]+)")
"""What a string imports that is a program for another process."""


class RelocationError(Exception):
    """Code that would look for a module of ours where the wheel does not have it."""


class Relocation(BuildHookInterface[BuilderConfig]):
    """Gives hatchling a copy of each Python file that names our modules as the wheel has them."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Called before a build: ``version`` is `standard` or `editable`."""
        self.copies = TemporaryDirectory()
        if version == "editable":
            return
        every = self.build_config.builder.recurse_included_files()
        files = [each for each in every if each.path.endswith(".py")]
        moved = {
            ".".join(Path(each.relative_path).with_suffix("").parts).removesuffix(".__init__")
            for each in files
            if each.distribution_path != each.relative_path
        }
        for each in files:
            copy = Path(self.copies.name, each.distribution_path)
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_bytes(relocated(Path(each.path).read_bytes(), moved, each.relative_path))
            build_data["force_include"][str(copy)] = each.distribution_path

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:
        """Called after a build."""
        self.copies.cleanup()


def relocated(code: bytes, moved: Set[str], place: str) -> bytes:
    """The code with each ``from analytic.x import y`` as ``from crankcheck.analytic.x import y``.

    All else stays letter for letter. ``moved`` are the modules that the wheel has in `crankcheck`;
    ``place`` is the file. Raises RelocationError, with all faults, where the code names one of them
    in another way, as that would be looked for in the wrong place.
    """
    every = list(nodes(ast.parse(code)))
    lines = code.splitlines(keepends=True)
    faults = [f"{place}:{line}: {fault}" for line, fault in sorted(unseen(every, moved))]
    imports = [node for node in every if isinstance(node, ast.ImportFrom)]
    # From right to left, so that places further left in the same line stay true.
    for node in sorted(imports, key=lambda each: -each.col_offset):
        name = node.module or ""
        if node.level or name not in moved:
            continue
        line, at = lines[node.lineno - 1], node.col_offset + len(b"from ")
        if not line[at:].startswith(name.encode()):
            faults.append(f"{place}:{node.lineno}: write `from {name} import` in one line")
        lines[node.lineno - 1] = line[:at] + b"crankcheck." + line[at:]
    if faults:
        raise RelocationError("\n".join(faults))
    return b"".join(lines)


def nodes(tree: ast.AST) -> Iterator[ast.AST]:
    """All nodes of a tree, in no order: in a third of the time that `ast.walk` takes, which is most
    of that of a build."""
    left = [tree]
    while left:
        node = left.pop()
        yield node
        for name in node._fields:
            value = getattr(node, name, None)
            if isinstance(value, ast.AST):
                left.append(value)
            elif isinstance(value, list):
                left += [each for each in value if isinstance(each, ast.AST)]


def unseen(every: Sequence[ast.AST], moved: Set[str]) -> Iterator[tuple[int, str]]:
    """Where the nodes of a file name our modules so that this step can not follow: line, and what
    to do."""
    prose = {id(node.value) for node in every if isinstance(node, ast.Expr)}
    for node in every:
        if isinstance(node, ast.Import):
            for alias in node.names:
                if alias.name in moved:
                    yield node.lineno, f"`import {alias.name}`: write `from ... import ...`"
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            names = moved & {node.value, *SCRIPT.findall(node.value)}
            if names and id(node) not in prose:
                listed = ", ".join(sorted(names))
                yield node.lineno, f"{listed} in a string: take the name from the module itself"
