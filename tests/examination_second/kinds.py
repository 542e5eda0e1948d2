"""What is wrong with each set, and what a careful analyst may say of it. Written before any verdict was seen.

A kind is a function that changes a Session (generate.py). KINDS holds it with its truth: `names` are the effects that are true,
`kin` those that one set may fail to tell from them, `guilty` the false columns, `place` where an effect without a name shows,
`acceptable` the verdicts that are no mistake although they are not the best.
"""

import dataclasses

import numpy as np

from physics import attached, base_restitution, readings

DEG, RPM = np.pi / 180, np.pi / 30
# One set seldom tells these apart: restitution and what acts like it; what makes spin; what turns the head.
SPEED = ("restitution-law", "face-compliance", "head-mass", "restitution-falloff")
SPIN = ("ball-tangential-compliance", "ball-inertia", "normal-force-offset", "loft-bias", "friction-limit", "ball-relaxation",
        "ball-cover-stiffness")
TURN = ("head-inertia", "head-rotation", "shaft-coupling", "cg-shift", "restitution-falloff", "head-mass")
HONEST = ("ambiguous", "insufficient", "unexplained")
SCATTER = HONEST + ("noise-contradicted",)  # where the truth is scatter as well
KINDS, MORE = {}, {}  # of this file, and of more_kinds.py


@dataclasses.dataclass
class Kind:
    change: object
    family: int
    listed: str
    about: str
    names: tuple = ()
    kin: tuple = ()
    guilty: tuple = ()
    place: tuple = ()
    acceptable: tuple = HONEST
    clubs: tuple = ("driver", "irons", "wedge")
    cartesian: bool = False  # spin as its two parts, never as rate and axis
    bag: object = None  # None: by chance


def kind(family, listed, about, **truth):
    def register(f):
        (KINDS if f.__module__ == __name__ else MORE)[f.__name__.replace("_", "-")] = Kind(f, family, listed, about, **truth)
        return f
    return register


def one(name, kin, about, **more):
    return kind(1, "library", about, names=(name,), kin=tuple(k for k in kin if k != name), **more)


def rolling_friction(s):
    """The friction that rolling needs in a middling blow."""
    return 0.18 * np.tan(np.median(s.x["dynamic_loft"] - s.x["attack_angle"]))


# 1: one effect of the library, in another form

@one("restitution-law", SPEED, "restitution falls as a power of the approach speed")
def power_law(s):
    level, power, middle = s.either(s.size(0.012, 0.06)), s.size(0.02, 0.10), np.median(s.x["club_speed"])
    s.law["e"] = lambda c: (0.86 - 0.0029 * middle + level) * (c.closing / middle) ** -power


@one("ball-tangential-compliance", SPIN, "tangential restitution grows from zero with the angle of incidence",
     clubs=("irons", "wedge"))
def rising_return(s):
    most = s.size(0.03, 0.2)
    s.law["et"] = lambda c: most * np.sin(c.obliquity) ** 2 / np.sin(45 * DEG) ** 2


@one("friction-limit", SPIN, "friction saturates smoothly: a hyperbolic tangent of the impulse ratio", clubs=("wedge",))
def soft_friction(s):
    s.law.update(friction=s.size(0.35, 0.9), soft=True)


@one("restitution-falloff", SPEED + TURN, "restitution falls off the centre as a Gaussian, an ellipse in toe and high")
def gauss_rim(s):
    wide, tall = s.size(0.035, 0.09), s.size(0.03, 0.08)
    s.law["e"] = lambda c: base_restitution(c) * np.exp(-((c.toe / wide) ** 2 + (c.high / tall) ** 2) / 2)


@one("face-compliance", SPEED, "a face like a clamped dome takes part of the ball's loss, most at the centre", clubs=("driver",))
def dome(s):
    centre, half = s.size(0.04, 0.5), s.size(0.032, 0.045)
    s.law["e"] = lambda c: 1 - (1 - base_restitution(c)) / (1 + centre * np.clip(1 - (c.toe**2 + 2 * c.high**2) / half**2, 0,
                                                                                 1) ** 2)


@one("shaft-coupling", TURN + ("head-closure",), "the shaft's tip at the hosel resists across its axis and about it, not along it",
     clubs=("driver", "irons"))
def tip_across(s):
    lie = s.size(56, 64) * DEG
    axis = np.array([0, np.cos(lie), np.sin(lie)])
    along = np.outer(axis, axis)
    hosel = np.array([-0.01, 0.045, 0.02]) + s.rng.normal(0, 0.003, 3)
    s.head = dataclasses.replace(s.head,
                                 added=attached(s.size(0.015, 0.09) * (np.eye(3) - along), s.size(2e-5, 1e-4) * along,
                                                hosel - s.head.cg))


@one("head-closure", ("cg-shift",), "the head closes about a leaning shaft, at a rate in proportion to the club's speed",
     clubs=("driver", "irons"))
def closing_shaft(s):
    lie = s.size(56, 64) * DEG
    rate = s.size(6, 45) * s.x["club_speed"] / np.mean(s.x["club_speed"])
    s.turning = rate[:, None] * np.array([0, np.cos(lie), np.sin(lie)])


@one("loft-bias", SPIN + ("monitor-misalignment",),
     "the shaft's lead adds loft with the square of the club's speed, unseen by the record")
def loft_kick(s):
    most, speed = s.either(s.size(0.4, 2.5) * DEG), s.x["club_speed"]
    s.delivered["dynamic_loft"] = s.x["dynamic_loft"] + most * (speed / np.mean(speed)) ** 2


@one("cg-shift", TURN + ("head-closure",),
     "a weight sits in another port than declared: centre of gravity and inertia move together", clubs=("driver",))
def weight_port(s):
    h, weight = s.head, s.size(0.008, 0.025)
    old, new = h.cg + [-0.03, 0, -0.015], h.cg + [-0.01, s.either(s.size(0.03, 0.05)), s.either(0.012)]
    part = lambda r: weight * (r @ r * np.eye(3) - np.outer(r, r))
    cg = h.cg + weight / h.mass * (new - old)
    whole = h.mass / weight * part(cg - h.cg)  # from the old centre of gravity to the new one
    s.head = dataclasses.replace(h, cg=cg, inertia=h.inertia - part(old - h.cg) + part(new - h.cg) - whole)


@one("normal-force-offset", SPIN, "the patch moves uphill with the tangent of incidence, and the normal force with it",
     clubs=("irons", "wedge"))
def uphill_patch(s):
    share = s.either(s.size(0.008, 0.05))
    s.law["offset"] = lambda c: share * np.tan(c.obliquity)


@one("monitor-misalignment", ("loft-bias", "cg-shift"),
     "the camera of the flight's direction leans on its tripod; the spin sensor does not",
     guilty=("launch_angle", "azimuth"))
def leaning_tripod(s):
    yaw, pitch = s.either(s.size(0.15, 1.5) * DEG), s.either(s.size(0.1, 0.8) * DEG)

    def change(t):
        t["azimuth"] = t["azimuth"] + yaw + pitch * np.tan(t["launch_angle"]) * np.sin(t["azimuth"])
        t["launch_angle"] = t["launch_angle"] + pitch * np.cos(t["azimuth"])
    s.seen.append(change)


@one("session-drift", ("restitution-law",), "balls warm up during the session: restitution rises, fast at first",
     guilty=("ball_speed",))
def warming_balls(s):
    rise, i = s.size(0.012, 0.06), np.arange(s.n) / s.n
    s.law["e"] = lambda c: base_restitution(c) + rise * np.log1p(4 * i) / np.log(5)


@one("head-inertia", TURN, "the shaft's torsion holds the head about the shaft's axis only", clubs=("driver", "irons"))
def held_axis(s):
    lie = s.size(56, 64) * DEG
    axis = np.array([0, np.cos(lie), np.sin(lie)])
    s.head = dataclasses.replace(s.head, inertia=s.head.inertia + s.size(0.3, 2.5) * s.head.inertia[2, 2] * np.outer(axis, axis))


# 2: several at once; all names are needed

def several(names, about, **more):
    return kind(2, "library", about, names=names, **more)


@several(("ball-tangential-compliance", "friction-limit"), "a lively cover on a face that lets it slide at high loft",
         clubs=("wedge",), bag=True,
         kin=("normal-force-offset", "ball-inertia", "loft-bias"))
def lively_and_slippery(s):
    s.law.update(et=s.size(0.06, 0.18), friction=s.size(0.19, 0.25))


@several(("restitution-law", "cg-shift"), "a dead ball on a head whose centre of gravity is towards the toe",
         kin=("face-compliance", "head-mass", "head-inertia", "head-rotation"),
         clubs=("driver", "irons"))
def dead_and_toe_heavy(s):
    loss = s.size(0.015, 0.06)
    s.law["e"] = lambda c: base_restitution(c) - loss
    s.head = dataclasses.replace(s.head, cg=s.head.cg + [0, -s.size(0.0025, 0.008), s.either(0.002)])


@several(("loft-bias", "head-closure"), "loft read too low, on a head that closes",
         kin=("cg-shift", "ball-tangential-compliance", "normal-force-offset", "ball-inertia"),
         clubs=("driver", "irons"))
def low_loft_and_closure(s):
    s.delivered["dynamic_loft"] = s.x["dynamic_loft"] + s.size(0.6, 2.2) * DEG
    s.turning = np.array([0, 0.4, 0.9]) * s.size(12, 45)


@several(("monitor-misalignment", "ball-tangential-compliance"), "the monitor is aimed off the target; the cover returns energy",
         kin=("normal-force-offset", "ball-inertia", "loft-bias"),
         guilty=("spin_axis",), clubs=("irons", "wedge"))
def aimed_off_and_lively(s):
    s.law["et"] = s.size(0.03, 0.12)
    s.turned = s.either(s.size(0.25, 1.2) * DEG)


@several(("face-compliance", "ball-tangential-compliance", "session-drift"),
         "a thin face, a lively cover, and a radar whose speed drifts", kin=SPEED + SPIN,
         clubs=("driver",))
def thin_lively_drifting(s):
    gain, drift = s.size(0.06, 0.25), s.either(s.size(0.010, 0.03))
    s.law["et"] = s.size(0.08, 0.3)
    s.law["e"] = lambda c: 1 - (1 - base_restitution(c)) / (1 + gain * np.exp(-(c.toe**2 + c.high**2) / 0.022**2)) ** 2
    s.seen.append(lambda t: t.update(ball_speed=t["ball_speed"] * (1 + drift * (np.arange(s.n) / s.n - 0.5))))


# 3: instruments, columns, recording

def instrument(guilty, about, **more):
    return kind(3, "instrument", about, guilty=guilty, **{"cartesian": True, **more})


@instrument(("club_speed",), "the radar corrects for a wrong angle: all club speeds are too high by one factor",
            kin=("restitution-law", "head-mass"))
def wrong_cosine(s):
    gain = 1 + s.size(0.012, 0.06)
    s.seen.append(lambda t: t.update(club_speed=t["club_speed"] * gain))


@instrument(("club_path",), "club path counts positive to the left, against the header")
def path_turned(s):
    s.seen.append(lambda t: t.update(club_path=-t["club_path"]))


@instrument(("impact_toe", "impact_high"), "the places across and up the face stand in each other's column",
            clubs=("driver", "irons"))
def places_swapped(s):
    s.seen.append(lambda t: t.update(impact_toe=t["impact_high"], impact_high=t["impact_toe"]))


@instrument(("backspin",), "after a lost shot, each backspin stands one row late", acceptable=SCATTER)
def row_late(s):
    first = int(s.size(0.3, 0.75) * s.n)

    def change(t):
        w = t["backspin"]
        t["backspin"] = np.concatenate([w[:first], w[first - 1 : -1]])
    s.seen.append(change)


@instrument(("ball_speed",), "the radar loses the ball now and then and repeats its last speed", acceptable=SCATTER)
def last_value(s):
    stuck = (s.rng.random(s.n) < s.size(0.14, 0.28)) & (np.arange(s.n) > 0)
    from_row = np.maximum.accumulate(np.where(stuck, 0, np.arange(s.n)))
    s.seen.append(lambda t: t.update(ball_speed=t["ball_speed"][from_row]))


@instrument(("backspin",), "the camera cannot count faster: backspin stops at a ceiling", kin=("friction-limit",))
def ceiling(s):
    share = 1 - s.size(0.15, 0.4)
    limit = np.quantile(s.outputs()["backspin"], share)
    s.seen.append(lambda t: t.update(backspin=np.minimum(t["backspin"], limit)))


@instrument(("dynamic_loft",), "dynamic loft is computed from launch, spin and speed, by a formula that is not the ball's",
            names=("loft-bias",), kin=tuple(k for k in SPIN if k != "loft-bias"), acceptable=HONEST + ("explained",))
def computed_loft(s):
    share, lever = s.size(0.7, 0.9), s.size(0.5, 1.0)
    middle = np.mean(s.x["dynamic_loft"])

    def change(t):
        spin_part = np.arctan(lever * t["backspin"] * 0.0213 / t["ball_speed"])
        centred = lambda v: v - np.mean(v)
        t["dynamic_loft"] = middle + centred(t["launch_angle"]) / share + 0.5 * centred(spin_part)
    s.seen.append(change)


@instrument(("sidespin",), "where the camera failed, sidespin is written as zero", acceptable=SCATTER)
def zero_for_nothing(s):
    lost = s.rng.random(s.n) < s.size(0.15, 0.3)
    s.seen.append(lambda t: t.update(sidespin=np.where(lost, 0.0, t["sidespin"])))


@instrument(("azimuth",), "the tripod was kicked: from one shot on, directions are off by a constant",
            kin=("monitor-misalignment", "session-drift"))
def kicked_tripod(s):
    step, first = s.either(s.size(0.3, 2.0) * DEG), int(s.size(0.3, 0.7) * s.n)
    s.seen.append(lambda t: t.update(azimuth=t["azimuth"] + step * (np.arange(s.n) >= first)))


# 4: physics in no list

def unlisted(place, about, **more):
    return kind(4, "none", about, place=place, **more)


@unlisted(("temperature_c",), "the ball is livelier when it is warm; a column has the temperature of each shot",
          kin=("restitution-law",))
def warm_ball(s):
    t = 15 + 6 * np.sin(2 * np.pi * (s.rng.random() + np.arange(s.n) / s.n * s.size(1.5, 3))) + s.rng.normal(0, 3, s.n)
    s.columns["temperature_c"] = np.round(t, 1)
    slope = s.size(0.0015, 0.0060)
    s.law["e"] = lambda c: base_restitution(c) + slope * (t - 15)


@unlisted(("mixture",), "two sorts of ball without a label: one rolls, one returns tangential energy", kin=SPIN, acceptable=SCATTER,
          clubs=("irons", "wedge"))
def unlabelled_balls(s):
    lively, et = s.rng.random(s.n) < s.size(0.3, 0.6), s.size(0.04, 0.2)
    s.law["et"] = lambda c: np.where(lively, et, 0)


@unlisted(("ball",), "two sorts of ball with their label: restitution and return differ",
          kin=("ball-tangential-compliance", "restitution-law"))
def labelled_balls(s):
    other, et, loss = s.rng.random(s.n) < s.size(0.3, 0.6), s.size(0.05, 0.3), s.size(0.005, 0.03)
    s.columns["ball"] = np.where(other, "urethane", "ionomer")
    s.law.update(et=lambda c: np.where(other, et, 0), e=lambda c: base_restitution(c) - np.where(other, loss, 0))


@unlisted(("shot",), "the radar's stand sways: directions swing to and fro with the shot's number",
          kin=("session-drift", "monitor-misalignment"), guilty=("azimuth",))
def swinging(s):
    phase, swing = 2 * np.pi * (s.rng.random() + np.arange(s.n) / s.n * s.size(2, 5)), s.size(0.2, 1.2) * DEG
    s.seen.append(lambda t: t.update(azimuth=t["azimuth"] + swing * np.sin(phase)))


@unlisted(("impact_toe", "impact_high"), "a hot spot of the face, a third of the way to the toe",
          kin=("restitution-falloff", "face-compliance", "cg-shift"), clubs=("driver",))
def hot_spot(s):
    more, toe, high = s.size(0.015, 0.09), s.size(0.008, 0.014), s.either(0.004)
    s.law["e"] = lambda c: base_restitution(c) + more * np.exp(-((c.toe - toe) ** 2 + (c.high - high) ** 2) / (2 * 0.006**2))


@unlisted(("impact_high",), "the lower face is wet: no more than a little friction below a line",
          kin=("friction-limit", "ball-tangential-compliance"), clubs=("irons", "wedge"))
def wet_below(s):
    line = s.size(0.001, 0.006)
    friction = rolling_friction(s) * s.size(0.88, 1.02)
    s.law["friction"] = lambda c: np.where(c.high < -line, friction, np.inf)


@unlisted(("impact_toe",), "the face is rounder or flatter from heel to toe than declared",
          kin=("cg-shift", "head-inertia", "head-rotation"), clubs=("driver",))
def other_bulge(s):
    s.head = dataclasses.replace(s.head, bulge=1 / (1 / s.head.bulge + s.either(s.size(0.3, 2.0))))


@unlisted(("club_path", "face_angle"), "milled lines: energy comes back across them, not along them",
          kin=("ball-tangential-compliance",), clubs=("irons", "wedge"))
def one_way_return(s):
    back = s.size(0.15, 0.8)
    s.law["et"] = lambda c: np.stack([np.zeros(s.n), np.full(s.n, back)], -1)


# 5: noise alone; nothing is to be reported

def nothing(about, **more):
    return kind(5, "null", about, **{"acceptable": (), **more})


ODD = ("insufficient", "noise-contradicted")  # of a scatter that is not as declared, this is true


@nothing("Gaussian noise as declared")
def quiet(s):
    pass


@nothing("Student's t with four degrees of freedom, of the declared variance", acceptable=ODD)
def heavy_tails(s):
    s.scatter = lambda z: {k: v / np.sqrt(s.rng.chisquare(4, s.n) / 4) / np.sqrt(2) for k, v in z.items()}


@nothing("the noise of each shot has its own size, and each player's too; the declared one is the mean square", acceptable=ODD)
def uneven(s):
    size = np.exp(s.rng.normal(0, 0.35, s.n) + s.rng.normal(0, 0.25, 4)[s.players])
    size /= np.sqrt(np.mean(size**2))
    s.scatter = lambda z: {k: v * size for k, v in z.items()}


@nothing("errors of launch angle and spin share a cause: correlation 0.7, and direction with sidespin", acceptable=ODD,
         cartesian=True)
def shared_error(s):
    def scatter(z):
        z["backspin"] = -0.7 * z["launch_angle"] + np.sqrt(0.51) * z["backspin"]
        z["sidespin"] = 0.7 * z["azimuth"] + np.sqrt(0.51) * z["sidespin"]
        return z
    s.scatter = scatter


@nothing("noise of the outputs is not declared; inputs by a precise instrument")
def undeclared(s):
    s.declare = False
    s.input_noise = {k: v * 0.2 for k, v in s.input_noise.items()}


@nothing("a display with few digits: steps of up to three standard deviations", acceptable=ODD)
def coarse(s):
    s.steps = {"mps": 0.5, "kmh": 2, "mph": 1, "deg": 0.5, "mm": 2, "rpm": (100, 200)[s.number % 2]}


@nothing("players with other habits in blocks, who tire: every input drifts", bag=False)
def habits(s):
    s.players = np.arange(s.n) * 4 // s.n
    centre = s.rng.normal(0, 1, (4, 7))[s.players] * [2.0, 1 * DEG, 1.5 * DEG, 2 * DEG, 1.5 * DEG, 0.006, 0.004]
    for k, d in zip(s.x, centre.T):
        s.x[k] = s.x[k] + d
    s.x["club_speed"] = s.x["club_speed"] - 2.5 * np.arange(s.n) / s.n
    s.clusters, s.delivered = True, s.x


@nothing("inputs that hang together: loft, attack and speed by one swing, face and path by another, high on the face by toe",
         bag=False)
def tied_inputs(s):
    for names in (("club_speed", "attack_angle", "dynamic_loft"), ("club_path", "face_angle"), ("impact_toe", "impact_high")):
        common = s.rng.normal(0, 1, s.n)
        for k in names:
            v = s.x[k]
            s.x[k] = np.mean(v) + np.std(v) * (s.either(0.98) * common + 0.2 * s.rng.normal(0, 1, s.n))
    s.delivered = s.x


@nothing("a bag of irons of other lofts, speeds and habits of attack", clubs=("irons",), bag=True)
def bag_of_irons(s):
    pass


@nothing("empty cells: a tenth, up to a fifth of those of one column")
def holes(s):
    s.holes = dict(zip(list(s.x) + list(s.channels), s.rng.uniform(0, 0.1, 12)))
    s.holes[list(s.holes)[s.rng.integers(12)]] = 0.2
