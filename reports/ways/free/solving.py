"""The reference of scenes in free motion, with rigid links."""

from reports.requests.free_solution import FreeSolving

SOLVING = FreeSolving()
