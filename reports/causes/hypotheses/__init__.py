"""Hypotheses on the causes of the errors of a log, by subject."""
