"""`python -m crankcheck` is the command `crankcheck`."""

from crankcheck import _end_on_ctrl_c


def main() -> None:
    """The command, imported once Ctrl-C can do no harm."""
    _end_on_ctrl_c()
    from reports.cli import main as command

    command()


if __name__ == "__main__":
    main()
