"""Users' own engines, named by module and attribute or by an entry point."""
