"""Put the page together: sections, style, scripts and Plotly, in one file that loads nothing."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from reports.page.embed import embedded, policy
from reports.page.looks import Look
from reports.page.numbers import NONE, count, duration, error_text
from reports.page.report import Report
from reports.page.sections import SECTIONS
from reports.page.sections.base import Section
from reports.page.sections.motion import build as motion
from reports.page.thinning import BUDGET
from reports.store.reader import Stored

HERE = Path(__file__).parent
MOST_BYTES = 7_900_000
"""Over this, drawings and curves give way: fewer steps of each line are drawn."""
FIRST = ("page.js", "tables.js")
"""Scripts that every page has, before those of its sections."""


def page(stored: Stored) -> str:
    """The report of a store as one HTML file.

    Raises
    ------
    CrankcheckError
        A store that can not be read, part by part.
    """
    report = Report(stored)
    found = {name: build(report) for name, build in SECTIONS.items()}
    text = _rendered(report, found)
    over = len(text.encode()) - MOST_BYTES
    if over > 0 and found["motion"] is not None:
        found["motion"] = motion(report, BUDGET - over)
        text = _rendered(report, found)
    return text


def _rendered(report: Report, found: Mapping[str, Section | None]) -> str:
    """The page of the sections that have something to show."""
    return render(report, [section for section in found.values() if section is not None])


def render(report: Report, sections: Sequence[Section]) -> str:
    """A page of some sections."""
    environment = _environment()
    bodies = [
        Markup(environment.get_template(f"sections/{one.template}").render(one.words))
        for one in sections
    ]
    names = dict.fromkeys([*FIRST, *(script for one in sections for script in one.scripts)])
    early = _script("theme.js")
    late = "\n".join(_script(name) for name in names)
    plotly = _plotly() if any(one.plotly for one in sections) else ""
    looks = [_shape(look) for look in report.looks.values()]
    return environment.get_template("page.html").render(
        policy=policy([script for script in (early, plotly, late) if script]),
        style=Markup(_asset("page.css")),
        early=Markup(early),
        plotly=Markup(plotly),
        late=Markup(late),
        sections=list(zip(sections, bodies, strict=True)),
        embedded=[
            ("looks", embedded(looks)),
            *((one.anchor, embedded(one.embedded)) for one in sections if one.embedded),
        ],
        cells=count(len(report.cells), "cell"),
        scenes=count(len(report.scenes), "scene"),
        engines=report.engines,
        settings=count(len(report.looks), "set of settings", "sets of settings"),
        made=max((str(run.get("started", "")) for run in stored_runs(report)), default=""),
    )


def stored_runs(report: Report) -> Sequence[dict[str, object]]:
    """The runs that filled the store."""
    return [dict(run) for run in report.stored.manifest.runs]


def _shape(look: Look) -> dict[str, object]:
    """What the scripts need of a look."""
    return {**vars(look), "name": look.name}


@cache
def _environment() -> Environment:
    """Templates that escape everything and know every name that they use."""
    environment = Environment(
        loader=FileSystemLoader(HERE / "templates"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {"error": error_text, "duration": duration}
    environment.globals |= {"dash": NONE, "infinite": math.inf}
    return environment


def _asset(name: str) -> str:
    return (HERE / "assets" / name).read_text(encoding="utf-8")


@cache
def _script(name: str) -> str:
    """A script of ours, which may stand inside a script element."""
    text = _asset(name)
    assert "</script" not in text.lower(), f"{name} would end its own element"
    return text


@cache
def _plotly() -> str:
    """Plotly as it is installed."""
    from plotly.offline import get_plotlyjs  # type: ignore[import-untyped]  # ships no stubs

    return str(get_plotlyjs()).replace("</script", "<\\/script")
