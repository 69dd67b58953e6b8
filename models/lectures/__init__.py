"""Input of lectures beside scenes: schemes, joints by their contacts, tasks of synthesis."""
