"""25 more kinds, of the same form as kinds.py, for `generate.py --more`. Written without sight of the loop or of any verdict.

Importing this file fills MORE. The truth of each kind means what kinds.py says.
"""

import dataclasses

import numpy as np

from kinds import DEG, MORE, ODD, SCATTER, SPEED, SPIN, TURN, instrument, nothing, one, rolling_friction, several, unlisted
from physics import Contact, attached, base_restitution

__all__ = ["MORE"]


def slipping(s):
    """Speed of the face along the ball's surface at first touch."""
    return np.hypot(*Contact(s.delivered, s.head, s.ball).slip.T)


# 1: one effect of the library, in another form

@one("restitution-falloff", SPEED + TURN, "restitution falls in straight lines off the centre, faster to the heel than to the toe",
     clubs=("driver", "irons"))
def stiff_heel(s):
    toe, heel, high = s.size(0.005, 0.03) * np.array([0.7, 1.6, 1.0]) / 0.01
    s.law["e"] = lambda c: base_restitution(c) - np.where(c.toe > 0, toe, -heel) * c.toe - high * np.abs(c.high)


@one("ball-inertia", SPIN, "the core slips in its mantle: the faster the face shears the ball, the less of the core turns",
     clubs=("irons", "wedge"))
def lagging_core(s):
    slip = slipping(s)
    s.struck = dataclasses.replace(s.ball, factor=0.4 * (1 - s.size(0.03, 0.2) * slip / np.mean(slip)))


@one("head-closure", ("cg-shift",), "players release differently: each closes the head about the shaft at a rate of his own",
     clubs=("driver", "irons"))
def own_release(s):
    lie = s.size(56, 64) * DEG
    rate = s.size(8, 45) * s.rng.uniform(0.3, 1.7, 4)[s.players]
    s.turning = rate[:, None] * np.array([0, np.cos(lie), np.sin(lie)])
    s.clusters = True


@one("friction-limit", ("ball-tangential-compliance",), "a film of water: friction falls as a power of the sliding speed",
     clubs=("wedge",))
def film_of_water(s):
    middle, power = rolling_friction(s) * s.size(0.95, 1.15), s.size(0.2, 0.8)
    fast = np.median(slipping(s))
    s.law["friction"] = lambda c: middle * (np.hypot(*c.slip.T) / fast) ** -power


@one("loft-bias", SPIN + ("monitor-misalignment",),
     "loft is read from the last picture before the blow, up to one frame early, while the loft still grows", acceptable=SCATTER)
def early_frame(s):
    s.delivered["dynamic_loft"] = s.x["dynamic_loft"] + s.size(0.5, 2.5) * DEG * s.rng.random(s.n)


@one("session-drift", ("monitor-misalignment", "loft-bias"), "the monitor sinks into soft turf: its launch angle settles",
     guilty=("launch_angle",))
def sinking_monitor(s):
    tilt = s.either(s.size(0.3, 2.0) * DEG) * -np.expm1(-3 * np.arange(s.n) / s.n)
    s.seen.append(lambda t: t.update(launch_angle=t["launch_angle"] + tilt))


# 2: several at once; all names are needed

@several(("restitution-falloff", "loft-bias"), "a face that loses towards its rim, on a head whose loft was bent later",
         kin=SPEED + SPIN + ("monitor-misalignment",), clubs=("driver", "irons"))
def rim_and_bent_loft(s):
    loss, power = s.size(0.008, 0.04), s.rng.uniform(1.2, 2.2)
    s.law["e"] = lambda c: base_restitution(c) - loss * (np.hypot(c.toe, c.high) / 0.01) ** power
    s.delivered["dynamic_loft"] = s.x["dynamic_loft"] + s.either(s.size(0.5, 2.0) * DEG)


@several(("head-mass", "session-drift"), "lead tape behind the face; the marks on the balls wear off, so less spin is counted",
         kin=SPEED + SPIN, guilty=("backspin",), cartesian=True)
def tape_and_worn_marks(s):
    s.head = dataclasses.replace(s.head, mass=s.head.mass + s.size(0.006, 0.03))
    less = s.size(0.02, 0.10) * np.arange(s.n) / s.n
    s.seen.append(lambda t: t.update(backspin=t["backspin"] * (1 - less)))


@several(("monitor-misalignment", "cg-shift", "restitution-law"),
         "a hot driver, glue towards its heel or toe, before a monitor that is aimed off the target",
         kin=SPEED + ("head-closure", "shaft-coupling", "loft-bias"), guilty=("spin_axis",), clubs=("driver",))
def hot_glued_aimed_off(s):
    more = s.size(0.01, 0.05)
    s.law["e"] = lambda c: base_restitution(c) + more
    s.head = dataclasses.replace(s.head, cg=s.head.cg + [0, s.either(s.size(0.002, 0.008)), s.either(0.0015)])
    s.turned = s.either(s.size(0.3, 1.2) * DEG)


@several(("shaft-coupling", "ball-tangential-compliance"), "a heavy steel shaft whose tip moves with the hosel; a lively cover",
         kin=SPEED + SPIN + TURN + ("head-closure",), clubs=("irons",))
def steel_and_lively(s):
    tip = attached(s.size(0.02, 0.09) * np.eye(3), s.size(1e-5, 6e-5) * np.eye(3), np.array([-0.005, 0.042, 0.025]) - s.head.cg)
    s.head = dataclasses.replace(s.head, added=tip)
    s.law["et"] = s.size(0.04, 0.15)


# 3: instruments, columns, recording

@instrument(("backspin",), "where the radar heard no spin, it fills in the spin usual for such a launch", acceptable=SCATTER)
def usual_spin(s):
    lost = s.rng.random(s.n) < s.size(0.15, 0.35)

    def change(t):
        usual = t["launch_angle"] * t["ball_speed"]
        t["backspin"] = np.where(lost, usual * np.median(t["backspin"]) / np.median(usual), t["backspin"])
    s.seen.append(change)


@instrument(("face_angle",), "the export gives the face to the path, under the header of the face to the target")
def face_to_path(s):
    s.seen.append(lambda t: t.update(face_angle=t["face_angle"] - t["club_path"]))


@instrument(("club_path",), "the display says 2.1 L or 2.1 R, and the letters were not typed in")
def letters_lost(s):
    s.seen.append(lambda t: t.update(club_path=np.abs(t["club_path"])))


@instrument(("club_speed",), "the monitor does not see the club: its speed is the ball's over a factor by launch angle",
            kin=SPEED + TURN, acceptable=SCATTER)
def speed_from_ball(s):
    factor = np.mean(s.outputs()["ball_speed"] / s.x["club_speed"]) * (1 + s.either(s.size(0.003, 0.03)))
    slope = s.size(0.3, 0.8)  # of the factor over the launch angle

    def change(t):
        launch = t["launch_angle"] - np.mean(t["launch_angle"])
        t["club_speed"] = t["ball_speed"] / (factor - slope * launch)
    s.seen.append(change)


@instrument(("dynamic_loft",), "lofts lost in runs of three to eight shots were bridged by straight lines", acceptable=SCATTER)
def bridged_gaps(s):
    lost, share = np.zeros(s.n, bool), s.size(0.18, 0.35)
    while lost.mean() < share:
        start = s.rng.integers(1, s.n - 8)
        lost[start : start + s.rng.integers(3, 9)] = True
    i = np.arange(s.n)
    s.seen.append(lambda t: t.update(dynamic_loft=np.interp(i, i[~lost], t["dynamic_loft"][~lost])))


@instrument(("impact_toe",), "one of four players photographs his face with the mirroring camera of a telephone", kin=TURN,
            clubs=("driver", "irons"))
def mirrored_photo(s):
    s.clusters = True
    sign = np.where(s.players == s.rng.integers(4), -1, 1)
    s.seen.append(lambda t: t.update(impact_toe=sign * t["impact_toe"]))


# 4: physics in no list

@unlisted(("lie",), "grass between face and ball leaves little friction in the rough; a column says where the ball lay",
          kin=("friction-limit", "ball-tangential-compliance"), clubs=("irons", "wedge"))
def flyer_lie(s):
    s.columns["lie"] = s.rng.choice(["fairway", "first cut", "rough"], s.n, p=[0.45, 0.25, 0.3])
    rough = s.size(0.88, 1.03)
    share = {"fairway": np.inf, "first cut": (1 + rough) / 2, "rough": rough}
    s.law["friction"] = rolling_friction(s) * np.array([share[v] for v in s.columns["lie"]])


@unlisted(("shot", "impact_toe"), "from one shot on, the face has a crack towards the toe, about which it gives less speed",
          kin=SPEED + ("session-drift",), guilty=("ball_speed",), clubs=("driver",))
def cracked_face(s):
    loss, wide, first = s.size(0.03, 0.15), s.size(0.010, 0.018), int(s.size(0.3, 0.65) * s.n)
    cracked = np.arange(s.n) >= first
    s.law["e"] = lambda c: base_restitution(c) - cracked * loss * np.exp(-((c.toe - 0.008) ** 2 + c.high**2) / (2 * wide**2))


@unlisted(("impact_high",), "the crown gives way: blows above the centre, and only those, find more loft the higher they are",
          kin=("loft-bias", "normal-force-offset", "ball-inertia", "monitor-misalignment", "cg-shift"), clubs=("driver",))
def soft_crown(s):
    slope = s.size(0.06, 0.4) * DEG / 0.001
    s.delivered["dynamic_loft"] = s.x["dynamic_loft"] + slope * np.maximum(s.x["impact_high"], 0)


@unlisted(("club", "dynamic_loft", "club_speed"), "each iron meets the ball at a lie of its own, which aims its loft aside",
          kin=("monitor-misalignment",), guilty=("face_angle", "azimuth"),
          clubs=("irons", "wedge"), bag=True)
def mixed_lies(s):
    names, which = np.unique(s.club, return_inverse=True)
    lies = s.either(s.size(0.8, 4.0) * DEG) * s.rng.permutation([-1.0, 0.2, 0.8])
    s.delivered["face_angle"] = s.x["face_angle"] + lies[: len(names)][which] * np.tan(s.x["dynamic_loft"])


@unlisted(("impact_toe", "impact_high"), "the grooves are worn where the face meets most balls: little friction in a round middle",
          kin=("friction-limit", "ball-tangential-compliance"), clubs=("irons", "wedge"))
def worn_middle(s):
    radius, friction = s.size(0.006, 0.012), rolling_friction(s) * s.size(0.88, 1.02)
    s.law["friction"] = lambda c: np.where(np.hypot(c.toe, c.high) < radius, friction, np.inf)


# 5: noise alone; nothing is to be reported

@nothing("the data sheet is careful: the scatter is 0.4 to 0.8 of what is declared", acceptable=ODD)
def careful_data_sheet(s):
    share = s.size(0.4, 0.8)
    s.scatter = lambda z: {k: share * v for k, v in z.items()}


@nothing("the instrument wanders: errors of the outputs are correlated from shot to shot", acceptable=ODD + ("unexplained",))
def wandering(s):
    keep = s.size(0.25, 0.55)

    def scatter(z):
        for k in s.channels:
            for i in range(1, s.n):
                z[k][i] = keep * z[k][i - 1] + np.sqrt(1 - keep**2) * z[k][i]
        return z
    s.scatter = scatter


@nothing("Gaussian as declared, but for one shot in fifty, at which one column is far off", acceptable=ODD)
def wild_readings(s):
    def scatter(z):
        for i in s.rng.choice(s.n, 1 + s.n // 50, replace=False):
            z[s.rng.choice(list(z))][i] = s.either(s.size(6, 20))
        return z
    s.scatter = scatter


@nothing("Gaussian as declared, but a tenth of the shots was exported twice, under two numbers")
def exported_twice(s):
    rows = np.sort(np.append(np.arange(s.n - s.n // 10), s.rng.choice(s.n - s.n // 10, s.n // 10, replace=False)))
    s.club, s.players = s.club[rows], s.players[rows]
    s.seen.append(lambda t: t.update({k: v[rows] for k, v in t.items()}))
