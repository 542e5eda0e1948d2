"""A blow as one linear system: momenta of ball and head, and three conditions where they touch.

All vectors are in the face frame of frames-and-data.md (Xc out of the face, Yc to the heel, Zc up) until `launch` turns them into
the global one. Unknown are the 12 velocities q = (ball, ball's spin, head, head's turning) after the blow, and the impulse J on the
ball along (normal, up the face, across it):

    M q - H J = M q0        G q = wanted velocity of the ball's surface against the face

G measures that velocity, H distributes the impulse; they differ where the normal force misses the ball's centre. Where the ball
slides, two conditions on J replace the tangential ones. A part that is fixed to the head is an addition to its block of M.
"""

import dataclasses

import numpy as np

INPUTS = ("club_speed", "attack_angle", "dynamic_loft", "club_path", "face_angle", "impact_toe", "impact_high")


@dataclasses.dataclass
class Ball:
    mass: float = 0.04593
    radius: float = 0.021335
    factor: object = 0.4  # I / (m r^2), or one for each shot


@dataclasses.dataclass
class Head:
    mass: object  # or one for each shot
    cg: np.ndarray
    inertia: np.ndarray
    bulge: float = np.inf
    roll: float = np.inf
    added: object = 0.0  # 6 x 6 about the cg: what is fixed to the head


def cross_matrix(v):
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def attached(translation, rotation, lever):
    """6 x 6 about the centre of gravity of a part with these 3 x 3 inertias at a lever from it."""
    s = cross_matrix(lever)
    return np.block([[translation, -translation @ s], [s @ translation, rotation - s @ translation @ s]])


def turn(loft, face):
    """Face to global: Rz(-face) Ry(-loft)."""
    cl, sl, cf, sf, o = np.cos(loft), np.sin(loft), np.cos(face), np.sin(face), np.zeros_like(loft)
    return np.stack([np.stack([cf * cl, sf, -cf * sl], -1), np.stack([-sf * cl, cf, sf * sl], -1), np.stack([sl, o, cl], -1)], -2)


class Contact:
    """Geometry and approach of n blows: what the laws of a kind may depend on."""

    def __init__(self, x, head, ball, turning=None):
        self.x, self.head, self.ball = x, head, ball
        self.toe, self.high = x["impact_toe"], x["impact_high"]
        n, y, z = len(self.toe), -self.toe, self.high
        self.frame = turn(x["dynamic_loft"], x["face_angle"])
        point = np.stack([-(y**2 / head.bulge + z**2 / head.roll) / 2, y, z], -1)
        normal = np.stack([np.ones(n), y / head.bulge, z / head.roll], -1)
        normal /= np.linalg.norm(normal, axis=1)[:, None]
        up = np.array([0.0, 0, 1]) - normal[:, 2:] * normal
        up /= np.linalg.norm(up, axis=1)[:, None]
        self.axes = np.stack([normal, up, np.cross(normal, up)], 1)
        self.arm_head, self.arm_ball = point - head.cg, -ball.radius * normal
        v, a, p = x["club_speed"], x["attack_angle"], x["club_path"]
        velocity = v[:, None] * np.stack([np.cos(a) * np.cos(p), -np.cos(a) * np.sin(p), np.sin(a)], -1)
        self.before = np.zeros((n, 12))
        self.before[:, 6:9] = np.einsum("nji,nj->ni", self.frame, velocity)
        if turning is not None:
            self.before[:, 9:] = turning
        self.gap = self.gather(0)
        slip = np.einsum("nij,nj->ni", self.gap, self.before)
        self.closing, self.slip = -slip[:, 0], slip[:, 1:]
        self.obliquity = np.arctan2(np.hypot(*self.slip.T), self.closing)

    def gather(self, offset):
        """n x 3 x 12: velocity of the ball's surface against the face, for a normal that passes `offset` radii above the centre."""
        shift = (np.zeros(len(self.toe)) + offset)[:, None] * self.ball.radius * self.axes[:, 1]
        rows = []
        for k in range(3):
            d, moved = self.axes[:, k], shift if k == 0 else 0
            rows.append(np.hstack([d, np.cross(self.arm_ball + moved, d), -d, -np.cross(self.arm_head + moved, d)]))
        return np.stack(rows, 1)

    def masses(self):
        n, m = len(self.toe), np.zeros((len(self.toe), 12, 12))
        i = np.arange(3)
        m[:, i, i] = self.ball.mass
        m[:, i + 3, i + 3] = (np.zeros(n) + self.ball.factor)[:, None] * self.ball.mass * self.ball.radius**2
        m[:, i + 6, i + 6] = (np.zeros(n) + self.head.mass)[:, None]
        m[:, 9:, 9:] = self.head.inertia
        m[:, 6:, 6:] += self.head.added
        return m


def base_restitution(c):
    return 0.86 - 0.0029 * c.closing


def strike(c, e=base_restitution, et=0.0, friction=np.inf, soft=False, offset=0.0):
    """(velocities after, impulse). Laws are numbers or functions of the contact; `et` may have a column for each direction; with
    `soft` the friction saturates as a hyperbolic tangent instead of at once."""
    value = lambda law: law(c) if callable(law) else law
    n, m = len(c.toe), c.masses()
    a, b = np.zeros((n, 15, 15)), np.zeros((n, 15))
    a[:, :12, :12], a[:, :12, 12:] = m, -np.swapaxes(c.gather(value(offset)), 1, 2)
    a[:, 12:, :12] = c.gap
    b[:, :12] = np.einsum("nij,nj->ni", m, c.before)
    b[:, 12] = value(e) * c.closing
    tangential = np.asarray(value(et), float)
    b[:, 13:] = -(tangential if tangential.ndim == 2 else (np.zeros(n) + tangential)[:, None]) * c.slip
    solve = lambda a, b: np.linalg.solve(a, b[..., None])[..., 0]
    s = solve(a, b)
    limit = np.zeros(n) + value(friction)
    ratio = np.hypot(s[:, 13], s[:, 14]) / s[:, 12]
    reached = limit * np.tanh(ratio / limit) if soft else np.minimum(ratio, limit)
    slides = reached < ratio
    if slides.any():
        direction = c.slip / np.hypot(*c.slip.T)[:, None]
        a[slides, 13:] = 0
        a[slides, 13, 13] = a[slides, 14, 14] = 1
        a[slides, 13:, 12] = (reached[:, None] * direction)[slides]
        b[slides, 13:] = 0
        s[slides] = solve(a[slides], b[slides])
    return s[:, :12], s[:, 12:]


def readings(velocity, spin):
    """Launch of global vectors, in radians and SI."""
    speed, rate = np.linalg.norm(velocity, axis=1), np.linalg.norm(spin, axis=1)
    return {"ball_speed": speed, "launch_angle": np.arcsin(velocity[:, 2] / speed),
            "azimuth": np.arctan2(-velocity[:, 1], velocity[:, 0]),
            "backspin": -spin[:, 1], "sidespin": -spin[:, 2], "spin_rate": rate, "spin_axis": np.arctan2(-spin[:, 2], -spin[:, 1])}


def launch(c, after):
    return readings(*(np.einsum("nij,nj->ni", c.frame, after[:, k : k + 3]) for k in (0, 3)))


def base(x, head, ball=Ball()):
    c = Contact(x, head, ball)
    return launch(c, strike(c)[0])
