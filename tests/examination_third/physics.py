"""The blow of a rigid head on a ball, in the frames of the specification; all shots at once.

The ball takes one impulse J at the contact point. What a real club or ball does otherwise is a field of `Club`.
"""

import dataclasses
import typing

import numpy as np

RPM = 60 / (2 * np.pi)
INPUTS = ("club_speed", "attack_angle", "club_path", "face_angle", "dynamic_loft", "impact_toe", "impact_high")  # m/s, deg, mm


def linear_law(vn, x):
    return 0.86 - 0.0029 * vn


@dataclasses.dataclass
class Club:
    """SI; a number or one value a shot. The functions get the deliveries x and speeds of approach."""
    mass: typing.Any
    cg: typing.Any
    inertia: typing.Any
    bulge: float = np.inf
    roll: float = np.inf
    ball_mass: typing.Any = 0.04593
    ball_radius: float = 0.021335
    ball_factor: typing.Any = 0.4
    omega: typing.Any = (0.0, 0.0, 0.0)
    restitution: typing.Callable = linear_law  # (vn, x)
    tangential: typing.Callable = lambda vn, vt, x: 0 * vn  # share of the tangential speed that is returned
    friction: typing.Callable = lambda vt, x: np.full_like(vt, np.inf)
    grain: float = 1.0  # share of the impulse along the grooves that the face transmits
    twist: typing.Callable = None  # (toe, high) -> degrees that the normal is open and lofted beyond the declared face


def turn(axis, degrees):
    """Rotation matrices about the axis x, y or z."""
    a = np.radians(np.atleast_1d(degrees).astype(float))
    c, s, i = np.cos(a), np.sin(a), "xyz".index(axis)
    j, k = (i + 1) % 3, (i + 2) % 3
    m = np.zeros((len(a), 3, 3))
    m[:, i, i] = 1
    m[:, j, j] = m[:, k, k] = c
    m[:, k, j], m[:, j, k] = s, -s
    return m


def apply(m, v):
    return np.einsum("...ij,...j->...i", m, v)


def dot(a, b):
    return np.sum(a * b, axis=-1, keepdims=True)


def cross_matrix(v):
    m = np.zeros((*v.shape[:-1], 3, 3))
    m[..., 0, 1], m[..., 0, 2], m[..., 1, 2] = -v[..., 2], v[..., 1], -v[..., 0]
    return m - np.swapaxes(m, -1, -2)


def blow(x, club):
    """Velocity and spin of the ball; under `_` what conservation laws need."""
    n = len(x["club_speed"])
    col = lambda a: np.broadcast_to(np.asarray(a, float), (n,))[:, None]
    y, z = -x["impact_toe"] / 1e3, x["impact_high"] / 1e3
    R = turn("z", -x["face_angle"]) @ turn("y", -x["dynamic_loft"])
    point = np.stack([-(y * y / club.bulge + z * z / club.roll) / 2, y, z], -1)
    normal = np.stack([np.ones(n), y / club.bulge, z / club.roll], -1)
    if club.twist:
        opened, lofted = club.twist(x["impact_toe"], x["impact_high"])
        normal = apply(turn("z", -opened) @ turn("y", -lofted), normal)
    normal = apply(R, normal / np.linalg.norm(normal, axis=-1, keepdims=True))
    attack, path = np.radians(x["attack_angle"]), np.radians(x["club_path"])
    V = x["club_speed"][:, None] * np.stack([np.cos(attack) * np.cos(path), -np.cos(attack) * np.sin(path), np.sin(attack)], -1)
    W = np.broadcast_to(np.asarray(club.omega, float), (n, 3))
    arm = apply(R, point - np.asarray(club.cg))
    inertia = R @ np.broadcast_to(np.asarray(club.inertia, float), (n, 3, 3)) @ np.swapaxes(R, 1, 2)
    m, M, r = col(club.ball_mass), col(club.mass), club.ball_radius
    ball_inertia = col(club.ball_factor) * m * r * r
    ball_arm = -r * normal

    X, Xb = cross_matrix(arm), cross_matrix(ball_arm)
    K = (1 / m + 1 / M)[:, :, None] * np.eye(3) - Xb @ Xb / ball_inertia[:, :, None] - X @ np.linalg.inv(inertia) @ X
    before = -(V + np.cross(W, arm))  # surface of the ball against that of the head
    vn = -dot(before, normal)
    across = before + vn * normal
    vt = np.linalg.norm(across, axis=-1)
    e = club.restitution(vn[:, 0], x)[:, None]
    after = e * vn * normal - club.tangential(vn[:, 0], vt, x)[:, None] * across
    J = np.linalg.solve(K, (after - before)[:, :, None])[:, :, 0]
    Jn = dot(J, normal)
    Jt = J - Jn * normal
    size = np.linalg.norm(Jt, axis=-1, keepdims=True)
    mu = club.friction(vt, x)[:, None]
    slides = size > mu * Jn
    along = Jt / np.maximum(size, 1e-12)
    push = normal + np.where(slides, mu, 0) * along
    J = np.where(slides, push * (1 + e) * vn / dot(normal, apply(K, push)), J)
    if club.grain != 1:
        groove = R[:, :, 1]
        J = J - (1 - club.grain) * dot(J - dot(J, normal) * normal, groove) * groove
    v, w = J / m, np.cross(ball_arm, J) / ball_inertia
    head = V - J / M, W - apply(np.linalg.inv(inertia), np.cross(arm, J))
    return {"v": v, "w": w, "_": {"V": V, "W": W, "after": head, "arm": arm, "ball_arm": ball_arm, "inertia": inertia,
                                  "ball_inertia": ball_inertia, "m": m, "M": M, "normal": normal, "e": e, "vn": vn, "J": J}}


def launch(v, w):
    speed = np.linalg.norm(v, axis=-1)
    back, side = -w[:, 1] * RPM, -w[:, 2] * RPM
    return {"ball_speed": speed, "launch_angle": np.degrees(np.arcsin(v[:, 2] / speed)),
            "azimuth": np.degrees(np.arctan2(-v[:, 1], v[:, 0])), "backspin": back, "sidespin": side,
            "riflespin": w[:, 0] * RPM, "spin_rate": np.linalg.norm(w, axis=-1) * RPM,
            "spin_axis": np.degrees(np.arctan2(side, back))}


def base(x, club):
    b = blow(x, club)
    return launch(b["v"], b["w"])
