#!/usr/bin/python3
"""What the examination of flights rests on: its integration, that each kind of set departs as its truth says, the grader's rules.
Some ten seconds."""

import sys
import unittest

try:
    import numpy as np
except ImportError:
    print("SKIPPED: no NumPy (python3-numpy)")
    sys.exit(77)

import flights
import generate
import grade
import reach


def one(nature, up=0.2, tilt=0.1, wind=(0.0, 0.0), dt=0.02, **more):
    v = 73 * np.array([[np.cos(up), 0, np.sin(up)]])
    w = 280 * np.array([[0, -np.cos(tilt), -np.sin(tilt)]])
    zero = np.zeros(1)
    ends, points = flights.fly(v, w, zero + wind[0], zero + wind[1], zero, zero, nature, dt=dt, **more)
    return ends[0], points[0]


class Flights(unittest.TestCase):
    def test_parabola(self):
        """Where nothing but weight acts: closed form."""
        nature = flights.Nature("libgolf")
        nature.drag = nature.lift = -1
        (carry, side, apex, time, angle), points = one(nature, instants=(1.0,))
        g, up = flights.GRAVITY, 0.2
        self.assertGreater(carry, 100)
        fall = 73 * np.sin(up)
        np.testing.assert_allclose([carry, side, apex, time, angle],
                                   [2 * fall * 73 * np.cos(up) / g, 0, fall**2 / (2 * g), 2 * fall / g, up], rtol=1e-9, atol=1e-12)
        np.testing.assert_allclose(points[0], [73 * np.cos(up), 0, fall - g / 2], atol=1e-9)

    def test_steps(self):
        """Kinks of a law within a step cost its order; a millimetre is a thousandth of the sets' noise."""
        for law in flights.LAWS:
            a, b = (one(flights.Nature(law), wind=(2.0, -1.0), dt=dt)[0] for dt in (0.01, 0.005))
            self.assertGreater(b[0], 200)
            np.testing.assert_allclose(a, b, rtol=0, atol=1e-3)

    def test_signs(self):
        """A tilt to the right curves to the right; the wind to the right carries there; more drag is shorter."""
        calm = one(flights.Nature("ferguson-2022"), tilt=0.0)[0]
        self.assertAlmostEqual(calm[1], 0, places=12)
        self.assertGreater(one(flights.Nature("ferguson-2022"), tilt=0.1)[0][1], 3)
        self.assertGreater(one(flights.Nature("ferguson-2022"), tilt=0.0, wind=(0.0, 3.0))[0][1], 3)
        for change, longer in (("drag", -1), ("lift", 1), ("density", -1)):
            nature = flights.Nature("ferguson-2022")
            setattr(nature, change, 0.05)
            self.assertGreater(longer * (one(nature, tilt=0.0)[0][0] - calm[0]), 0.5, change)


class Sets(unittest.TestCase):
    def test_departures(self):
        """Every kind moves some reading by its noise or more on average over the set, and noise alone moves none."""
        for kind, (change, right, _) in generate.KINDS.items():
            ends = []
            for changed in (False, True):
                rng = np.random.default_rng(3)
                s = generate.Session(rng, 0, kind)
                if changed:
                    change(s.nature, np.random.default_rng(4))
                s.rng = np.random.default_rng(5)
                ends.append(s.fly()[0])
            moved = np.abs((ends[1] - ends[0]).mean(0)) / [1.5, 1.5, 0.4, 0.04, 0.7 * generate.DEG]
            self.assertEqual(right is None, moved.max() < 1e-12, kind)
            if right and not kind.endswith("-form"):
                self.assertGreater(moved.max(), 0.8, kind)


class Reach(unittest.TestCase):
    def test_grows_with_the_square(self):
        """Nothing undeclared is worth nothing; twice a small effect four times as much; an unknown wind takes from it."""
        def worth(axis, wind):
            s = generate.Session(np.random.default_rng(1), 0, "spin-axis-bias")
            few = slice(0, 60, 10)  # six drives on five holes
            s.n = 6
            for name in ("hole", "speed", "up", "azimuth", "spin", "tilt", "along", "right"):
                setattr(s, name, getattr(s, name)[few])
            s.nature.axis, s.wind = axis, wind
            return reach.reach(s)

        self.assertEqual(worth(0.0, 1.5), 0)
        small = worth(0.002, 1.5)
        self.assertGreater(small, 0)
        self.assertAlmostEqual(worth(0.004, 1.5) / small, 4, delta=0.05)
        self.assertGreater(worth(0.002, 0.01), 1.5 * small)


class Grades(unittest.TestCase):
    def test_rules(self):
        def report(verdict, adopted=(), ties=()):
            return {"verdict": verdict, "adopted": list(adopted), "ties": [list(t) for t in ties]}

        drag, null = {"right": "drag-level", "form": False}, {"right": None, "form": False}
        form = {"right": "drag-level", "form": True}
        for answer, truth, wanted in (
                (report("explained", ["drag-level"]), drag, "alone"),
                (report("ambiguous", [], [["air-density", "drag-level"]]), drag, "tied"),
                (report("ambiguous", [], [["air-density", "lift-law"]]), drag, "wrong"),
                (report("explained", ["drag-level", "wind"]), drag, "wrong"),
                (report("explained", ["wind"]), drag, "wrong"),
                (report("no-residual"), drag, "nothing"),
                (report("unexplained"), drag, "nothing"),
                (report("unexplained"), form, "answered"),
                (report("no-residual"), null, "clean"),
                (report("unexplained"), null, "wrong"),
                (None, drag, "wrong")):
            self.assertEqual(grade.grade(answer, truth), wanted)


if __name__ == "__main__":
    unittest.main()
