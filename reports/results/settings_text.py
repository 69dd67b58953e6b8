"""The settings of variants in words: what they set otherwise than the engine as shipped."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from reports.results.lines import Line, Named, called, named
from sim.engine import SettingValue

OWN = "every setting as the engine is shipped"


def usual(lines: Sequence[Line], engine: str) -> Line:
    """What the others of an engine are held against: it as shipped, or else its first variant."""
    own = [line for line in lines if line.engine == engine]
    return next((line for line in own if line.variant == "as-shipped"), own[0])


def settings_told(lines: Sequence[Line]) -> Mapping[Named, str]:
    """The settings of each variant, by engine, variant and drive.

    Those of an engine as shipped go without saying; where it was not run so, its first variant is
    told in full, and of the others what differs from that.
    """
    return {named(line): _told(line, lines) for line in lines}


def value_text(value: SettingValue | None) -> str:
    """A value as it is shown; empty for a setting that is not there."""
    if value is None:
        return ""
    return f"{value:g}" if isinstance(value, float) else str(value) or "none"


def _told(line: Line, lines: Sequence[Line]) -> str:
    first = usual(lines, line.engine)
    if first.variant == "as-shipped":
        return _words(_differing(line, first)) or OWN
    name = called(first.variant, first.drive)
    if (line.variant, line.drive) == (first.variant, first.drive):
        return _words(line.settings)
    differing = _words(_differing(line, first))
    return f"as {name}, but {differing}" if differing else f"as {name}"


def _differing(line: Line, other: Line) -> Mapping[str, SettingValue]:
    """The settings of a line that another one has not, or otherwise."""
    return {
        name: value
        for name, value in line.settings.items()
        if name not in other.settings or other.settings[name] != value
    }


def _words(settings: Mapping[str, SettingValue]) -> str:
    return ", ".join(f"{name} {value_text(value)}" for name, value in settings.items())
