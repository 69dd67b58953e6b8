"""The house in numbers: lines, files, imports, names, circles, words, conditions on a scene's kind.

    python -m benchmarks.house              # of this checkout
    python -m benchmarks.house FOLDER       # of another, such as one at c015253c

Conditions are those of `if`, `while`, `assert`, `match`, of conditional expressions and of
comprehensions that name what makes the kind of a scene: `is_free`, `free`, `elastic`,
`with_forces`, as a name, an attribute or a text.
"""

import ast
import re
import sys
from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping
from pathlib import Path

from tests.recorded.recording import PACKAGES, ROOT

KIND = {"is_free", "free", "elastic", "with_forces"}
LECTURES = "lectures"
LEAST_LINES = 60
"""Shorter files are entries of a registry, or names of the public face."""


def files(root: Path) -> dict[str, str]:
    """The texts of all product files of Python, by their paths in the checkout."""
    return {
        path.relative_to(root).as_posix(): path.read_text(encoding="utf-8")
        for package in PACKAGES
        for path in sorted((root / package).rglob("*.py"))
    }


def tests_of(tree: ast.AST) -> Iterator[ast.expr]:
    """What is asked in a file."""
    for node in ast.walk(tree):
        if isinstance(node, ast.If | ast.IfExp | ast.While | ast.Assert):
            yield node.test
        elif isinstance(node, ast.comprehension):
            yield from node.ifs
        elif isinstance(node, ast.Match):
            yield node.subject


def is_of_kind(test: ast.expr) -> bool:
    """Whether it asks for the kind of a scene."""
    names = (
        getattr(node, field, None)
        for node in ast.walk(test)
        for field in ("attr", "id", "value")
        if isinstance(node, ast.Attribute | ast.Name | ast.Constant)
    )
    return any(isinstance(name, str) and name in KIND for name in names)


def imported(tree: ast.AST, modules: Mapping[str, str]) -> set[str]:
    """The files that a file imports, at once or late."""
    found: set[str] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            found |= {modules[alias.name] for alias in node.names if alias.name in modules}
        elif isinstance(node, ast.ImportFrom) and node.module:
            for alias in node.names:
                whole = f"{node.module}.{alias.name}"
                if file := modules.get(whole) or modules.get(node.module):
                    found.add(file)
    return found


def circles(arrows: Mapping[str, set[str]]) -> list[set[str]]:
    """The sets of more than one that reach each other."""

    def reached(start: str) -> set[str]:
        seen, todo = set[str](), [start]
        while todo:
            new = arrows[todo.pop()] - seen
            seen |= new
            todo += new
        return seen

    after = {file: reached(file) for file in arrows}
    rings = {frozenset(b for b in after[a] if a in after[b]) for a in after if a in after[a]}
    return [set(ring) for ring in rings if len(ring) > 1]


def docstrings(tree: ast.AST) -> Iterator[str]:
    """The texts that stand as statements: docstrings, also those of attributes and constants."""
    for node in ast.walk(tree):
        for each in body if isinstance(body := getattr(node, "body", None), list) else ():
            if isinstance(each, ast.Expr) and isinstance(each.value, ast.Constant):
                yield str(each.value.value)


def shared_names(trees: Mapping[str, ast.Module]) -> list[str]:
    """Return the names that several classes have."""
    names = Counter(
        node.name for tree in trees.values() for node in tree.body if isinstance(node, ast.ClassDef)
    )
    return sorted(name for name, count in names.items() if count > 1)


def share_of_what(trees: Mapping[str, ast.Module]) -> float:
    """Return how many of 10,000 words of docstrings are "what", which hides the noun."""
    words = [word.lower() for tree in trees.values() for text in docstrings(tree)
             for word in re.findall(r"[A-Za-z][A-Za-z'-]*", text)]  # fmt: skip
    return 1e4 * words.count("what") / len(words)


def show(root: Path) -> None:
    """Print them."""
    texts = files(root)
    trees = {file: ast.parse(text) for file, text in texts.items()}
    lines = {file: len(text.splitlines()) for file, text in texts.items()}
    modules = {
        file.removesuffix(".py").removesuffix("/__init__").replace("/", "."): file for file in texts
    }
    arrows = {file: imported(tree, modules) - {file} for file, tree in trees.items()}
    total = sum(lines.values())
    lectures = [file for file in texts if LECTURES in file.split("/")]
    print(f"{total} lines in {len(texts)} files, {total - sum(lines[f] for f in lectures)} lines "
          f"in {len(texts) - len(lectures)} outside of lectures")  # fmt: skip
    rows = sum(
        (node.end_lineno or node.lineno) - node.lineno + 1
        for tree in trees.values()
        for node in tree.body
        if isinstance(node, ast.Import | ast.ImportFrom)
    )
    print(f"{rows} lines of imports at the top of files, {100.0 * rows / total:.1f} %")
    print(f"{len(shared_names(trees))} class names that mean several things")
    print(f"{len(circles(arrows))} circles of files")
    short = [file for file, count in lines.items() if 1 < count < LEAST_LINES]
    print(f"{len(short)} files of less than {LEAST_LINES} lines: {', '.join(short)}")
    print(f"{share_of_what(trees):.0f} of 10,000 words of docstrings are 'what'")
    into = [f"{a} -> {b}" for a in arrows for b in sorted(arrows[a])
            if LECTURES in b.split("/") and LECTURES not in a.split("/")]  # fmt: skip
    print(f"{len(into)} imports of lectures from elsewhere: {', '.join(into)}")
    asked = {file: sum(map(is_of_kind, tests_of(tree))) for file, tree in trees.items()}
    by_room = defaultdict[str, int](int)
    for file, count in asked.items():
        by_room["/".join(file.split("/")[:2])] += count
    print(f"{sum(asked.values())} conditions on the kind of a scene in "
          f"{sum(map(bool, asked.values()))} files:")  # fmt: skip
    for room, count in sorted(by_room.items(), key=lambda each: -each[1]):
        if count:
            print(f"  {count:4} {room}")


if __name__ == "__main__":
    show(Path(sys.argv[1]).resolve() if len(sys.argv) > 1 else ROOT)
