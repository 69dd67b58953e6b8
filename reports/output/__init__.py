"""How anything leaves: console, Markdown, numbers, JSON, files, provenance."""
