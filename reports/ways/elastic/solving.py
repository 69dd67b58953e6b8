"""The reference of scenes whose driver follows a law, with links that bend."""

from reports.requests.elastic_solution import ElasticSolving

SOLVING = ElasticSolving()
