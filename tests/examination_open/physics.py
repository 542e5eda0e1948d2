"""An impact of a ball on a free rigid head in three dimensions, written for this examination alone.

SI units and radians. Arrays run over the shots: scalars (n,), vectors (n, 3), matrices (n, 3, 3). Frames and signs are
those of docs/code.md: X to the target, Z up, Y towards a right-handed golfer; the face frame is the global one turned
by Rz(-face angle) Ry(-dynamic loft).
"""

import numpy as np

RADIUS, MASS, FACTOR = 0.021335, 0.04593, 0.4
INPUTS = ["club_speed", "attack_angle", "dynamic_loft", "club_path", "face_angle", "impact_toe", "impact_high"]
CHANNELS = ["ball_speed", "launch_angle", "azimuth", "backspin", "sidespin"]


def skew(v):
    m = np.zeros(v.shape[:-1] + (3, 3))
    m[..., 0, 1], m[..., 0, 2], m[..., 1, 2] = -v[..., 2], v[..., 1], -v[..., 0]
    return m - np.swapaxes(m, -1, -2)


def dot(a, b):
    return np.sum(a * b, axis=-1)


def times(m, v):
    return np.einsum("...ij,...j->...i", m, v)


class Head:
    """Mass [kg] (a number or one for each shot), centre of gravity [m], inertia about it [kg m^2], bulge and roll [m]."""

    def __init__(self, mass, cg, inertia, bulge=np.inf, roll=np.inf):
        self.mass, self.cg, self.inertia = mass, np.asarray(cg, float), np.asarray(inertia, float)
        self.bulge, self.roll = bulge, roll


class Blow:
    """Geometry and velocities at first contact, `omega` [rad/s] the head's turning in global axes."""

    def __init__(self, x, head, omega=None):
        self.x, self.head = x, head
        n = len(x["club_speed"])
        sl, cl, sf, cf = (f(x[k]) for k in ("dynamic_loft", "face_angle") for f in (np.sin, np.cos))
        zero, one = np.zeros(n), np.ones(n)
        loft = np.stack([np.stack([cl, zero, -sl], -1), np.stack([zero, one, zero], -1), np.stack([sl, zero, cl], -1)], -2)
        face = np.stack([np.stack([cf, sf, zero], -1), np.stack([-sf, cf, zero], -1), np.stack([zero, zero, one], -1)], -2)
        self.turn = face @ loft
        y, z = -x["impact_toe"], x["impact_high"]
        self.toe, self.high = x["impact_toe"], x["impact_high"]
        self.distance = np.hypot(y, z)
        point = np.stack([-(y**2 / (2 * head.bulge) + z**2 / (2 * head.roll)), y, z], -1)
        normal = np.stack([one, y / head.bulge, z / head.roll], -1)
        self.n = times(self.turn, normal / np.linalg.norm(normal, axis=-1)[:, None])
        self.c = times(self.turn, point - head.cg)  # centre of gravity to contact
        self.a = -RADIUS * self.n  # ball's centre to contact
        v, at, p = x["club_speed"], x["attack_angle"], x["club_path"]
        self.v = v[:, None] * np.stack([np.cos(at) * np.cos(p), -np.cos(at) * np.sin(p), np.sin(at)], -1)
        self.omega = np.zeros((n, 3)) if omega is None else omega
        self.w = self.v + np.cross(self.omega, self.c)  # of the face past the ball, at the contact
        self.approach = dot(self.w, self.n)
        self.slip = self.w - self.approach[:, None] * self.n
        self.slip_speed = np.linalg.norm(self.slip, axis=-1)
        self.angle = np.arctan2(self.slip_speed, self.approach)
        eye = np.eye(3)
        self.mass = np.broadcast_to(np.asarray(head.mass, float), (n,))
        self.inertia = self.turn @ np.broadcast_to(head.inertia, (n, 3, 3)) @ np.swapaxes(self.turn, -1, -2)
        self.yields = np.linalg.inv(self.inertia)  # of the head to a couple
        self.ball = eye / MASS - skew(self.a) @ skew(self.a) / (FACTOR * MASS * RADIUS**2)
        self.k = self.ball + eye / self.mass[:, None, None] - skew(self.c) @ self.yields @ skew(self.c)


def rigid(b, e, et=0.0, mu=np.inf):
    """Impulse on the ball: e returned of the approach, et of the slip, unless friction mu lets it slide throughout."""
    e, et, mu = (np.broadcast_to(q, b.approach.shape) for q in (e, et, mu))
    wanted = ((1 + e) * b.approach)[:, None] * b.n + (1 + et)[:, None] * b.slip
    J = np.linalg.solve(b.k, wanted[..., None])[..., 0]
    jn = dot(J, b.n)
    jt = J - jn[:, None] * b.n
    size = np.linalg.norm(jt, axis=-1)
    slides = size > mu * jn
    if slides.any():
        d = b.n + np.where(slides, mu, 0)[:, None] * jt / np.maximum(size, 1e-300)[:, None]
        sliding = ((1 + e) * b.approach / dot(b.n, times(b.k, d)))[:, None] * d
        J = np.where(slides[:, None], sliding, J)
    return J


def compliant(b, e, ratio, mu, loss=0.0, steps=2000):
    """Impulse of a contact that lasts: normal spring F = k d, which gives e^2 of its energy back; across it a spring of
    `ratio` times k that slips where it pulls more than mu F and a damper of `loss` times the critical one. The bodies keep
    the configuration of first contact. Returns J and the energy that is in the springs at separation over that before."""
    n = len(b.approach)
    e, mu = np.broadcast_to(e, (n,)), np.broadcast_to(mu, (n,))
    knn = dot(b.n, times(b.k, b.n))
    rate = 2 * np.pi / 9e-4  # half a period lasts 0.45 ms
    k = rate**2 / knn
    h = 6e-4 / steps
    d, u, w, J = np.zeros(n), np.zeros((n, 3)), b.w.copy(), np.zeros((n, 3))
    open_ = np.ones(n, bool)
    across = (ratio * k)[:, None]
    soft = loss * np.sqrt(ratio) * 2 * k / rate * np.sqrt(2 / 7)
    while open_.any():
        wn = dot(w, b.n)
        d = np.where(open_, d + h * wn, d)
        u = np.where(open_[:, None], u + h * (w - wn[:, None] * b.n), u)
        open_ &= d > 0
        fn = k * d * np.where(wn > 0, 1, e**2)
        pull = across * u + soft[:, None] * (w - wn[:, None] * b.n)
        size = np.linalg.norm(pull, axis=-1)
        keep = np.where(mu * np.fmax(fn, 1e-300) < size, mu * fn / np.maximum(size, 1e-300), 1)
        u = np.where((open_ & (keep < 1))[:, None], u * keep[:, None], u)
        f = np.where(open_[:, None], fn[:, None] * b.n + keep[:, None] * pull, 0)
        J += h * f
        w -= h * times(b.k, f)
    before = 0.5 * dot(b.w, np.linalg.solve(b.k, b.w[..., None])[..., 0])
    return J, 0.5 * across[:, 0] * dot(u, u) / before


def after(b, J):
    """Velocity and spin of the ball, then velocity and turning of the head."""
    return (J / MASS, np.cross(b.a, J) / (FACTOR * MASS * RADIUS**2), b.v - J / b.mass[:, None],
            b.omega - times(b.yields, np.cross(b.c, J)))


def launch(b, J):
    v, spin = after(b, J)[:2]
    speed = np.linalg.norm(v, axis=-1)
    return {"ball_speed": speed, "launch_angle": np.arcsin(v[:, 2] / speed), "azimuth": np.arctan2(-v[:, 1], v[:, 0]),
            "backspin": -spin[:, 1], "sidespin": -spin[:, 2]}


def base_restitution(b):
    return 0.86 - 0.0029 * b.approach


def base(x, head):
    """The base model of the cases: no slip after the blow, restitution 0.86 - 0.0029 v."""
    b = Blow(x, head)
    return launch(b, rigid(b, base_restitution(b)))


def planar(head):
    """A head that does not turn: what the planar base takes any head for."""
    return Head(head.mass, head.cg, np.eye(3) * 1e6)
