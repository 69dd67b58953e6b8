"""The hard cases, in groups.

A further case is a `Case` in the tuple of its group; a further group is a tuple and its line in
``reports/ways/<kind>/cases.py``.
"""
