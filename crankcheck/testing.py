"""Assertion for your own tests: fail where a linkage is not where the closed form has it.

::

    import crankcheck.testing

    def test_my_solver_holds_the_four_bar():
        crankcheck.testing.assert_within("fourbar-lecture-1", "log.csv", target=1e-4)

docs/python.md has more of it. Nothing needs to be installed in pytest.
"""

from reports.requests.within import assert_within

__all__ = ["assert_within"]
