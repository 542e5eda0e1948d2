"""A ball in flight, many at once: drag, lift and loss of spin as published, Runge and Kutta's fourth order, NumPy alone.

X to the target, Y to the left, Z up; spins are vectors; SI units. The laws: Ferguson, McNally and McPhee (2022); Smits and
Smith (1994); the open-source library libgolf. The moment that takes the spin away is a coefficient times the area, the
diameter and the dynamic pressure in the first, a share of the spin for each radius of path in the others.
"""

import numpy as np

MASS, RADIUS, GRAVITY, VISCOSITY = 0.04593, 0.021335, 9.80665, 1.789e-5
AREA, INERTIA = np.pi * RADIUS**2, 0.4 * MASS * RADIUS**2
DENSITY = 1.225
ROUGHNESS, HEIGHT = 0.03, 10.0  # of the wind's profile


def ferguson(re, s):
    return 0.1304 + 0.9287 * s - 0.8259 * s**2, 0.0504 + 1.2031 * s - 1.1490 * s**2


def smits_smith(re, s):
    return 0.24 + 0.18 * s + 0.06 * np.sin(np.pi * (re - 9e4) / 2e5), 0.54 * s**0.4


def libgolf(re, s):
    ramp = np.clip((re - 5e4) / 5e4, 0, 1)
    return 0.5 - 0.3 * ramp + 0.18 * s, 0.268 * 16 * s / (1 + 16 * s)


LAWS = {"ferguson-2022": ferguson, "smits-smith-1994": smits_smith, "libgolf": libgolf}


def spin_loss(law, density, speed):
    """Relative, per second."""
    if law == "ferguson-2022":
        return 0.5 * density * AREA * 2 * RADIUS * 0.01 * RADIUS * speed / INERTIA
    return 2e-5 * speed / RADIUS


class Nature:
    """What the ball meets. Relative changes of the declared law and air, a wind beyond the groups' own, forms of drag and
    lift that the law has not: `lift_form` turns the lift about a spin ratio of 0.1, `drag_form` the drag about Re 1.4e5."""

    def __init__(self, law):
        self.law = law
        self.drag = self.lift = self.decay = self.density = self.along = self.right = 0.0
        self.drag_form = self.lift_form = 0.0


def fly(velocity, spin, along, right, own_drag, own_lift, nature, instants=(), dt=0.01):
    """(carry, side, apex, time, landing angle) of each flight, and positions at the instants [flight, instant, axis]; NaN
    where a ball has landed by then."""
    n = len(velocity)
    rate = np.linalg.norm(spin, axis=1)
    axis = spin / rate[:, None]
    density = DENSITY * (1 + nature.density)

    def slope(y):
        share = np.log1p(np.maximum(0, y[:, 2]) / ROUGHNESS) / np.log1p(HEIGHT / ROUGHNESS)
        wind = np.stack([along + nature.along, -(right + nature.right), np.zeros(n)], 1)
        u = y[:, 3:6] - share[:, None] * wind
        speed = np.linalg.norm(u, axis=1)
        re, s = 2 * RADIUS * density * speed / VISCOSITY, rate * y[:, 6] * RADIUS / speed
        cd, cl = LAWS[nature.law](re, s)
        cd = cd * (1 + nature.drag) * (1 + own_drag) * (1 + nature.drag_form * np.log(re / 1.4e5))
        cl = cl * (1 + nature.lift) * (1 + own_lift) * (1 + nature.lift_form * np.log(s / 0.1))
        k = 0.5 * density * AREA / MASS * speed
        a = k[:, None] * (cl[:, None] * np.cross(axis, u) - cd[:, None] * u)
        a[:, 2] -= GRAVITY
        loss = spin_loss(nature.law, density, speed) + nature.decay
        return np.concatenate([y[:, 3:6], a, -(loss * y[:, 6])[:, None]], 1)

    y = np.concatenate([np.zeros((n, 3)), velocity, np.ones((n, 1))], 1)
    out = np.full((n, 5), np.nan)
    points = np.full((n, len(instants), 3), np.nan)
    steps = {round(t / dt): k for k, t in enumerate(instants)}
    apex, step, flying = np.zeros(n), 0, np.ones(n, bool)
    while flying.any():
        k1 = slope(y)
        k2 = slope(y + dt / 2 * k1)
        k3 = slope(y + dt / 2 * k2)
        k4 = slope(y + dt * k3)
        new = y + dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        top = (y[:, 5] > 0) & (new[:, 5] <= 0)  # the fall of a parabola from the step's start
        apex[top] = (y[:, 2] + y[:, 5]**2 / (2 * (y[:, 5] - new[:, 5]) / dt))[top]
        for i in np.flatnonzero(flying & (new[:, 2] < 0)):
            s = y[i, 2] / (y[i, 2] - new[i, 2])
            for _ in range(20):  # height between the two by its values and slopes: Newton from the chord
                h = hermite(s, y[i], new[i], dt)[2]
                s -= h / ((hermite(s + 1e-6, y[i], new[i], dt)[2] - h) / 1e-6)
            x, v = hermite(s, y[i], new[i], dt), y[i, 3:6] + s * (new[i, 3:6] - y[i, 3:6])
            out[i] = (np.hypot(x[0], x[1]), -x[1], apex[i], (step + s) * dt, np.arctan2(-v[2], np.hypot(v[0], v[1])))
            flying[i] = False
        step += 1
        if step in steps:
            points[flying, steps[step]] = new[flying, :3]
        y = np.where(flying[:, None], new, y)
        y[~flying, 5] = 0  # they stay where they are
    return out, points


def hermite(s, a, b, dt):
    """Position between two states, s from 0 to 1."""
    return ((2 * s**3 - 3 * s**2 + 1) * a[:3] + (s**3 - 2 * s**2 + s) * dt * a[3:6] + (3 * s**2 - 2 * s**3) * b[:3]
            + (s**3 - s**2) * dt * b[3:6])
