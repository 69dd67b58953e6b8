"""Commands for lecturers, on top of all the rest; no room imports them, a table names them."""
