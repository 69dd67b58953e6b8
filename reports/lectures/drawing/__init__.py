"""What lectures draw: sheets to scale, chains, schemes, workbooks with formulas."""
