"""What is said of stored cells of driven scenes."""

from reports.results.result_kind import ResultKind

RESULTS = ResultKind(
    error="An error is the largest of a whole run against the closed form: of a link angle in "
    "radians, of a slider's displacement or a point's place in lengths of the longest link, "
    "whichever is worst.",
    stands=0,
    leads=1,
    axis="largest error: angle [rad], place / L [-]",
    promise="place (rad, or of the longest link)",
)
