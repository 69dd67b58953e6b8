"""Changes between two stored runs: better, worse, new and missing cells."""
