"""The most of a log that is read, which is looked at before it is."""

from __future__ import annotations

from models.files.inputs import UnreadableError

MOST_ROWS = 2_000_000
"""Ten hours of samples at 60 Hz, half an hour at 1 kHz; judging them takes seconds."""
MOST_COLUMNS = 2_000
MOST_NUMBERS = 80_000_000
"""Of columns that something is made of."""


def refuse_columns(columns: int) -> None:
    """Raise UnreadableError for more columns than are looked at."""
    if columns > MOST_COLUMNS:
        raise UnreadableError(
            f"{columns} columns; at most {MOST_COLUMNS} are read: leave out what is not of the "
            "mechanism"
        )


def refuse_rows(rows: int, columns: int) -> None:
    """Raise UnreadableError for more rows, of so many columns that are read, than that."""
    if rows > MOST_ROWS:
        raise UnreadableError(
            f"{rows} rows; at most {MOST_ROWS} are read: cut the log, or keep every n-th row"
        )
    if rows * columns > MOST_NUMBERS:
        raise UnreadableError(
            f"{rows} rows of {columns} columns; at most {MOST_NUMBERS} numbers are read: keep "
            "every n-th row, or fewer columns"
        )
