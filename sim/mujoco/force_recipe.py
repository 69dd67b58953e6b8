"""Program that reads reactions and the driving torque out of MuJoCo."""

from collections.abc import Iterable

from models.errors import EngineError
from models.mjcf.document import build
from models.mjcf.forces import planned
from models.mjcf.tree import driven_freedom
from models.motion import State
from models.scene import Scene, characteristics, joints, laws
from sim.engine import Settings
from sim.mujoco.settings import writing
from sim.registry.offers import ForceRecipe, written

PROGRAM = '''"""Reactions and driving torque of {scene} in MuJoCo, over one turn of {driver}."""

import mujoco
import numpy as np

MODEL = """\\
{model}"""

model = mujoco.MjModel.from_xml_string(MODEL)
data = mujoco.MjData(model)
mujoco.mj_resetDataKeyframe(model, data, 0)  # assembled, with the speeds that go together

# Pins that close a loop: the equality, and the sign of its force on the body named. A connect
# pushes its first body by +force and its second by -force.
LOOPS = {loops}
# Pins of the tree: the body that hangs there, and the sign for the body named.
HINGES = {hinges}
crank = model.joint({joint!r}).dofadr[0]


def loop_force(equality):
    """Of a connect [N], along x and y of the world."""
    # efc_force holds three rows for each active connect, x, y and z; efc_id says of which equality.
    # Equalities come first, so that the rows of one stand together among the first ne.
    rows = np.flatnonzero(data.efc_id[: data.ne] == model.equality(equality).id)
    return data.efc_force[rows[:2]]


print(",".join(["time_s", *(f"{{pin}}.{{axis}}_n" for pin in (*LOOPS, *HINGES) for axis in "xy"),
                "torque_n_m"]))
inertial = np.zeros(model.nv)
for step in range({steps}):
    # After mj_step the accelerations and forces in data still are those of the state before it,
    # under RK4 of its last stage. mj_forward computes them at the state that data holds now.
    mujoco.mj_forward(model, data)
    # cfrc_int, what each body is given by its parent, is filled by this call alone. Its rows are
    # moment and force, in the world's axes, about the centre of mass of the whole tree: the force
    # is that at the pin, the moment is not.
    mujoco.mj_rnePostConstraint(model, data)
    # What the bodies take of the crank's hinge for their acceleration, velocity and weight. The
    # armature that keeps the speed is no part of it, as qfrc_actuator or M qacc would have it.
    mujoco.mj_rne(model, data, 1, inertial)
    # Loops, friction, loads and springs do their share; the drive does the rest.
    torque = inertial[crank] - data.qfrc_constraint[crank] - data.qfrc_actuator[crank]
    torque -= data.qfrc_passive[crank]
    forces = [sign * loop_force(name) for name, sign in LOOPS.values()]
    forces += [sign * data.cfrc_int[model.body(name).id, 3:5] for name, sign in HINGES.values()]
    # The clock adds up steps, and rounding; number times step does not.
    row = [{start!r} + step * model.opt.timestep, *np.ravel(forces), torque]
    print(",".join(f"{{number:.12g}}" for number in row))
    mujoco.mj_step(model, data)
'''


def write_recipe(scene: Scene, state: State, settings: Settings, dt_s: float) -> str:
    """Write the recipe for pins of two bodies; without loads and springs, which ``cfrc_int`` may
    count as joint forces, for the tree's too. Refuse drives and loads that a file does not hold."""
    _check_held(scene)
    chosen = writing(scene, settings, dt_s, "prescribed")
    tree = planned(scene, state, chosen.close, delay_s=chosen.delay_s)
    names = {one: f"{one.point}: {' to '.join(one.bodies)}" for one in tree.closures}
    loops = _signed(scene, ((one.point, one.bodies[0], name) for one, name in names.items()))
    if not loops:
        raise EngineError(
            f"{scene.name}: no loop closes at a pin of two bodies, whose reaction this recipe "
            "reads; take another scene, or close it elsewhere (setting close)"
        )
    limbs = () if scene.loads or scene.springs else tree.limbs
    hinges = _signed(scene, ((e.point, e.body, e.body) for e in limbs if e.slider is None))
    return PROGRAM.format(
        scene=scene.name,
        driver=scene.driver.link,
        model=build(scene, state, chosen, tree).replace("\\", "\\\\").replace('"""', '\\"""'),
        loops=written(loops),
        hinges=written(hinges),
        joint=driven_freedom(scene, tree.limbs)[0],
        steps=round(scene.driver.law.period_s / dt_s) + 1,
        start=state.time_s,
    )


def _check_held(scene: Scene) -> None:
    """Refuse free motion, and loads and laws that need a control at each step."""
    varying = ["driver"] * (not isinstance(scene.driver.law, laws.ConstantSpeed))
    varying += [
        f"loads.{load.name}"
        for load in scene.loads.values()
        if not isinstance(load.characteristic, characteristics.Constant) or load.stroke != "both"
    ]
    faults = {
        "nothing drives it, and the recipe reads the torque of a drive; use a scene of constant "
        "speed": scene.is_free,
        f"its driver is {scene.driver.joint}, and the recipe reads the torque of a crank; take a "
        "scene whose driver is a link at the ground": not scene.driver.is_crank,
        f"{', '.join(varying)} comes as a control of each step, which the recipe leaves out; take "
        "a scene of constant speed and constant loads": bool(varying),
    }
    for fault in (text for text, there in faults.items() if there):
        raise EngineError(f"{scene.name}: {fault}")


def _signed(scene: Scene, ties: Iterable[tuple[str, str, str]]) -> dict[str, tuple[str, int]]:
    """Return names and signs of the ties (point, pushed body, name) at pins of two bodies, by pin
    and its second body."""
    pins = joints.joined_at(scene)
    return {
        f"{point}.{pins[point][1]}": (name, 1 if body == pins[point][1] else -1)
        for point, body, name in ties
        if len(pins[point]) == 2
    }


FORCE_RECIPE: ForceRecipe = write_recipe
