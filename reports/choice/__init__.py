"""Choosing settings: what an error costs, and the cheapest that reaches a target on every scene."""
