"""The kinds of scenes, a folder each: how they are run and compared with the reference.

A further kind is a folder with a `Way` and its parts, and its name in `reports.protocol.way.WAYS`.
"""
