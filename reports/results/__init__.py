"""Results of stored cells."""
