"""What lecturers have beside scenes: schemes, joints by their contacts, tasks of synthesis."""
