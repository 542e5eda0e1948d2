"""The kinds of sets. A kind is a function of a Session (generate.py); its truth stands in the decorator and in what it appends:

listed      library (an effect of the loop's list), instrument (a column or rows are wrong), none (in no list), null
s.names     effects of the list that are truly there (the loop's names)
kin         names that hold a part of the truth: acceptable beside `unexplained`, `insufficient` or in a tie, else wrong
s.guilty    columns that are wrong
s.place     regressors, or `mixture`, that locate what is in no list
acceptable  verdicts that are no error here, beside the right one
"""

import dataclasses
import typing

import numpy as np

import physics

DEG = np.pi / 180
RPM = np.pi / 30
WEAK = ("insufficient", "unexplained")  # true of every kind: something was seen, nothing false was said
DOUBT = WEAK + ("noise-contradicted",)  # where the departure may pass for scatter


@dataclasses.dataclass
class Kind:
    name: str
    family: int
    listed: str
    change: typing.Callable
    about: str
    acceptable: tuple
    kin: tuple
    planar: bool
    irons: bool


KINDS = {}


def kind(family, listed, acceptable=WEAK, kin=(), planar=False, irons=False):
    def register(f):
        name = f.__name__.replace("_", "-")
        KINDS[name] = Kind(name, family, listed, f, " ".join(f.__doc__.split()), acceptable, kin, planar, irons)
        return f
    return register


def also_e(s, change):
    e = s.law["e"]
    s.law["e"] = lambda b: e(b) + change(b)


def turn(t, pitch, yaw, roll):
    """The outputs as an instrument reads them whose axes are turned against the target frame."""
    v = t["ball_speed"][:, None] * np.stack([np.cos(t["launch_angle"]) * np.cos(t["azimuth"]),
                                            -np.cos(t["launch_angle"]) * np.sin(t["azimuth"]), np.sin(t["launch_angle"])], -1)
    spin = np.stack([0 * t["backspin"], -t["backspin"], -t["sidespin"]], -1)
    (cp, sp), (cy, sy), (cr, sr) = ((np.cos(q), np.sin(q)) for q in (pitch, yaw, roll))
    m = (np.array([[cy, sy, 0], [-sy, cy, 0], [0, 0, 1]]) @ np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
         @ np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]]))
    v, spin = v @ m.T, spin @ m.T
    t["launch_angle"], t["azimuth"] = np.arcsin(v[:, 2] / t["ball_speed"]), np.arctan2(-v[:, 1], v[:, 0])
    t["backspin"], t["sidespin"] = -spin[:, 1], -spin[:, 2]


# 1. One effect of the library, in a form that the library need not code.


@kind(1, "library")
def restitution_form(s):
    """Restitution falls with speed as a power, in a step, or levels off."""
    s.names += ["restitution-law"]
    middle = np.median(physics.Blow(s.x, s.head).approach)
    form, a = s.number % 3, s.size(0.012, 0.04)
    if form == 0:
        s.law["e"] = lambda b: (0.86 - 0.0029 * middle) * (middle / b.approach) ** (0.15 + 10 * a)
    elif form == 1:
        also_e(s, lambda b: -a * (b.approach > middle))
    else:
        s.law["e"] = lambda b: 0.86 - 0.0029 * np.minimum(b.approach, middle) + a


@kind(1, "library")
def tangential_angle(s):
    """Tangential restitution that grows with the angle of the blow: that of a patch which slips and sticks (compliant)."""
    s.names += ["ball-tangential-compliance"]
    share = s.size(0.06, 0.5)

    def et(b):
        J, _ = physics.compliant(b, s.law["e"](b), 0.5, 0.35, 0.05, steps=1000)
        w = b.w - physics.times(b.k, J)
        back = -physics.dot(w, b.slip) / np.maximum(b.slip_speed, 1) ** 2
        return share * np.clip(back, 0, 0.7)
    s.law["et"] = et


@kind(1, "library", kin=("head-inertia",))
def gear_arm(s):
    """The gear effect has a longer arm than declared, the more so off the centre."""
    s.names += ["cg-shift"]
    a = s.size(0.006, 0.02)
    cg = np.tile(s.head.cg, (s.n, 1))
    cg[:, 0] -= a * (1 + (s.x["impact_toe"] / 0.015) ** 2) / 2
    s.head = physics.Head(s.head.mass, cg, s.head.inertia, s.head.bulge, s.head.roll)


@kind(1, "library", planar=True)
def head_rotation(s):
    """The head turns about its centre of gravity, which the planar base denies."""
    s.names += ["head-rotation"]
    q = s.size(0.4, 1.2)
    s.head = physics.Head(s.head.mass, [-0.036, 0, 0.003], np.diag([2.7e-4, 2.9e-4, 4.7e-4]) / q)


@kind(1, "library", irons=True)
def friction_speed(s):
    """Friction falls with the slip speed: high lofts slide throughout."""
    s.names += ["friction-limit"]
    s.x["dynamic_loft"] += 22 * DEG
    s.delivered = dict(s.x)
    a = s.size(0.40, 0.33)
    s.law["mu"] = lambda b: np.maximum(a - 0.004 * b.slip_speed, 0.05)


@kind(1, "library")
def soft_side(s):
    """The face gives more back on the heel's side, less on the toe's: linear."""
    s.names += ["restitution-falloff", "face-compliance"]
    a = s.size(0.015, 0.05)
    also_e(s, lambda b: -a * b.toe / 0.02)


@kind(1, "library")
def cone_falloff(s):
    """Restitution falls in proportion to the distance from the face centre."""
    s.names += ["restitution-falloff", "face-compliance"]
    a = s.size(0.015, 0.05)
    also_e(s, lambda b: -a * b.distance / 0.02)


@kind(1, "library", kin=("restitution-law", "restitution-falloff"))
def yielding_face(s):
    """Restitution is raised round the centre as a bell over the face."""
    s.names += ["face-compliance"]
    a = s.size(0.015, 0.05)
    also_e(s, lambda b: a * np.exp(-((b.toe / 0.022) ** 2) - (b.high / 0.014) ** 2))


@kind(1, "library")
def closure_speed(s):
    """The head closes at a rate that grows with the club speed squared."""
    s.names += ["head-closure"]
    v = s.x["club_speed"]
    s.omega = np.stack([0 * v, 0 * v, s.size(10, 40) * (v / v.mean()) ** 2], -1)


@kind(1, "library")
def stiff_head(s):
    """The club behind the head resists its turn about the vertical and adds a little mass."""
    s.names += ["head-inertia", "head-mass", "shaft-coupling"]
    h = s.head
    s.head = physics.Head(h.mass + 0.004, h.cg, h.inertia * np.diag([1, 1, 1 + s.size(0.3, 1.0)]), h.bulge, h.roll)


# 2. Several at once.


@kind(2, "library", kin=("face-compliance",))
def spin_and_falloff(s):
    """Tangential restitution and a conical fall of the normal one."""
    s.names += ["ball-tangential-compliance", "restitution-falloff"]
    et, a = s.size(0.02, 0.08), s.size(0.015, 0.05)
    s.law["et"] = lambda b: et
    also_e(s, lambda b: -a * b.distance / 0.02)


@kind(2, "library")
def loft_large_spin_small(s):
    """The recorded loft is too large in proportion, and the ball gives a little tangential energy back."""
    s.names += ["loft-bias", "ball-tangential-compliance"]
    s.delivered["dynamic_loft"] = s.x["dynamic_loft"] * (1 - s.size(0.03, 0.08))
    s.law["et"] = lambda b: 0.02


@kind(2, "library")
def monitor_and_step(s):
    """A turned monitor, and restitution lower above the median speed."""
    s.names += ["monitor-misalignment", "restitution-law"]
    a, b_ = s.size(0.3, 1.0) * DEG, s.size(0.012, 0.035)
    middle = np.median(physics.Blow(s.x, s.head).approach)
    also_e(s, lambda b: -b_ * (b.approach > middle))
    s.seen.append(lambda t: turn(t, 0.6 * a, a, 0))


@kind(2, "library", kin=("restitution-law",))
def three_ordinary(s):
    """Loft recorded too small, monitor turned about the vertical, head lighter than declared."""
    s.names += ["loft-bias", "monitor-misalignment", "head-mass"]
    a = s.size(0.35, 1.0)
    s.delivered["dynamic_loft"] = s.x["dynamic_loft"] + 1.2 * a * DEG
    h = s.head
    s.head = physics.Head(h.mass - 0.02 * a, h.cg, h.inertia, h.bulge, h.roll)
    s.seen.append(lambda t: turn(t, 0, a * DEG, 0))


@kind(2, "library", kin=("face-compliance", "session-drift"))
def another_ball(s):
    """The ball gives tangential energy back and is less lively, and the recorded loft is too small."""
    s.names += ["ball-tangential-compliance", "restitution-law", "loft-bias"]
    s.law["et"] = lambda b: 0.18
    also_e(s, lambda b: -0.02)
    s.delivered["dynamic_loft"] = s.x["dynamic_loft"] + 1.5 * DEG
    s.declare = s.number // 2 % 2 == 0


# 3. Instruments.


@kind(3, "library")
def radar_turned(s):
    """The radar is pitched, yawed and rolled."""
    s.names += ["monitor-misalignment"]
    a = s.size(0.3, 1.0) * DEG * s.rng.choice([-1, 1], 3)
    s.seen.append(lambda t: turn(t, *a))


@kind(3, "instrument", DOUBT)
def spin_model(s):
    """The backspin of 40 to 70 % of the rows is computed from ball speed and launch angle."""
    s.guilty += ["backspin"]
    share = s.rng.uniform(0.4, 0.7)

    def model(t):
        rows = s.rng.random(s.n) < share
        x = np.stack([np.ones(s.n), t["ball_speed"] * t["launch_angle"]], -1)
        t["backspin"][rows] = (x @ np.linalg.lstsq(x, t["backspin"], rcond=None)[0])[rows]
    s.seen.append(model)


@kind(3, "instrument", DOUBT)
def fast_club(s):
    """The club speed of the fastest 40 % is read too high by a factor."""
    s.guilty += ["club_speed"]
    a = s.size(0.012, 0.04)

    def change(t):
        v = t["club_speed"]
        v[v > np.quantile(v, 0.6)] *= 1 + a
    s.seen.append(change)


@kind(3, "instrument", DOUBT)
def delay(s):
    """Loft (attack angle) is that of the shot before."""
    column = "dynamic_loft" if s.number // 2 % 2 == 0 else "attack_angle"
    s.guilty += [column]

    def change(t):
        t[column][1:] = t[column][:-1].copy()
    s.seen.append(change)


@kind(3, "library")
def settling(s):
    """The ball speed reads ever higher and settles within the session."""
    s.names += ["session-drift"]
    a = s.size(0.5, 1.5)
    s.seen.append(lambda t: t.update(ball_speed=t["ball_speed"] + a * (1 - np.exp(-5 * np.arange(s.n) / s.n))))


@kind(3, "instrument", DOUBT)
def formula_column(s):
    """Loft from launch angle and attack angle, or face angle from azimuth and path: a plain formula on all rows."""
    s.guilty += ["dynamic_loft" if s.number % 2 == 0 else "face_angle"]

    def change(t):
        if s.number % 2 == 0:
            t["dynamic_loft"] = 1.18 * t["launch_angle"] - 0.12 * t["attack_angle"] + 0.5 * DEG
        else:
            t["face_angle"] = 1.14 * t["azimuth"] - 0.14 * t["club_path"]
    s.seen.append(change)


@kind(3, "instrument", DOUBT)
def expression_tree(s):
    """One input is a random expression of other columns, on 40 to 100 % of the rows."""
    column = s.rng.choice(["club_speed", "attack_angle", "dynamic_loft", "face_angle", "impact_high"])
    s.guilty += [str(column)]
    share, seed = s.rng.uniform(0.4, 1.0), s.rng.integers(1 << 31)

    def change(t):
        r = np.random.default_rng(seed)
        others = [k for k in t if k != column]
        scaled = lambda v: (v - v.mean()) / v.std()

        def tree(depth):
            if depth == 0:
                return scaled(t[r.choice(others)])
            a, b = tree(depth - 1), tree(depth - 1)
            return [a + b, a - 0.5 * b, a * b, np.tanh(a) + b, np.sqrt(1 + a * a) - b][r.integers(5)]
        v = tree(2)
        rows = r.random(s.n) < share
        t[column] = np.where(rows, t[column].mean() + t[column].std() * scaled(v), t[column])
    s.seen.append(change)


@kind(3, "instrument", DOUBT)
def swapped(s):
    """Two columns stand under each other's name: the place of impact, or path and face angle."""
    a, b = ("impact_toe", "impact_high") if s.number % 2 == 0 else ("club_path", "face_angle")
    s.guilty += [a, b]
    s.seen.append(lambda t: t.update({a: t[b], b: t[a]}))


@kind(3, "instrument")
def player_unit(s):
    """One player's club speed stands there in another unit than the header says."""
    s.guilty += ["club_speed"]
    s.clusters = True
    s.players = np.arange(s.n) * 4 // s.n
    factor = 0.44704 if s.number % 2 == 0 else 1 / 1.609344
    rows = s.players == 2
    s.seen.append(lambda t: t.update(club_speed=np.where(rows, t["club_speed"] * factor, t["club_speed"])))


@kind(3, "instrument", DOUBT)
def slips(s):
    """Fifteen rows in a hundred slipped in one column, by 8 to 15 of its noise units, up or down."""
    column = ["club_speed", "dynamic_loft", "face_angle"][s.number % 3]
    s.guilty += [column]
    sd = {"club_speed": 0.25, "dynamic_loft": 0.3 * DEG, "face_angle": 0.3 * DEG}[column]

    def change(t):
        rows = s.rng.random(s.n) < 0.15
        t[column] = t[column] + rows * s.rng.choice([-1, 1], s.n) * s.rng.uniform(8, 15, s.n) * sd
    s.seen.append(change)


@kind(3, "null", ("insufficient", "noise-contradicted"))
def coarse(s):
    """Coarse rounding and a tenth of the cells empty; nothing else."""
    s.rounding = {"dynamic_loft": 0.5, "backspin": 100, "sidespin": 50, "impact_toe": 2, "impact_high": 2}

    def change(t):
        for k in ("impact_toe", "attack_angle", "backspin", "launch_angle"):
            t[k] = np.where(s.rng.random(s.n) < 0.1, np.nan, t[k])
    s.seen.append(change)


# 4. In no list.


@kind(4, "none", DOUBT)
def temperature(s):
    """Restitution follows the temperature, which rises and falls; half of the sets record it."""
    T = 18 + 8 * np.sin(2 * np.pi * (1.5 * np.arange(s.n) / s.n + s.rng.random()))
    a = s.size(0.012, 0.04)
    also_e(s, lambda b: a * (T - T.mean()) / 8)
    s.place += ["shot", "session"]
    if s.number % 2 == 0:
        s.columns["temperature_c"] = [f"{v:.1f}" for v in T]
        s.place += ["temperature_c"]


@kind(4, "none", DOUBT, kin=("friction-limit",), irons=True)
def wet_face(s):
    """Three shots in ten meet a wet face, on which they slide."""
    s.x["dynamic_loft"] += 10 * DEG
    s.delivered = dict(s.x)
    wet = s.rng.random(s.n) < 0.3
    a = s.size(0.13, 0.08)
    s.law["mu"] = lambda b: np.where(wet, a, np.inf)
    s.place += ["mixture", "dynamic_loft"]


@kind(4, "none", DOUBT, kin=("ball-tangential-compliance", "restitution-law"))
def two_balls(s):
    """Half of the shots are of another ball: more spin, less restitution; no column says which."""
    other = s.rng.random(s.n) < 0.5
    a = s.size(0.03, 0.12)
    s.law["et"] = lambda b: a * other
    also_e(s, lambda b: -0.3 * a * other)
    s.place += ["mixture"]


@kind(4, "none", DOUBT)
def draught(s):
    """The azimuth wanders with a draught that neighbouring shots share."""
    a, w = s.size(0.3, 1.0) * DEG, np.zeros(s.n)
    for i in range(1, s.n):
        w[i] = 0.9 * w[i - 1] + 0.44 * s.rng.normal()
    w -= w.mean()
    s.seen.append(lambda t: t.update(azimuth=t["azimuth"] + a * w))
    s.place += ["shot", "session"]


@kind(4, "none", DOUBT, kin=("restitution-law", "restitution-falloff"))
def cracked_face(s):
    """The face cracks in the middle of the session: less restitution, most off the centre."""
    late = np.arange(s.n) >= s.n // 2
    a = s.size(0.012, 0.04)
    also_e(s, lambda b: -a * late * (1 + (b.distance / 0.01) ** 2) / 2)
    s.place += ["shot", "session"]


@kind(4, "none", DOUBT, kin=("loft-bias",))
def player_shaft(s):
    """Each player's shaft delivers a loft that differs from the record by a constant of his own, zero in the mean."""
    s.clusters = True
    s.players = s.rng.integers(0, 4, s.n)
    own = np.array([-1.2, -0.4, 0.4, 1.2])[s.players] * s.size(0.5, 1.5) * DEG
    s.delivered["dynamic_loft"] = s.x["dynamic_loft"] + own - own.mean()
    s.place += ["player"]


# 5. Nothing but noise.


@kind(5, "null", ("insufficient",))
def null_declared(s):
    """Gaussian noise, declared."""


@kind(5, "null", ("insufficient",))
def null_undeclared(s):
    """Gaussian noise, not declared."""
    s.declare = False


@kind(5, "null", ("insufficient", "noise-contradicted"))
def null_heavy(s):
    """Noise of Student's t with 3 degrees of freedom, of the declared standard deviation."""
    s.scatter = lambda k, n: s.rng.standard_t(3, n) / np.sqrt(3)
    s.declare = s.number % 2 == 0


@kind(5, "null", DOUBT)
def null_clustered(s):
    """Three tenths of the noise's variance is shared by the shots of a player: structure by player is a true finding."""
    s.clusters = True
    s.players = s.rng.integers(0, 4, s.n)
    s.scatter = lambda k, n: np.sqrt(0.7) * s.rng.normal(0, 1, n) + np.sqrt(0.3) * s.rng.normal(0, 1, 4)[s.players]
