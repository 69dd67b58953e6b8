"""`python -m crankcheck` is the command `crankcheck`."""

from reports.cli import main

if __name__ == "__main__":
    main()
