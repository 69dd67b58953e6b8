"""`python -m crankcheck` is the command `crankcheck`."""

import os

from crankcheck import _end_on_ctrl_c


def main() -> None:
    """Run the command, imported once Ctrl-C can do no harm."""
    _end_on_ctrl_c()
    from reports.workers import one_thread

    one_thread(os.environ)  # before anything imports numpy
    from reports.cli import main as command

    command()


if __name__ == "__main__":
    main()
