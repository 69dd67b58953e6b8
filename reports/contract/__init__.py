"""The contract of every engine, whoever wrote it: clauses (EC..), and their check on an engine."""
