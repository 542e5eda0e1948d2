#!/usr/bin/python3
"""What a set can tell of its truth at most: log-likelihood of the truth over that of none, everything else as declared.

    reach.py --seed 41 [--kinds A B] [--numbers 0 2]

Readings are linear in what is unknown of shots and holes; their covariance is noise and unknowns together. With m the
shift of all readings that the undeclared effect makes, the truth is worth m' S^-1 m / 2 in the mean over all noise.
"""

import argparse
import copy
import zlib

import numpy as np

import flights
import generate

DEG, RPM = generate.DEG, generate.RPM


def readings(s, nature, moved=None, by=0.0):
    """[flight, channel] of a session with one unknown of all its shots moved, no ball of its own, no noise."""
    q = {"speed": s.speed, "up": s.up, "azimuth": s.azimuth, "spin": s.spin, "tilt": s.tilt + nature.axis, "along": s.along,
         "right": s.right, "drag": np.zeros(s.n), "lift": np.zeros(s.n)}
    if moved:
        q[moved] = q[moved] + by
    v = q["speed"][:, None] * np.stack([np.cos(q["up"]) * np.cos(q["azimuth"]), -np.cos(q["up"]) * np.sin(q["azimuth"]),
                                        np.sin(q["up"])], 1)
    w = q["spin"][:, None] * np.stack([np.zeros(s.n), -np.cos(q["tilt"]), -np.sin(q["tilt"])], 1)
    ends, points = flights.fly(v, w, q["along"], q["right"], q["drag"], q["lift"], nature, generate.INSTANTS)
    return np.concatenate([ends[:, :1], points.reshape(s.n, -1)], 1) if s.by_path else ends


def reach(s):
    launch, flight = generate.LAUNCH, list(generate.FLIGHT.values())
    noise = np.array([flight[0]] + [generate.POSITION] * (3 * len(generate.INSTANTS)) if s.by_path
                     else [*flight[:4], flight[4] * DEG])
    tilt = launch["spin_axis_deg"] if s.axis_seen else 7.0
    own = {"speed": (launch["ball_speed_mps"], 0.1), "up": (launch["launch_angle_deg"] * DEG, 1e-3),
           "azimuth": (launch["azimuth_deg"] * DEG, 1e-3), "spin": (launch["spin_rate_rpm"] * RPM, 1.0),
           "tilt": (tilt * DEG, 1e-2), "drag": (s.own_drag, 1e-2), "lift": (s.own_lift, 1e-2)}
    slope = lambda name, step: (readings(s, s.nature, name, step) - readings(s, s.nature, name, -step)) / (2 * step)
    none = copy.copy(s.nature)
    for name in ("drag", "lift", "decay", "density", "along", "right", "drag_form", "lift_form", "axis"):
        setattr(none, name, 0.0)
    shift = readings(s, s.nature) - readings(s, none)
    of_shot = [sd * slope(name, step) for name, (sd, step) in own.items() if sd]
    of_hole = [s.wind * slope(name, 0.1) for name in ("along", "right")]
    worth = 0.0
    for hole in np.unique(s.hole):
        rows = np.flatnonzero(s.hole == hole)
        take = lambda of: of[rows].ravel()
        seen = np.isfinite(take(shift)) & np.all([np.isfinite(take(j)) for j in of_shot + of_hole], 0)
        same = np.repeat(rows, shift.shape[1])
        S = np.diag(np.tile(noise**2, len(rows)))
        for j in of_shot:
            S += np.outer(take(j), take(j)) * (same[:, None] == same)
        for j in of_hole:
            S += np.outer(take(j), take(j))
        m = take(shift)[seen]
        worth += 0.5 * m @ np.linalg.solve(S[np.ix_(seen, seen)], m)
    return worth


def main():
    p = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    p.add_argument("--seed", type=int, required=True)
    p.add_argument("--kinds", nargs="*", default=[k for k in generate.KINDS if k != "noise"], choices=list(generate.KINDS))
    p.add_argument("--numbers", nargs="*", type=int)
    a = p.parse_args()
    for kind in a.kinds:
        change, _, count = generate.KINDS[kind]
        for number in a.numbers or range(count):
            rng = np.random.default_rng([a.seed, zlib.crc32(kind.encode()), number])
            s = generate.Session(rng, number, kind)
            change(s.nature, rng)
            print(f"{kind}-{number}: {reach(s):.1f}", flush=True)


if __name__ == "__main__":
    main()
