"""Why the channels of a user's own log are off."""

from __future__ import annotations

from reports.causes.cause import Case, Cause
from reports.causes.find import causes

__all__ = ["Case", "Cause", "causes"]
