"""The report page: one HTML file with everything in it, made of sections."""
