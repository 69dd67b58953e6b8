"""The commands by their words, in panels: the request of each, in a room beside this, and its help.

None is loaded before it is called. The first line of a help stands in the list of all commands.
"""

from collections.abc import Mapping
from typing import NamedTuple


class Command(NamedTuple):
    """A command: module and name of its request below `reports`, the panel of the list in which it
    stands, and its help: a line for the list, and lines of this file on the rest."""

    request: str
    panel: str
    lines: str

    @property
    def help(self) -> str:
        """The help, a line for each of its two paragraphs."""
        first, *rest = self.lines.strip().split("\n")
        return "\n\n".join(filter(None, (first, " ".join(rest))))


COMPARE, OWN, REFERENCE = "Compare engines", "Your own", "The reference"
DRAW, DESIGN = "Draw", "Design"
PANELS = COMPARE, OWN, REFERENCE, DRAW, DESIGN

# fmt: off
COMMANDS: Mapping[str, Command] = {
    "verify": Command("requests.options:VerifyOptions", COMPARE, """
Run scenes in engines and compare each with the closed form.
Or run a MuJoCo model of your own (--mjcf). The exit code is 1 if anything is out of tolerance."""),
    "sweep": Command("requests.sweep:SweepRequest", COMPARE, """
Run a grid of scenes, engines, settings and steps; store it."""),
    "report": Command("requests.report:ReportRequest", COMPARE, """
Write a sweep as one offline page, or as Markdown.
The Markdown is for a pull request."""),
    "figures": Command("requests.figures:FiguresRequest", COMPARE, """
Draw the diagrams of a sweep as SVG and PDF, for a paper."""),
    "stability": Command("requests.stability:StabilityRequest", COMPARE, """
Grade engines on hard cases; find where each one fails.
The exit code is 0; it is 1 with --at if the value is not held, and with --baseline if an outcome
got worse or a critical value moved by more than its uncertainty."""),
    "history": Command("requests.history:HistoryRequest", COMPARE, """
Repeat a verification with several versions of an engine."""),
    "diff": Command("requests.diff:DiffRequest", COMPARE, """
Compare two stored runs.
The exit code is 1 if an error grew by more than the factor."""),
    "tune": Command("requests.tune:TuneRequest", COMPARE, """
Find an engine's cheapest settings for a target error."""),
    "advise": Command("requests.advise:AdviseRequest", COMPARE, """
Find the settings and sub-steps that fit your frame time.
The exit code is 0 if some settings reach the target, else 1."""),
    "selftest": Command("requests.stability:SelftestRequest", COMPARE, """
Plant faults in runs and check that a rule catches each.
The exit code is 1 if one is not caught."""),
    "explain": Command("requests.explain:ExplainRequest", COMPARE, """
Explain a rule, or the error of one cell, and what lowers it.
A rule (CC110) or a clause of the contract (EC52): its statement, its reason, its limit. A scene
with --engine: its error by part, the limit that binds, and the settings to change."""),
    "judge": Command("requests.judge:JudgeRequest", OWN, """
Compare a log of your own with the closed form.
The exit code is 1 if it is out of tolerance."""),
    "run": Command("requests.run:RunRequest", OWN, """
Run a scene in an engine and write its log.
The exit code is 1 if the run failed."""),
    "export": Command("requests.export:ExportRequest", OWN, """
Write a scene as MJCF, with its state as the keyframe."""),
    "solve": Command("requests.options:SolveOptions", REFERENCE, """
Print the reference: places, rates and forces of a scene.
Also free motion and energy of a scene without a driver, and deflection of elastic links with its
effects."""),
    "scenes": Command("requests.export:ScenesRequest", REFERENCE, """
List the shipped scenes with structure, driver and source."""),
    "view": Command("requests.export:ViewRequest", REFERENCE, """
Open MuJoCo's viewer, or draw the motion into a file.
It draws if there is no screen, or with -o."""),
    "cycle": Command("lectures.machine.regulation:CycleRequest", REFERENCE, """
Print the steady cycle of a machine under its loads.
Extreme speeds, coefficient of fluctuation, surplus of work, reduced inertia, power. A driven
scene keeps its mean speed by a constant torque; a scene of free motion has only its loads."""),
    "flywheel": Command("lectures.machine.regulation:FlywheelRequest", REFERENCE, """
Size the flywheel for a coefficient of fluctuation.
Exact, and as textbooks approximate it; also the speed over the cycle, with and without it."""),
    "vibration": Command("lectures.machine.vibration:VibrationRequest", REFERENCE, """
Print vibrations of elastic links at one or more speeds.
Natural frequencies, deflection, stability, resonances. The exit code is 2 at a resonance, which has
no periodic motion."""),
    "rotatability": Command("lectures.machine.rotatability:RotatabilityRequest", REFERENCE, """
Print which links turn fully, swings and dead points.
Also Grashof type, circuits, branches and transmission angles. Exit code 1: the driver does not
lead through the requested positions (a defect of branch, circuit or order)."""),
    "equilibria": Command("lectures.machine.equilibria:EquilibriaRequest", REFERENCE, """
Print where a scene rests under weights, springs and loads.
Stable or not, in each of its circuits, with the frequency of small oscillations; a driven scene
as if its driver were free."""),
    "sensitivity": Command("lectures.machine.sensitivity:SensitivityRequest", REFERENCE, """
Print which length matters most to the motion, and where.

Effect of each length and angle, at a tolerance and at 1 %, on the follower or on any link, slider
or point, over a turn; exact to first order, from the gradient of the reference."""),
    "fit": Command("lectures.machine.fit:FitRequest", REFERENCE, """
Find the lengths of a real mechanism from a log of it.

With one standard deviation of each, from the angles of its driver and of another link, or places.
Angles alone determine ratios. The exit code is 1 where no lengths explain the log."""),
    "polygon": Command("lectures.drawing.polygon:PolygonRequest", DRAW, """
Draw the velocity and acceleration polygons of a position.
Group by group, to scale. Without -o it prints the table of the vectors. With --log the images of
a log's points stand beside those of the reference."""),
    "positions": Command("lectures.drawing.sheet_requests:PositionsRequest", DRAW, """
Draw the positions over a turn, with arcs and loci, to scale."""),
    "centres": Command("lectures.drawing.sheet_requests:CentresRequest", DRAW, """
Draw the instant centres of a position (Aronhold and Kennedy).
With the inflection circle, Bresse's circles and the centrodes of a link."""),
    "graph": Command("lectures.drawing.graph:GraphRequest", DRAW, """
Draw a coordinate over a period with its graphical rates.
An angle, a displacement or a coordinate of a point, each rate drawn with ruler and pole beside
the exact curves. Without -o it prints the tables of the drawing."""),
    "synth": Command("lectures.design.synth:SynthRequest", DESIGN, """
Find the mechanisms that do a task: scenes, defects, figure.
With --prove they run in engines. Exit code 1: no solution without a defect, or one that an engine
does not lead through the requested positions."""),
    "structure": Command("lectures.drawing.structure:StructureRequest", DESIGN, """
Print links, joints, mobility and Assur groups of a scene.
The groups with class and order, the class with every other joint as the driver, and all
assemblies at one place."""),
    "chains": Command("lectures.drawing.sheet_requests:ChainsRequest", DESIGN, """
List and draw the kinematic chains of so many links.
Number synthesis: inversions with the class of each, and types with sliders."""),
    "joint": Command("lectures.drawing.mobility:JointRequest", DESIGN, """
Print the class of a joint from how its two links touch.
A lower or a higher pair, and its freedoms by name."""),
    "mobility": Command("lectures.drawing.mobility:MobilityRequest", DESIGN, """
Count the motions of a planar or spatial scheme.
Passive constraints and idle freedoms by name, from the rank of its equations."""),
    "cam": Command("lectures.cams.cam_request:CamRequest", DESIGN, """
Design a cam from its task: profile, checks, drawings, scene.
The profile as DXF, SVG and CSV; pressure angle, curvature, contact force, the speed at which the
follower leaves. Exit code 1: the cam exceeds a limit of its task."""),
    "gears": Command("lectures.machine.gears:GearsRequest", DESIGN, """
Print ratios, speeds, torques and teeth of a gear train.
Tooth forces for given loads, efficiency with the losses of its teeth, circles and contact ratio,
and how many equal planets fit."""),
    "engines": Command("requests.engines:EnginesRequest", COMPARE, """
List engines: versions, profiles, how to install them."""),
    "engines check": Command("requests.engines:EngineCheckRequest", COMPARE, """
Check an engine against the contract of engines.
It prints how to repair what breaks a clause. The exit code is 0 if the engine holds every clause,
else 1."""),
    "recipe forces": Command("requests.export:ForceRecipeRequest", OWN, """
Print a program that reads reactions and the driving torque.
The program needs only the engine, and prints them over a turn as lines of numbers with commas."""),
}
# fmt: on
