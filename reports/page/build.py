"""Build the page: sections, style, scripts and Plotly, in one file that loads nothing."""

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined, Template
from markupsafe import Markup

from reports.drawing.moving import embedded, policy
from reports.output.numbers import NONE, count, duration, error_text, readable
from reports.output.palette import COLOURS, DARK
from reports.page.sections import OF_WAYS, SECTIONS
from reports.page.sections.hard import hard, lighter
from reports.page.sections.motion import build as motion
from reports.page.sections.section import BUDGET, PageReport, Section
from reports.results import overview
from reports.results.looks import Look
from reports.stability.matrix import Matrix
from reports.store.reader import Stored

HERE = Path(__file__).parent
MOST_BYTES = 7_900_000
"""Size limit of a page; above it fewer steps of each line are drawn in drawings and curves."""
ALONE = 6_500_000
"""Characters for the moving pictures of hard cases on a page of their own."""
FIRST = ("page.js", "tables.js")
"""Scripts of every page, before the scripts of its sections."""


@dataclass(frozen=True)
class Head:
    """Head of a page: its title, and the facts of the measurement; ``made`` is the date, as text.

    ``first`` names the first section, ``looks`` are the looks of the diagrams.
    """

    title: str
    facts: Sequence[str]
    made: str
    first: str
    looks: Sequence[Look] = ()


def page(stored: Stored, matrix: Matrix | None = None) -> str:
    """Return the report of a store as one HTML file, with the hard cases that were run beside it.

    Raises CrankcheckError for a store that can not be read, part by part.
    """
    report = PageReport(stored, matrix)
    sections = {name: build(report) for name, build in SECTIONS.items()}
    text = render(report, sections.values())
    for name in (*OF_WAYS, "motion", "hard"):
        over, section = len(text.encode()) - MOST_BYTES, sections[name]
        if over <= 0 or section is None:
            continue
        if name == "hard" and matrix is not None:
            sections[name] = lighter(matrix, section, over)
        elif name == "motion" and report.driven is not None:
            sections[name] = motion(report.driven, BUDGET - over)
        elif name in OF_WAYS and (own := OF_WAYS[name].lighter):
            sections[name] = own(report, max(BUDGET - over, 0))
        text = render(report, sections.values())
    return text


def stability_page(matrix: Matrix) -> str:
    """Return a page of the hard cases alone as one HTML file."""
    engines = dict.fromkeys(run.engine for run in matrix.runs)
    head = Head(
        title="crankcheck: hard cases",
        facts=(
            *(f"{engine} {matrix.facts.get(engine, '')}".strip() for engine in engines),
            count(len(matrix.cases), "case"),
            count(len(matrix.runs), "run"),
        ),
        made=str(matrix.facts.get("made", "")),
        first="map",
    )
    section = hard(matrix, ALONE)
    text = assembled(head, [section])
    over = len(text.encode()) - MOST_BYTES
    return text if over <= 0 else assembled(head, [lighter(matrix, section, over)])


def render(report: overview.Report, sections: Iterable[Section | None]) -> str:
    """Return a page of some sections of a report."""
    head = Head(
        title="crankcheck report",
        facts=(
            *(f"{engine} {version}" for engine, version in report.engines.items()),
            count(len(report.looks), "set of settings", "sets of settings"),
            count(len(report.scenes), "scene"),
            count(len(report.cells), "cell"),
        ),
        made=max((str(run.get("started", "")) for run in report.stored.manifest.runs), default=""),
        first="verdict",
        looks=list(report.looks.values()),
    )
    return assembled(head, sections)


def printed_page(title: str, facts: Mapping[str, str], printed: str) -> str:
    """Return a page of an answer that is HTML already; its ``title`` is command and verdict."""
    command, _, verdict = title.partition(": ")
    head = Head(f"crankcheck {command}", [verdict], facts["made"], "verdict")
    return assembled(
        head, [Section("verdict", "Verdict", "shown.html", {"shown": Markup(printed)})]
    )


def assembled(head: Head, shown: Iterable[Section | None]) -> str:
    """Return a page of some sections under a head, without the empty sections (None)."""
    sections = [each for each in shown if each is not None]
    environment = _environment()
    bodies = [Markup(_template(environment, one.template).render(one.words)) for one in sections]
    names = dict.fromkeys([*FIRST, *(script for one in sections for script in one.scripts)])
    early = _script("theme.js")
    late = "\n".join(_script(name) for name in names)
    plotly = _plotly() if any(one.plotly for one in sections) else ""
    styles = dict.fromkeys(["page.css", *(style for one in sections for style in one.styles)])
    drawn = [{**vars(look), "name": look.name} for look in head.looks]
    return environment.get_template("page.html").render(
        policy=policy([script for script in (early, plotly, late) if script]),
        style=Markup("\n".join([*map(_asset, styles), palette()])),
        early=Markup(early),
        plotly=Markup(plotly),
        late=Markup(late),
        sections=list(zip(sections, bodies, strict=True)),
        embedded=[
            ("looks", embedded(drawn)),
            *((one.anchor, embedded(one.embedded)) for one in sections if one.embedded),
        ],
        head=head,
    )


def _template(environment: Environment, template: str | Path) -> Template:
    if isinstance(template, Path):
        return environment.from_string(template.read_text(encoding="utf-8"))
    return environment.get_template(f"sections/{template}")


@cache
def _environment() -> Environment:
    environment = Environment(
        loader=FileSystemLoader(HERE / "templates"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {"error": error_text, "readable": readable, "duration": duration}
    environment.globals |= {"dash": NONE, "infinite": math.inf}
    return environment


BY_CHOICE, BY_SYSTEM = ':root[data-theme="dark"]', ':root:not([data-theme="light"])'
"""Dark themes of the style sheets."""


@cache
def palette() -> str:
    """Return the style of the colours of engines, and of the dark theme by the system."""
    text = ""
    for theme, colours in ((":root", COLOURS), (BY_CHOICE, DARK)):
        text += f"{theme} {{ {' '.join(f'--c{n}: {c};' for n, c in enumerate(colours))} }}\n"
    text += " ".join(f".c{n} {{ color: var(--c{n}); }}" for n in range(len(DARK)))
    dark = re.findall(rf"{re.escape(BY_CHOICE)} ({{[^}}]*}})", _asset("page.css") + text)
    by_system = " ".join(f"{BY_SYSTEM} {rule}" for rule in dark)
    return f"{text}\n@media (prefers-color-scheme: dark) {{ {by_system} }}"


def _asset(name: str) -> str:
    return (HERE / "assets" / name).read_text(encoding="utf-8")


@cache
def _script(name: str) -> str:
    """Return a script of our own, which may stand inside a script element."""
    text = _asset(name)
    assert "</script" not in text.lower(), f"{name} would end its own element"
    return text


@cache
def _plotly() -> str:
    from plotly.offline import get_plotlyjs  # type: ignore[import-untyped]  # ships no stubs

    return str(get_plotlyjs()).replace("</script", "<\\/script")
