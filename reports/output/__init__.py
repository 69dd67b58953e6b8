"""Output of any kind: console, Markdown, numbers, JSON, files, provenance."""
