"""Words for an own model: its reading, its possible disturbances, gains of lines, the verdict."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from models.errors import few
from reports.judge.halving import worst_place
from reports.judge.rules import RULES
from reports.output.numbers import count, error_text, listed, short
from reports.own_model.account import ModelAccount, told
from reports.own_model.judged import PARTS, JudgedModel

OPEN = 1e-9
"""Least opening of a joint that is reported, over the longest link."""
SHOWN = 6
NO_HELP = "no settings that were tried here help"
EACH = 3
"""Number of disturbances of a kind that are listed on a terminal."""


@dataclass(frozen=True)
class SentenceGroup:
    """The disturbances of a kind, and the effect of leaving them out: "" without such a line."""

    kind: str
    texts: Sequence[str]
    effect: str

    def short(self) -> str:
        """Return the first of them, and the number of the others."""
        left = len(self.texts) - EACH
        return "; ".join(self.texts[:EACH]) + (f"; and {left} more" if left > 0 else "")


def reading(account: ModelAccount) -> dict[str, str]:
    """Return words for the reading of the file, its drive, and its start, each under its head."""
    scene = account.scene
    sliders = f"; {_count_and_names(list(scene.sliders), 'slider')}" if scene.sliders else ""
    notes = {f"note {n}" if n else "note": text for n, text in enumerate(account.notes)}
    return {
        "read as": f"{_count_and_names(list(scene.links), 'link')}{sliders}",
        **notes,
        "pose": _pose_text(account),
        "drive": _drive_text(account),
    }


def _drive_text(account: ModelAccount) -> str:
    request = account.request
    turned = f"{account.steps * account.dt_s / account.scene.driver.law.period_s:.4g}"
    turns = "1 turn" if turned == "1" else f"{turned} turns"
    start = "the pose as drawn" if request.key is None else f"keyframe {request.key}"
    if request.start_deg is not None:
        start = f"{request.start_deg:g} deg"
    return (
        f"{request.joint} at {request.speed_rad_s:g} rad/s, {turns} from {start}, by a "
        "flywheel on that hinge, set at run time, by whose ratio the solver's tolerance is "
        "divided; nothing else is changed"
    )


def _count_and_names(names: Sequence[str], noun: str) -> str:
    return f"{count(len(names), noun)} ({few(names, SHOWN)})"


def _pose_text(account: ModelAccount) -> str:
    most = OPEN * (account.scene.longest_m or 1.0)
    gaping = sorted(
        ((gap, name) for name, gap in account.open_m.items() if gap > most), reverse=True
    )
    if not gaping:
        return "shut as the file has it; the run starts from the closed form"
    each = few([f"{name} by {short(gap, 3)} m" for gap, name in gaping], SHOWN)
    return (
        f"the file's own is open at {each}; the run starts from the closed form, where every joint "
        "is shut"
    )


def groups(judged: JudgedModel) -> list[SentenceGroup]:
    """Return possible disturbances of the comparison, kind by kind, those on the way first."""
    kinds: dict[str, list[str]] = {}
    for each in judged.account.disturbances:
        kinds.setdefault(each.kind, []).append(each.text)
    return [SentenceGroup(kind, texts, effect(judged, kind)) for kind, texts in kinds.items()]


def effect(judged: JudgedModel, kind: str) -> str:
    """Return the effect of leaving out the disturbances of a kind; "" if no line shows it."""
    one = judged.without(kind)
    if one is None:
        return ""
    if one.status != "ok":
        return f"without: {one.status}"
    if judged.own.status != "ok":
        return "without: it runs to its end"
    return f"without: {factor_words(judged.gains(one)[0])}"


def factor_words(factor: float) -> str:
    """Return an error as written over another one, in words."""
    if math.isnan(factor):
        return "not to be told"
    if 0.99 < factor < 1.01:
        return "the same error"
    if factor > 1.0:
        return "no error at all" if math.isinf(factor) else f"{factor_text(factor)} x less error"
    return f"{factor_text(1 / factor)} x more error" if factor > 0.0 else "all of the error"


def factor_text(factor: float) -> str:
    """Return a factor with few digits: 1.3, 27, 1.2e5."""
    if not math.isfinite(factor):
        return "-" if math.isnan(factor) else "inf"
    if factor >= 1e4 or factor < 0.095:
        return short(factor)
    return f"{factor:.0f}" if factor >= 100 else f"{factor:.2g}"


def gaps(judged: JudgedModel) -> str:
    """Return the widest gap of all joints as written, in words; "" where nothing was logged."""
    joints = [joint for joint in judged.joints() if judged.own.cell.profile in joint.gap_m]
    if not joints:
        return ""
    worst, *rest = joints
    name = judged.own.cell.profile
    longest_m = judged.scene.longest_m or 1.0

    def size(gap_m: float) -> str:
        return f"{error_text(gap_m)} m ({error_text(gap_m / longest_m)} L)"

    told_ = f"the widest as written is {worst.name}, {size(worst.gap_m[name])}"
    if math.isfinite(worst.share):
        told_ += f", {share_text(worst.share)}"
    if rest:
        told_ += f"; {count(len(rest), 'other')} up to {size(rest[0].gap_m[name])}"
    return told_


def still_out(judged: JudgedModel) -> str:
    """Return why the recommended settings are out of tolerance, "" if they are within."""
    finding = judged.still()
    if finding is None:
        return ""
    more = len(judged.lines[-1].failures) - 1
    others = f"; and by {count(more, 'more rule')}" if more else ""
    return f"out by {finding.rule} {RULES[finding.rule].title}: {finding.text}{others}"


def share_text(share: float) -> str:
    """Return a part of a limit: 12.3% of its limit, 34 times its limit."""
    if share >= 1.0:
        return f"{factor_text(share)} times its limit"
    return f"{share:.1%} of its limit" if share >= 1e-3 else "below 0.1% of its limit"


def verdict_text(judged: JudgedModel) -> str:
    """Return the verdict on the model as written in one line, and the possible gain."""
    own, last = judged.own, judged.lines[-1]
    if own.verdict == "within":
        head = "WITHIN TOLERANCE as written"
    elif own.verdict == "unsupported":
        head = f"NOT RUN as written: {own.reason}"
    else:
        head = f"OUT OF TOLERANCE as written{_why_out(judged)}"
    if not judged.account.helps:
        return f"{head}; {NO_HELP}"
    better = "within" if last.verdict == "within" else last.verdict
    gain = judged.gains(last)[0]
    words = f", {factor_words(gain)}" if math.isfinite(gain) else ""
    return f"{head}; recommended: {better}{words}"


def _why_out(judged: JudgedModel) -> str:
    own = judged.own
    if own.status != "ok":
        return f": {own.status}"
    worst = worst_place(own.errors) if own.errors else None
    if worst is None:
        return ""
    return f": {worst.quantity} of {worst.body} {short(worst.pure)}"


def footer(judged: JudgedModel) -> list[str]:
    """Return the reference and scale of the numbers, and the length of the run."""
    account, own = judged.account, judged.own
    drive = own.errors.worst("drive") if own.errors else None
    driven = f"; largest drive error {short(drive.maximum)} rad" if drive else ""
    finer = ""
    if account.request.converge:
        finer = f"; {listed(list(told(account.profiles)))} at half and quarter step too"
    per_turn = account.scene.driver.law.period_s / account.dt_s
    return [
        "Largest errors of place against the closed form at the commanded time: rad, or over the "
        "longest link L; gain: the error as written over that of the line.",
        f"dt {account.dt_s:g} s, {per_turn:.4g} steps a turn, {account.steps} steps{driven}"
        f"{finer}.",
    ]


def steps_text(judged: JudgedModel) -> str:
    """Return the steps at which lines are run, in words."""
    if not judged.account.request.converge:
        return f"at dt {judged.account.dt_s:g} s"
    return f"at dt {judged.account.dt_s:g} s, its half and its quarter"


def step_heads(judged: JudgedModel) -> list[str]:
    """Return the heads of the columns of errors."""
    if not judged.account.request.converge:
        return ["dt"]
    return ["dt" if parts == 1 else f"dt/{parts}" for parts in PARTS]


def recommended_head(judged: JudgedModel) -> str:
    """Return the sentence before the recommended settings, if there are any."""
    if not judged.account.helps:
        return f"{NO_HELP.capitalize()}: stiff loops run no better, nor with fourth-order steps."
    if not judged.patch:
        return "The file has the recommended settings already."
    return f"Recommended{', as a diff of the file' * is_diff(judged.patch)}:"


def is_diff(patch: str) -> bool:
    """True if recommended settings are a diff, and not words."""
    return patch.startswith("--- ")
