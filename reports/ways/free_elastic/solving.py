"""The reference of scenes in free motion, with links that bend."""

from reports.requests.free_solution import ReleasedElasticSolving

SOLVING = ReleasedElasticSolving()
