"""The commands by their words: the request of each, in a room beside this, and its help.

None is loaded before it is called. Commands of one word come in this order, then the groups.
"""

from collections.abc import Mapping

# fmt: off
COMMANDS: Mapping[str, tuple[str, str]] = {
    "verify": ("requests.options:VerifyOptions", """
Run scenes in engines, or a model of your own, and hold them to the closed form; exit 1 when
out of tolerance."""),
    "selftest": ("requests.stability:SelftestRequest", """
Plant faults in healthy runs, and see that the right rule catches each; exit 1 if not."""),
    "diff": ("requests.diff:DiffRequest", """
Compare two stored runs; exit 1 when an error grew past the factor."""),
    "history": ("requests.history:HistoryRequest", """
Run the same verification with several versions of an engine, and show what changed."""),
    "sweep": ("requests.sweep:SweepRequest", """
Run a grid of scenes, engines, settings and steps; keep and time every cell."""),
    "tune": ("requests.tune:TuneRequest", """
Search an engine's settings for the cheapest that reach a target error."""),
    "advise": ("requests.advise:AdviseRequest", """
Say what engines reach at your frame time, and how few sub-steps reach a target.

The exit code is 0 where some settings reach it, 1 where none do."""),
    "report": ("requests.report:ReportRequest", """
Write a sweep as one page that works offline, or as Markdown for a pull request."""),
    "figures": ("requests.figures:FiguresRequest", """
Draw the diagrams of a sweep as SVG and PDF, for a paper."""),
    "stability": ("requests.stability:StabilityRequest", """
Grade the engines on hard cases, and find how far each holds them.

The exit code is 0; with --at it is 1 where the value is not held."""),
    "solve": ("requests.options:SolveOptions", """
Show the reference alone: angles, points and sliders with all their rates, and the forces
that these ask for; of a scene that is let go, its free motion and energy; of one with elastic
links, how these bend, and what that changes."""),
    "run": ("requests.run:RunRequest", """
Run a scene in an engine and write its log; exit 1 when the run did not end well."""),
    "export": ("requests.export:ExportRequest", """
Write the scene as MJCF, assembled, with its state as the keyframe."""),
    "scenes": ("requests.export:ScenesRequest", """
List the shipped scenes with their structure, driver and source."""),
    "view": ("requests.export:ViewRequest", """
Open MuJoCo's viewer, or, without a screen or with -o, draw the motion into a file."""),
    "judge": ("requests.judge:JudgeRequest", """
Hold a log of your own to the closed form; exit 1 when out of tolerance."""),
    "centres": ("lectures.drawing.sheet_requests:CentresRequest", """
Show the instant centres of a position by the theorem of Aronhold and Kennedy, with the
inflection circle, Bresse's circles and the centrodes of a link."""),
    "positions": ("lectures.drawing.sheet_requests:PositionsRequest", """
Draw the positions of a mechanism over a turn, with arcs and loci, to scale."""),
    "polygon": ("lectures.drawing.polygon:PolygonRequest", """
Draw the velocity and the acceleration polygon of a position, group by group, to scale.

Without -o the table of the vectors is shown. With --log the images of a log's points stand
beside those of the reference."""),
    "graph": ("lectures.drawing.graph:GraphRequest", """
Draw an angle, a displacement or a coordinate over a period with its rates, each from the
other with ruler and pole, beside the exact curves.

Without -o the table is shown that is drawn first, and what is drawn from it."""),
    "cycle": ("lectures.machine.regulation:CycleRequest", """
Show the cycle that a machine repeats under its loads: extreme speeds, the coefficient of
fluctuation, surplus of work, reduced inertia, power.

A scene that is driven keeps its mean speed by a constant torque; one that is let go has its
loads alone."""),
    "flywheel": ("lectures.machine.regulation:FlywheelRequest", """
Work out the flywheel on the driver for a coefficient of fluctuation, exact and as the
textbooks approximate it, and the speed over the cycle with it and without."""),
    "equilibria": ("lectures.machine.equilibria:EquilibriaRequest", """
Show where a scene rests under its weights, springs and loads, stable or not, in each of its
circuits, with the frequency of small oscillations; a driven one as if it were let go."""),
    "gears": ("lectures.machine.gears:GearsRequest", """
Show the gear train of a scene: ratios, speeds, torques and tooth forces for given loads,
efficiency with the losses of its teeth, their circles and contact ratio, and how many equal
planets fit."""),
    "chains": ("lectures.drawing.sheet_requests:ChainsRequest", """
List and draw the distinct kinematic chains of so many links: number synthesis, their
inversions with the class of each, and their types with sliders."""),
    "structure": ("lectures.drawing.structure:StructureRequest", """
Show what a scene is made of: links and joints, mobility, Assur groups with class and order,
the class with every other joint as the driver, and all its assemblies at one place."""),
    "rotatability": ("lectures.machine.rotatability:RotatabilityRequest", """
Show which links turn fully and how far others swing, the Grashof type, circuits and
branches, dead points and transmission angles.

Exit code 1: the driver does not lead through the positions asked for (a defect of branch,
circuit or order)."""),
    "synth": ("lectures.design.synth:SynthRequest", """
Find the mechanisms that do a task: their scenes, defects, figure, and proof in engines.

Exit code 1: no solution without a defect, or with --prove one that an engine does not lead
through what is asked."""),
    "cam": ("lectures.cams.cam_request:CamRequest", """
Design a cam from its task: profile as DXF, SVG and CSV, pressure angle, curvature, contact
force, the speed at which the follower leaves, drawings.

Exit code 1: the cam exceeds a limit of its task."""),
    "vibration": ("lectures.machine.vibration:VibrationRequest", """
Show how elastic links vibrate at the driver's speed, or over speeds: natural frequencies,
deflection, stability, resonances.

A resonance, where there is no periodic motion to tell, ends with exit code 2."""),
    "joint": ("lectures.drawing.mobility:JointRequest", """
Say the class of a joint, whether it is a lower or a higher pair, and its freedoms by name,
from how its two links touch."""),
    "mobility": ("lectures.drawing.mobility:MobilityRequest", """
Count the motions of a planar or spatial scheme, and say by name which constraints are
passive and which freedoms idle, from the rank of its equations."""),
    "engines": ("requests.engines:EnginesRequest", """
List the engines with their version, or the command that installs them, and profiles."""),
    "engines check": ("requests.engines:EngineCheckRequest", """
Say what of the contract of engines one holds, and how to mend what it does not.

The exit code is 0 where it holds all of it, 1 where it does not."""),
    "recipe forces": ("requests.export:ForceRecipeRequest", """
Show a program that reads reactions and the driving torque right; it needs the engine alone.

Run it to have them over a turn, as lines of numbers with commas."""),
}
# fmt: on
