"""What the verdict can see: faults planted on purpose, and the rule that must name each."""
