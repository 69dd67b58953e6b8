"""The reference of scenes in free motion, with rigid links."""

from __future__ import annotations

from reports.requests.free_solution import FreeSolving

SOLVING = FreeSolving()
