"""A cell: run, compared, judged."""
