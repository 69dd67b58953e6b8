"""Shipped scene files with something done to them; the same seed does the same."""

import math
import random
import re
from collections.abc import Callable, Iterator

from models.files.reading import every_shipped

Rng = random.Random
NUMBER = re.compile(r"(?<![\w.-])-?\d+\.\d*(?:e[+-]?\d+)?(?![\w.])")
TIED = re.compile(r'\b[A-G]\b|"\w+"')
ENDS = ("0.0", "-1.0", "1e-15", "-1e-15", "1e-9", "1e-4", "1e4", "1e9", "1e15", "-1e15",
        "123456.789")  # fmt: skip
WORD = re.compile(r"[A-Za-z][A-Za-z0-9_-]*")
GENTLE = (0.9, 0.95, 0.99, 0.999, 1.0 + 1e-12, 1.01, 1.05, 1.1)
FACTORS = (-1.0, 0.0, 0.5, 2.0, 10.0, 1e-3, 1e3, 1e-6, 1e6, 1e-9, 1e9, 1e-14, 1e14, 1e30)
NUMBERS = ("0", "-0.0", "1e15", "1e-15", "1e16", "1e300", "1e-300", "1e400", "nan", "-inf",
           "9" * 5000, "0x1F", "1_000", "true", '"1"', "[]", "{}", "1979-05-27", "07:32:00",
           "1" + "0" * 4400 + ".0", "[1.0, 2.0]")  # fmt: skip
WORDS = ("ground", "world", "crank", "A", "Z", "../x", "links", "on", "<b>", "a&amp;b",
         "\u202eabc", "caf\u00e9", "\u0000", "\u001b[31m", "x" * 10_000, "'", '"', "=", "#",
         "[[", "]]>", "-->", "{")  # fmt: skip
LINES = ("[links]", "[driver]", "[[driver]]", "[branch]", "[sliders.C]", '"" = 1', "x = 1",
         "points = { A = [0, 0] }", 'on = "ground"', "mass_kg = 0", "mass_kg = 1e15", "C = -1",
         "gravity_m_s2 = [1e15, -1e15]", "[tolerance]\nangle = 1", "angle_deg = 45",
         'law = "oscillating"', 'law = "from-rest"\nrise_s = 1e-15', "inertia_kg_m2 = 1e-15",
         "a." * 300 + "b = 1", "[" + "a." * 3000 + "b]", 'note = """' + "n" * 3000 + '"""',
         "# " + "c" * 10_000, "\t \t", "\r", "\ufeff")  # fmt: skip


def mutant(seed: int) -> bytes:
    """A shipped file after one to four mutations."""
    rng = random.Random(seed)
    text = _shipped(rng)
    for _ in range(rng.choice((1, 1, 1, 1, 2, 2, 4))):
        text = rng.choices(list(MUTATIONS), list(MUTATIONS.values()))[0](rng, text)
    raw = text.encode("utf-8", "surrogatepass")
    if rng.random() < 0.08:
        raw = rng.choice(BYTES)(rng, raw)
    return raw


def retied() -> Iterator[tuple[str, bytes]]:
    """Every shipped file with one name in place of another, each with each: what was done, and the
    file."""
    for name, path in every_shipped().items():
        text = path.read_text(encoding="utf-8")
        body = text.index("[ground]")
        found = [one for one in TIED.finditer(text) if one.start() > body]
        for new in sorted({one[0].strip('"') for one in found} | {"ground"}):
            for one in found:
                quote = '"' if one[0].startswith('"') else ""
                changed = _put(one, quote + new + quote)
                if changed != text:
                    yield f"{name}: {new} for {one[0]} at {one.start()}", changed.encode()


def stretched() -> Iterator[tuple[str, bytes]]:
    """Every shipped file with one number in place of each of its own."""
    for name, path in every_shipped().items():
        text = path.read_text(encoding="utf-8")
        for one in NUMBER.finditer(text):
            for new in ENDS:
                told = f"{name}: {new} for {one[0]} at {one.start()}"
                yield told, _put(one, new).encode()


def _shipped(rng: Rng) -> str:
    return rng.choice(list(every_shipped().values())).read_text(encoding="utf-8")


def _put(one: re.Match[str], new: str) -> str:
    """The text with something else in that place."""
    return one.string[: one.start()] + new + one.string[one.end() :]


def _number(rng: Rng, text: str) -> str:
    """A number times a factor, or another in its place."""
    found = list(NUMBER.finditer(text))
    if not found:
        return text
    one = rng.choice(found)
    if rng.random() < 0.15:
        return _put(one, rng.choice(NUMBERS))
    value = float(one[0]) * rng.choice(rng.choice((GENTLE, FACTORS)))
    return _put(one, repr(value) if math.isfinite(value) else "inf")


def _scaled(rng: Rng, text: str) -> str:
    factor = rng.choice(FACTORS)
    return NUMBER.sub(lambda one: repr(float(one[0]) * factor), text)


def _word(rng: Rng, text: str) -> str:
    """A word in another's place: once, or wherever it stands."""
    found = list(WORD.finditer(text))
    if not found:
        return text
    one = rng.choice(found)
    new = rng.choice([*WORDS, rng.choice(found)[0]])
    return text.replace(one[0], new) if rng.random() < 0.3 else _put(one, new)


def _line(rng: Rng, text: str) -> str:
    """Lines left out, one of them elsewhere, or one of `LINES` between them."""
    lines = text.splitlines(keepends=True) or [""]
    first = rng.randrange(len(lines))
    how = rng.choice(("drop", "again", "insert"))
    if how == "drop":
        del lines[first : first + rng.choice((1, 1, 1, 2, 5))]
    else:
        lines.insert(first, f"{rng.choice(LINES)}\n" if how == "insert" else rng.choice(lines))
    return "".join(lines)


def _into_table(rng: Rng, text: str) -> str:
    """One more key in an inline table, such as that of a link."""
    places = [one.start() for one in re.finditer(r" ?\}", text)]
    keys = ("mass_kg", "inertia_kg_m2", "centre_m", "length_m", "points", "Q", "A", "bar")
    values = ("0.0", "1e15", "1e-15", "1.0", "[0.0, 0.0]", "[1e15, 0]", "{ X = [0, 0] }", "nan")
    if not places:
        return text
    at = rng.choice(places)
    return f"{text[:at]}, {rng.choice(keys)} = {rng.choice(values)}{text[at:]}"


def _splice(rng: Rng, text: str) -> str:
    """The beginning, and at times the end of another file."""
    other = rng.choice((_shipped(rng), ""))
    return text[: rng.randrange(len(text) + 1)] + other[rng.randrange(len(other) + 1) :]


def _huge(rng: Rng, text: str) -> str:
    """As much of something as a file may hold, where tables stand, or alone."""
    size = rng.choice((1_000, 30_000, 198_000))
    link = ", ".join(f"Q{i} = [{i}.0, 0.5]" for i in range(size // 20))
    many = (
        "x = " + "[" * size, "x = " + "[" * (size // 2) + "]" * (size // 2),
        "x = " + "{a=" * (size // 3), "a." * (size // 2) + "b = 1", "[" + "a." * (size // 2) + "b]",
        'source = "' + "x" * size + '"', "#" + "x" * size, "x = " + "9" * size,
        "x = 1." + "9" * size, "\n" * size, "[[a]]\n" * (size // 6),
        "\n".join(f"[links.k{i}]\nbar = ['A', 'B']\nlength_m = 0.1" for i in range(size // 50)),
        f"[links.big]\npoints = {{ A = [0.0, 0.0], {link} }}",
        "[branch]\n" + "\n".join(f"Z{i} = 1" for i in range(size // 10)),
        "\n".join(f"[sliders.S{i}]\non = 'ground'" for i in range(size // 30)),
        "x" * 1_050_000,
        "[tolerance]\n" + "\n".join(f"q{i} = 1.0" for i in range(size // 12)),
    )  # fmt: skip
    one = rng.choice(many)
    return rng.choice((one, text + "\n" + one, one + "\n" + text))[:1_100_000]


MUTATIONS: dict[Callable[[Rng, str], str], float] = {
    _number: 15.0, _scaled: 2.0, _word: 4.0, _line: 6.0, _into_table: 2.0, _splice: 2.0,
    _huge: 0.5,
}  # fmt: skip
"""What is done to a text, and how often."""


def _flip(rng: Rng, raw: bytes) -> bytes:
    changed = bytearray(raw)
    for _ in range(rng.choice((1, 3, 30)) if changed else 0):
        changed[rng.randrange(len(changed))] ^= 1 << rng.randrange(8)
    return bytes(changed)


def _inserted(rng: Rng, raw: bytes) -> bytes:
    """Bytes that are no text, or that no line has."""
    at = rng.randrange(len(raw) + 1)
    new = rng.choice(
        (b"\x00", b"\xff\xfe", b"\xc3\x28", b"\xed\xa0\x80", b"\x1b[2J", b"\xf8", b"\r")
    )
    return raw[:at] + new + raw[at:]


BYTES: tuple[Callable[[Rng, bytes], bytes], ...] = (
    _flip,
    _flip,
    _inserted,
    lambda rng, raw: b"\xef\xbb\xbf" + raw,
    lambda rng, raw: raw.replace(b"\n", b"\r\n"),
    lambda rng, raw: raw.replace(b"\n", b"\r"),
    lambda rng, raw: raw.decode("utf-8", "replace").encode("utf-16"),
    lambda rng, raw: b"",
)
