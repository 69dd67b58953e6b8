"""The contract of every engine, whoever wrote it: clauses, and their check on an engine."""
