"""Commands that lecturers use, on top of all the rest; nothing imports them, a table names them."""
