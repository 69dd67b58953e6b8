"""Program that reads forces out of exudyn: it holds a scene, as a user would write it."""

from models.errors import EngineError
from models.motion import State
from models.scene import GROUND, Scene, laws
from sim.engine import Settings
from sim.engine.acting import EngineBodies, centres
from sim.engine.ties import hinges
from sim.exudyn import rows
from sim.exudyn.settings import BY_NEED, assignments
from sim.registry.offers import ForceRecipe, written

PROGRAM = '''"""{title}"""

import exudyn as exu
import exudyn.itemInterface as items
import numpy as np

SPEED, DT, STEPS = {speed!r}, {dt!r}, {steps}  # rad/s, s, a turn of the driver
GRAVITY = {gravity!r}
# mass, inertia about the centre of mass, its place and the angle, and the rates of both
BODIES = {bodies}
# point, the two bodies, and where it is on each, from their centres of mass
PINS = {pins}
# what slides and where on it, its guide and a place on the line, their directions, whether it turns
LINES = {lines}

container = exu.SystemContainer()
mbs = container.AddSystem()
ground = mbs.AddObject(items.ObjectGround())
body, node = {{"{ground}": ground}}, {{}}
for name, (mass, inertia, place, rates) in BODIES.items():
    # A node's coordinates count from its reference, so the angle of the sensor below does too.
    node[name] = mbs.AddNode(
        items.NodeRigidBody2D(referenceCoordinates=place, initialVelocities=rates)
    )
    body[name] = mbs.AddObject(
        items.ObjectRigidBody2D(mass=mass, inertia=inertia, nodeNumber=node[name])
    )
    weight = mbs.AddMarker(items.MarkerBodyMass(bodyNumber=body[name]))
    mbs.AddLoad(items.LoadMassProportional(markerNumber=weight, loadVector=GRAVITY))


def marker(name, place):
    return mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=body[name], localPosition=[*place, 0]))


# The force of a hinge is its multiplier, in the ground's frame: what the hinge exerts on the body
# of its FIRST marker; on that of its second it is the opposite.
forces = []
for point, first, at_first, second, at_second in PINS:
    hinge = mbs.AddObject(
        items.ObjectJointRevolute2D(
            markerNumbers=[marker(first, at_first), marker(second, at_second)]
        )
    )
    forces.append(
        mbs.AddSensor(
            items.SensorObject(
                objectNumber=hinge,
                outputVariableType=exu.OutputVariableType.Force,
                storeInternal=True,
                writeToFile=False,
            )
        )
    )
for rider, tip, guide, through, axis, normal, keeps_angle in LINES:
    mbs.AddObject(
        items.ObjectJointPrismatic2D(
            markerNumbers=[marker(rider, tip), marker(guide, through)],
            axisMarker0=axis,
            normalMarker1=normal,
            constrainRotation=keeps_angle,
        )
    )
# The drive prescribes the speed of the driver's angle; its force is the torque with which it holds
# against that: the torque on the driver is the opposite.
still = mbs.AddMarker(
    items.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(items.NodePointGround()), coordinate=0)
)
angle = mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node[{driver!r}], coordinate=2))
drive = mbs.AddObject(
    items.ObjectConnectorCoordinate(
        markerNumbers=[still, angle], velocityLevel=True, offset=SPEED
    )
)
torque = mbs.AddSensor(
    items.SensorObject(
        objectNumber=drive,
        outputVariableType=exu.OutputVariableType.Force,
        storeInternal=True,
        writeToFile=False,
    )
)
mbs.Assemble()

simulationSettings = exu.SimulationSettings()
simulationSettings.solution.file.write = False
simulationSettings.solution.sensors.writePeriod = 0.0  # sensors keep every step, not one in 10 ms
stepping = simulationSettings.timeIntegration
stepping.numberOfSteps, stepping.endTime = STEPS, STEPS * DT
{settings}
mbs.SolveDynamic(simulationSettings, solverType=exu.DynamicSolverType.{integrator})

# Sensors hold time and three components, the start among them; all of it acts at these times.
at_pins = [mbs.GetSensorStoredData(sensor) for sensor in forces]
driving = mbs.GetSensorStoredData(torque)
# Places are exact after the first step, forces are not: what a start shakes shows in them for a
# few steps (more of them where spectralRadius is near 1). Leave these out, or halve the step.
columns = [f"{{point}}.{{name}}.{{x}}" for point, _, _, name, _ in PINS for x in ("x_n", "y_n")]
print("time_s", *columns, "torque_n_m", sep=",")
for k, (time_s, against) in enumerate(driving[:, :2]):
    on_second = [-component for each in at_pins for component in each[k, 1:3]]
    print(*map(repr, map(float, (time_s, *on_second, -against))), sep=",")
'''


def exudyn_force_recipe(scene: Scene, state: State, settings: Settings, dt_s: float) -> str:
    """Write it for scenes without loads, springs, friction, at constant speed. See
    `ForceRecipe`."""
    law = scene.driver.law
    lacking = {
        "loads": scene.loads,
        "a driver that is no crank": not scene.driver.is_crank,
        "springs": scene.springs,
        "friction": scene.friction,
        "a driver whose speed changes": not isinstance(law, laws.ConstantSpeed),
    }
    words = [what for what, there in lacking.items() if there]
    if words or not isinstance(law, laws.ConstantSpeed):
        raise EngineError(
            f"{scene.name}: the recipe of exudyn does not cover {' and '.join(words)}; remove "
            "that, or use another scene"
        )
    placed = EngineBodies(scene, state, centre=centres(scene))
    pins = ((h.point, *a, *b) for h in hinges(scene, GROUND) for a, b in [placed.hinge_ends(h)])
    return PROGRAM.format(
        title=f"Reactions in the pins, and driving torque, of {scene.name} in exudyn.",
        speed=law.speed_rad_s,
        dt=dt_s,
        steps=round(law.period_s / dt_s),
        gravity=[*scene.gravity_m_s2, 0.0],
        bodies=written(rows.body_rows(scene, state)),
        pins=written(pins),
        lines=written(rows.line_rows(placed).values()),
        ground=GROUND,
        driver=scene.driver.link,
        settings="\n".join(_settings(settings)),
        integrator=settings["integrator"],
    )


def _settings(settings: Settings) -> list[str]:
    own = assignments(settings)
    # Joints and drive determine all coordinates of these scenes.
    own["newton.residualMode"] = int(settings["residual"] != "forces")
    if settings["integrator"] != "GeneralizedAlpha":
        del own["generalizedAlpha.spectralRadius"]
    linear = settings["linear_solver"]
    redundant = linear == BY_NEED or settings["ignore_singular"] == "enable"
    solver = "EigenDense" if linear == BY_NEED else linear
    return [
        *(f"stepping.{path} = {value!r}" for path, value in own.items()),
        f"simulationSettings.linearSolver.solverType = exu.LinearSolverType.{solver}",
        f"simulationSettings.linearSolver.ignoreSingularJacobian = {redundant}",
    ]


FORCE_RECIPE: ForceRecipe = exudyn_force_recipe
