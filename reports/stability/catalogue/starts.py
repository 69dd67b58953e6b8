"""Bad starts: joints that are open, velocities that do not fit, the wrong assembly."""

from __future__ import annotations

from reports.stability.case import Case

CASES: tuple[Case, ...] = ()
