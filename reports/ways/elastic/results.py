"""What is said of stored cells of elastic links."""

from reports.results.result_kind import ResultKind

RESULTS = ResultKind(
    error="Where links bend, the error is that of their deflection against the solved motion of "
    "the beam, as a share of the largest deflection.",
    stands=1,
    leads=0,
    axis="largest error of deflection / largest deflection [-]",
    promise="deflection (of the largest)",
    unit="/ D",
    targets=(1e-1, 1e-2, 1e-3),  # nearer to the beam comes no chain that is run
    kept="deflection within a target of the beam's",
    head="target\n/ D",
    notes=(
        "Each elastic link is so many rigid segments, with a spring of rate EI n / l in every pin "
        "between them. Whatever the speed, the step times their highest frequency stays below 1.5.",
    ),
)
