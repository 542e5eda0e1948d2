#!/usr/bin/python3
"""What the second examination rests on: mechanics of one blow, sets that the seed alone decides, truths that can be graded."""

import pathlib
import sys
import tempfile

try:
    import numpy as np
except ImportError:
    print("SKIPPED: no NumPy")
    sys.exit(77)

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "examination_open")]  # physics and kinds are this folder's own

import generate
import physics
from grade import FAMILIES, grade
from kinds import DEG, KINDS, MORE, RPM

EFFECTS = set("""ball-tangential-compliance friction-limit restitution-law restitution-falloff head-rotation head-mass head-inertia
shaft-coupling cg-shift head-closure ball-inertia normal-force-offset loft-bias monitor-misalignment session-drift face-compliance
ball-cover-stiffness ball-relaxation contact-creep""".split())
VERDICTS = {"no-residual", "explained", "ambiguous", "unexplained", "insufficient", "noise-contradicted"}
HEAD = physics.Head(0.2, np.array([-0.035, 0, 0]), np.diag([3.7e-4, 2.9e-4, 4.8e-4]), 0.3, 0.3)


def near(a, b, tolerance, what):
    error = np.max(np.abs(np.asarray(a) - b))
    assert error <= tolerance, f"{what}: {error:.3g} beyond {tolerance:.3g}"


def blows(n=200):
    """Drawn so that every shot has a place, a direction and a turning head of its own."""
    r = np.random.default_rng(5)
    x = {k: r.normal(m, s, n) for k, (m, s) in {
        "club_speed": (42, 4), "attack_angle": (0, 3 * DEG), "dynamic_loft": (25 * DEG, 8 * DEG), "club_path": (0, 4 * DEG),
        "face_angle": (0, 4 * DEG), "impact_toe": (0, 0.012), "impact_high": (0, 0.008)}.items()}
    return physics.Contact(x, HEAD, physics.Ball(), r.normal(0, 30, (n, 3)))


def momentum(c, q):
    """Of both bodies: linear, then angular about the centre of the face."""
    m = np.einsum("nij,nj->ni", c.masses(), q)
    ball = c.arm_head + HEAD.cg - c.arm_ball
    return np.hstack([m[:, :3] + m[:, 6:9], m[:, 3:6] + m[:, 9:] + np.cross(ball, m[:, :3]) + np.cross(HEAD.cg, m[:, 6:9])])


def mechanics():
    c = blows()
    energy = lambda q: np.einsum("ni,nij,nj->n", q, c.masses(), q) / 2
    for law in ({}, {"friction": 0.12}, {"friction": 0.2, "soft": True}, {"et": 0.4, "offset": 0.05}):
        after, impulse = physics.strike(c, **law)
        near(momentum(c, after), momentum(c, c.before), 1e-9, f"momentum {law}")
        parting = np.einsum("nij,nj->ni", c.gap, after)
        near(parting[:, 0], physics.base_restitution(c) * c.closing, 1e-9, f"restitution {law}")
        assert (energy(after) < energy(c.before)).all(), f"energy {law}"
        if "friction" in law:
            assert (np.hypot(*impulse[:, 1:].T) <= law["friction"] * impulse[:, 0] * (1 + 1e-9)).all(), "Coulomb's limit"
        elif not law.get("offset"):
            near(parting[:, 1:], 0, 1e-9, "sticking")
    near(energy(physics.strike(c, e=1.0, et=1.0)[0]) / energy(c.before), 1, 1e-10, "elastic blow")


def closed_form():
    """A central blow of a head that cannot turn, on a flat face: rigid-planar of frames-and-data.md."""
    n, b = 7, physics.Ball()
    loft, attack, v = np.linspace(8, 45, n) * DEG, np.linspace(-5, 4, n) * DEG, np.linspace(50, 30, n)
    zero = np.zeros(n)
    x = {"club_speed": v, "attack_angle": attack, "dynamic_loft": loft, "club_path": zero, "face_angle": zero, "impact_toe": zero,
         "impact_high": zero}
    got = physics.base(x, physics.Head(0.25, np.array([-0.02, 0.0, 0.0]), np.eye(3) * 1e6))
    a = loft - attack
    normal = v * np.cos(a) * (1.86 - 0.0029 * v * np.cos(a)) / (1 + b.mass / 0.25)
    along = v * np.sin(a) / (1 + b.mass / 0.25 + 1 / 0.4)
    near(got["ball_speed"], np.hypot(normal, along), 1e-6, "ball speed")
    near(got["launch_angle"], loft - np.arctan(along / normal), 1e-7, "launch angle")
    near(got["backspin"], along / (0.4 * b.radius), 1e-4, "spin")
    near([got["azimuth"], got["sidespin"]], 0, 1e-9, "plane")


def published():
    """One row of the reference values of rigid-eccentric: frames and signs."""
    row = {"club_speed": 42.0, "attack_angle": -3 * DEG, "club_path": -3 * DEG, "face_angle": 3 * DEG, "dynamic_loft": 14 * DEG,
           "impact_toe": 0.012, "impact_high": -0.006}
    got = physics.base({k: np.array([v]) for k, v in row.items()}, HEAD)
    for k, unit, value in (("ball_speed", 1, 56.1572111), ("launch_angle", DEG, 9.4649126), ("azimuth", DEG, 4.2558819),
                           ("backspin", RPM, 3709.46885), ("sidespin", RPM, 1152.83596)):
        near(got[k] / unit, value, 1e-5, k)


def attached_part():
    """A point fixed to the head gives the mass matrix of the two bodies as one."""
    lever = np.array([0.01, 0.04, 0.02])
    m = physics.attached(0.05 * np.eye(3), np.zeros((3, 3)), lever)
    twist = np.array([1.0, 2, 3, 4, 5, 6])
    v = twist[:3] + np.cross(twist[3:], lever)
    near(twist @ m @ twist / 2, 0.025 * v @ v, 1e-12, "energy of an attached point")


def answer(truth):
    """The report that is right."""
    r = {"verdict": "explained", "adopted": truth["names"], "ties": [], "columns": [], "unexplained": [],
         "rows": {"read": truth["shots"]}}
    if truth["listed"] == "instrument":
        return {**r, "verdict": "unexplained", "adopted": [],
                "columns": [{"column": truth["guilty"][0] + "_deg", "finding": "scale"}]}
    if truth["listed"] == "none":
        return {**r, "verdict": "unexplained", "adopted": [], "unexplained": [{"regressor": truth["place"][0], "detail": ""}]}
    return {**r, "verdict": "no-residual", "adopted": []} if truth["listed"] == "null" else r


def truths():
    counts = dict.fromkeys(FAMILIES, 0)
    for name, k in (KINDS | MORE).items():
        counts[k.family] += 1
        assert k.listed == {1: "library", 2: "library", 3: "instrument", 4: "none", 5: "null"}[k.family], name
        assert set(k.names) | set(k.kin) <= EFFECTS and not set(k.names) & set(k.kin) or k.family == 2, name
        assert set(k.acceptable) <= VERDICTS, name
        assert set(k.guilty) <= {*generate.NOISE, *generate.INPUT_NOISE}, name
        assert (len(k.names) > 1) == (k.family == 2) and bool(k.place) == (k.family == 4), name
        s, _ = generate.make(3, name, 1)
        exact, noisy = s.tables()
        assert all(np.isfinite(noisy[c]).all() and len(noisy[c]) == s.n for c in (*physics.INPUTS, *s.channels)), name
        total = s.signal(exact)
        assert total < 1e-6 if k.family == 5 else total > 1, (name, total)
        truth = {**{f: getattr(k, f) for f in ("family", "listed", "names", "kin", "guilty", "place", "acceptable")},
                 "total": total, "shots": s.n}
        assert grade(answer(truth), truth)[0] == "right", name
        assert np.linalg.eigvalsh(s.head.inertia).min() > 0, name
    assert len(KINDS) == 45 and len(MORE) == 25 and not set(KINDS) & set(MORE), counts  # a run without --more has the 45


def seeds():
    with tempfile.TemporaryDirectory() as folder:
        f = pathlib.Path(folder)

        def text(seed, run):
            generate.write(f / run, f / "truth", "holes-4", *generate.make(seed, "holes", 4), False)
            return "".join(p.read_text() for p in (f / run / "shots.csv", f / run / "case.toml", f / "truth" / "holes-4.json"))
        assert text(1, "a") == text(1, "b") != text(2, "c"), "the seed decides"


for test in (mechanics, closed_form, published, attached_part, truths, seeds):
    test()
    print("ok", test.__name__)
