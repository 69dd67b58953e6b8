"""What is said of stored cells of free motion."""

from reports.results.result_kind import ResultKind

RESULTS = ResultKind(
    error="What was let go is held to the integrated motion at the same time, its errors over the "
    "sensitivity G of that motion.",
    stands=2,
    leads=2,
    axis="largest error / sensitivity: angle [rad], place / L [-]",
    promise="place over the sensitivity (rad, or of the longest link)",
)
