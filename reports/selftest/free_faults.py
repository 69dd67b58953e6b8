"""Faults of free motion: of the machine that an engine is given, in its steps, in its log."""

from dataclasses import replace
from functools import partial

import numpy as np

from analytic.kinematics import solve_driven
from models.scene import Scene
from reports.compare.free_truth import free_truth
from reports.selftest import engines, fault
from reports.selftest import free_changes as change
from reports.selftest.log_faults import late, moved, of_output, taken
from sim.engine import Energy, Run

SWING, PULSE = "fourbar-swing", "fourbar-pulse"
SPRING, PRESS, SQUEEZER = "slider-crank-spring", "press-motor", "squeezer"
FREE_RUNS: dict[str, tuple[float, int]] = {
    SWING: (4e-4, 2500),
    PULSE: (1e-3, 1500),
    SPRING: (5e-4, 2000),
    PRESS: (1e-3, 500),
    SQUEEZER: (5e-4, 400),
}
"""Step [s] and number of steps by scene: as long as the fault needs to show, and no longer."""


_STEP_S = FREE_RUNS[PULSE][0]


def _fault(
    name: str,
    what: str,
    changed: fault.SceneChange,
    size: float | None = None,
    unit: str = "",
    *,
    scene: str = SWING,
    rule: str = "CC127",
    finer: bool = False,
) -> fault.Fault:
    plant = change.in_free_scene(changed)
    return fault.Fault(
        "dynamics", name, what, rule, plant, size, unit, scenes=(scene,), finer=finer
    )


DYNAMICS = (
    _fault("mass-wrong", "a link is too heavy", change.of_coupler(change.of_more_mass),
           0.1, "of it"),
    _fault("inertia-at-pin", "inertia about a pin, not the centre",
           change.of_coupler(change.about_pin), 1.0, "m d^2"),
    _fault("centre-moved", "a centre of mass is elsewhere", change.of_coupler(change.off_centre),
           0.1, "of it"),
    _fault("gravity-scaled", "gravity is too strong", change.stronger_gravity, 1e-3, "of it"),
    _fault("gravity-hardly", "the same, within this step's limit", change.stronger_gravity,
           1e-4, "of it", rule="CC110", finer=True),
    _fault("gravity-turned", "gravity is not straight down", change.turned_gravity, 1e-2, "rad"),
    _fault("start-faster", "the driver starts too fast", change.faster_start, 1e-2, "w",
           scene=SPRING),
    _fault("torque-late", "a torque over time acts late",
           change.of_load("pulse", change.later(_STEP_S)), 1.0, "steps", scene=PULSE),
    _fault("torque-lasts", "a torque over time ends late",
           change.of_load("pulse", change.lasting(_STEP_S)), 1.0, "steps", scene=PULSE),
    _fault("torque-reversed", "a torque turns the other way",
           change.of_load("pulse", change.reversed_load), scene=PULSE),
    _fault("torque-elsewhere", "a torque acts on another link",
           change.of_load("pulse", change.on_last_link), scene=PULSE),
    _fault("motor-held", "a motor keeps its first torque",
           change.of_load("motor", change.held_at_start), scene=PRESS),
    _fault("table-in-lines", "a table read along straight lines",
           change.of_load("work", change.along_lines), scene=PRESS),
    _fault("flywheel-lost", "the flywheel is forgotten", change.without_flywheel, 0.9, "of it",
           scene=PRESS),
    _fault("spring-stiff", "a spring is too stiff",
           change.of_spring(lambda x, share, _: replace(x, rate=(1.0 + share) * x.rate)),
           0.1, "of it", scene=SPRING),
    _fault("spring-reversed", "a spring pushes where it should pull",
           change.of_spring(lambda x, swap, _: replace(x, rate=(1.0 - 2.0 * swap) * x.rate)),
           scene=SPRING),
    _fault("spring-long", "a spring is slack elsewhere",
           change.of_spring(lambda x, _, off_m: replace(x, free=x.free + off_m)), 0.1, "L",
           scene=SPRING),
    _fault("spring-elsewhere", "a spring pulls at another point", change.spring_elsewhere,
           1e-2, "m", scene=SQUEEZER),
    _fault("damper-lost", "a damper is forgotten",
           change.of_spring(lambda x, share, _: replace(x, damping=(1.0 - share) * x.damping)),
           1.0, "of it", scene=SPRING),
    _fault("damper-reversed", "a damper drives",
           change.of_spring(lambda x, swap, _: replace(x, damping=(1.0 - 2.0 * swap) * x.damping)),
           scene=SPRING, rule="CC129"),
    _fault("coupler-long", "a link is too long", change.of_coupler(change.long_by), 1e-2, "of it",
           rule="CC128"),
)  # fmt: skip


_stepping = partial(fault.Fault, "stepping", scenes=(SWING,))
STEPPING = (
    _stepping("damping-left-on", "something damps all joints", "CC129",
              engines.after_look(lambda tools: tools.damp), 0.1, "1/s"),
    _stepping("armature-left-on", "the last joint is slow to turn", "CC127",
              engines.after_look(lambda tools: tools.slow), 1.0, "of it"),
    _stepping("mass-later", "a body becomes heavier", "CC127",
              engines.after_a_third(lambda tools: tools.load), 1.0, "of it"),
    _stepping("gravity-later", "more gravity in mid-run", "CC127",
              engines.after_a_third(lambda tools: tools.pull), 1.0, "m/s^2"),
    _stepping("start-contradicts", "a link starts at a speed of its own", "CC101",
              engines.done_to(lambda tools: tools.spin), 1e-3, "rad/s",
              says=(fault.REFUSED, "turns at")),
    _stepping("explicit-euler", "explicit steps: energy grows", "CC129", engines.explicit,
              1.0, "of it"),
    _stepping("energy-fed", f"speeds made larger, {engines.TIMES} times", "CC129",
              engines.done_to(lambda tools: tools.quicken, engines.now_and_then), 1e-3, "of it"),
    _stepping("loop-slips", "a joint slips on its link in mid-run", "CC128",
              engines.after_a_third(lambda tools: tools.slip), 1e-3, "m"),
    _stepping("semi-implicit", "semi-implicit Euler for RK4", "CC127",
              fault.in_settings("semi-implicit"), needs=fault.can_set("semi-implicit")),
    _stepping("bias-left-on", "gaps closed slowly: first order", "CC129",
              fault.in_settings("first-order"), needs=fault.can_set("first-order")),
)  # fmt: skip


def _copied(scene: Scene, done: Run) -> Run:
    motion = moved(done)
    true = free_truth(scene, done.steps, done.dt_s).at(motion.time_s)
    return replace(
        done,
        motion=replace(motion, links=true.links, points=true.points, sliders=true.sliders),
        velocity_time_s=motion.time_s,
        acceleration_time_s=motion.time_s,
    )


def _in_other_assembly(scene: Scene, done: Run) -> Run:
    """Log the driver angle as it is, and all places of the other assembly there."""
    own = moved(done)
    crank = own.links[scene.driver.link]
    across = replace(scene, branch={key: -sign for key, sign in scene.branch.items()})
    still = np.zeros_like(crank.theta)
    there = solve_driven(across, crank.theta, crank.omega, still, own.time_s, bound=False)
    other = taken(own, there, links=["theta", "omega"], points=["position", "velocity"])
    return replace(done, motion=other)


def _leaking(_: Scene, done: Run, share: float) -> Run:
    """Lose energy evenly, as a share of the largest kinetic energy."""
    assert done.energy is not None
    kinetic, potential = done.energy.kinetic_j, done.energy.potential_j
    lost = share * kinetic.max() * np.linspace(0.0, 1.0, len(kinetic))
    return replace(done, energy=Energy(kinetic, potential - lost))


_record = partial(fault.Fault, "record", scenes=(SWING,))
RECORD = (
    _record("row-later", "every sample is a later one", "CC127", late, 1.0, "sample", whole=True),
    _record("rate-off", "a logged velocity is too large", "CC106",
            fault.in_log(of_output("omega", lambda omega, share: (1.0 + share) * omega)),
            0.1, "of it"),
    _record("energy-leaks", "energy that is lost evenly", "CC129", fault.in_log(_leaking),
            1e-2, "T"),
    _record("other-assembly", "the other assembly is logged", "CC101",
            fault.switched(_in_other_assembly)),
    _record("energy-missing", "no energy is in the log", "CC109",
            fault.switched(lambda _, done: replace(done, energy=None))),
    _record("free-copied", "the reference, handed back", "CC111", fault.switched(_copied),
            scenes=(SWING, SPRING)),
)  # fmt: skip
