"""The reference of scenes whose driver follows a law, with rigid links."""

from reports.requests.solve import DrivenSolving

SOLVING = DrivenSolving()
