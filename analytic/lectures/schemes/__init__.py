"""Mobility of schemes before dimensions, planar and spatial, and classes of joints."""
