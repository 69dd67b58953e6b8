"""Self-test of the verdict: faults planted on purpose, and the rule that must name each."""
