"""Mutants: single faults, drawn by a seed over all product code, that the tests have to find.

A mutant replaces one piece of one line. The places are spread evenly over the lines of all folders,
and the seven kinds of change take turns, so that no room and no kind is left out. The list itself,
`benchmarks/mutants.json`, was committed before the tests that it measures were changed:

    python -m benchmarks.mutants_drawn > benchmarks/mutants.json
"""

from __future__ import annotations

import ast
import dataclasses
import json
import random
import subprocess
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from tests.recorded.recording import PACKAGES, ROOT

LIST = Path(__file__).with_name("mutants.json")
BEFORE = "c015253c"
"""The commit that the list was drawn from."""
AROUND = 8
"""Lines before and after one by which it is told from others that read the same."""
CHANGED = {
    1: (
        'turned = load.direction_rad - lean if load.frame == "body" else load.direction_rad',
        "load.direction_rad - lean",
        "(load.direction_rad + lean)",
    ),
    5: (
        "links=each_array(change, self.links),",
        "each_array(change, self.links)",
        "(each_array(self.links, change))",
    ),
    6: ("return toml_text(head, dict(_tables(scene, flywheels or {})))", "flywheels", "scene"),
    7: (
        "if isinstance(slider, str) and slider not in names.sliders:",
        "slider not in names.sliders",
        "(slider in names.sliders)",
    ),
    13: (
        "return driver_course(self.scene, motion)",
        "return driver_course(self.scene, motion)",
        "pass",
    ),
    21: (
        "yield self._in_window(int(k), instants[number == k])",
        "number == k",
        "(number != k)",
    ),
    24: ("if error is not None:", "error is not None", "(not (error is not None))"),
    36: (
        "m = (x * d[1] - y * d[0]) / det",
        "(x * d[1] - y * d[0]) / det",
        "((x * d[1] - y * d[0]) * det)",
    ),
    38: (
        "(-k1, -k2, k3), generator.opposite(self.input_start), self.output_start, turned",
        "-k2",
        "k2",
    ),
    39: (
        "drawn = shares(curves(family, x[:, None], book.arm[k : k + 1]))",
        "k + 1",
        "(k + 1 + 1)",
    ),
    40: ("off = STRAYED * (high - low) * rng.uniform(-1.0, 1.0, 3)", "rng", "path"),
    45: ("*(comment(redundant) if by_need else []),", "by_need", "(not (by_need))"),
    46: ("if len(pins[point]) == 2", "len(pins[point])", "(len(pins[point]) + 1)"),
    47: (
        "elif max(first, second) <= 0.0 and (-first < STIFFNESS or -second < DAMPING):",
        "max(first, second)",
        "(max(second, first))",
    ),
    50: (
        "complete = defaults | dict(settings)",
        "defaults | dict(settings)",
        "(defaults & dict(settings))",
    ),
    61: ("say_whole(console, told)", "(console, told)", "(told, console)"),
    62: (
        "say(console, f\"{document['scene']}: only its own branch\")",
        "say(console, f\"{document['scene']}: only its own branch\")",
        "pass",
    ),
    63: ("if self.folder is not None:", "self.folder is not None", "(self.folder is None)"),
    64: (
        'return GivenAs(chosen_segments(segments), chosen_springs(springs or "plain"))',
        'springs or "plain"',
        "(springs and 'plain')",
    ),
    65: (
        'keep_trajectories: Annotated[bool, "Keep the whole motion of every cell."] = False',
        "False",
        "True",
    ),
    66: (
        "if left is None or not _elsewhere(beside, far):",
        "left is None or not _elsewhere(beside, far)",
        "(not (left is None or not _elsewhere(beside, far)))",
    ),
    76: (
        "any_log.refuse_run(scene, log, replace(asked, require=required))",
        "any_log.refuse_run(scene, log, replace(asked, require=required))",
        "pass",
    ),
    78: (
        "option: OTHERS[name] if name not in own and OTHERS.get(name) in own else name",
        "name not in own and OTHERS.get(name) in own",
        "(name not in own or OTHERS.get(name) in own)",
    ),
    86: ("log: OwnLog = field(kw_only=True)", "True", "False"),
    87: ("while words and words[-1] in AFTER:", "-1", "1"),
    101: (
        "return SECONDS if {clock_of(drive) for drive in drives} <= {SECONDS} else TURNS",
        "{clock_of(drive) for drive in drives} <= {SECONDS}",
        "(not ({clock_of(drive) for drive in drives} <= {SECONDS}))",
    ),
    102: ('elastic.in_beam(elastic.stiffer_beam), 1e-2, "of it"),', "1e-2", "0.0125"),
    103: (
        "return run(scene, state, name, *args, settings={**(settings or {}), **wrong}, **more)",
        "(settings or {})",
        "(name or {})",
    ),
    106: (
        "_omega(_all_of(lambda omega: omega * 30.0 / np.pi))),",
        "omega * 30.0 / np.pi",
        "(omega * 30.0 * np.pi)",
    ),
    108: (
        "size = SMALL if width_in(caption) <= room else TINY",
        "width_in(caption) <= room",
        "(not (width_in(caption) <= room))",
    ),
    118: ("_show(console, heads, modes)", "_show(console, heads, modes)", "pass"),
}
"""Lines that read otherwise since then, and the piece of each before and after the fault."""
SEED = 37
COUNT = 120


@dataclass(frozen=True)
class Mutant:
    """The columns ``start`` to ``end`` of a line, what stands there, and what the fault writes."""

    number: int
    kind: str
    file: str
    line: int
    start: int
    end: int
    old: str
    new: str

    def applied(self, text: str) -> str:
        """The text of the file with the fault in it; ValueError if the line has changed."""
        lines = text.splitlines(keepends=True)
        row = lines[self.line - 1]
        if row[self.start : self.end] != self.old:
            raise ValueError(f"{self.file}:{self.line} does not read {self.old!r} any more")
        lines[self.line - 1] = row[: self.start] + self.new + row[self.end :]
        return "".join(lines)


def listed() -> list[Mutant]:
    """The committed list, at the places of `BEFORE`."""
    return [Mutant(**each) for each in json.loads(LIST.read_text(encoding="utf-8"))]


def followed(mutant: Mutant, root: Path) -> Mutant | None:
    """The mutant in a later checkout: in the line that reads the same, and of several the one with
    the same lines around it. None where the line is gone, or half of what is around it."""
    text = subprocess.check_output(["git", "show", f"{BEFORE}:{mutant.file}"], cwd=ROOT, text=True)
    lines = text.splitlines()
    line = lines[mutant.line - 1]
    if mutant.number in CHANGED:
        line, old, new = CHANGED[mutant.number]
        start = line.index(old)
        mutant = dataclasses.replace(mutant, old=old, new=new, start=start, end=start + len(old))
    around = set(_around(lines, mutant.line))
    found: list[tuple[int, int, str, int, str]] = []
    for file, rows in _stripped(root).items():
        for number, row in enumerate(rows, 1):
            if row.strip() == line.strip():
                alike = len(around.intersection(_around(rows, number)))
                own = int(file == mutant.file) + int(Path(file).name == Path(mutant.file).name)
                found.append((alike, own, file, number, row))
    alike, _, file, number, row = max(found, default=(0, 0, "", 0, ""), key=lambda each: each[:2])
    if not file or (alike < len(around) / 2 and mutant.number not in CHANGED):
        return None
    shift = len(row) - len(row.lstrip()) - (len(line) - len(line.lstrip()))
    start, end = mutant.start + shift, mutant.end + shift
    return dataclasses.replace(mutant, file=file, line=number, start=start, end=end)


def _around(lines: list[str], number: int) -> list[str]:
    """The lines before and after one, but for empty ones."""
    near = lines[max(number - 1 - AROUND, 0) : number + AROUND]
    return [text for text in map(str.strip, near) if text]


@cache
def _stripped(root: Path) -> dict[str, list[str]]:
    """The lines of all files that a mutant may stand in, by their paths in a checkout."""
    homes = (*PACKAGES, "tests/second_opinions")
    return {
        str(path.relative_to(root)): path.read_text(encoding="utf-8").splitlines()
        for home in homes
        for path in sorted((root / home).rglob("*.py"))
    }


Change = tuple[ast.AST, str]
"""The node that is replaced, and the text in its place."""

OPERATORS: dict[type[ast.operator], type[ast.operator]] = {
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult,
    ast.FloorDiv: ast.Mult, ast.Mod: ast.Mult, ast.BitAnd: ast.BitOr, ast.BitOr: ast.BitAnd,
}  # fmt: skip
COMPARISONS: dict[type[ast.cmpop], type[ast.cmpop]] = {
    ast.Eq: ast.NotEq, ast.NotEq: ast.Eq, ast.Lt: ast.GtE, ast.GtE: ast.Lt, ast.Gt: ast.LtE,
    ast.LtE: ast.Gt, ast.Is: ast.IsNot, ast.IsNot: ast.Is, ast.In: ast.NotIn, ast.NotIn: ast.In,
}  # fmt: skip
BOUNDARIES: dict[type[ast.cmpop], type[ast.cmpop]] = {
    ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt,
}  # fmt: skip


def _operators(node: ast.AST) -> Iterator[Change]:
    if isinstance(node, ast.BinOp) and type(node.op) in OPERATORS:
        if not _is_text(node.left) and not _is_text(node.right):
            yield node, ast.unparse(ast.BinOp(node.left, OPERATORS[type(node.op)](), node.right))
    elif isinstance(node, ast.BoolOp):
        other = ast.Or() if isinstance(node.op, ast.And) else ast.And()
        yield node, ast.unparse(ast.BoolOp(other, node.values))


def _constants(node: ast.AST) -> Iterator[Change]:
    if isinstance(node, ast.Constant):
        if isinstance(node.value, bool):
            yield node, str(not node.value)
        elif isinstance(node.value, float):
            yield node, repr(node.value * 1.25 or 1.0)
        elif isinstance(node.value, int):
            yield node, repr(node.value + 2)


def _signs(node: ast.AST) -> Iterator[Change]:
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub | ast.Not):
        yield node, ast.unparse(node.operand)
    elif isinstance(node, ast.Return) and isinstance(node.value, ast.BinOp):
        if not isinstance(node.value.op, ast.BitOr) and not _is_text(node.value.left):
            yield node.value, f"-({ast.unparse(node.value)})"
    elif isinstance(node, ast.IfExp | ast.If):
        yield node.test, f"not ({ast.unparse(node.test)})"


def _off_by_one(node: ast.AST) -> Iterator[Change]:
    if isinstance(node, ast.Compare) and type(node.ops[0]) in BOUNDARIES:
        yield node, _compared(node, BOUNDARIES[type(node.ops[0])]())
    elif isinstance(node, ast.Call) and ast.unparse(node.func) == "len":
        yield node, f"{ast.unparse(node)} + 1"
    elif isinstance(node, ast.Call) and ast.unparse(node.func) == "range":
        yield node, f"{ast.unparse(node)[:-1]} - 1)"
    elif isinstance(node, ast.Slice):
        for bound in (node.lower, node.upper):
            if bound is not None:
                yield bound, f"{ast.unparse(bound)} + 1"


def _arguments(node: ast.AST) -> Iterator[Change]:
    if isinstance(node, ast.Call) and len(node.args) >= 2:
        first, second, *rest = node.args
        starred = any(isinstance(each, ast.Starred) for each in (first, second))
        if not starred and ast.dump(first) != ast.dump(second):
            yield node, ast.unparse(ast.Call(node.func, [second, first, *rest], node.keywords))


def _names(node: ast.AST) -> Iterator[Change]:
    """Each use of a parameter, as another parameter of the same function."""
    if not isinstance(node, ast.FunctionDef):
        return
    every = [each.arg for each in (*node.args.args, *node.args.kwonlyargs)]
    names = [name for name in every if name not in ("self", "cls")]
    for use in ast.walk(ast.Module(node.body, [])):
        if isinstance(use, ast.Name) and isinstance(use.ctx, ast.Load) and use.id in names[1:]:
            yield use, names[names.index(use.id) - 1]


def _deleted(node: ast.AST) -> Iterator[Change]:
    call = isinstance(node, ast.Expr) and isinstance(node.value, ast.Call)
    part = isinstance(node, ast.Assign) and isinstance(
        node.targets[0], ast.Attribute | ast.Subscript
    )
    if call or part or isinstance(node, ast.AugAssign | ast.Raise | ast.Continue | ast.Break):
        yield node, "pass"


def _comparisons(node: ast.AST) -> Iterator[Change]:
    if isinstance(node, ast.Compare) and type(node.ops[0]) in COMPARISONS:
        yield node, _compared(node, COMPARISONS[type(node.ops[0])]())


KINDS: dict[str, tuple[Callable[[ast.AST], Iterator[Change]], ...]] = {
    "operator": (_operators,),
    "constant": (_constants,),
    "sign": (_signs,),
    "off by one": (_off_by_one,),
    "swapped": (_arguments, _names),
    "deleted": (_deleted,),
    "comparison": (_comparisons,),
}


def _compared(node: ast.Compare, by: ast.cmpop) -> str:
    return ast.unparse(ast.Compare(node.left, [by, *node.ops[1:]], node.comparators))


def _is_text(node: ast.AST) -> bool:
    return isinstance(node, ast.JoinedStr) or (
        isinstance(node, ast.Constant) and isinstance(node.value, str)
    )


def _code(tree: ast.Module) -> Iterator[ast.AST]:
    """All nodes that run: no annotations, nothing for type checkers alone, no decorators (whether
    a class is frozen, say, changes no answer)."""
    waiting: list[ast.AST] = [tree]
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.dump(node.test):
            continue
        yield node
        for name, value in ast.iter_fields(node):
            if name not in ("annotation", "returns", "decorator_list"):
                some = value if isinstance(value, list) else [value]
                waiting += [each for each in some if isinstance(each, ast.AST)]


def mutants_of(path: Path) -> dict[str, list[Mutant]]:
    """All mutants of a file, by kind, in the order of its lines."""
    text = path.read_text(encoding="utf-8")
    lines, file = text.splitlines(), path.relative_to(ROOT).as_posix()
    of_kind: dict[str, list[Mutant]] = {}
    every = list(_code(ast.parse(text)))
    for kind, makers in KINDS.items():
        changes = [each for make in makers for node in every for each in make(node)]
        made = [_mutant(kind, file, lines, node, new) for node, new in changes]
        alive = {each for each in made if each is not None and each.old != each.new}
        of_kind[kind] = sorted(alive, key=lambda m: (m.line, m.start, m.new))
    return of_kind


def _mutant(kind: str, file: str, lines: list[str], node: ast.AST, new: str) -> Mutant | None:
    """None for what stands on several lines, or where columns are not bytes."""
    line, end_line, start, end = (
        getattr(node, name) for name in ("lineno", "end_lineno", "col_offset", "end_col_offset")
    )
    if line != end_line or not lines[line - 1].isascii():
        return None
    whole = kind == "deleted" or new.isidentifier() or new[0].isdigit()
    old = lines[line - 1][start:end]
    return Mutant(0, kind, file, line, start, end, old, new if whole else f"({new})")


def drawn(seed: int = SEED, count: int = COUNT) -> list[Mutant]:
    """That many mutants, by systematic sampling over the lines of all files."""
    dice = random.Random(seed)
    files = [path for name in PACKAGES for path in sorted((ROOT / name).rglob("*.py"))]
    lengths = [len(path.read_text(encoding="utf-8").splitlines()) for path in files]
    every = sum(lengths) / count
    at, behind = dice.random() * every, 0
    found: list[Mutant] = []
    for path, length in zip(files, lengths, strict=True):
        behind += length
        while at < behind:
            kind = list(KINDS)[len(found) % len(KINDS)]
            if (mutant := _one_of(mutants_of(path), kind, dice)) is None:
                break  # the next file has it
            found.append(dataclasses.replace(mutant, number=len(found) + 1))
            at += every
    return found


def _one_of(by_kind: dict[str, list[Mutant]], kind: str, dice: random.Random) -> Mutant | None:
    """One of that kind; where a file has none, one of any."""
    some = by_kind[kind] or [each for other in by_kind.values() for each in other]
    return dice.choice(some) if some else None


def main() -> None:
    rows = [json.dumps(dataclasses.asdict(each)) for each in drawn()]
    print("[\n" + ",\n".join(rows) + "\n]")


if __name__ == "__main__":
    main()
