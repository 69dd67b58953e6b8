"""What `import crankcheck` gives: functions with arguments that are checked, and their results."""
