#!/usr/bin/python3
"""What the examination rests on: its impact keeps momentum and energy, its sets depart from the base as their truths say, its
grader follows its rules, its rivals can predict. A few seconds."""

import sys
import unittest
import zlib

try:
    import numpy as np
except ImportError:
    print("SKIPPED: no NumPy (python3-numpy)")
    sys.exit(77)

import generate
import grade
import physics
import rivals
from kinds import KINDS


def blow(n=40, turning=True):
    r = np.random.default_rng(7)
    x = {"club_speed": r.normal(42, 3, n), "attack_angle": r.normal(0, 0.05, n), "dynamic_loft": r.normal(0.4, 0.15, n),
         "club_path": r.normal(0, 0.05, n), "face_angle": r.normal(0, 0.05, n), "impact_toe": r.normal(0, 0.012, n),
         "impact_high": r.normal(0, 0.008, n)}
    inertia = np.array([[2.7e-4, 2e-5, -3e-5], [2e-5, 2.9e-4, 1e-5], [-3e-5, 1e-5, 4.7e-4]])
    head = physics.Head(0.2, [-0.036, 0.004, 0.003], inertia, 0.3, 0.28)
    return physics.Blow(x, head, r.normal(0, 20, (n, 3)) if turning else None)


def energy(b, v, spin, V, W):
    return 0.5 * (physics.MASS * physics.dot(v, v) + physics.FACTOR * physics.MASS * physics.RADIUS**2 * physics.dot(spin, spin)
                  + b.mass * physics.dot(V, V) + physics.dot(W, physics.times(b.inertia, W)))


def momenta(b, v, spin, V, W):
    """Linear, and angular about the contact."""
    about = physics.FACTOR * physics.MASS * physics.RADIUS**2 * spin + physics.MASS * np.cross(-b.a, v)
    return (physics.MASS * v + b.mass[:, None] * V,
            about + physics.times(b.inertia, W) + b.mass[:, None] * np.cross(-b.c, V))


class Physics(unittest.TestCase):
    def states(self, b, J):
        at_rest = np.zeros_like(b.v)
        after = physics.after(b, J)
        self.assertGreater(np.linalg.norm(after[0], axis=1).min(), 30)  # the ball was struck,
        self.assertGreater(np.abs(after[1]).min(axis=0).max(), 1)  # spins,
        self.assertGreater(np.linalg.norm(after[3] - b.omega, axis=1).max(), 10)  # and the head turned
        return (at_rest, at_rest, b.v, b.omega), after

    def test_momentum(self):
        b = blow()
        e = physics.base_restitution(b)
        for J in (physics.rigid(b, e), physics.rigid(b, e, 0.4, 0.05), physics.compliant(b, e, 0.5, 0.3, steps=200)[0]):
            before, after = self.states(b, J)
            for m0, m1 in zip(momenta(b, *before), momenta(b, *after)):
                np.testing.assert_allclose(m1, m0, atol=1e-10 * np.abs(m0).max())  # round-off

    def test_energy(self):
        b = blow()
        before, after = self.states(b, physics.rigid(b, 1.0, 1.0))
        np.testing.assert_allclose(energy(b, *after), energy(b, *before), rtol=1e-12)  # all comes back: round-off
        before, after = self.states(b, physics.rigid(b, physics.base_restitution(b)))
        self.assertLess(np.max(energy(b, *after) / energy(b, *before)), 0.97)

    def test_compliant_energy(self):
        """Elastic, sticking: what is not in the bodies is in the springs, to the time step (first order)."""
        b, gaps = blow(), []
        for steps in (500, 1000):
            J, stored = physics.compliant(b, 1.0, 0.5, np.inf, steps=steps)
            before, after = self.states(b, J)
            contact = 0.5 * physics.dot(b.w, np.linalg.solve(b.k, b.w[..., None])[..., 0])
            gaps.append(np.max(np.abs(energy(b, *after) + stored * contact - energy(b, *before)) / contact))
        self.assertLess(gaps[1], 0.01)
        self.assertLess(gaps[1], 0.7 * gaps[0])

    def test_friction_limit(self):
        b = blow()
        J = physics.rigid(b, 0.8, 0.0, 0.03)
        jn = physics.dot(J, b.n)
        share = np.linalg.norm(J - jn[:, None] * b.n, axis=1) / jn
        self.assertGreater(np.mean(np.isclose(share, 0.03)), 0.5)  # most slide,
        self.assertLess(share.max(), 0.03 + 1e-12)  # none beyond,
        after = b.w - physics.times(b.k, J)
        np.testing.assert_allclose(physics.dot(after, b.n), -0.8 * b.approach, rtol=1e-12)  # and restitution holds

    def test_planar_closed_form(self):
        """The formulas of the rolling model, docs/theory.md."""
        b = blow(turning=False)
        x = {**b.x, **{k: 0 * b.x[k] for k in ("club_path", "face_angle")}}
        got = physics.base(x, physics.planar(b.head))
        a, v, m, M = x["dynamic_loft"] - x["attack_angle"], x["club_speed"], physics.MASS, 0.2
        vn = v * np.cos(a) * (1.86 - 0.0029 * v * np.cos(a)) / (1 + m / M)
        vp = v * np.sin(a) / (1 + m / M + 1 / physics.FACTOR)
        # The head's inertia is 1e6 kg m^2 there, not infinite.
        np.testing.assert_allclose(got["ball_speed"], np.hypot(vn, vp), rtol=1e-6)
        np.testing.assert_allclose(got["backspin"], vp / physics.FACTOR / physics.RADIUS, rtol=1e-6, atol=1e-4)


class Sets(unittest.TestCase):
    def test_signal(self):
        """Every kind makes a set; it departs from the base model exactly where its truth is no null."""
        self.assertGreaterEqual(len(KINDS), 30)
        for name, kind in KINDS.items():
            tables = []
            for _ in range(2):
                s = generate.Session(np.random.default_rng([1, zlib.crc32(name.encode()), 3]), 3, kind.planar, kind.irons)
                kind.change(s)
                tables.append(s.table())
            total = s.signal(tables[0][0])
            if kind.listed == "null":
                self.assertEqual(total, 0, name)
                self.assertFalse(s.names + s.guilty + s.place, name)
            else:
                self.assertGreater(total, 1, name)
                self.assertTrue(s.names + s.guilty + s.place, name)
            for k in tables[0][1]:  # the same seed, the same set
                np.testing.assert_array_equal(tables[0][1][k], tables[1][1][k])


def report(verdict, adopted=(), ties=(), columns=(), derived=(), flagged=(), unexplained=()):
    return {"verdict": verdict, "adopted": list(adopted), "ties": [list(t) for t in ties], "rows": {"read": 60},
            "columns": [{"column": c, "finding": "scale"} for c in columns],
            "derived_columns": [{"column": c, "from": f} for c, f in derived],
            "flagged_rows": [{"shot": i, "column": c} for c, n in flagged for i in range(n)],
            "unexplained": [{"channel": "backspin_rpm", "regressor": r, "detail": d} for r, d in unexplained]}


def truth(listed, total=20.0, names=(), guilty=(), place=(), kin=(), acceptable=("insufficient", "unexplained"), family=1):
    return {"listed": listed, "total": total, "names": list(names), "guilty": list(guilty), "place": list(place), "kin": list(kin),
            "acceptable": list(acceptable), "family": family}


class Grades(unittest.TestCase):
    def test_rules(self):
        law, two = truth("library", names=["restitution-law"]), truth("library", names=["loft-bias", "cg-shift"], family=2)
        speed = truth("instrument", guilty=["club_speed"])
        wet = truth("none", place=["mixture", "player"], kin=["friction-limit"])
        null = truth("null", total=0.0, acceptable=("insufficient",))
        for expected, r, t in [
            ("wrong", None, law),
            ("right", report("explained", ["restitution-law"]), law),
            ("wrong", report("explained", ["restitution-law", "cg-shift"]), law),
            ("wrong", report("explained", ["head-mass"]), law),
            ("acceptable", report("ambiguous", ties=[["head-mass", "restitution-law"]]), law),
            ("wrong", report("ambiguous", ties=[["head-mass", "cg-shift"]]), law),
            ("wrong", report("ambiguous", ["restitution-law"], [["head-mass", "cg-shift"]]), law),
            ("acceptable", report("insufficient"), law),
            ("wrong", report("no-residual"), law),
            ("acceptable", report("no-residual"), {**law, "total": 4.9}),
            ("wrong", report("unexplained", columns=["impact_toe_mm"]), law),
            ("right", report("explained", ["loft-bias", "cg-shift"]), two),
            ("acceptable", report("explained", ["cg-shift"]), two),
            ("right", report("unexplained", ["cg-shift"], columns=["dynamic_loft_deg"]), two),
            ("wrong", report("explained", ["restitution-law", "head-mass"]), {**law, "kin": ["head-mass"]}),
            ("right", report("unexplained", ["restitution-law", "head-mass"]), {**law, "kin": ["head-mass"]}),
            ("right", report("unexplained", columns=["club_speed_mph"]), speed),
            ("right", report("no-residual", flagged=[("club_speed_mph", 9)]), speed),
            ("wrong", report("no-residual", flagged=[("club_speed_mph", 3)]), speed),
            ("wrong", report("unexplained", flagged=[("impact_toe_mm", 9)]), speed),
            ("right", report("unexplained", derived=[("launch_angle_deg", ["club_speed_mph"])]), speed),
            ("wrong", report("unexplained", derived=[("launch_angle_deg", ["attack_angle_deg"])]), speed),
            ("wrong", report("explained", ["restitution-law"], columns=["club_speed_mph"]), speed),
            ("right", report("unexplained", unexplained=[("player", "")]), wet),
            ("right", report("unexplained", unexplained=[("", "a mixture of two")]), wet),
            ("acceptable", report("unexplained", ["friction-limit"], unexplained=[("shot", "")]), wet),
            ("wrong", report("explained", ["friction-limit"]), wet),
            ("right", report("no-residual"), null),
            ("acceptable", report("insufficient"), null),
            ("wrong", report("unexplained"), null),
            ("wrong", report("noise-contradicted"), null),
        ]:
            with self.subTest(report=r, truth=t):
                self.assertEqual(grade.grade(r, t)[0], expected)


class Rivals(unittest.TestCase):
    def test_predict(self):
        """Each finds a square in noise of a tenth of it: held out, it is left with about the noise."""
        r = np.random.default_rng(3)
        x = r.normal(size=(120, 3))
        y = 2 + x[:, 0] - x[:, 1] ** 2 + 0.15 * r.normal(size=120)
        self.assertGreater(y[80:].std(), 1)
        for name, rival in rivals.RIVALS.items():
            left = np.sqrt(np.mean((y[80:] - rival(x[:80], y[:80], x[80:])) ** 2))
            self.assertLess(left, 0.3, name)


if __name__ == "__main__":
    sys.exit(unittest.main())
