"""Workbooks whose cells are the formulas: change a length, and tables and charts follow."""
