"""The page of a judged model: one HTML file with the verdict, its lines, the motion, the diff."""

import math
from collections.abc import Mapping

import numpy as np

from models.array import Array
from models.errors import harmless
from reports.drawing.moving import INSTANTS, displacements, drawing, singles
from reports.judge.halving import worst_place
from reports.judge.rules import RULES
from reports.output.numbers import count
from reports.own_model import table
from reports.own_model.account import CheckedLine
from reports.own_model.judged import PARTS, JointGap, JudgedModel, errors_of
from reports.page.build import Head, assembled
from reports.page.sections.motion import scene_words
from reports.page.sections.section import Section, name_text, sentence_text, setting_rows
from reports.results.looks import DASHES, Look


def model_page(judged: JudgedModel, facts: Mapping[str, str]) -> str:
    """Return the page of a judged model; ``facts`` are versions and the like."""
    sections = [
        _verdict(judged),
        _lines(judged),
        _motion(judged),
        _disturbing(judged),
        _recommended(judged),
        _made(judged, facts),
    ]
    return assembled(_head(judged, facts), sections)


def _head(judged: JudgedModel, facts: Mapping[str, str]) -> Head:
    account = judged.account
    request = account.request
    return Head(
        title=f"crankcheck: {name_text(request.path.name)}",
        facts=(
            f"{name_text(request.joint)} driven at {request.speed_rad_s:g} rad/s",
            count(len(account.scene.links), "link"),
            f"{account.steps} steps of {account.dt_s:g} s",
            *(f"{one.cell.engine} {one.version}" for one in judged.lines[:1] if one.version),
        ),
        made=name_text(facts.get("made", "")),
        first="verdict",
        looks=list(line_looks(judged).values()),
    )


COLOURS = (4, 6, 2)
"""Colours of the style sheet: as written, contacts off, recommended."""
SYMBOLS = ("circle", "square", "diamond")
SIZES = (11.0, 9.0, 7.0)


def line_looks(judged: JudgedModel) -> Mapping[str, Look]:
    """Return a look for each of the three shown lines, by the name of the line."""
    return {
        one.cell.profile: Look(
            number=number,
            engine="",
            variant=one.cell.profile,
            version=one.version,
            colour=COLOURS[number],
            symbol=SYMBOLS[number],
            dash=DASHES[number],
            size=SIZES[number],
        )
        for number, one in enumerate(judged.three)
    }


def _verdict(judged: JudgedModel) -> Section:
    """Return the verdict in one line, its reasons, the lines with their gains, every joint."""
    return Section(
        anchor="verdict",
        title="Verdict",
        template="model_verdict.html",
        words={
            "verdict": sentence_text(table.verdict_text(judged)),
            "level": "within" if judged.verdict == "within" else "out",
            "failures": [
                (each.rule, RULES[each.rule].title, sentence_text(each.text))
                for each in judged.failures
            ],
            "cure": sentence_text(judged.own.remedy),
            "steps": table.steps_text(judged),
            "heads": table.step_heads(judged),
            "rows": [_row(judged, one) for one in (*judged.three, *judged.others)],
            "still_out": sentence_text(table.still_out(judged)),
            "lines": [one.cell.profile for one in judged.three],
            "joints": [_joint(judged, joint) for joint in judged.joints()],
        },
        styles=("log.css", "model.css"),
    )


def _row(judged: JudgedModel, one: CheckedLine) -> dict[str, object]:
    worst = worst_place(one.errors) if one.errors else None
    steps = len(table.step_heads(judged))
    first = math.nan if worst is None else worst.pure
    gains = [math.nan] * steps if one is judged.own else judged.gains(one)[:steps]
    ended = one.convergence.words if one.convergence else ""
    if one.status != "ok":
        ended = f"{one.status}: {one.reason}"
    return {
        "look": line_looks(judged).get(one.cell.profile),
        "line": one.cell.profile,
        "within": one.verdict == "within",
        "errors": list(zip([first, *errors_of(one)[1:]], map(_gain, gains), strict=False)),
        "worst": name_text(f"{worst.quantity} of {worst.body}") if worst else "",
        "ended": sentence_text(ended),
    }


def _gain(factor: float) -> str:
    return "" if math.isnan(factor) else table.factor_text(factor)


def _joint(judged: JudgedModel, joint: JointGap) -> dict[str, object]:
    """Return a joint: its opening in the drawing, and its widest gap in each line."""
    names = [one.cell.profile for one in judged.three]
    return {
        "name": name_text(joint.name, 40),
        "open_m": joint.open_m,
        "gaps": [joint.gap_m.get(name, math.nan) for name in names],
        "share": joint.share,
        "share_told": table.share_text(joint.share) if math.isfinite(joint.share) else "",
        "out": joint.share > 1.0,
    }


def _lines(judged: JudgedModel) -> Section | None:
    """Return the error of the three lines over time and against the step; None without a log."""
    if not any(one.course for one in judged.three):
        return None
    return Section(
        anchor="lines",
        title="Error of the lines",
        template="model_lines.html",
        words={"converge": judged.account.request.converge},
        embedded={
            "lines": [_line(judged, one) for one in judged.three],
            "limits": {"error": _limit(judged), "gap": _limit_of(judged, "gap")},
        },
        scripts=("legend.js", "charts.js", "model_lines.js"),
        styles=("log.css", "model.css"),
        plotly=True,
    )


def _line(judged: JudgedModel, one: CheckedLine) -> dict[str, object]:
    dt_s, course = judged.account.dt_s, one.course
    return {
        "look": line_looks(judged)[one.cell.profile].number,
        "dt": [dt_s / parts for parts in PARTS],
        "error": list(errors_of(one)),
        "course": None
        if course is None
        else {
            "time": singles(course.time_s),
            "error": singles(course.error),
            "gap": singles(course.gap),
        },
    }


def _limit(judged: JudgedModel) -> float | None:
    worst = worst_place(judged.own.errors) if judged.own.errors else None
    return None if worst is None else _limit_of(judged, worst.tolerance)


def _limit_of(judged: JudgedModel, name: str) -> float | None:
    limit = judged.own.limits.get(name)
    return None if limit is None else limit.number


def _motion(judged: JudgedModel) -> Section:
    """Return the mechanism as it was read, in motion: the closed form, and over it the lines."""
    time_s = _instants(judged)
    looks = line_looks(judged)
    off = {
        looks[one.cell.profile].number: displacements(judged.scene, one.last_turn, time_s)
        for one in judged.three
    }
    words = scene_words(judged.scene)
    return Section(
        anchor="motion",
        title="In motion",
        template="model_motion.html",
        words={
            "driver": sentence_text(str(words["driver"])),
            "facts": [sentence_text(str(fact)) for fact in words["facts"]],  # type: ignore[attr-defined]  # a list
            "missing": [
                one.cell.profile
                for one in judged.three
                if off[looks[one.cell.profile].number] is None
            ],
        },
        embedded={
            "drawing": drawing(judged.scene, time_s),
            "lines": [{"look": number, "off": rows} for number, rows in off.items() if rows],
        },
        scripts=("legend.js", "mechanism.js", "stage.js", "model_motion.js"),
        styles=("log.css", "model.css"),
    )


def _instants(judged: JudgedModel) -> Array:
    """Return the instants of the longest last turn of a line; of the last period without any."""
    empty = np.zeros(0)
    times = [one.last_turn.get("time_s", empty) for one in judged.three if one.status == "ok"]
    longest = max(times, key=len, default=empty)
    if len(longest) > 1:
        return longest
    account = judged.account
    end_s = account.dt_s * account.steps
    start_s = max(0.0, end_s - account.scene.driver.law.period_s)
    return np.linspace(start_s, end_s, INSTANTS)


MOST = 300
"""Number of texts of one kind that are listed."""


def _disturbing(judged: JudgedModel) -> Section | None:
    """Return parts beside the linkage that can disturb the comparison, by kind; None if none."""
    found = table.groups(judged)
    if not found:
        return None
    return Section(
        anchor="disturbing",
        title="Possible disturbances",
        template="model_disturbing.html",
        words={
            "groups": [
                {
                    "kind": group.kind,
                    "effect": group.effect,
                    "texts": [sentence_text(text) for text in group.texts[:MOST]],
                    "number": len(group.texts),
                }
                for group in found
            ],
            "each": table.EACH,
        },
        styles=("log.css",),
    )


def _recommended(judged: JudgedModel) -> Section:
    last = judged.lines[-1]
    gain = judged.gains(last)[0]
    return Section(
        anchor="recommended",
        title="Recommended settings" if judged.account.helps else "No settings help",
        template="model_recommended.html",
        words={
            "head": table.recommended_head(judged),
            "patch": harmless(judged.patch),
            "is_diff": table.is_diff(judged.patch),
            "file": name_text(judged.account.request.path.name),
            "within": last.verdict == "within",
            "gain": table.factor_words(gain) if gain == gain else "",
        },
        scripts=("copying.js",),
        styles=("log.css",),
    )


def _made(judged: JudgedModel, facts: Mapping[str, str]) -> Section:
    account = judged.account
    told = {"file": str(account.request.path), **table.reading(account)}
    rows = setting_rows([one.settings for one in judged.lines], judged.own.settings)
    return Section(
        anchor="made",
        title="How it was read and run",
        template="model_made.html",
        words={
            "told": {head: sentence_text(text) for head, text in told.items()},
            "lines": [one.cell.profile for one in judged.lines],
            "settings": [
                (name, [(name_text(value), differs) for value, differs in values])
                for name, values in rows
            ],
            "facts": {name_text(k): name_text(str(v)) for k, v in facts.items() if k != "made"},
            "means": [sentence_text(text) for text in table.footer(judged)],
        },
        styles=("log.css",),
    )
