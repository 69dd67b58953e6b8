"""A penalty method: every pin a spring and a damper, all bodies stepped explicitly.

Velocities first, then positions with them (symplectic Euler), so that velocities belong half a step
before the positions. A spring is as stiff as the step allows: pins give way as the step squared.
"""

import time

import numpy as np

import crankcheck.engine as cc

VERSION, SHIFT = "1.0", -0.5
QUARTER = np.array([[0.0, 1.0], [-1.0, 0.0]])  # an arm times this: its end's velocity at 1 rad/s
PROFILES = {
    name: cc.Profile(
        name, "penalty", summary, {"stiffness": cc.Setting(k, why), "damping": cc.Setting(c, why)}
    )
    for name, summary, k, c, why in (
        ("as-shipped", "soft springs", 0.1, 0.1, "default"),
        ("tuned", "as stiff as a step can take", 0.8, 0.3, "a six-bar is unstable at 0.8 and 0.7"),
    )
}
"""Both settings are shares of what one pin by itself could take in a step."""


def check(settings):
    """Refuse what is no share, by SettingError."""
    cc.check_ranges(settings, {"stiffness": (1e-6, 1.0), "damping": (0.0, 1.0)})


def turned(local, theta):
    """Vectors of bodies, in the plane."""
    theta = np.reshape(theta, (-1, 1))
    return np.cos(theta) * local + np.sin(theta) * local @ QUARTER


class PenaltySession:
    """Bodies row by row, the ground last: places and angles of their centres, and the rates."""

    def __init__(self, scene, state, settings, dt_s, driven_by):
        check(settings)
        if driven_by == "servo" or scene.sliders:
            raise cc.EngineError(f"penalty: it has no {'sliders' if scene.sliders else 'servo'}")
        self.scene, self.settings, self.dt, self.done = scene, dict(settings), dt_s, 0
        self.start_s, self.driven = state.time_s, driven_by == "prescribed"
        self.names, crank = cc.bodies(scene), scene.driver.link
        self.crank, self.pivot = self.names.index(crank), scene.ground[scene.driver_pivot]
        where = [cc.frames(scene, state, SHIFT * dt_s)[name] for name in (*self.names, cc.GROUND)]
        self.centre = np.array([*(cc.centre_of(scene, name) for name in self.names), (0.0, 0.0)])
        self.arm = self.centre[[self.crank]] - cc.local_point(scene, crank, scene.driver_pivot)
        self.matter = matter = np.array([cc.mass_of(scene, name) for name in self.names])
        free = np.array([name != crank or not self.driven for name in self.names])
        if light := [n for n, m, f in zip(self.names, matter, free, strict=True) if f and not m[0]]:
            raise cc.EngineError(f"{light[0]}: mass_kg 0; give it a mass")
        self.give = np.zeros((len(where), 2))  # 1 / mass, 1 / inertia
        self.give[:-1][free] = 1.0 / matter[free]
        self.gravity = np.array(scene.gravity_m_s2) * (self.give[:, :1] > 0.0)
        self.theta, self.omega = np.array([(frame.theta, frame.omega) for frame in where]).T.copy()
        self.place = np.array([f.at(c) for f, c in zip(where, self.centre, strict=True)])
        self.speed = np.array([f.velocity_at(p) for f, p in zip(where, self.place, strict=True)])
        # The two bodies of each pin, where it is on each, and what it can take in a step.
        row = {name: number for number, name in enumerate((*self.names, cc.GROUND))}
        pins = [(p.point, p.bodies[0], b) for p in cc.joints(scene).pins for b in p.bodies[1:]]
        give = np.zeros(len(pins))  # the inverse of the mass that a pin feels
        self.sides = []
        for side, sign in ((1, 1.0), (2, -1.0)):
            at = np.array([row[pin[side]] for pin in pins])
            local = np.array([cc.local_point(scene, pin[side], pin[0]) for pin in pins])
            local -= self.centre[at]
            give += self.give[at, 0] + self.give[at, 1] * (local**2).sum(axis=1)
            self.sides.append((at, local, sign))
        share = np.divide(1.0, give, out=np.zeros_like(give), where=give > 0.0)[:, None]
        self.stiffness = settings["stiffness"] * share / self.dt**2
        self.damping = settings["damping"] * share / self.dt

    def step(self, steps):
        law, last = self.scene.driver.law, self.done + steps
        for angle in cc.drive.angles(law, self.start_s, self.dt, self.done + 1, last):
            self._push()
            if self.driven:  # by rates that lead to where it has to be
                end = self.pivot + turned(self.arm, angle)[0]
                self.speed[self.crank] = (end - self.place[self.crank]) / self.dt
                self.omega[self.crank] = (angle - self.theta[self.crank]) / self.dt
            self.place += self.dt * self.speed
            self.theta += self.dt * self.omega
        self.done = last

    def _push(self):
        """The velocities after the forces of a step."""
        pull, arms = 0.0, [turned(local, self.theta[at]) for at, local, _ in self.sides]
        for (at, _, sign), arm in zip(self.sides, arms, strict=True):
            speed = self.speed[at] + self.omega[at, None] * (arm @ QUARTER)
            pull = pull - sign * (self.stiffness * (self.place[at] + arm) + self.damping * speed)
        self.speed += self.dt * self.gravity
        for (at, _, sign), arm in zip(self.sides, arms, strict=True):
            push = sign * self.dt * pull
            np.add.at(self.speed, at, self.give[at, :1] * push)
            np.add.at(self.omega, at, self.give[at, 1] * (push * (arm @ QUARTER)).sum(axis=1))

    def record(self, steps, every):
        began, rows = time.perf_counter(), [self._row()]
        for count in [every] * (steps // every):
            self.step(count)
            rows.append(self._row())
        self.step(steps % every)
        wall_s = time.perf_counter() - began
        good = np.isfinite([row.sum() for _, row in rows])
        count = len(rows) if good.all() else max(int(np.argmin(good)), 1)
        return cc.Log(self._poses(rows[:count]), (count - 1) * every, not good.all(), (), wall_s)

    def read(self):
        return self._poses([self._row()])

    def _row(self):
        return float(self.done), np.column_stack([self.place, self.speed, self.theta, self.omega])

    def _poses(self, rows):
        """Frames of the links, from their centres; velocities at the angles of their instant."""
        lag_s, poses = SHIFT * self.dt, {}
        for number, name in enumerate(self.names):
            row = np.array([state[number] for _, state in rows])
            theta, omega = row[:, 4].copy(), row[:, 5].copy()
            local = np.broadcast_to(self.centre[number], (len(rows), 2))
            then = turned(local, theta + lag_s * omega) @ QUARTER
            place, speed = row[:, :2] - turned(local, theta), row[:, 2:4] - omega[:, None] * then
            none = np.full((len(rows), 2), np.nan)  # it reports no accelerations
            poses[name] = cc.BodyPose(place, theta, speed, omega, none, none[:, 0].copy())
        return cc.Poses(self.start_s + self.dt * np.array([d for d, _ in rows]), poses, lag_s)

    def facts(self):
        return cc.Facts(
            VERSION,
            mass_kg=dict(zip(self.names, self.matter[:, 0].tolist(), strict=True)),
            inertia_kg_m2=dict(zip(self.names, self.matter[:, 1].tolist(), strict=True)),
            centre_m={n: tuple(c.tolist()) for n, c in zip(self.names, self.centre, strict=False)},
            gravity_m_s2=self.scene.gravity_m_s2,
            start=self.read(),
            settings={**self.settings, "timestep_s": self.dt},
            velocity_shift=SHIFT,
            acceleration_shift=0.0,
        )


ENGINE = cc.Engine(
    *("penalty", PROFILES, lambda: VERSION, check, PenaltySession),
    reports_accelerations=False,
    in_seconds=lambda settings: (),  # both settings are shares of what a step can take
)
