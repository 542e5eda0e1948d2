#!/usr/bin/python3
"""Makes the sets of a seed: generate.py --seed 1 --sets DIR --truth DIR. Deterministic: same seed, same bytes."""

import argparse
import json
import os
import pathlib
import zlib

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy: of small matrices, threads wait for each other
import numpy as np

from kinds import KINDS
from physics import Blow, base
from twins import twins

INPUTS = ["club_speed", "attack_angle", "dynamic_loft", "club_path", "face_angle", "impact_toe", "impact_high"]
ANGLES = ["attack_angle", "dynamic_loft", "club_path", "face_angle", "launch_angle", "azimuth", "spin_axis"]
MPS = {"mps": 1.0, "mph": 0.44704, "kmh": 1 / 3.6}

# number: shots, club, columns, goal of the total, club speed in, ball speed in, spin as, declared noise
LAYOUTS = {
    0: (40, "iron", [], 13, "mps", "mps", "components", "both"),
    1: (60, "driver", ["player"], 22, "mph", "mph", "rate", "both"),
    2: (80, "wedge", ["session"], 16, "mph", "mph", "components", "both"),
    3: (100, "bag", ["club"], 30, "mps", "mps", "rate", "both"),
    4: (120, "driver", ["session", "ball"], 11, "kmh", "kmh", "components", "both"),
    5: (160, "iron", ["player", "ball"], 42, "mph", "mps", "rate", "both"),
    6: (220, "bag", ["club", "humidity_pct"], 19, "mph", "mph", "components", "both"),
    7: (260, "driver", ["player", "session"], 26, "mps", "mps", "rate", "inputs"),
    8: (320, "wedge", ["player"], 9, "mph", "mph", "rate", "both"),
    9: (400, "driver", ["session"], 55, "mps", "mps", "components", "exact"),
}
# Where a kind does not go with the club of the number.
INSTEAD = {"driver": ["iron", "wedge"], "iron": ["driver", "wedge"], "wedge": ["iron", "driver"], "bag": ["iron", "wedge", "driver"]}

CLUBS = {  # means and scatters of INPUTS within a player, then head
    "driver": dict(mean=[46, 1.0, 13.0, 0.5, 0.0, 1.0, 1.0], sd=[1.8, 1.6, 1.7, 2.2, 2.0, 9.0, 5.5], mass=0.200,
                   cg=[-35, 1, 2], inertia=[3.6e-4, 2.9e-4, 4.8e-4], bulge=0.305, roll=0.305),
    "iron": dict(mean=[37, -3.8, 24.0, 0.5, 0.3, 0.0, -2.5], sd=[1.5, 1.2, 1.7, 2.0, 1.9, 7.5, 4.0], mass=0.262,
                 cg=[-9, 5, -1], inertia=[2.9e-4, 0.85e-4, 2.4e-4], bulge=np.inf, roll=np.inf),
    "wedge": dict(mean=[31, -5.0, 43.0, -0.3, 0.6, 0.5, -3.0], sd=[2.0, 1.3, 2.2, 2.0, 2.0, 6.5, 4.0], mass=0.296,
                  cg=[-8, 6, -3], inertia=[3.2e-4, 1.0e-4, 2.7e-4], bulge=np.inf, roll=np.inf),
}
BAG = {"5i": (38.5, 19.0, 0.252), "7i": (36.5, 24.5, 0.268), "9i": (34.5, 32.0, 0.282), "PW": (33.0, 38.0, 0.288)}
# bulge and roll of 305 mm and no product of inertia are declared; the rest varies with the set
SD_IN = {"club_speed": 0.25, "attack_angle": 0.25, "dynamic_loft": 0.25, "club_path": 0.25, "face_angle": 0.2, "impact_toe": 0.7,
         "impact_high": 0.6}
DIGITS = {"club_speed": 2, "ball_speed": 2, "impact_toe": 1, "impact_high": 1, "backspin": 0, "sidespin": 0, "spin_rate": 0, "head_mass": 4}


class Session:
    """The true blows of a set, its head, ball, noise and words."""

    def __init__(self, kind, number, g):
        self.n, club, columns, self.goal, self.club_unit, self.ball_unit, self.spin, self.declared = LAYOUTS[number]
        if club not in kind.clubs:
            club = next((c for c in INSTEAD[club] if c in kind.clubs), kind.clubs[0])
        columns = [c for c in columns if c != "club"] + (["club"] if club == "bag" else [])
        columns += [c for c in kind.needs if c not in columns]
        self.club, self.columns, self.shot = club, columns, np.arange(1, self.n + 1)
        n, own = self.n, CLUBS["iron" if club == "bag" else club]
        self.text, self.number = {}, {}
        if "player" in columns:
            who = np.array(["Ana", "Ben", "Cho", "Dov"])[: int(g.integers(3, 5))]
            self.text["player"] = who[(np.arange(n) * len(who) // n) if g.random() < 0.4 else g.integers(0, len(who), n)]
        if "session" in columns:
            self.text["session"] = np.array(["am", "noon", "pm", "eve"])[np.arange(n) * 4 // n]
        if "ball" in columns:
            self.text["ball"] = np.array(["A1", "B2", "C3"])[np.arange(n) % 3 if g.random() < 0.5 else g.integers(0, 3, n)]
        if "club" in columns:
            self.text["club"] = np.array(list(BAG))[np.arange(n) * 4 // n if g.random() < 0.5 else g.integers(0, 4, n)]
        if "humidity_pct" in columns:
            self.number["humidity_pct"] = np.round(55 + 12 * np.sin(np.arange(n) / n * 2.5 + g.random()) + g.normal(0, 1.5, n), 1)

        mean, sd = np.array(own["mean"], float), np.array(own["sd"], float)
        mean += sd * g.normal(0, 0.25, 7)
        z = g.standard_normal((n, 7))
        z[:, 4] = 0.45 * z[:, 3] + 0.89 * z[:, 4]  # face follows path
        z[:, 2] = 0.4 * z[:, 1] + 0.92 * z[:, 2]  # loft follows attack
        z = np.clip(z, -2.8, 2.8)
        x = mean + sd * z
        if "player" in self.text:
            for p in np.unique(self.text["player"]):
                x[self.text["player"] == p] += sd * g.normal(0, 0.6, 7) * np.array([1.3, 1, 0.8, 1, 0.6, 0.5, 0.5])
        mass = np.full(n, own["mass"] + round(g.normal(0, 0.003), 4))
        if club == "bag":
            for c, (speed, loft, m) in BAG.items():
                his = self.text["club"] == c
                x[his, 0] += speed - 37
                x[his, 2] += loft - 24
                mass[his] = m
        x[:, 2] = np.maximum(x[:, 2], 5.0)
        self.x = {c: x[:, i] for i, c in enumerate(INPUTS)}
        spread = 1 + g.uniform(-0.1, 0.1, 3)
        self.head = {"mass": mass, "cg": np.round(np.array(own["cg"]) + g.normal(0, [2, 1, 1]), 1) * 1e-3,
                     "inertia": np.diag(np.round(np.array(own["inertia"]) * spread, 6)), "bulge": own["bulge"], "roll": own["roll"]}
        self.ball = {"mass": 0.04593, "radius": 0.021335, "factor": 0.4}
        self.channels = ["ball_speed", "launch_angle", "azimuth"] + (["spin_rate", "spin_axis"] if self.spin == "rate" else ["backspin", "sidespin"])
        rough = {"driver": 65, "iron": 80, "bag": 90, "wedge": 120}[club] * g.uniform(0.8, 1.3)
        k = g.uniform(0.8, 1.3, 4)
        self.sd = {"ball_speed": round(0.22 * k[0], 3), "launch_angle": round(0.2 * k[1], 3), "azimuth": round(0.22 * k[2], 3)}
        self.sd |= ({"spin_rate": round(rough), "spin_axis": round(0.8 * k[3], 3)} if self.spin == "rate" else
                    {"backspin": round(rough), "sidespin": round(0.9 * rough)})
        self.sd_in = {c: round(v * g.uniform(0.7, 1.3), 3) for c, v in SD_IN.items()}

    def blow(self, head=None, ball=None, **more):
        return Blow(self.x, head or self.head, ball or self.ball, **more)

    def by(self, column, values):
        """One of values for each shot, by its word in a column; without the column the first."""
        if column not in self.text:
            return np.full(self.n, values[0])
        return np.asarray(values)[np.unique(self.text[column], return_inverse=True)[1]]

    def channels_of(self, out):
        rec = {c: out[c] for c in ("ball_speed", "launch_angle", "azimuth")}
        if self.spin == "rate":
            rec["spin_rate"] = np.sqrt(out["back"] ** 2 + out["side"] ** 2 + out["rifle"] ** 2)
            rec["spin_axis"] = np.degrees(np.arctan2(out["side"], out["back"]))
        else:
            rec["backspin"], rec["sidespin"] = out["back"], out["side"]
        return rec

    def base(self, rec):
        return self.channels_of(base({c: rec[c] for c in INPUTS}, self.head, self.ball))


def made(s, kind, a, seed, errors_in, errors_out):
    """The recorded columns in m/s, deg, mm, rpm."""
    x, out = kind.mech(s, a, np.random.default_rng(seed + [1]))
    rec = {c: x[c] + errors_in.get(c, 0.0) for c in INPUTS}
    rec |= {c: v + errors_out.get(c, 0.0) for c, v in s.channels_of(out).items()}
    rec |= {c: v.copy() for c, v in s.text.items()}
    kind.fault(s, a, np.random.default_rng(seed + [2]), rec)
    return rec


def whitener(s, rec, exact):
    """Per shot the inverse root of the covariance of outputs and inputs."""
    cov = np.broadcast_to(np.diag([s.sd[c] ** 2 for c in s.channels]), (s.n, 5, 5)).copy()
    if not exact:
        for c in INPUTS:
            d = s.sd_in[c]
            up, down = (s.base(dict(rec, **{c: rec[c] + t * d})) for t in (1, -1))
            j = np.stack([(up[k] - down[k]) / 2 for k in s.channels], -1)
            cov += j[:, :, None] * j[:, None, :]
    return np.linalg.inv(np.linalg.cholesky(cov))


def total(s, rec, white):
    f = s.base(rec)
    r = np.stack([rec[c] - f[c] for c in s.channels], -1)
    return float(np.sqrt(np.sum(np.einsum("nij,nj->ni", white, r) ** 2)))


def header(s, c):
    if c in ANGLES:
        return c + "_deg"
    if c in ("club_speed", "ball_speed"):
        return c + "_" + (s.club_unit if c == "club_speed" else s.ball_unit)
    return c + ("_mm" if c.startswith("impact") else "_rpm")


def unit(s, c):
    return MPS[s.club_unit] if c == "club_speed" else MPS[s.ball_unit] if c == "ball_speed" else 1.0


def write(folder, s, rec, seed, all_digits):
    folder.mkdir(parents=True, exist_ok=True)
    numbers = INPUTS + s.channels
    columns = {"shot": [str(i) for i in s.shot]}
    columns |= {c: [str(v) for v in rec[c]] for c in s.text} | {c: [str(v) for v in values] for c, values in s.number.items()}
    if s.club == "bag":
        columns["head_mass_kg"] = ["%.4f" % m for m in s.head["mass"]]
    for c in numbers:
        form = "%.15g" if all_digits else "%%.%df" % DIGITS.get(c, 2)
        columns[header(s, c)] = [form % (v / unit(s, c)) for v in rec[c]]
    rows = [",".join(columns)] + [",".join(row) for row in zip(*columns.values())]
    (folder / "shots.csv").write_text("\n".join(rows) + "\n")

    def radius(r):
        return "inf" if np.isinf(r) else "%.1f" % (r * 1e3)

    h = s.head
    lines = ['kind  = "loop"', f'title = "measured shots, {s.n} of them"', "", "[model]", 'base = "rigid-eccentric"', "", "[ball]",
             "mass_kg = 0.04593", "radius_mm = 21.335", "inertia_factor = 0.4", "", "[head]",
             "mass_kg = %.4f" % (0.27 if s.club == "bag" else h["mass"][0]),
             "cg_mm = [%s]" % ", ".join("%.1f" % (v * 1e3) for v in h["cg"]),
             "inertia_kg_m2 = [%s]" % ", ".join("[%s]" % ", ".join("%.6g" % v for v in row) for row in h["inertia"]),
             f"bulge_mm = {radius(h['bulge'])}", f"roll_mm = {radius(h['roll'])}", "", "[data]", 'shots = "shots.csv"']
    if s.declared != "inputs":
        lines += ["", "[data.noise]"] + ["%s = %.6g" % (header(s, c), s.sd[c] / unit(s, c)) for c in s.channels]
    if s.declared != "exact" and not all_digits:
        lines += ["", "[data.input_noise]"] + ["%s = %.6g" % (header(s, c), s.sd_in[c] / unit(s, c)) for c in INPUTS]
    lines += ["", "[split]", f"seed = {seed}"]
    (folder / "case.toml").write_text("\n".join(lines) + "\n")


def make(kind, number, seed, exact):
    key = [seed, zlib.crc32(kind.name.encode()), number]
    g = np.random.default_rng(key)
    s = Session(kind, number, g)
    s.clean = plain = s.channels_of(base(s.x, s.head, s.ball))
    exact_inputs = exact or s.declared == "exact"
    goal = s.goal * np.exp(g.normal(0, 0.15))

    def size_of(a):
        rec = made(s, kind, a, key, {}, {})
        return total(s, rec, white)

    white = whitener(s, dict(s.x, **plain), s.declared == "exact")
    low, high = kind.sizes
    if kind.listed == "null":
        a = low
    elif size_of(high) <= goal:
        a = high
    elif size_of(low) >= goal:
        a = low
    else:
        for _ in range(14):
            a = np.sqrt(low * high)
            low, high = (a, high) if size_of(a) < goal else (low, a)
        a = high  # where the total jumps, above it
    clean = made(s, kind, a, key, {}, {})
    length, alike = 0.0, set()
    if kind.listed != "null":
        own = whitener(s, clean, s.declared == "exact")
        length = total(s, clean, own)
        alike = twins(s, kind, clean, own)
    draw = np.random.default_rng(key + [3])
    errors_in = {c: s.sd_in[c] * draw.standard_normal(s.n) for c in INPUTS}
    errors_out = kind.noise(s, draw, s.sd) if kind.noise else {c: s.sd[c] * draw.standard_normal(s.n) for c in s.channels}
    rec = made(s, kind, a, key, {} if exact_inputs else errors_in, {} if exact else errors_out)
    truth = {"kind": kind.name, "family": kind.family, "number": number, "seed": seed, "listed": kind.listed,
             "names": sorted(set(kind.names) | alike), "kin": sorted(set(kind.kin) - alike), "twins": sorted(alike),
             "guilty": sorted(kind.guilty), "place": list(kind.place),
             "acceptable": sorted(set(kind.acceptable) | ({"explained", "ambiguous"} if alike else set())), "total": round(length, 1), "size": float("%.4g" % a), "shots": s.n, "club": s.club,
             "bag": s.club == "bag", "clusters": bool(s.text)}
    return s, rec, truth


def listed(words):
    return [w for word in words for w in word.replace(",", " ").split()]


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
    names = listed(a.kinds) if a.kinds else list(KINDS)
    numbers = [int(n) for n in listed(a.numbers)] if a.numbers else list(LAYOUTS)
    unknown = [n for n in names if n not in KINDS] + [str(n) for n in numbers if n not in LAYOUTS]
    if unknown:
        p.error("no such kind or number: " + ", ".join(unknown))
    a.truth.mkdir(parents=True, exist_ok=True)
    for name in names:
        for number in numbers:
            s, rec, truth = make(KINDS[name], number, a.seed, a.exact)
            write(a.sets / f"{name}-{number}", s, rec, a.seed, a.exact)
            (a.truth / f"{name}-{number}.json").write_text(json.dumps(truth, indent=1) + "\n")


if __name__ == "__main__":
    main()
