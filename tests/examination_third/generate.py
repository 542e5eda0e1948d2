#!/usr/bin/python3
"""Writes sets of shots whose truth is known: a case directory for each, and its truth for ../examination_open/grade.py.

    generate.py --seed 1 --sets DIR/sets --truth DIR/truth [--kinds a,b] [--numbers 0,1] [--exact]
"""

import argparse
import dataclasses
import json
import os
import pathlib
import zlib

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy: of small matrices, threads wait for each other
import numpy as np

import physics
from kinds import KINDS

SPEEDS = {"mps": 1.0, "mph": 1 / 0.44704, "kmh": 3.6}
# number: shots, letter of the layout, columns, size, unit of club and ball, spin as vector or rate, what of the noise is declared
LAYOUTS = [
    (120, 0, "", 1.0, "mps", "mps", "vector", "all"), (60, 1, "player", 1.0, "mph", "mph", "rate", "all"),
    (300, 2, "session", 0.6, "mph", "mph", "vector", "all"), (80, 3, "", 1.4, "kmh", "kmh", "vector", "all"),
    (200, 0, "player session", 0.6, "mph", "mps", "rate", "all"), (40, 1, "", 1.4, "mps", "kmh", "vector", "all"),
    (400, 2, "player", 0.5, "mps", "mph", "rate", "all"), (150, 3, "session", 1.0, "kmh", "mps", "vector", "inputs"),
    (250, 0, "", 0.8, "mph", "mph", "vector", "all"), (100, 1, "player session", 1.0, "mps", "mps", "rate", "outputs")]
# mean and scatter of the deliveries, m/s, deg, mm
HABITS = {"driver": ((45, 2.0), (1, 1.6), (0, 2.8), (0, 2.2), (13, 1.7), (0, 9), (1, 6)),
          "iron": ((37, 1.5), (-4, 1.5), (0, 2.5), (0, 2.0), (24, 1.9), (1, 7), (-3, 5)),
          "wedge": ((32, 2.2), (-5, 1.6), (0, 2.5), (0, 2.0), (43, 2.6), (1, 6), (-4, 5))}
BAG = [("5i", 1.08, 0.247, -7.0), ("7i", 1.0, 0.262, 0.0), ("9i", 0.93, 0.277, 8.0), ("PW", 0.89, 0.285, 13.0)]
NOISE = {"club_speed": 0.3, "attack_angle": 0.3, "club_path": 0.3, "face_angle": 0.3, "dynamic_loft": 0.3, "impact_toe": 1.2,
         "impact_high": 1.2, "ball_speed": 0.25, "launch_angle": 0.2, "azimuth": 0.25, "backspin": 60.0, "sidespin": 60.0,
         "spin_rate": 60.0, "spin_axis": 1.0}
DIGITS = {"deg": 2, "mm": 1, "rpm": 0}


class Session:
    """One set: deliveries, the declared club, the real one, and what the instrument does with both."""

    def __init__(self, kind, number, rng):
        self.kind, self.number, self.rng = kind, number, rng
        n, letter, columns, self.size, club_unit, ball_unit, form, self.declared = LAYOUTS[number]
        self.n, self.t = n, np.arange(n) / (n - 1)
        self.club = kind.clubs[letter % len(kind.clubs)]
        self.bag = self.club == "bag"
        columns = set(columns.split()) | set(kind.columns)
        form = kind.form or form
        spin = ["backspin", "sidespin"] if form == "vector" else ["spin_rate", "spin_axis"]
        self.outputs = ["ball_speed", "launch_angle", "azimuth"] + spin
        self.unit = {c: "deg" for c in NOISE} | {"club_speed": club_unit, "ball_speed": ball_unit} | {
            c: "mm" for c in ("impact_toe", "impact_high")} | {c: "rpm" for c in ("backspin", "sidespin", "spin_rate")}
        self.groups = {}
        if "player" in columns:
            self.groups["player"] = np.array([f"p{1 + i}" for i in np.sort(rng.integers(0, 3 + number % 2, n))])
            rng.shuffle(self.groups["player"])
        if "session" in columns:
            self.groups["session"] = np.array([f"s{1 + i}" for i in np.arange(n) * 3 // n])
        self.sigma = dict(NOISE)
        scale = rng.choice([1.0, 1.0, 1.5])  # a finer and a plainer instrument
        for c in self.sigma:
            self.sigma[c] = round(self.sigma[c] * scale, 3)
        if self.declared == "outputs":  # inputs are exact then
            self.sigma.update({c: 0.0 for c in physics.INPUTS})
        self.x = self.deliveries(rng)
        self.head = self.declare(rng)
        self.real = dataclasses.replace(self.head)
        self.known = []  # what the recorded inputs are against the true ones: (x) -> None
        self.turned = None  # rotation from the target frame to the monitor's
        self.reads = []  # the instrument: (inputs, outputs) -> None, in place, after the noise
        self.distort = None  # own noise: (rng) -> the errors of every column
        self.rounds = {}  # steps of coarse readings, part of the noise

    def deliveries(self, rng, bond=0.3):
        """Habits: a swing from the inside meets the ball towards the toe and with a closed face, a steep one low; a miss is slow."""
        n, habits = self.n, HABITS["iron" if self.bag else self.club]
        g = rng.standard_normal((7, n))
        players = self.groups.get("player", np.full(n, ""))
        for p in np.unique(players):
            g[:, players == p] += 0.5 * rng.standard_normal((7, 1)) * (p != "")
        g[5] = bond * g[2] + np.sqrt(1 - bond**2) * g[5]
        g[3] = bond * g[2] + np.sqrt(1 - bond**2) * g[3]
        g[6] = bond * g[1] + np.sqrt(1 - bond**2) * g[6]
        g[0] -= bond * (g[5] ** 2 + g[6] ** 2 - 2) / 3
        x = {c: m + s * g[i] for i, (c, (m, s)) in enumerate(zip(physics.INPUTS, habits))}
        if self.bag:
            self.groups["club"] = np.array([BAG[i][0] for i in rng.integers(0, 4, n)])
            for name, speed, _, loft in BAG:
                on = self.groups["club"] == name
                x["club_speed"][on] *= speed
                x["dynamic_loft"][on] += loft
        return x

    def declare(self, rng):
        near = lambda v, by: v * (1 + by * rng.uniform(-1, 1))
        if self.club == "driver":
            mass, cg, inertia = near(0.2, 0.03), (near(-35, 0.1), rng.uniform(-2, 2), rng.uniform(-2, 3)), (3.6e-4, 2.9e-4, 4.8e-4)
            curve = (round(near(0.3, 0.1), 3), round(near(0.29, 0.1), 3))
        else:
            mass, cg = near(0.265 if self.club != "wedge" else 0.3, 0.03), (near(-9, 0.15), rng.uniform(-1, 4), rng.uniform(-3, 1))
            inertia, curve = (3.0e-4, 0.8e-4, 2.6e-4), (np.inf, np.inf)
        if self.bag:
            mass = np.array([next(b[2] for b in BAG if b[0] == c) for c in self.groups["club"]])
        inertia = np.diag([near(i, 0.05) for i in inertia]) + 1e-5 * (np.ones((3, 3)) - np.eye(3)) * rng.uniform(-1, 1)
        return physics.Club(np.round(mass, 4), np.round(np.array(cg), 1) / 1e3, np.round(inertia, 8), *curve)

    def measure(self, rng=None):
        """Recorded inputs and outputs; without rng free of noise."""
        b = physics.blow(self.x, self.real)
        v, w = (physics.apply(self.turned, a) if self.turned is not None else a for a in (b["v"], b["w"]))
        out = {c: a for c, a in physics.launch(v, w).items() if c in self.outputs}
        x = {c: a.copy() for c, a in self.x.items()}
        for f in self.known:
            f(x)
        if rng is not None:
            errors = self.distort(rng) if self.distort else {c: rng.standard_normal(self.n) * s for c, s in self.sigma.items()}
            for d in (x, out):
                for c in d:
                    d[c] = d[c] + errors[c]
                    if c in self.rounds:
                        d[c] = np.round(d[c] / self.rounds[c]) * self.rounds[c]
        for f in self.reads:
            f(x, out)
        return x, out

    def total(self, x, out):
        """Length of the residual of the base in noise units, each shot whitened by the noise of outputs and inputs."""
        launched = lambda x: np.stack([physics.base(x, self.head)[c] for c in self.outputs], -1)
        y = launched(x)
        cov = np.zeros((self.n, 5, 5)) + np.diag([self.sigma[c] ** 2 for c in self.outputs])
        for c in physics.INPUTS:
            h = 1e-4
            d = (launched({**x, c: x[c] + h}) - y) / h * self.sigma[c]
            cov += d[:, :, None] * d[:, None, :]
        r = np.stack([out[c] for c in self.outputs], -1) - y
        return float(np.sqrt(np.einsum("ni,nij,nj->", r, np.linalg.inv(cov), r)))

    def header(self, c):
        return f"{c}_{self.unit[c]}"

    def inner(self, c):
        """Header's unit over the internal one."""
        return SPEEDS.get(self.unit[c], 1.0)

    def write(self, folder, x, out, exact):
        folder.mkdir(parents=True, exist_ok=True)
        values = {**x, **out}
        cells = lambda c: [f"{v * self.inner(c):.{10 if exact else DIGITS.get(self.unit[c], 2)}f}" for v in values[c]]
        table = {"shot": [str(i + 1) for i in range(self.n)], **{g: list(a) for g, a in self.groups.items()}}
        if self.bag:
            table["head_mass_kg"] = [f"{m:.4f}" for m in self.head.mass]
        table |= {self.header(c): cells(c) for c in values}
        lines = [",".join(table)] + [",".join(row) for row in zip(*table.values())]
        (folder / "shots.csv").write_text("\n".join(lines) + "\n")
        h, mm = self.head, lambda v: "inf" if np.isinf(v) else f"{v * 1e3:g}"
        rows = ", ".join("[" + ", ".join(f"{v:.8g}" for v in row) + "]" for row in h.inertia)
        text = f"""kind  = "loop"
title = "measured set {self.kind.number:02d}{self.number}"

[model]
base = "rigid-eccentric"

[ball]
mass_kg = 0.04593
radius_mm = 21.335
inertia_factor = 0.4

[head]
mass_kg = {np.mean(h.mass):.4f}
cg_mm = [{", ".join(f"{v * 1e3:.1f}" for v in h.cg)}]
inertia_kg_m2 = [{rows}]
bulge_mm = {mm(h.bulge)}
roll_mm = {mm(h.roll)}

[data]
shots = "shots.csv"
"""
        part = lambda name, columns: f"[data.{name}]\n" + "".join(
            f"{self.header(c)} = {self.sigma[c] * self.inner(c):.4g}\n" for c in columns if self.sigma[c])
        if self.declared != "inputs" or exact:
            text += part("noise", self.outputs)
        if self.declared != "outputs" and not exact:
            text += part("input_noise", physics.INPUTS)
        (folder / "case.toml").write_text(text)

    def truth(self, total):
        k = self.kind
        acceptable = list(k.acceptable) + (["insufficient"] if total < 20 or k.family == 5 else [])
        return {"kind": k.name, "family": k.family, "listed": k.listed, "names": k.names, "kin": k.kin, "guilty": k.guilty,
                "place": k.place, "acceptable": sorted(set(acceptable)), "total": round(total, 1), "shots": self.n, "bag": self.bag,
                "clusters": bool({"player", "session", "ball"} & set(self.groups)), "club": self.club, "number": self.number}


def make(kind, number, seed, exact=False):
    """The session, its recorded inputs and outputs, and its truth."""
    s = Session(kind, number, np.random.default_rng([seed, zlib.crc32(kind.name.encode()), number]))
    kind.plant(s)
    total = s.total(*s.measure())
    x, out = s.measure(None if exact else np.random.default_rng([seed, zlib.crc32(kind.name.encode()), number, 1]))
    return s, x, out, s.truth(total)


def main():
    p = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    p.add_argument("--seed", type=int, required=True)
    p.add_argument("--sets", type=pathlib.Path, required=True)
    p.add_argument("--truth", type=pathlib.Path, required=True)
    p.add_argument("--kinds", nargs="+", help="only these, separated by blanks or commas")
    p.add_argument("--numbers", nargs="+", help="only these of 0 to 9")
    p.add_argument("--exact", action="store_true", help="without noise, all digits")
    p.add_argument("--more", action="store_true", help="ignored: there are no further kinds")
    a = p.parse_args()
    split = lambda v: [w for part in v for w in part.replace(",", " ").split()]
    kinds = split(a.kinds) if a.kinds else list(KINDS)
    numbers = [int(i) for i in split(a.numbers)] if a.numbers else range(10)
    unknown = set(kinds) - set(KINDS)
    if unknown:
        p.error(f"no kind {', '.join(sorted(unknown))}; there are {', '.join(KINDS)}")
    a.truth.mkdir(parents=True, exist_ok=True)
    for k in kinds:
        for number in numbers:
            s, x, out, truth = make(KINDS[k], number, a.seed, a.exact)
            s.write(a.sets / f"{k}-{number}", x, out, a.exact)
            (a.truth / f"{k}-{number}.json").write_text(json.dumps(truth, indent=1) + "\n")


if __name__ == "__main__":
    main()
