"""Drawings of lectures: sheets to scale, chains, schemes, workbooks with formulas."""
