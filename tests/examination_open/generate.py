#!/usr/bin/python3
"""Writes sets of shots with a known truth: SETS/<kind>-<number>/{case.toml,shots.csv}, and TRUTH/<kind>-<number>.json.

    generate.py --seed 1 --sets out/sets --truth out/truth [--kinds A B] [--numbers 0 1]

Each kind of kinds.py is a function that changes a Session. What is right and what is acceptable stands beside it, and was
written before any verdict was seen.
"""

import argparse
import csv
import json
import pathlib
import zlib

import numpy as np

import physics
from kinds import KINDS

DEG = np.pi / 180
# One standard deviation of the instruments, SI and radians.
NOISE = {"ball_speed": 0.3, "launch_angle": 0.25 * DEG, "azimuth": 0.3 * DEG, "backspin": 70 * np.pi / 30, "sidespin": 70 * np.pi / 30}
INPUT_NOISE = {"club_speed": 0.25, "attack_angle": 0.3 * DEG, "dynamic_loft": 0.3 * DEG, "club_path": 0.3 * DEG,
               "face_angle": 0.3 * DEG, "impact_toe": 0.0012, "impact_high": 0.0012}
UNITS = {"mps": 1, "kmh": 1 / 3.6, "mph": 0.44704, "deg": DEG, "mm": 1e-3, "rpm": np.pi / 30}
DECIMALS = {"mps": 2, "kmh": 1, "mph": 1, "deg": 1, "mm": 1, "rpm": 0}


class Session:
    """A set in the making. A kind changes `law` and `omega` (the blow), `head` (the true one), `delivered` (what the
    ball met, where the record is of something else), `seen` (changes of the table of exact values, in SI) and `scatter`."""

    def __init__(self, rng, number, planar=False, irons=False):
        self.rng, self.number, self.planar = rng, number, planar
        self.n = n = (60, 150, 300)[number % 3]
        self.bag, self.clusters = number % 2 == 1, number // 4 % 2 == 0
        self.players = rng.integers(0, 4, n) if self.clusters else np.zeros(n, int)
        self.sessions = np.arange(n) * 3 // n
        iron = rng.random() < 0.5 or self.bag or irons
        if iron:
            head = physics.Head(0.262, [-0.012, 0.002, 0.002], np.diag([2.9e-4, 1.0e-4, 2.8e-4]))
        else:
            head = physics.Head(0.202, [-0.036, 0.0, 0.003], np.diag([2.7e-4, 2.9e-4, 4.7e-4]), 0.3, 0.3)
        club = rng.integers(0, 4, n) if self.bag else np.full(n, 2 if iron else 4)
        self.club = np.array(["4i", "6i", "8i", "PW", "D"])[club]
        draw = lambda centre, sd: rng.normal(0, sd, n) + centre
        skill = rng.normal(0, 1, (4, 3))[self.players]
        self.x = {
            "club_speed": draw(np.array([39.0, 37.5, 36.0, 34.5, 45.0])[club], 1.6) + 1.5 * skill[:, 0],
            "attack_angle": draw(np.array([-2.0, -3.0, -4.0, -4.5, 1.0])[club], 1.2) * DEG,
            "dynamic_loft": (draw(np.array([17.0, 22.0, 28.0, 35.0, 14.0])[club], 2.0) + skill[:, 1]) * DEG,
            "club_path": (draw(0, 2.0) + skill[:, 2]) * DEG, "face_angle": draw(0, 1.8) * DEG,
            "impact_toe": draw(0, 0.010), "impact_high": draw(0, 0.007)}
        if planar:  # blows in the plane of the loft, of a head that does not turn
            head = physics.planar(head)
            self.x["club_path"], self.x["face_angle"] = np.zeros(n), np.zeros(n)
        self.head, self.declared = head, head
        self.law = {"e": physics.base_restitution, "et": lambda b: 0.0, "mu": lambda b: np.inf}
        self.omega, self.delivered, self.columns = None, dict(self.x), {}
        self.seen, self.scatter, self.declare, self.rounding = [], None, True, {}
        self.names, self.place, self.guilty = [], [], []

    def size(self, small, large):
        """Numbers 0, 1, 4, 5, 8, 9 large, the others small, each within 20 %."""
        return (large if self.number // 2 % 2 == 0 else small) * 10 ** self.rng.uniform(-0.08, 0.08)

    def base(self, x):
        return physics.base(x, self.declared)

    def outputs(self):
        b = physics.Blow(self.delivered, self.head, self.omega)
        return physics.launch(b, physics.rigid(b, *(np.asarray(self.law[k](b), float) for k in ("e", "et", "mu"))))

    def signal(self, table):
        """Departure of exact values from the base model, in noise units over the whole set and for each channel."""
        x = {k: table[k] for k in physics.INPUTS}
        expected, outputs = self.base(x), np.stack([table[k] for k in self.channels], -1)
        cov = np.diag([NOISE[k] ** 2 for k in self.channels]) + np.zeros((self.n, 1, 1))
        for k in physics.INPUTS:
            h = INPUT_NOISE[k] * 0.1
            moved = self.base({**x, k: x[k] + h})
            slope = np.stack([(moved[c] - expected[c]) / h for c in self.channels], -1) * INPUT_NOISE[k]
            cov = cov + slope[:, :, None] * slope[:, None, :]
        d = outputs - np.stack([expected[c] for c in self.channels], -1)
        good = np.isfinite(d).all(-1)
        return float(np.sqrt(np.sum(d[good] * np.linalg.solve(cov[good], d[good][..., None])[..., 0])))

    @property
    def channels(self):
        return ["ball_speed", "launch_angle", "backspin"] if self.planar else physics.CHANNELS

    def table(self):
        """Exact table, then the recorded one: noise of both kinds, what the instrument does, rounding."""
        exact = {**{k: v.copy() for k, v in self.x.items()}, **self.outputs()}
        if self.planar:
            exact["azimuth"], exact["sidespin"] = np.zeros(self.n), np.zeros(self.n)
        noisy = {k: v.copy() for k, v in exact.items()}
        scatter = self.scatter or (lambda k, n: self.rng.normal(0, 1, n))
        for k, sd in {**NOISE, **INPUT_NOISE}.items():
            noisy[k] = noisy[k] + sd * scatter(k, self.n)
        state = self.rng.bit_generator.state
        for change in self.seen:
            self.rng.bit_generator.state = state
            change(exact)
            self.rng.bit_generator.state = state
            change(noisy)
        return exact, noisy


def number(v, decimals):
    return "" if not np.isfinite(v) else f"{v:.{decimals}f}"


def write(folder, truths, name, s, kind):
    exact, noisy = s.table()
    speed = "mph" if s.rng.random() < 0.5 else "mps"
    unit = {k: speed if "speed" in k else "mm" if "impact" in k else "rpm" if "spin" in k else "deg" for k in noisy}
    folder.mkdir(parents=True, exist_ok=True)
    inputs = [k for k in physics.INPUTS if not (s.planar and k in ("club_path", "face_angle"))]
    used = inputs + list(s.channels)
    text = {"shot": np.arange(1, s.n + 1)}
    if s.bag:
        text["club"] = s.club
    if s.clusters:
        text["player"], text["session"] = s.players + 1, s.sessions + 1
    text.update(s.columns)
    with open(folder / "shots.csv", "w", newline="") as f:
        out = csv.writer(f, lineterminator="\n")
        out.writerow(list(text) + [f"{k}_{unit[k]}" for k in used])
        for i in range(s.n):
            row = [text[k][i] for k in text]
            for k in used:
                step = s.rounding.get(k)
                v = noisy[k][i] / UNITS[unit[k]]
                v = np.round(v / step) * step if step else v
                row.append(number(v, DECIMALS[unit[k]]))
            out.writerow(row)
    h = s.declared
    lines = ["# A set of the open examination; its truth is kept elsewhere.", 'kind  = "loop"', f'title = "{name}"', "", "[model]",
             f'base = "{"rigid-planar" if s.planar else "rigid-eccentric"}"', "", "[ball]", f"mass_kg = {physics.MASS}",
             f"radius_mm = {physics.RADIUS * 1e3:.3f}", f"inertia_factor = {physics.FACTOR}", "", "[head]", f"mass_kg = {h.mass}"]
    if not s.planar:
        lines += [f"cg_mm = {[round(float(v) * 1e3, 3) for v in h.cg]}", f"inertia_kg_m2 = {h.inertia.tolist()}",
                  f"bulge_mm = {h.bulge * 1e3}", f"roll_mm = {h.roll * 1e3}"]
    else:  # declared, and not used by that base
        lines += ["cg_mm = [-36.0, 0.0, 3.0]", "inertia_kg_m2 = [[2.7e-4, 0, 0], [0, 2.9e-4, 0], [0, 0, 4.7e-4]]"]
    lines += ["", "[data]", 'shots = "shots.csv"']
    if s.declare:
        sigma = lambda k, sd: f"{k}_{unit[k]} = {sd / UNITS[unit[k]]:.6g}"
        lines += ["[data.noise]", *(sigma(k, NOISE[k]) for k in s.channels)]
        lines += ["[data.input_noise]", *(sigma(k, INPUT_NOISE[k]) for k in inputs)]
    lines += ["", "[split]", "seed = 1"]
    (folder / "case.toml").write_text("\n".join(lines) + "\n")
    truth = {"kind": kind.name, "family": kind.family, "listed": kind.listed, "names": s.names, "kin": list(kind.kin),
             "guilty": s.guilty, "place": s.place, "acceptable": list(kind.acceptable), "about": kind.about,
             "total": round(s.signal(exact), 2), "shots": s.n, "bag": s.bag, "clusters": s.clusters, "declared": s.declare}
    truths.mkdir(parents=True, exist_ok=True)
    (truths / f"{name}.json").write_text(json.dumps(truth, indent=1) + "\n")


def main():
    p = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    p.add_argument("--seed", type=int, default=1)
    p.add_argument("--sets", type=pathlib.Path, required=True)
    p.add_argument("--truth", type=pathlib.Path, required=True)
    p.add_argument("--kinds", nargs="*", default=list(KINDS))
    p.add_argument("--numbers", nargs="*", type=int, default=range(10))
    a = p.parse_args()
    for name in a.kinds:
        kind = KINDS[name]
        for i in a.numbers:
            s = Session(np.random.default_rng([a.seed, zlib.crc32(name.encode()), i]), i, kind.planar, kind.irons)
            kind.change(s)
            write(a.sets / f"{name}-{i}", a.truth, f"{name}-{i}", s, kind)


if __name__ == "__main__":
    main()
