"""What every engine has to do, whoever wrote it: clauses, and whether an engine holds them."""
