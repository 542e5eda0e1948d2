#!/usr/bin/python3
"""Tests of the examination itself; prints the sizes of the kinds. --hosel BIN compares the base with the program's, without any effect."""

import argparse
import csv
import importlib.util
import json
import os
import pathlib
import subprocess
import sys
import tempfile

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy: of small matrices, threads wait for each other
import numpy as np

import generate
import physics
from kinds import KINDS

HERE = pathlib.Path(__file__).resolve().parent
A = physics.Club(0.2, (-0.035, 0, 0), np.diag([3.7e-4, 2.9e-4, 4.8e-4]), 0.3, 0.3)
B = physics.Club(0.2, (-0.038, 0.003, 0.004), np.array([[29, -2, 3], [-2, 41, 1], [3, 1, 56]]) * 1e-5, 0.3, 0.3)
# speed, attack, path, face, loft, toe, high; ball speed, launch, azimuth, back-, side-, riflespin: rigid-eccentric.md
REFERENCE = [(A, (50, 0, 0, 0, 10, 0, 0), (68.7996625, 8.1568547, 0, 2476.09382, 0, 0)),
             (A, (50, 0, 0, 0, 10, 20, 0), (67.0417009, 8.1044535, 4.0202226, 2444.23816, -188.28558, -198.66279)),
             (A, (50, 0, 0, 0, 12, 0, -10), (68.2542186, 7.4994374, 0, 3453.13610, 0, 0)),
             (A, (50, -1, 4, -2, 11, 0, 0), (68.0572782, 8.7779367, -0.8427541, 2958.08862, -1492.09525, -186.91199)),
             (A, (42, -3, -3, 3, 14, 12, -6), (56.1572111, 9.4649126, 4.2558819, 3709.46885, 1152.83596, -83.31975)),
             (B, (46, 2, 2, -1, 12, 8, 5), (63.1286855, 10.9169153, 1.3165128, 2502.76664, -884.02101, -228.06872))]
ORDER = ("club_speed", "attack_angle", "club_path", "face_angle", "dynamic_loft", "impact_toe", "impact_high")


def reference():
    for club, x, expected in REFERENCE:
        y = physics.base({c: np.array([float(v)]) for c, v in zip(ORDER, x)}, club)
        got = [y[c][0] for c in ("ball_speed", "launch_angle", "azimuth", "backspin", "sidespin", "riflespin")]
        assert np.allclose(got, expected, rtol=1e-8, atol=6e-6), (x, got, expected)


def conservation():
    """Momentum, angular momentum about the contact point, the law of restitution, and no energy from nowhere, for every kind."""
    for k in KINDS.values():
        s = generate.Session(k, 4, np.random.default_rng(3))
        k.plant(s)
        b = physics.blow(s.x, s.real)
        q = b["_"]
        V, W = q["after"]
        spin = lambda w: physics.apply(q["inertia"], w)
        assert np.allclose(q["m"] * b["v"] + q["M"] * (V - q["V"]), 0, atol=1e-12), k.name
        ball = q["ball_inertia"] * b["w"] - q["m"] * np.cross(q["ball_arm"], b["v"])
        W0 = np.broadcast_to(np.asarray(s.real.omega, float), W.shape)
        head = spin(W - W0) - q["M"] * np.cross(q["arm"], V - q["V"])
        assert np.allclose(ball, 0, atol=1e-9) and np.allclose(head, 0, atol=1e-9), k.name
        apart = physics.dot(b["v"] + np.cross(b["w"], q["ball_arm"]) - V - np.cross(W, q["arm"]), q["normal"])
        if s.real.grain == 1:
            assert np.allclose(apart, q["e"] * q["vn"], rtol=1e-9), k.name
        energy = lambda M, v, I, w: M * physics.dot(v, v) + physics.dot(w, I)
        gone = energy(q["M"], q["V"], spin(W0), W0) - energy(q["M"], V, spin(W), W) - energy(q["m"], b["v"], q["ball_inertia"] * b["w"], b["w"])
        assert np.all(gone > 0), k.name


def sizes(seed):
    """The kinds' totals; and every truth goes through the grader with every verdict."""
    spec = importlib.util.spec_from_file_location("grade", HERE.parent / "examination_open" / "grade.py")
    grader = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(grader)
    for k in KINDS.values():
        totals = []
        for number in range(10):
            s, x, out, truth = generate.make(k, number, seed)
            truth = json.loads(json.dumps(truth))
            assert all(np.all(np.isfinite(a)) for a in (*x.values(), *out.values())), k.name
            assert (truth["total"] < 1e-6) == (k.family == 5), k.name
            empty = {"adopted": [], "ties": [], "unexplained": [], "rows": {"read": s.n}}
            right = [{**empty, "verdict": "explained", "adopted": truth["names"]}, {**empty, "verdict": "no-residual"},
                     {**empty, "verdict": "unexplained", "columns": [{"column": c} for c in truth["guilty"]]},
                     {**empty, "verdict": "unexplained", "unexplained": [{"channel": "", "regressor": (truth["place"] or [""])[0]}]}]
            marks = [grader.grade(r, truth)[0] for r in right]
            assert marks[{1: 0, 2: 0, 3: 2, 4: 3, 5: 1}[k.family]] == "right", (k.name, marks)
            for verdict in ("no-residual", "explained", "ambiguous", "unexplained", "insufficient", "noise-contradicted"):
                grader.grade({**empty, "verdict": verdict}, truth)
            totals.append(truth["total"])
        print(f"{k.family} {k.name:26s}" + "".join(f"{t:7.1f}" for t in totals))


def same_bytes():
    with tempfile.TemporaryDirectory() as folder:
        runs = []
        for run in ("1", "2"):
            subprocess.run([sys.executable, HERE / "generate.py", "--seed", "5", "--sets", f"{folder}/{run}/sets", "--truth",
                            f"{folder}/{run}/truth", "--kinds", "wet-face,spin-ceiling", "heavy-tails", "--numbers", "1,4"], check=True)
            files = sorted(f for f in pathlib.Path(folder, run).rglob("*") if f.is_file())
            runs.append([(f.relative_to(f"{folder}/{run}"), f.read_bytes()) for f in files])
        assert runs[0] == runs[1] and len(runs[0]) == 18


def against(hosel):
    """Sets without effect and noise: the program's base agrees to the printed digits, on the channels that it does not take for computed."""
    compared = set()
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.executable, HERE / "generate.py", "--seed", "7", "--sets", f"{folder}/sets", "--truth", f"{folder}/truth",
                        "--kinds", "habits-alone", "--exact"], check=True)
        for case in sorted(pathlib.Path(folder, "sets").iterdir()):
            subprocess.run([hosel, "run", case, "--out", f"{folder}/out", "--force", "--quiet"], check=True, stdout=subprocess.DEVNULL)
            rows = list(csv.DictReader(open(f"{folder}/out/residuals.csv")))
            channels = [c[:-len("__measured")] for c in rows[0] if c.endswith("__measured")] if rows else []
            worst = max([abs(float(r[c + "__measured"]) - float(r[c + "__before"])) / max(1, abs(float(r[c + "__measured"])))
                         for r in rows for c in channels], default=0)
            print(f"{case.name}: {len(rows)} shots, {len(channels)} channels, worst difference {worst:.1e}", flush=True)
            assert worst < 1e-7
            compared |= set(channels)
        assert len({c.rsplit("_", 1)[0] for c in compared}) >= 6, compared


if __name__ == "__main__":
    p = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    p.add_argument("--hosel")
    p.add_argument("--seed", type=int, default=1)
    a = p.parse_args()
    reference()
    conservation()
    same_bytes()
    sizes(a.seed)
    if a.hosel:
        against(a.hosel)
    print(f"{len(KINDS)} kinds: passed")
