"""A user's own log, judged: within tolerance or not, and if not, why."""
