"""What users read is plain technical English: the worst phrases are refused, as `How we write` of
docs/glossary.md lists them."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]
PRODUCT = ("analytic", "models", "sim", "reports", "crankcheck")
REFUSED = {
    "let go": "free, in free motion, released",
    "asked for": "requested",
    "held to": "compared with",
    "the truth": "the reference",
    "whose truth": "with the reference",
    "is told": "is given, named, printed, reported",
    "are told": "are given, named, printed, reported",
    "told apart": "distinguished, separated",
    "it is of": "belongs to, is for",
    "says itself": "states, carries",
}
PHRASE = re.compile(r"\b(" + "|".join(REFUSED).replace(" ", r"\s+") + r")\b", re.I)
JOINED = re.compile(r'["\']\s*\n\s*f?["\']')
CODE = re.compile(r"^\s*(//|/\*|\*).*$|\s//\s.*$", re.M)
WAYS = "docs/glossary.md"


def refused(text: str) -> set[str]:
    """The refused phrases of a text, on one line each."""
    return {" ".join(found[0].lower().split()) for found in PHRASE.finditer(text)}


def texts(path: Path) -> Iterator[str]:
    """What users may read of a file: constants and docstrings of Python, pages but for comments."""
    text = path.read_text(encoding="utf-8")
    if path.suffix != ".py":
        yield CODE.sub("", text) if path.suffix == ".js" else text
    elif refused(JOINED.sub("", text)):  # most files need no parsing
        nodes = ast.walk(ast.parse(text))
        for node in nodes:
            if isinstance(node, ast.Constant) and isinstance(node.value, str):
                yield node.value
            elif isinstance(node, ast.JoinedStr):
                yield "".join(
                    str(part.value) if isinstance(part, ast.Constant) else "{}"
                    for part in node.values
                )


def files() -> Iterator[Path]:
    """Product, templates, scripts of pages and documentation; the list of replacements apart."""
    for folder in PRODUCT:
        for kind in ("*.py", "*.html", "*.js"):
            yield from (ROOT / folder).rglob(kind)
    yield from (path for path in (ROOT / "docs").rglob("*.md") if path != ROOT / WAYS)
    yield ROOT / "README.md"


def test_users_read_none_of_the_refused_phrases() -> None:
    found = [
        f"{path.relative_to(ROOT)}: {phrase}; write {REFUSED[phrase]}"
        for path in files()
        for text in texts(path)
        for phrase in sorted(refused(text))
    ]
    assert not found, "\n".join(found)


def test_the_glossary_lists_every_refused_phrase_and_forty_replacements() -> None:
    page = (ROOT / WAYS).read_text(encoding="utf-8")
    rows = re.findall(r"^\| ([^|]+) \| [^|]+ \|$", page.split("## How we write")[1], re.M)
    assert len(rows) >= 40
    assert not {each for each in REFUSED if not any(each in row for row in rows)}
