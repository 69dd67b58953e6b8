"""Figures of a store for a paper, as SVG and PDF, and its summary for a pull request comment."""
