"""Workbooks with formulas as cells: change a length, and tables and charts follow."""
