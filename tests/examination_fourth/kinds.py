"""The kinds of sets: what is true, what may be answered. A kind has

mech(s, a, g)        what happens: (inputs, outputs) as ideal instruments read them; a is the size, g draws
fault(s, a, g, rec)  what the instruments make of it: changes the recorded columns (after noise) in place

The same g is made for every call, so that the draws do not depend on the size. All lists were written before any run.
"""

import dataclasses
import typing

import numpy as np

from physics import Blow, added_mass, base_restitution, dot, read, rotation, vectors

SPINS = ["backspin", "sidespin", "spin_rate", "spin_axis"]


def plain_mech(s, a, g):
    b = s.blow()
    return s.x, b.launch(b.stuck())


def no_fault(s, a, g, rec):
    pass


@dataclasses.dataclass
class Kind:
    name: str
    family: int
    listed: str  # library, instrument, none, null
    sizes: tuple  # smallest and largest size that is credible
    mech: typing.Callable = plain_mech
    fault: typing.Callable = no_fault
    names: tuple = ()
    kin: tuple = ()
    guilty: tuple = ()
    place: tuple = ()
    acceptable: tuple = ("unexplained", "insufficient")
    clubs: tuple = ("driver", "iron", "wedge", "bag")
    needs: tuple = ()  # columns
    noise: typing.Callable = None  # (s, g, sd) -> errors of the outputs; None: normal


KINDS = {}


def kind(name, family, listed, sizes, **more):
    def add(f):
        more["fault" if f.__name__ == "fault" else "noise" if f.__name__ == "noise" else "mech"] = f
        KINDS[name] = Kind(name, family, listed, sizes, **more)
        return f
    return add


def rise(t):
    """Smooth step from 0 at 0 to 1 at 1."""
    t = np.clip(t, 0, 1)
    return t * t * (3 - 2 * t)


# 1: one effect of the library in another form -----------------------------------------------------------------------------------

@kind("maw-slip", 1, "library", (0.03, 0.6), names=("ball-tangential-compliance",),
      kin=("ball-inertia", "normal-force-offset", "contact-creep", "friction-limit", "ball-relaxation", "ball-cover-stiffness", "loft-bias"))
def mech(s, a, g):
    """Shear springs back, less so the more of the patch slips: Maw, Barber and Fawcett's shape over the angle."""
    b = s.blow()
    et = a * (1 - (np.tan(b.obliquity) / np.tan(np.radians(58))) ** 2)
    return s.x, b.launch(b.stuck(et=et))


@kind("polished-wedge", 1, "library", (0.02, 3.0), names=("friction-limit",), clubs=("wedge", "bag"),
      kin=("contact-creep", "ball-tangential-compliance", "loft-bias", "ball-relaxation", "normal-force-offset"))
def mech(s, a, g):
    """A worn face; friction falls with slip speed (Stribeck), so some blows slide throughout and others stick at the end."""
    b = s.blow()
    j = b.slipping(lambda slip: (0.20 + 0.12 * np.exp(-slip / 6.0)) / (1 + a))
    return s.x, b.launch(j)


@kind("power-cor", 1, "library", (0.01, 0.5), names=("restitution-law",),
      kin=("head-mass", "face-compliance", "restitution-falloff"))
def mech(s, a, g):
    """Restitution falls as a power of the approach speed (viscoelastic ball), equal to the declared at 0.7 of the usual speed."""
    b = s.blow()
    e = base_restitution(b.w) * (b.w / (0.7 * np.mean(b.w))) ** -a
    return s.x, b.launch(b.stuck(e=e))


@kind("plateau-cliff", 1, "library", (0.01, 0.4), names=("restitution-falloff",), clubs=("driver", "iron"),
      kin=("face-compliance", "restitution-law", "head-mass", "cg-shift", "head-inertia"))
def mech(s, a, g):
    """Variable thickness: as declared over a wide middle, then quickly less outside an ellipse."""
    b = s.blow()
    q = np.hypot((s.x["impact_toe"] - 2) / 9, s.x["impact_high"] / 6)
    return s.x, b.launch(b.stuck(e=base_restitution(b.w) - a * rise((q - 1) / 1.2)))


@kind("cup-face", 1, "library", (0.004, 0.2), names=("face-compliance", "restitution-falloff", "restitution-law"),
      clubs=("driver", "iron"), kin=("head-mass", "cg-shift", "head-inertia"))
def mech(s, a, g):
    """A thin clamped face: restitution gains with the square of a clamped plate's deflection, about a point above the centre."""
    b = s.blow()
    wide, high = (32, 20) if s.club == "driver" else (24, 14)
    q2 = np.clip(((s.x["impact_toe"] + 2) / wide) ** 2 + ((s.x["impact_high"] - 2) / high) ** 2, 0, 1)
    return s.x, b.launch(b.stuck(e=base_restitution(b.w) + a * (1 - q2) ** 2))


@kind("steel-tip", 1, "library", (0.002, 0.09), names=("shaft-coupling", "head-inertia", "head-mass", "cg-shift"),
      clubs=("driver", "iron"), kin=("restitution-law", "face-compliance", "restitution-falloff"))
def mech(s, a, g):
    """The lowest part of a heavy shaft moves with the hosel during the blow: a mass there."""
    where = np.array([-0.012, 0.045, 0.025] if s.club == "driver" else [-0.002, 0.038, 0.02])
    b = s.blow(head=added_mass(s.head, a, where))
    return s.x, b.launch(b.stuck())


@kind("late-release", 1, "library", (1.5, 70.0), names=("head-closure",), clubs=("driver", "iron"),
      kin=("cg-shift", "monitor-misalignment", "loft-bias", "shaft-coupling", "head-inertia"))
def mech(s, a, g):
    """The head turns about the shaft, not the vertical, faster in fast swings and as each player does."""
    lie = np.radians(57)
    axis = np.array([0.0, np.cos(lie), np.sin(lie)])
    rate = a * (s.x["club_speed"] / np.mean(s.x["club_speed"])) ** 1.5 * s.by("player", g.uniform(0.8, 1.2, 12))
    b = s.blow(omega=rate[:, None] * axis)
    return s.x, b.launch(b.stuck())


@kind("slid-weight", 1, "library", (0.2, 9.0), names=("cg-shift",), clubs=("driver", "iron"),
      kin=("head-inertia", "shaft-coupling", "head-closure", "monitor-misalignment", "loft-bias"))
def mech(s, a, g):
    """A weight slid along its track: the centre of gravity moves, and the inertia with it."""
    m, weight = s.head["mass"], 0.016
    far = g.choice([-1, 1]) * a * 1e-3 * float(np.mean(m)) / weight
    before, after = np.array([-0.05, 0.0, -0.015]), np.array([-0.05, far, -0.015 + 0.1 * abs(far)])
    if s.club == "iron":
        before[0] = after[0] = -0.015
    light = added_mass(s.head, -weight, before)
    b = s.blow(head=added_mass(light, weight, after))
    return s.x, b.launch(b.stuck())


@kind("metal-core", 1, "library", (0.01, 0.3), names=("ball-inertia",),
      kin=("ball-tangential-compliance", "normal-force-offset", "loft-bias", "contact-creep", "ball-relaxation", "friction-limit"))
def mech(s, a, g):
    """Ball with a dense core (less inertia) or a dense cover (more); of several balls not the first."""
    sign = g.choice([-1, 1])
    which = (s.text["ball"] != s.text["ball"][0]) if "ball" in s.text else np.ones(s.n, bool)
    b = s.blow(ball=dict(s.ball, factor=0.4 * (1 + sign * a * which)))
    return s.x, b.launch(b.stuck())


@kind("kick-forward", 1, "library", (0.1, 4.0), names=("loft-bias",),
      kin=("normal-force-offset", "monitor-misalignment", "cg-shift", "ball-tangential-compliance", "ball-inertia"))
def mech(s, a, g):
    """The loft was read some milliseconds early; the shaft's kick adds loft since, more for fast swings."""
    recorded = dict(s.x)
    recorded["dynamic_loft"] = s.x["dynamic_loft"] - a * (s.x["club_speed"] / np.mean(s.x["club_speed"])) ** 2
    b = s.blow()
    return recorded, b.launch(b.stuck())


@kind("lagging-pressure", 1, "library", (0.001, 0.12), names=("normal-force-offset",),
      kin=("ball-tangential-compliance", "ball-inertia", "loft-bias", "contact-creep", "ball-relaxation", "friction-limit",
           "ball-cover-stiffness"))
def mech(s, a, g):
    """The centre of pressure trails the ball's motion over the face, by more with a longer contact (slow blows)."""
    b = s.blow()
    offset = g.choice([-1, 1]) * a * np.tan(b.obliquity) * (b.w / np.mean(b.w)) ** -0.2
    b = s.blow(offset=offset)
    return s.x, b.launch(b.stuck())


@kind("balls-from-the-boot", 1, "library", (0.004, 0.15), names=("session-drift",),
      kin=("restitution-law", "head-mass", "face-compliance"))
def mech(s, a, g):
    """A basket of cold balls warms in the sun: restitution rises with the shots, steadily, slower at the end; right on the mean."""
    b = s.blow()
    warm = 1 - np.exp(-1.5 * (s.shot - 1) / (s.n - 1))
    return s.x, b.launch(b.stuck(e=base_restitution(b.w) + a * (warm - np.mean(warm))))


@kind("rolled-tripod", 1, "library", (0.2, 9.0), names=("monitor-misalignment",),
      kin=("loft-bias", "head-closure", "cg-shift"))
def mech(s, a, g):
    """The monitor stands out of level across the target line: a roll, which mixes azimuth with launch and tilts the spin."""
    b = s.blow()
    v, spin = vectors(b.launch(b.stuck()))
    r = rotation("x", np.full(s.n, np.radians(g.choice([-1, 1]) * a)))
    return s.x, read(np.einsum("nij,nj->ni", r, v), np.einsum("nij,nj->ni", r, spin))


# 2: several at once -------------------------------------------------------------------------------------------------------------

@kind("hook-setting", 2, "library", (0.1, 3.0), names=("head-closure", "cg-shift"), clubs=("driver", "iron"),
      kin=("head-inertia", "shaft-coupling", "monitor-misalignment", "loft-bias"))
def mech(s, a, g):
    """A weight moved to the heel, and a player who turns the head over."""
    head = dict(s.head, cg=s.head["cg"] + np.array([0, 2.5e-3 * a, 0]))
    axis = np.array([0.0, 0.5, 0.87])
    b = s.blow(head=head, omega=20 * a * (s.x["club_speed"] / np.mean(s.x["club_speed"]))[:, None] * axis)
    return s.x, b.launch(b.stuck())


@kind("junior-head", 2, "library", (0.1, 3.0), names=("head-mass", "loft-bias"),
      kin=("restitution-law", "normal-force-offset", "monitor-misalignment", "cg-shift"))
def mech(s, a, g):
    """A lighter head than declared, bent weak: the marker of the loft was not reset."""
    recorded = dict(s.x, dynamic_loft=s.x["dynamic_loft"] - 1.2 * a)
    mass = np.asarray(s.head["mass"])
    b = s.blow(head=dict(s.head, mass=mass * (1 - np.minimum(0.1 * a, 0.4))))
    return recorded, b.launch(b.stuck())


@kind("soft-cover-thin-edge", 2, "library", (0.05, 3.0), names=("restitution-falloff", "ball-tangential-compliance"),
      clubs=("driver", "iron"),
      kin=("face-compliance", "restitution-law", "head-mass", "ball-inertia", "normal-force-offset", "loft-bias", "contact-creep",
           "cg-shift", "head-inertia"))
def mech(s, a, g):
    """A ball with much shear spring, on a face that is dead towards its edge."""
    b = s.blow()
    q2 = (s.x["impact_toe"] / 20) ** 2 + (s.x["impact_high"] / 14) ** 2
    return s.x, b.launch(b.stuck(e=base_restitution(b.w) - 0.1 * a * q2 ** 1.3, et=0.25 * np.tanh(a)))


@kind("drift-on-a-tilt", 2, "library", (0.05, 4.0), names=("session-drift", "monitor-misalignment"),
      kin=("restitution-law", "loft-bias", "cg-shift", "head-closure", "head-mass", "face-compliance"))
def mech(s, a, g):
    """A monitor that is turned and nods, and balls that cool shot by shot."""
    b = s.blow()
    v, spin = vectors(b.launch(b.stuck(e=base_restitution(b.w) - 0.04 * a * ((s.shot - 1) / (s.n - 1) - 0.5))))
    r = rotation("z", np.full(s.n, np.radians(0.6 * a))) @ rotation("y", np.full(s.n, np.radians(-0.4 * a)))
    return s.x, read(np.einsum("nij,nj->ni", r, v), np.einsum("nij,nj->ni", r, spin))


@kind("spin-cancels", 2, "library", (0.1, 4.0), names=("loft-bias", "normal-force-offset"),
      kin=("ball-inertia", "monitor-misalignment", "ball-tangential-compliance", "friction-limit", "contact-creep", "cg-shift"))
def mech(s, a, g):
    """More loft than recorded, and a centre of pressure that takes the added spin away again, on the mean."""
    recorded = dict(s.x, dynamic_loft=s.x["dynamic_loft"] - a)
    goal = np.mean(Blow(recorded, s.head, s.ball).launch(Blow(recorded, s.head, s.ball).stuck())["back"])

    def out(offset):
        b = s.blow(offset=np.full(s.n, offset))
        return b.launch(b.stuck())

    none, some = np.mean(out(0.0)["back"]), np.mean(out(0.01)["back"])
    return recorded, out(0.01 * (goal - none) / (some - none))


@kind("cold-slick", 2, "library", (0.05, 3.0), names=("friction-limit", "restitution-law"), clubs=("wedge", "bag"),
      kin=("contact-creep", "head-mass", "ball-tangential-compliance", "loft-bias", "ball-relaxation", "face-compliance"))
def mech(s, a, g):
    """Frost: the ball is dead, more so in hard blows, and slides on an icy face."""
    b = s.blow()
    e = base_restitution(b.w) - 0.02 * a * (b.w / 20) ** 0.5
    j = b.slipping(lambda slip: 0.26 / (1 + 0.7 * a) + 0 * slip, e=e)
    return s.x, b.launch(j)


@kind("three-strands", 2, "library", (0.1, 3.0), names=("restitution-law", "cg-shift", "loft-bias"), clubs=("driver", "iron"),
      kin=("head-mass", "head-inertia", "normal-force-offset", "monitor-misalignment", "shaft-coupling", "face-compliance", "head-closure"))
def mech(s, a, g):
    """A used club from the rack: heavier in the toe, weaker by a degree, and range balls."""
    recorded = dict(s.x, dynamic_loft=s.x["dynamic_loft"] - 0.7 * a)
    b = s.blow(head=dict(s.head, cg=s.head["cg"] + np.array([0, -2.5e-3 * a, 1e-3 * a])))
    return recorded, b.launch(b.stuck(e=base_restitution(b.w) * (1 - 0.02 * a)))


# 3: the instrument --------------------------------------------------------------------------------------------------------------

def spin_columns(rec):
    return [c for c in SPINS if c in rec]


BAD = ("unexplained", "noise-contradicted", "insufficient")


@kind("bridged-gaps", 3, "instrument", (0.12, 0.7), guilty=tuple(SPINS), place=("mixture", "shot"), acceptable=BAD)
def fault(s, a, g, rec):
    """Spin was lost in a share of the shots; the export drew straight lines between the neighbours."""
    lost = g.random(s.n) < a
    lost[[0, -1]] = False
    i = np.arange(s.n)
    for c in spin_columns(rec):
        rec[c] = np.where(lost, np.interp(i, i[~lost], rec[c][~lost]), rec[c])


@kind("lie-board-loft", 3, "instrument", (0.12, 0.7), guilty=("dynamic_loft",), kin=("loft-bias",),
      place=("mixture", "dynamic_loft"), acceptable=BAD)
def fault(s, a, g, rec):
    """Where the camera missed the face, the loft is the setup's nominal one."""
    lost = g.random(s.n) < a
    groups = s.text["club"] if "club" in s.text else np.full(s.n, "one")
    for c in np.unique(groups):
        own = groups == c
        rec["dynamic_loft"] = np.where(lost & own, np.round(np.median(s.x["dynamic_loft"][own])), rec["dynamic_loft"])


@kind("narrow-view", 3, "instrument", (0.02, 0.97), guilty=("impact_toe", "impact_high"), clubs=("driver", "iron"),
      kin=("restitution-falloff", "head-inertia", "cg-shift"), place=("impact_toe", "impact_high"), acceptable=BAD)
def fault(s, a, g, rec):
    """The face camera sees the middle of the face: places outside stop at the edge of its picture."""
    for c in ("impact_toe", "impact_high"):
        middle, sd = np.mean(s.x[c]), np.std(s.x[c])
        rec[c] = np.clip(rec[c], middle - 2.6 * sd * (1 - a), middle + 2.6 * sd * (1 - a))


@kind("calm-display", 3, "instrument", (0.02, 0.95), guilty=("club_speed",), kin=(), place=("club_speed", "shot"), acceptable=BAD)
def fault(s, a, g, rec):
    """The club speed that is exported is the display's, a running mean of the last swings."""
    groups = s.text["club"] if "club" in s.text else np.full(s.n, "one")
    new = rec["club_speed"].copy()
    for c in np.unique(groups):
        own = np.flatnonzero(groups == c)
        for i, j in zip(own[:-1], own[1:]):
            new[j] = (1 - a) * rec["club_speed"][j] + a * new[i]
    rec["club_speed"] = new


@kind("one-behind", 3, "instrument", (0.12, 1.0), guilty=("impact_toe", "impact_high"), clubs=("driver", "iron"),
      kin=(), place=("impact_toe", "impact_high", "shot", "mixture"), acceptable=BAD)
def fault(s, a, g, rec):
    """The face camera dropped a picture; from then on each place belongs to the shot before."""
    first = max(1, int(round((1 - a) * s.n)))
    for c in ("impact_toe", "impact_high"):
        rec[c] = np.concatenate([rec[c][:first], rec[c][first - 1:-1]])


@kind("lost-sign", 3, "instrument", (0.12, 1.0), guilty=("sidespin", "spin_axis"), kin=(),
      place=("face_angle", "club_path", "shot", "mixture"), acceptable=BAD)
def fault(s, a, g, rec):
    """After an update the letters L and R of the spin are dropped."""
    late = np.arange(s.n) >= round((1 - a) * s.n)
    for c in ("sidespin", "spin_axis"):
        if c in rec:
            rec[c] = np.where(late, np.abs(rec[c]), rec[c])


@kind("stroboscope", 3, "instrument", (0.1, 0.8), guilty=tuple(SPINS), kin=("friction-limit", "contact-creep"),
      place=("dynamic_loft", "club_speed", "mixture"), acceptable=BAD)
def fault(s, a, g, rec):
    """Two flashes: above half a turn between them the spin folds back."""
    rate = rec["spin_rate"] if "spin_rate" in rec else np.hypot(rec["backspin"], rec["sidespin"])
    fold = np.quantile(rate, 1 - a)
    scale = np.where(rate > fold, (2 * fold - rate) / rate, 1.0)
    for c in ("spin_rate", "backspin", "sidespin"):
        if c in rec:
            rec[c] = rec[c] * scale


@kind("barrel-lens", 3, "instrument", (0.01, 3.0), guilty=("launch_angle",), names=("monitor-misalignment",),
      kin=("loft-bias", "normal-force-offset"), place=("launch_angle", "dynamic_loft", "attack_angle"),
      acceptable=("unexplained", "insufficient", "ambiguous", "explained"))
def fault(s, a, g, rec):
    """The lens shrinks angles far from its axis, which looks 6 degrees below the usual launch."""
    d = rec["launch_angle"] - (np.mean(s.clean["launch_angle"]) - 6)
    rec["launch_angle"] = rec["launch_angle"] - a * d**3 / 100


@kind("left-handed-guest", 3, "instrument", (0.12, 0.45), kin=(),
      guilty=("azimuth", "sidespin", "spin_axis", "club_path", "face_angle", "impact_toe"),
      place=("player", "shot", "mixture", "face_angle", "club_path", "session"), acceptable=BAD)
def fault(s, a, g, rec):
    """A left-handed guest in the middle of the session: club columns in his own sense, ball columns in the range's."""
    k = max(1, int(round(a * s.n)))
    start = int(g.uniform(0.1, 0.5) * s.n)
    own = (np.arange(s.n) >= start) & (np.arange(s.n) < start + k)
    for c in ("azimuth", "sidespin", "spin_axis"):
        if c in rec:
            rec[c] = np.where(own, -rec[c], rec[c])
    if "player" in rec:
        rec["player"] = np.where(own, "guest", rec["player"])


@kind("swing-plane-path", 3, "instrument", (0.05, 1.6), guilty=("club_path",), kin=("monitor-misalignment", "head-closure", "cg-shift"),
      place=("attack_angle", "club_path"), acceptable=("unexplained", "insufficient", "ambiguous"))
def fault(s, a, g, rec):
    """What is printed as path is the direction of the swing plane: path plus attack over the plane's tangent."""
    rec["club_path"] = rec["club_path"] + a * rec["attack_angle"] / np.tan(np.radians(58))


@kind("pasted-block", 3, "instrument", (0.11, 0.45), guilty=("launch_angle", "azimuth"), kin=(),
      place=("shot", "mixture", "session"), acceptable=BAD)
def fault(s, a, g, rec):
    """In the spreadsheet a block of launch angles and azimuths was pasted over the block after it."""
    k = max(2, int(round(a * s.n)))
    start = int(g.uniform(0, s.n - 2 * k))
    for c in ("launch_angle", "azimuth"):
        rec[c] = rec[c].copy()
        rec[c][start + k:start + 2 * k] = rec[c][start:start + k]


# 4: in no list ------------------------------------------------------------------------------------------------------------------

@kind("dented-face", 4, "none", (0.01, 0.6), clubs=("driver", "iron"), place=("impact_toe", "impact_high"),
      kin=("restitution-falloff", "face-compliance", "cg-shift", "restitution-law", "head-inertia"),
      acceptable=("unexplained", "insufficient"))
def mech(s, a, g):
    """A cracked spot on one side of the face gives way."""
    b = s.blow()
    t, h = g.choice([-7, 7]), g.choice([-4, 4])
    d2 = (s.x["impact_toe"] - np.mean(s.x["impact_toe"]) - t) ** 2 + (s.x["impact_high"] - np.mean(s.x["impact_high"]) - h) ** 2
    return s.x, b.launch(b.stuck(e=base_restitution(b.w) - a * np.exp(-d2 / 50)))


@kind("shower", 4, "none", (0.02, 4.0), clubs=("wedge", "bag"), place=("shot", "mixture", "session"),
      kin=("friction-limit", "contact-creep", "ball-tangential-compliance", "session-drift"), acceptable=("unexplained", "insufficient", "ambiguous"))
def mech(s, a, g):
    """Rain begins at one shot: water between ball and face until it stops."""
    b = s.blow()
    t = np.arange(s.n) / s.n
    start = g.uniform(0.25, 0.45)
    wet = (t > start) & (t < start + 0.35)
    mu = np.where(wet, 0.26 / (1 + a), 2.0)
    return s.x, b.launch(b.slipping(lambda slip: mu))


@kind("grain-of-the-face", 4, "none", (0.02, 0.9), place=("face_angle", "club_path", "impact_toe"),
      kin=("ball-tangential-compliance", "ball-inertia", "contact-creep", "normal-force-offset", "head-inertia"),
      acceptable=("unexplained", "insufficient"))
def mech(s, a, g):
    """Grooves let the ball spring back along them but not across: tangential restitution has a direction."""
    b = s.blow()
    return s.x, b.launch(b.stuck(et_along=g.choice([-1, 1]) * a))


@kind("belt-wave", 4, "none", (0.003, 0.12), kin=(), place=("shot", "session"), acceptable=("unexplained", "insufficient", "noise-contradicted"))
def mech(s, a, g):
    """The heater of the ball hopper cycles: restitution goes up and down with the shots, four to seven times."""
    b = s.blow()
    phase = 2 * np.pi * (s.shot / s.n * g.uniform(4, 7) + g.random())
    wave = np.sin(phase) + 0.3 * np.sin(2 * phase)
    return s.x, b.launch(b.stuck(e=base_restitution(b.w) + a * wave))


@kind("stray-range-balls", 4, "none", (0.005, 0.3), place=("mixture",),
      kin=("restitution-law", "head-mass", "ball-tangential-compliance", "face-compliance"),
      acceptable=("unexplained", "insufficient", "noise-contradicted"))
def mech(s, a, g):
    """A fifth of the balls are worn range balls, and nobody wrote down which."""
    b = s.blow()
    stray = g.random(s.n) < 0.2
    return s.x, b.launch(b.stuck(e=base_restitution(b.w) - a * stray, et=-2.0 * a * stray))


@kind("toe-hangs", 4, "none", (0.8, 25.0), clubs=("driver",), place=("impact_toe", "impact_high"),
      kin=("cg-shift", "head-inertia", "monitor-misalignment", "shaft-coupling", "head-closure"), acceptable=("unexplained", "insufficient"))
def mech(s, a, g):
    """The shaft droops: the face's own axes are turned about its normal, toe down, against those of the camera's picture."""
    b = s.blow(lie=np.full(s.n, -a))
    return s.x, b.launch(b.stuck())


@kind("rubber-tee", 4, "none", (0.1, 8.0), clubs=("driver",), place=("impact_high",),
      kin=("loft-bias", "normal-force-offset", "cg-shift", "restitution-law", "restitution-falloff", "friction-limit", "contact-creep"),
      acceptable=("unexplained", "insufficient"))
def mech(s, a, g):
    """Low strikes drag the ball over the lip of a rubber tee: less spin, less speed, higher start."""
    b = s.blow()
    out = b.launch(b.stuck())
    touch = a / (1 + np.exp((s.x["impact_high"] - np.mean(s.x["impact_high"]) + 3) / 1.5))
    return s.x, dict(out, back=out["back"] - 220 * touch, ball_speed=out["ball_speed"] - 0.3 * touch,
                     launch_angle=out["launch_angle"] + 0.4 * touch)


@kind("one-bent-club", 4, "none", (0.2, 8.0), needs=("player",), guilty=("dynamic_loft",), place=("player", "club", "mixture"),
      kin=("loft-bias", "normal-force-offset", "monitor-misalignment"), acceptable=("insufficient", "unexplained", "ambiguous"))
def mech(s, a, g):
    """One player's club has a bent hosel: what is recorded is not the loft that his balls met. The others' is right."""
    his = s.text["player"] == np.unique(s.text["player"])[-1]
    b = s.blow()
    return dict(s.x, dynamic_loft=s.x["dynamic_loft"] - g.choice([-1, 1]) * a * his), b.launch(b.stuck())


@kind("grass-between", 4, "none", (0.02, 0.9), clubs=("iron", "wedge", "bag"), place=("attack_angle",),
      kin=("friction-limit", "contact-creep", "ball-tangential-compliance", "loft-bias", "ball-relaxation", "normal-force-offset"),
      acceptable=("unexplained", "insufficient"))
def mech(s, a, g):
    """A shallow attack traps more grass: the ball leaves short of rolling, by an amount that follows the attack angle."""
    b = s.blow()
    t = (s.x["attack_angle"] - np.mean(s.x["attack_angle"])) / np.std(s.x["attack_angle"])
    return s.x, b.launch(b.stuck(et=-a / (1 + np.exp(-2.5 * (t - 0.3)))))


@kind("six-balls-in-turn", 4, "none", (0.004, 0.15), kin=(), place=("shot", "mixture"), acceptable=("unexplained", "insufficient", "noise-contradicted"))
def mech(s, a, g):
    """The robot takes six marked balls in turn, and each has its own restitution."""
    b = s.blow()
    own = np.array([1.3, -0.4, 0.6, -1.5, 0.9, -0.9])[g.permutation(6)]
    return s.x, b.launch(b.stuck(e=base_restitution(b.w) + a * own[(s.shot - 1) % 6]))


# 5: nothing ---------------------------------------------------------------------------------------------------------------------

KINDS["plain"] = Kind("plain", 5, "null", (1.0, 1.0), acceptable=())


@kind("student-tails", 5, "null", (1.0, 1.0), acceptable=("noise-contradicted",))
def noise(s, g, sd):
    """Student's noise with five degrees of freedom, of the declared standard deviation."""
    return {c: v * g.standard_t(5, s.n) * np.sqrt(3 / 5) for c, v in sd.items()}


@kind("tied-channels", 5, "null", (1.0, 1.0), acceptable=("noise-contradicted",))
def noise(s, g, sd):
    """One error of the ball's picture moves launch angle and spin together."""
    out = {c: v * g.standard_normal(s.n) for c, v in sd.items()}
    c = "backspin" if "backspin" in sd else "spin_rate"
    out[c] = sd[c] * (0.65 * out["launch_angle"] / sd["launch_angle"] + np.sqrt(1 - 0.65**2) * out[c] / sd[c])
    return out


@kind("per-cent-noise", 5, "null", (1.0, 1.0), acceptable=("noise-contradicted",))
def noise(s, g, sd):
    """Errors in proportion to the reading; declared is their root mean square."""
    out = {}
    for c, v in sd.items():
        grow = np.abs(s.clean[c]) if c in ("ball_speed", "backspin", "spin_rate") else np.ones(s.n)
        out[c] = v * grow / np.sqrt(np.mean(grow**2)) * g.standard_normal(s.n)
    return out


@kind("kept-good-shots", 5, "null", (1.0, 1.0), acceptable=("noise-contradicted",))
def noise(s, g, sd):
    """Readings with an error beyond 2.2 standard deviations were measured again; declared is the maker's figure."""
    out = {}
    for c, v in sd.items():
        e = g.standard_normal(s.n)
        while np.any(np.abs(e) > 2.2):
            e = np.where(np.abs(e) > 2.2, g.standard_normal(s.n), e)
        out[c] = v * e
    return out


@kind("coarse-display", 5, "null", (1.0, 1.0), acceptable=("noise-contradicted",))
def fault(s, a, g, rec):
    """The display's digits: the step is 0.8 of the noise; the declared noise includes it."""
    for c in s.channels:
        step = 0.8 * s.sd[c] / np.sqrt(1 + 0.8**2 / 12)
        rec[c] = np.round(rec[c] / step) * step
