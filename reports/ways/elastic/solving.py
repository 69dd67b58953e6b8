"""The reference of scenes whose driver follows a law, with links that bend."""

from reports.requests.free_solution import ElasticSolving

SOLVING = ElasticSolving()
