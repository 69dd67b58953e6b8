"""`python -m reports.cli` is the command `crankcheck`."""

from reports.cli import main

main()
