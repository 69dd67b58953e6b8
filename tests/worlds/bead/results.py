"""What is said of stored beads."""

from reports.results.result_kind import ResultKind

RESULTS = ResultKind(
    error="Of beads the error is that of the angle, or of a place, against the swing.",
    stands=3,
    leads=3,
    axis="largest error of a bead: angle [rad], place / L [-]",
    promise="place of a bead (rad, or of the spoke)",
)
