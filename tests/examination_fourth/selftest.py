#!/usr/bin/python3
"""Mechanics against the reference values, conservation, bytes of two runs, every truth with the grader."""
import importlib.util
import os
import pathlib
import sys

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy: of small matrices, threads wait for each other
try:
    import numpy as np
except ImportError:
    print("NumPy is not there")
    sys.exit(77)

import physics
from generate import LAYOUTS, make
from kinds import KINDS

EFFECTS = set("""ball-tangential-compliance friction-limit restitution-law restitution-falloff head-rotation head-mass head-inertia
shaft-coupling cg-shift head-closure ball-inertia normal-force-offset loft-bias monitor-misalignment session-drift face-compliance
ball-cover-stiffness ball-relaxation contact-creep""".split())
VERDICTS = {"no-residual", "explained", "ambiguous", "unexplained", "insufficient", "noise-contradicted"}

physics.selftest()
spec = importlib.util.spec_from_file_location(
    "grade", pathlib.Path(__file__).resolve().parent.parent / "examination_open/grade.py")
grade = importlib.util.module_from_spec(spec)
sys.dont_write_bytecode = True
spec.loader.exec_module(grade)
empty = {"rows": {"read": 100}, "columns": [], "derived_columns": [], "flagged_rows": [], "adopted": [], "ties": [], "unexplained": []}
for k in KINDS.values():
    assert set(k.names) | set(k.kin) <= EFFECTS and set(k.acceptable) <= VERDICTS and not set(k.names) & set(k.kin), k.name
    for number in (2, 7):
        s, rec, truth = make(k, number, 3, False)
        s2, rec2, truth2 = make(k, number, 3, False)
        assert truth == truth2 and all(np.array_equal(rec[c], rec2[c]) for c in rec), k.name
        # the perfect answer is right, an absurd one wrong
        if k.listed == "library":
            best = dict(empty, verdict="explained", adopted=list(k.names if k.family == 2 else k.names[:1]))
        elif k.listed == "instrument":
            c = next(c for c in k.guilty if c in rec)
            best = dict(empty, verdict="unexplained", columns=[{"column": c + "_deg", "finding": "offset"}])
        elif k.listed == "none":
            best = dict(empty, verdict="unexplained", unexplained=[{"channel": "x", "regressor": k.place[0], "detail": "mixture"}])
        else:
            best = dict(empty, verdict="no-residual")
        wanted = "acceptable" if k.family == 2 and truth["twins"] else "right"
        assert grade.grade(best, truth)[0] == wanted, (k.name, grade.grade(best, truth))
        assert grade.grade(dict(empty, verdict="explained", adopted=["head-rotation"]), truth)[0] == "wrong", k.name
        if k.listed != "null":
            assert truth["total"] > 5 and grade.grade(dict(empty, verdict="no-residual"), truth)[0] == "wrong", k.name

# Momentum and energy: ball and head after the blow
s, rec, _ = make(KINDS["plain"], 9, 3, True)
b = s.blow(omega=np.random.default_rng(0).normal(0, 20, (s.n, 3)))
for j in (b.stuck(), b.slipping(lambda v: 0.05 + 0 * v)):
    v, spin = physics.vectors(b.launch(j))
    head_v = b.velocity - j / b.head_mass[:, None]
    spin_h = -physics.mat_vec(b.head_inverse, np.cross(b.lever, j))
    after = v + np.cross(spin, b.arm) - (b.velocity_there - j / b.head_mass[:, None] + np.cross(spin_h, b.lever))
    assert np.allclose(physics.dot(after, b.normal), physics.base_restitution(b.w) * b.w, rtol=1e-8)
    assert np.allclose(0.04593 * v + b.head_mass[:, None] * (head_v - b.velocity), 0, atol=1e-12)
    # work of the impulse on the relative motion is lost energy: never a gain
    assert np.all(physics.dot(j, b.u0 + after) <= 1e-12)
print(len(KINDS), "kinds,", len(LAYOUTS), "numbers: in order")
