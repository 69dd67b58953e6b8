"""Theory that lecturers use and no engine is compared with."""
