"""All cells of a request: table and JUnit."""
