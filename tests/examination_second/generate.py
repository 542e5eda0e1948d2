#!/usr/bin/python3
"""Writes sets of shots with a known truth: SETS/<kind>-<number>/{case.toml,shots.csv}, and TRUTH/<kind>-<number>.json.

    generate.py --seed 1 --sets out/sets --truth out/truth [--more] [--kinds A B] [--numbers 0 1] [--exact]
"""

import argparse
import csv
import json
import pathlib
import zlib

import numpy as np

import physics
from kinds import DEG, KINDS, RPM
from more_kinds import MORE

UNITS = {"mps": 1, "kmh": 1 / 3.6, "mph": 0.44704, "deg": DEG, "mm": 1e-3, "rpm": RPM}
DECIMALS = {"mps": 2, "kmh": 1, "mph": 1, "deg": 2, "mm": 1, "rpm": 0}
SHOTS = (400, 120, 64, 230, 90, 160, 40, 300, 75, 200)  # by number, turned by each kind's name
# One standard deviation of a usual instrument; each set has its own multiple.
NOISE = {"ball_speed": 0.25, "launch_angle": 0.22 * DEG, "azimuth": 0.28 * DEG, "backspin": 65 * RPM, "sidespin": 55 * RPM,
         "spin_rate": 65 * RPM, "spin_axis": 0.9 * DEG}
INPUT_NOISE = {"club_speed": 0.2, "attack_angle": 0.25 * DEG, "dynamic_loft": 0.25 * DEG, "club_path": 0.3 * DEG,
               "face_angle": 0.25 * DEG, "impact_toe": 0.001, "impact_high": 0.001}


class Session:
    """A set in the making. A kind changes

    - the blow: `law`, `head`, `struck` (the ball), `turning` (of the head, face frame), `delivered` (what the ball met);
    - the record: `turned` (the monitor about the vertical: the ball appears further to the right), `seen` (functions on a table of
      values in SI), `scatter` (of standard normal deviates);
    - the file: `columns`, `holes`, `steps`, `declare`.
    """

    def __init__(self, rng, number, name, kind):
        self.rng, self.number = rng, number
        order = zlib.crc32(name.encode()) % 10
        self.n = n = SHOTS[(number + order) % 10]
        club = kind.clubs[number % len(kind.clubs)]
        bag = rng.random() < 0.3 if kind.bag is None else kind.bag
        self.bag = bag and club != "driver"
        self.clusters = rng.random() < 0.5
        self.players = rng.integers(0, 4, n)
        self.head = self.declared = self.draw_head(club)
        names, speed, attack, loft = {"driver": (["1W"], [46.0], [1.5], [13.0]),
                                      "irons": (["5i", "7i", "9i"], [38.0, 36.0, 34.0], [-2.5, -3.5, -4.5], [20, 25.5, 33]),
                                      "wedge": (["PW", "52", "58"], [33.0, 31.0, 29.0], [-4.0, -4.5, -5.0], [36.0, 41, 47])}[club]
        which = rng.integers(0, len(names), n) if self.bag else np.full(n, rng.integers(len(names)))
        self.club = np.array(names)[which]
        habit = rng.normal(0, 1, (4, 3))[self.players] * (0.8 if self.clusters else 0)
        skill = rng.uniform(0.7, 1.5)  # large: a beginner, whose blows spread
        around = lambda centre, sd: centre + skill * rng.normal(0, sd, n)
        self.x = {"club_speed": around(np.array(speed)[which], 1.7) + 1.5 * habit[:, 0],
                  "attack_angle": around(np.array(attack)[which], 1.1) * DEG,
                  "dynamic_loft": (around(np.array(loft, float)[which], 1.6) + habit[:, 1]) * DEG,
                  "club_path": (around(0, 2.0) + habit[:, 2]) * DEG,
                  "face_angle": around(0, 1.7) * DEG, "impact_toe": around(rng.normal(0, 0.002), 0.0095),
                  "impact_high": around(0, 0.006)}
        self.ball = self.struck = physics.Ball(round(rng.uniform(0.0452, 0.04593), 5), round(rng.uniform(0.02134, 0.02145), 6))
        self.delivered, self.law, self.turning, self.turned = dict(self.x), {}, None, 0.0
        self.channels = ["ball_speed", "launch_angle", "azimuth"]
        self.channels += ["spin_rate", "spin_axis"] if rng.random() < 0.3 and not kind.cartesian else ["backspin", "sidespin"]
        self.noise = {k: NOISE[k] * f for k, f in zip(self.channels, rng.uniform(0.6, 1.6) * rng.uniform(0.8, 1.25, 5))}
        self.input_noise = {k: v * rng.uniform(0.5, 1.4) for k, v in INPUT_NOISE.items()}
        self.declare = rng.random() < 0.85
        self.seen, self.scatter, self.columns, self.holes, self.steps = [], lambda z: z, {}, {}, {}
        if kind.family == 5:  # the kinds of noise say themselves what is declared
            self.declare = True

    def draw_head(self, club):
        r = self.rng
        if club == "driver":
            product = r.normal(0, 8e-6, 3)
            off = np.array([[0, product[0], product[1]], [product[0], 0, product[2]], [product[1], product[2], 0]])
            return physics.Head(round(r.uniform(0.193, 0.208), 4),
                                np.round([r.uniform(-0.041, -0.033), r.normal(0, 0.001), r.uniform(0, 0.005)], 4),
                                np.round(np.diag(r.uniform(0.9, 1.1, 3) * [3.1e-4, 3.0e-4, 4.9e-4]) + off, 8),
                                round(r.uniform(0.26, 0.34), 3), round(r.uniform(0.24, 0.34), 3))
        mass, depth = (r.uniform(0.245, 0.275), -0.010) if club == "irons" else (r.uniform(0.285, 0.305), -0.006)
        return physics.Head(round(mass, 4), np.round([depth, r.normal(0.001, 0.001), r.normal(0.001, 0.001)], 4),
                            np.round(np.diag(r.uniform(0.9, 1.1, 3) * [3.0e-4, 1.05e-4, 2.6e-4]), 8))

    def size(self, small, large):
        """Between the two, even in the logarithm."""
        return float(np.exp(self.rng.uniform(np.log(small), np.log(large))))

    def either(self, value):
        return value * self.rng.choice([-1, 1])

    def outputs(self):
        c = physics.Contact(self.delivered, self.head, self.struck, self.turning)
        q = physics.strike(c, **self.law)[0]
        frame = physics.turn(np.zeros(self.n), np.full(self.n, self.turned)) @ c.frame
        return physics.readings(*(np.einsum("nij,nj->ni", frame, q[:, k : k + 3]) for k in (0, 3)))

    def tables(self):
        """The table without noise, and the one with it; `seen` acts on both."""
        exact = {**{k: v.copy() for k, v in self.x.items()}, **self.outputs()}
        deviations = {**self.noise, **self.input_noise}
        z = self.scatter({k: self.rng.normal(0, 1, self.n) for k in deviations})
        noisy = {k: exact[k] + sd * z[k] for k, sd in deviations.items()}
        for change in self.seen:
            change(exact)
            change(noisy)
        return exact, noisy

    def signal(self, exact):
        """Length of the exact residual of the base, in noise units of outputs and, to first order, of inputs, over the whole set."""
        expect = lambda x: np.stack([physics.base(x, self.declared, self.ball)[k] for k in self.channels], -1)
        x = {k: exact[k] for k in physics.INPUTS}
        middle = expect(x)
        covariance = np.zeros((self.n, 5, 5)) + np.diag([self.noise[k] ** 2 for k in self.channels])
        for k, sd in self.input_noise.items():
            slope = expect({**x, k: x[k] + sd}) - middle
            covariance += slope[:, :, None] * slope[:, None, :]
        d = np.stack([exact[k] for k in self.channels], -1) - middle
        return float(np.sqrt(np.sum(d * np.linalg.solve(covariance, d[..., None])[..., 0])))


def bystanders(s):
    """Columns that have nothing to do with the blow."""
    pool = {"temperature_c": np.round(18 + 3 * np.sin(np.arange(s.n) / s.n * 3) + s.rng.normal(0, 0.4, s.n), 1),
            "tee_height_mm": np.round(s.rng.normal(30, 4, s.n)),
            "humidity_pct": np.round(50 + np.cumsum(s.rng.normal(0, 0.3, s.n)), 1),
            "comment": s.rng.choice(["", "", "good", "thin, a bit low", 'felt "dead"'], s.n),
            "ball": s.rng.choice(["sleeve 1", "sleeve 2", "sleeve 3"], s.n)}
    return {k: v for k, v in pool.items() if s.rng.random() < 0.3 and k not in s.columns}


def write(folder, truths, name, s, kind, plain_exact):
    exact, noisy = s.tables()
    if plain_exact:
        noisy = exact
    used = list(physics.INPUTS) + list(s.channels)
    speeds = s.rng.choice(["mps", "mph", "kmh"], 2)
    unit = dict.fromkeys(used, "deg") | {"club_speed": str(speeds[0]), "ball_speed": str(speeds[1]), "impact_toe": "mm", "impact_high": "mm"}
    unit |= dict.fromkeys(("backspin", "sidespin", "spin_rate"), "rpm")
    text = {"shot": np.arange(1, s.n + 1), **s.columns, **bystanders(s)}
    if s.bag:
        text["club"] = s.club
    if s.clusters:
        text["player"] = np.array(["Ann", "Ben", "Cleo", "Dov"])[s.players]
    empty = {k: s.rng.random(s.n) < s.holes.get(k, 0) for k in used}
    folder.mkdir(parents=True, exist_ok=True)
    with open(folder / "shots.csv", "w", newline="") as f:
        out = csv.writer(f, lineterminator="\n")
        out.writerow(list(text) + [f"{k}_{unit[k]}" for k in used])
        for i in range(s.n):
            row = [text[k][i] for k in text]
            for k in used:
                step, v = s.steps.get(unit[k]), noisy[k][i] / UNITS[unit[k]]
                v = round(v / step) * step if step else v
                row.append("" if empty[k][i] else f"{v:.{6 if plain_exact else DECIMALS[unit[k]]}f}")
            out.writerow(row)
    h = s.declared
    millimetres = lambda v: "inf" if np.isinf(v) else f"{v * 1e3:.1f}"
    lines = ["# A set of the second examination; its truth is kept elsewhere.", 'kind = "loop"', f'title = "{name}"', "[model]",
             'base = "rigid-eccentric"',
             "[ball]", f"mass_kg = {s.ball.mass}", f"radius_mm = {s.ball.radius * 1e3:.3f}", "inertia_factor = 0.4", "[head]",
             f"mass_kg = {h.mass}",
             f"cg_mm = {[round(float(v) * 1e3, 2) for v in h.cg]}", f"inertia_kg_m2 = {h.inertia.tolist()}",
             f"bulge_mm = {millimetres(h.bulge)}",
             f"roll_mm = {millimetres(h.roll)}", "[data]", 'shots = "shots.csv"']
    declared = lambda noise: [f"{k}_{unit[k]} = {sd / UNITS[unit[k]]:.5g}" for k, sd in noise.items()]
    lines += ["[data.noise]", *declared(s.noise)] if s.declare and not plain_exact else []
    lines += ["[data.input_noise]", *declared(s.input_noise)] if not plain_exact else []  # none: inputs are exact
    lines += ["[split]", "seed = 1"]
    (folder / "case.toml").write_text("\n".join(lines) + "\n")
    truth = {"kind": name.rsplit("-", 1)[0],
             **{k: getattr(kind, k) for k in ("family", "listed", "names", "kin", "guilty", "place", "acceptable", "about")},
             "total": round(s.signal(exact), 2), "shots": s.n, "bag": bool(s.bag), "clusters": s.clusters, "declared": s.declare}
    truths.mkdir(parents=True, exist_ok=True)
    (truths / f"{name}.json").write_text(json.dumps(truth, indent=1) + "\n")


def make(seed, name, number):
    kind = (KINDS | MORE)[name]
    s = Session(np.random.default_rng([seed, 2, zlib.crc32(name.encode()), number]), number, name, kind)
    kind.change(s)
    return s, kind


def main():
    p = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    p.add_argument("--seed", type=int, default=1)
    p.add_argument("--sets", type=pathlib.Path, required=True)
    p.add_argument("--truth", type=pathlib.Path, required=True)
    p.add_argument("--more", action="store_true", help="the kinds of more_kinds.py in place of those of kinds.py")
    p.add_argument("--kinds", nargs="*", help="these, of either file")
    p.add_argument("--numbers", nargs="*", type=int, default=range(10))
    p.add_argument("--exact", action="store_true", help="no noise and six decimals: to compare the base models")
    a = p.parse_args()
    for name in a.kinds or (MORE if a.more else KINDS):
        for i in a.numbers:
            write(a.sets / f"{name}-{i}", a.truth, f"{name}-{i}", *make(a.seed, name, i), a.exact)


if __name__ == "__main__":
    main()
