"""The kinds: what is planted, and what an honest answer may say. Written before any verdict was seen."""

import dataclasses
import typing

import numpy as np

import physics
from physics import turn

SPIN = ["ball-tangential-compliance", "ball-inertia", "normal-force-offset", "contact-creep", "friction-limit", "ball-relaxation"]
SPEED = ["restitution-law", "head-mass", "face-compliance", "shaft-coupling", "ball-cover-stiffness"]
GEAR = ["cg-shift", "head-inertia", "head-rotation", "shaft-coupling", "head-closure"]
AXES = ["monitor-misalignment", "head-closure", "cg-shift", "shaft-coupling"]
EDGE = ["restitution-falloff", "face-compliance"]
ALL = ("driver", "iron", "bag", "wedge")


@dataclasses.dataclass
class Kind:
    name: str
    family: int  # 1 one effect, 2 several, 3 instruments, 4 in no list, 5 noise alone
    plant: typing.Callable
    names: list = dataclasses.field(default_factory=list)
    kin: list = dataclasses.field(default_factory=list)
    guilty: list = dataclasses.field(default_factory=list)
    place: list = dataclasses.field(default_factory=list)
    acceptable: tuple = ()
    clubs: tuple = ALL
    columns: tuple = ()
    form: str = ""
    number: int = 0
    listed = property(lambda k: {1: "library", 2: "library", 3: "instrument", 4: "none", 5: "null"}[k.family])


KINDS = {}


def kind(family, **options):
    def add(plant):
        k = Kind(plant.__name__.replace("_", "-"), family, plant, number=len(KINDS) + 1, **options)
        k.kin = sorted(set(k.kin) - set(k.names))
        KINDS[k.name] = k
        return plant
    return add


def miss(x, flat=1.4):
    return np.hypot(x["impact_toe"], flat * x["impact_high"])


def add_restitution(s, change):
    """change(vn, x) is added to the law that holds so far."""
    law = s.real.restitution
    s.real.restitution = lambda vn, x: law(vn, x) + change(vn, x)


def wet(s, share, rows=True):
    """Friction that falls with the speed of sliding, such that this share of the shots would slide."""
    b = physics.blow(s.x, s.real)["_"]
    normal = physics.dot(b["J"], b["normal"])
    needed = (np.linalg.norm(b["J"] - normal * b["normal"], axis=-1) / normal[:, 0])
    fall = lambda vt: 1 / (1 + vt / 40)
    vt = s.x["club_speed"] * np.sin(np.radians(s.x["dynamic_loft"] - s.x["attack_angle"]))
    mu = np.quantile(needed / fall(vt), 1 - share)
    s.real.friction = lambda v, x: np.where(rows, mu * fall(v), np.inf)


def some(s, share):
    return s.rng.permutation(s.n) < share * s.n


def batch(s, share):
    """Consecutive rows."""
    start = s.rng.uniform(0, 1 - share)
    return (s.t >= start) & (s.t < start + share)


def heel_cg(s, mm):
    s.real.cg = np.asarray(s.real.cg) + np.array([0, mm, -0.4 * mm]) / 1e3


def release(s, rate):
    """About a shaft with a lie of 58 deg; rate in rad/s at 45 m/s, one or one a shot."""
    axis = np.array([0, np.cos(np.radians(58)), np.sin(np.radians(58))])
    s.real.omega = (rate * s.x["club_speed"] / 45)[:, None] * axis


def scale_drift(s, loss, power):
    def read(x, out):
        out["ball_speed"] *= 1 - loss * s.t**power
    s.reads.append(read)


# One effect in a form of its own -------------------------------------------------------------------------------------

@kind(1, names=["restitution-law"], kin=SPEED + EDGE, acceptable=("unexplained",))
def power_law_restitution(s):  # of a viscous contact, against the base's straight line
    add_restitution(s, lambda vn, x: s.size * (0.78 * (vn / 40) ** -0.12 - physics.linear_law(vn, x)))


@kind(1, names=["ball-tangential-compliance"], kin=SPIN + ["loft-bias"], acceptable=("unexplained",))
def obliquity_spin(s):  # elastic shear is returned at small obliquity and spent in slip at large
    s.real.tangential = lambda vn, vt, x: 0.22 * s.size * np.exp(-((vt / vn / 0.7) ** 2))


@kind(1, names=["friction-limit"], kin=SPIN + ["loft-bias"], acceptable=("unexplained",), clubs=("wedge", "iron", "bag"))
def wet_face(s):
    wet(s, 0.3 + 0.3 * s.size)


@kind(1, names=EDGE, kin=["restitution-law"] + GEAR, acceptable=("unexplained",), clubs=("driver", "iron", "bag"))
def plateau_falloff(s):  # nothing is lost within 7 mm
    add_restitution(s, lambda vn, x: -0.05 * s.size * (np.maximum(miss(x) - 7, 0) / 10) ** 1.5)


@kind(1, names=EDGE + ["restitution-law"], kin=SPEED, acceptable=("unexplained",), clubs=("driver", "iron"))
def trampoline(s):  # a bell-shaped gain
    add_restitution(s, lambda vn, x: 0.04 * s.size * np.exp(-((miss(x, 1.2) / 20) ** 2)))


@kind(1, names=["shaft-coupling", "head-mass", "cg-shift", "head-inertia"], kin=SPEED + GEAR + ["ball-tangential-compliance"],
      acceptable=("unexplained",))
def hosel_mass(s):  # the shaft's tip as a point mass on the hosel
    h = s.head
    extra, at = 0.016 * s.size, np.array([-0.012, 0.05, 0.025])
    mass = np.broadcast_to(h.mass, (s.n,))[:, None]
    between = at - np.asarray(h.cg)
    s.real.mass = mass[:, 0] + extra
    s.real.cg = np.asarray(h.cg) + between * extra / (mass + extra)
    steiner = np.dot(between, between) * np.eye(3) - np.outer(between, between)
    s.real.inertia = h.inertia + (mass * extra / (mass + extra))[:, :, None] * steiner


@kind(1, names=["head-closure"], kin=AXES + ["normal-force-offset", "head-inertia"], acceptable=("unexplained",), clubs=("driver", "iron"))
def release_with_speed(s):  # a fast swing closes faster
    release(s, (26 if s.club == "driver" else 45) * s.size)


@kind(1, names=["head-closure", "session-drift"], kin=AXES, acceptable=("unexplained",), clubs=("driver",), place=["shot"])
def tired_release(s):  # the hands slow down through the session
    release(s, 45 * s.size * (1 - 0.8 * s.t))


@kind(1, names=["cg-shift"], kin=GEAR + SPIN + ["loft-bias", "monitor-misalignment"], acceptable=("unexplained",), clubs=("driver", "iron"))
def cg_by_wrong_lie(s):  # measured from the hosel in a frame that is turned by a few degrees
    hosel = np.array([0.0, 0.05, 0.02])
    s.real.cg = hosel + physics.apply(turn("x", 4.5 * s.size)[0], np.asarray(s.head.cg) - hosel)


@kind(1, names=["loft-bias"], kin=SPIN + ["monitor-misalignment", "cg-shift"], acceptable=("unexplained",))
def droop_loft(s):  # the shaft adds loft after the camera has looked, more at speed
    speed = s.x["club_speed"]
    def known(x):
        x["dynamic_loft"] -= s.size * (0.9 + 0.12 * (speed - np.mean(speed)))
    s.known.append(known)


@kind(1, names=["monitor-misalignment"], kin=AXES + ["loft-bias", "normal-force-offset"], acceptable=("unexplained",))
def tilted_unit(s):  # set down on a slope: rolled and yawed
    s.turned = turn("x", 1.6 * s.size) @ turn("z", 0.6 * s.size)


@kind(1, names=["head-mass", "restitution-law", "head-inertia"], kin=SPEED + EDGE + ["ball-inertia", "ball-tangential-compliance"],
      acceptable=("unexplained",))
def floating_ball(s):  # of 43 g
    s.real.ball_mass = 0.04593 - 0.0029 * s.size


@kind(1, names=["session-drift"], kin=["restitution-law"], guilty=["ball_speed"], acceptable=("unexplained",), place=["shot"])
def battery_sag(s):  # the scale of the reading falls faster and faster
    scale_drift(s, 0.02 * s.size, 1.6)


# Several at once ------------------------------------------------------------------------------------------------------

@kind(2, names=["friction-limit", "monitor-misalignment"], kin=SPIN + AXES + ["loft-bias"], acceptable=("unexplained",),
      clubs=("wedge", "bag", "iron"))
def wet_and_turned(s):
    wet(s, 0.3 + 0.3 * s.size)
    s.turned = turn("z", -0.9 * s.size)


@kind(2, names=["restitution-law", "cg-shift"], kin=SPEED + GEAR + SPIN + ["loft-bias", "monitor-misalignment"],
      acceptable=("unexplained",), clubs=("driver", "iron"))
def cold_ball_heel_cg(s):
    add_restitution(s, lambda vn, x: -s.size * (0.018 + 0.0006 * (vn - 35)))
    heel_cg(s, 3.5 * s.size)


@kind(2, names=["ball-tangential-compliance", "restitution-law"], kin=SPIN + SPEED + EDGE + ["loft-bias"], acceptable=("unexplained",))
def old_range_ball(s):
    add_restitution(s, lambda vn, x: -0.022 * s.size * (vn / 35) ** 1.5)
    s.real.tangential = lambda vn, vt, x: 0.14 * s.size + 0 * vn


@kind(2, names=["head-closure", "session-drift"], kin=AXES + ["restitution-law"], guilty=["ball_speed"], acceptable=("unexplained",),
      clubs=("driver",), place=["shot"])
def release_and_battery(s):
    release(s, 26 * s.size)
    scale_drift(s, 0.018 * s.size, 1.0)


@kind(2, names=["ball-tangential-compliance", "restitution-falloff", "monitor-misalignment"],
      kin=SPIN + EDGE + AXES + ["loft-bias", "restitution-law", "head-inertia"], acceptable=("unexplained",), clubs=("driver", "iron"))
def three_at_once(s):
    s.real.tangential = lambda vn, vt, x: 0.15 * s.size + 0 * vn
    add_restitution(s, lambda vn, x: -0.025 * s.size * (miss(x, 1.0) / 12) ** 2)
    s.turned = turn("z", -0.8 * s.size)


# Instruments ----------------------------------------------------------------------------------------------------------

INSTRUMENT = ("unexplained", "noise-contradicted")


@kind(3, guilty=["club_speed"], kin=["restitution-law"], acceptable=INSTRUMENT, clubs=("driver", "iron", "wedge"))
def smoothed_speed(s):  # the display shows the mean of the last four
    def read(x, out):
        v = x["club_speed"].copy()
        x["club_speed"][:] = [np.mean(v[max(0, i - 3):i + 1]) for i in range(s.n)]
    s.reads.append(read)


@kind(3, guilty=["spin_axis"], kin=GEAR, acceptable=INSTRUMENT, clubs=("driver", "iron", "bag"), form="rate")
def axis_from_face_and_path(s):  # not measured at all
    def read(x, out):
        side = np.sin(np.radians(x["face_angle"] - x["club_path"])) / np.sin(np.radians(x["dynamic_loft"] - x["attack_angle"]))
        out["spin_axis"][:] = 0.85 * np.degrees(np.arctan(side))
    s.reads.append(read)


@kind(3, guilty=["club_speed"], kin=["restitution-law", "head-mass"], acceptable=INSTRUMENT)
def club_speed_imputed(s):  # a third of the swings were not seen: ball speed over the usual smash factor
    rows, smash = some(s, 0.33), physics.base(s.x, s.head)["ball_speed"] / s.x["club_speed"]
    usual = np.zeros(s.n)
    for c in np.unique(s.groups.get("club", np.zeros(s.n))):
        on = s.groups.get("club", np.zeros(s.n)) == c
        usual[on] = round(1.02 * np.median(smash[on]), 2)
    def read(x, out):
        x["club_speed"][rows] = (out["ball_speed"] / usual)[rows]
    s.reads.append(read)


@kind(3, guilty=["impact_toe", "impact_high"], acceptable=INSTRUMENT, clubs=("driver", "iron", "wedge"), place=["shot"])
def inches_in_a_batch(s):  # under a header of mm
    rows = batch(s, 0.35)
    def read(x, out):
        for c in ("impact_toe", "impact_high"):
            x[c][rows] /= 25.4
    s.reads.append(read)


@kind(3, guilty=["impact_toe"], acceptable=INSTRUMENT, clubs=("driver", "iron"))
def toe_flipped_by_an_update(s):
    rows = s.t > s.rng.uniform(0.5, 0.65)
    def read(x, out):
        x["impact_toe"][rows] *= -1
    s.reads.append(read)


@kind(3, guilty=["club_speed"], kin=["restitution-law", "head-mass"], acceptable=INSTRUMENT)
def late_trigger(s):  # the window of some readings reaches into the time after the blow
    share = np.where(some(s, 0.2), s.rng.uniform(0.03, 0.1, s.n), 0)
    def read(x, out):
        x["club_speed"] *= 1 - share
    s.reads.append(read)


@kind(3, guilty=["face_angle"], kin=AXES, acceptable=INSTRUMENT, columns=("session",))
def face_zeroed_anew(s):  # for the second session
    rows = s.groups["session"] == "s2"
    def read(x, out):
        x["face_angle"][rows] += 1.3 * s.size
    s.reads.append(read)


@kind(3, guilty=["backspin", "spin_rate"], kin=["friction-limit"], acceptable=INSTRUMENT)
def spin_ceiling(s):
    ceiling = {c: np.quantile(a, 0.68) for c, a in physics.base(s.x, s.head).items() if c in ("backspin", "spin_rate")}
    def read(x, out):
        for c in set(ceiling) & set(out):
            out[c][:] = np.minimum(out[c], round(ceiling[c], -1))
    s.reads.append(read)


@kind(3, guilty=["backspin", "sidespin", "spin_rate", "spin_axis"], acceptable=INSTRUMENT, clubs=("driver", "iron", "wedge"))
def spin_by_default(s):  # where the radar lost the ball: the club's usual spin, no tilt
    rows, usual = some(s, 0.2), {c: round(np.mean(a), -2) for c, a in physics.base(s.x, s.head).items() if c in ("backspin", "spin_rate")}
    def read(x, out):
        for c in s.outputs[3:]:
            out[c][rows] = usual.get(c, 0.0)
    s.reads.append(read)


@kind(3, guilty=["face_angle"], kin=GEAR, acceptable=INSTRUMENT)
def face_from_azimuth(s):
    def read(x, out):
        x["face_angle"][:] = (out["azimuth"] - 0.18 * x["club_path"]) / 0.82
    s.reads.append(read)


@kind(3, guilty=["impact_toe"], kin=GEAR, acceptable=INSTRUMENT, clubs=("driver",))
def toe_from_gear_effect(s):  # with the gear effect of another head
    mean = {c: np.array([np.mean(a)]) for c, a in s.x.items()}
    side = lambda **d: physics.base({**mean, **d}, s.head)["sidespin"][0]
    start = side()
    slope = {c: side(**{c: mean[c] + 0.5}) - side(**{c: mean[c] - 0.5}) for c in ("impact_toe", "face_angle", "club_path")}
    def read(x, out):
        spin = out["sidespin"] if "sidespin" in out else out["spin_rate"] * np.sin(np.radians(out["spin_axis"]))
        rest = sum(slope[c] * (x[c] - mean[c]) for c in ("face_angle", "club_path"))
        x["impact_toe"][:] = mean["impact_toe"] + 0.8 * (spin - start - rest) / slope["impact_toe"]
    s.reads.append(read)


# Physics in no list ---------------------------------------------------------------------------------------------------

@kind(4, kin=SPIN, place=["ball", "mixture"], acceptable=("unexplained",))
def two_cores(s):  # balls of two makes, in a column
    s.groups["ball"] = np.where(some(s, 0.5), "A", "B")
    s.real.ball_factor = np.where(s.groups["ball"] == "A", 0.4 - 0.025 * s.size, 0.4 + 0.035 * s.size)


@kind(4, kin=["restitution-law", "head-mass"], place=["mixture"], acceptable=("unexplained", "noise-contradicted"))
def dead_balls_among_live(s):  # in no column
    rows = some(s, 0.3)
    add_restitution(s, lambda vn, x: np.where(rows, -0.06 * s.size, 0.0))


@kind(4, kin=EDGE + ["restitution-law", "cg-shift", "head-inertia"], place=["impact_toe", "impact_high", "mixture"],
      acceptable=("unexplained",), clubs=("driver", "iron"))
def cracked_face(s):  # dead at one place only
    add_restitution(s, lambda vn, x: -0.1 * s.size * np.exp(-((x["impact_toe"] - 9) ** 2 + (x["impact_high"] + 3) ** 2) / 49))


@kind(4, names=["friction-limit"], kin=SPIN + ["session-drift"], place=["session", "shot", "mixture"],
      acceptable=("unexplained", "explained", "ambiguous"), clubs=("wedge", "bag", "iron"), columns=("session",))
def rain_in_one_session(s):
    wet(s, 0.8, s.groups["session"] == "s3")


@kind(4, kin=GEAR, place=["impact_toe"], acceptable=("unexplained",), clubs=("driver",))
def wrong_bulge(s):
    s.real.bulge = s.head.bulge / (1 + 0.22 * s.size)


@kind(4, kin=GEAR + ["monitor-misalignment", "loft-bias"], place=["impact_toe", "impact_high"], acceptable=("unexplained",), clubs=("driver",))
def twisted_face(s):  # open and lofted high on the toe, the contrary low on the heel
    s.real.twist = lambda toe, high: (0.04 * s.size * (toe + high), 0.03 * s.size * (toe + high))


@kind(4, kin=["session-drift", "restitution-law"], place=["shot"], acceptable=("unexplained",))
def sun_and_cloud(s):  # the balls warm up and cool down
    phase = s.rng.uniform(0, 2 * np.pi)
    swing = np.tanh(2 * np.sin(2 * np.pi * np.arange(s.n) / 27 + phase))
    add_restitution(s, lambda vn, x: 0.022 * s.size * swing)


@kind(4, kin=SPEED, place=["player"], acceptable=("unexplained",), columns=("player",))
def clubs_of_their_own(s):  # each player's head has another mass than the declared one
    players = np.unique(s.groups["player"])
    share = dict(zip(players, s.rng.permutation(np.linspace(-1, 1, len(players)))))
    s.real.mass = s.head.mass * (1 + 0.1 * s.size * np.array([share[p] for p in s.groups["player"]]))


@kind(4, kin=EDGE + ["restitution-law", "cg-shift", "head-mass"], place=["impact_high", "attack_angle", "club_speed", "mixture"],
      acceptable=("unexplained",), clubs=("iron", "wedge", "bag"))
def turf_first(s):  # a low and steep blow has lost speed between the reading and the ball
    loss = 0.03 * s.size * np.maximum(0, -(s.x["impact_high"] + 4) / 5) * np.maximum(0, -s.x["attack_angle"] / 4)
    loss = np.minimum(loss, 0.15)
    def known(x):
        x["club_speed"] /= 1 - loss
    s.known.append(known)


@kind(4, kin=SPIN + AXES, place=["club_path", "face_angle"], acceptable=("unexplained",))
def grain_of_the_grooves(s):  # the face holds the ball across the grooves, less along them
    s.real.grain = 1 - 0.3 * s.size


# Noise alone ----------------------------------------------------------------------------------------------------------

@kind(5)
def habits_alone(s):  # inputs that go together
    s.x = s.deliveries(s.rng, 0.85)


@kind(5)
def undeclared_noise(s):  # of the outputs; that of the inputs is declared
    s.declared = "inputs"


@kind(5, acceptable=("noise-contradicted",))
def heavy_tails(s):  # Student's t of 3 degrees, of the declared standard deviation
    s.distort = lambda rng: {c: a / np.sqrt(3) * rng.standard_t(3, s.n) for c, a in s.sigma.items()}


@kind(5, acceptable=("noise-contradicted",), columns=("session",))
def noise_by_session(s):  # its mean square is the declared one
    level = np.array([0.6, 1.0, 1.3])[[int(g[1]) - 1 for g in s.groups["session"]]]
    level /= np.sqrt(np.mean(level**2))
    s.distort = lambda rng: {c: a * level * rng.standard_normal(s.n) for c, a in s.sigma.items()}


@kind(5, acceptable=("noise-contradicted",))
def errors_of_one_vector(s):  # channels that come from the same measured direction or plate of markers
    pairs = {"sidespin": ("azimuth", 0.7), "spin_axis": ("azimuth", 0.7), "backspin": ("launch_angle", -0.6),
             "spin_rate": ("launch_angle", -0.6), "dynamic_loft": ("attack_angle", 0.7), "face_angle": ("club_path", 0.7)}
    def distort(rng):
        g = {c: rng.standard_normal(s.n) for c in s.sigma}
        for c, (with_, share) in pairs.items():
            g[c] = share * g[with_] + np.sqrt(1 - share**2) * g[c]
        return {c: g[c] * s.sigma[c] for c in g}
    s.distort = distort


@kind(5, acceptable=("noise-contradicted",))
def coarse_rounding(s):  # the declared noise contains that of the rounding
    small = {c: 0.6 * a for c, a in s.sigma.items()}
    steps = {"deg": 0.5, "mm": 2.0, "rpm": 100.0}
    s.rounds = {c: steps.get(s.unit[c], 1.0) / s.inner(c) for c in s.sigma}
    s.sigma = {c: float(np.hypot(small[c], s.rounds[c] / np.sqrt(12))) for c in small}
    s.declared = "all"
    s.distort = lambda rng: {c: a * rng.standard_normal(s.n) for c, a in small.items()}
