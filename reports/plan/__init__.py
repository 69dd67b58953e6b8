"""Requests, checked before anything runs."""
