"""A ball struck by a free rigid head in three dimensions, many shots at once. SI units and radians; frames of frames-and-data.md."""

import numpy as np


def cross_matrix(v):
    m = np.zeros(v.shape[:-1] + (3, 3))
    m[..., 0, 1], m[..., 0, 2], m[..., 1, 2] = -v[..., 2], v[..., 1], -v[..., 0]
    m[..., 1, 0], m[..., 2, 0], m[..., 2, 1] = v[..., 2], -v[..., 1], v[..., 0]
    return m


def mat_vec(m, v):
    return np.einsum("...ij,...j->...i", m, v)


def dot(a, b):
    return np.sum(a * b, axis=-1)


def rotation(axis, angle):
    """Right-handed, about a global axis x, y or z."""
    c, s = np.cos(angle), np.sin(angle)
    i, j = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
    r = np.zeros(np.shape(angle) + (3, 3))
    k = 3 - i - j
    r[..., k, k] = 1
    r[..., i, i] = r[..., j, j] = c
    r[..., i, j], r[..., j, i] = -s, s
    return r


def base_restitution(w):
    return 0.86 - 0.0029 * w


class Blow:
    """Geometry, velocities and the matrix of the blow, before any law of contact."""

    def __init__(self, x, head, ball, lie=0.0, omega=None, offset=None):
        """x: dict of the inputs (m/s, deg, mm). head: mass (n), cg (3) or (n, 3) m, inertia (3, 3) or (n, 3, 3), bulge, roll m.
        ball: mass, radius, inertia factor. lie: deg, of the face's frame about its normal, positive toe up. omega: (n, 3)."""
        deg = np.pi / 180
        n = len(x["club_speed"])
        loft, face = x["dynamic_loft"] * deg, x["face_angle"] * deg
        attack, path = x["attack_angle"] * deg, x["club_path"] * deg
        self.n_shots = n
        self.ball = {k: np.broadcast_to(np.asarray(v, float), (n,)) for k, v in ball.items()}
        self.head_mass = np.broadcast_to(np.asarray(head["mass"], float), (n,))
        turn = rotation("z", -face) @ rotation("y", -loft)
        if np.any(np.asarray(lie) != 0):
            # toe is -Yc: toe up is a turn about +Xc by the negative angle
            turn = turn @ rotation("x", np.broadcast_to(-np.asarray(lie, float) * deg, (n,)))
        y, z = -x["impact_toe"] * 1e-3, x["impact_high"] * 1e-3
        kb, kr = 1 / head["bulge"], 1 / head["roll"]
        place = np.stack([-(y * y * kb + z * z * kr) / 2, y, z], -1)
        normal = np.stack([np.ones(n), y * kb, z * kr], -1)
        normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
        self.turn = turn
        self.normal = mat_vec(turn, normal)
        self.lever = mat_vec(turn, place - np.broadcast_to(head["cg"], (n, 3)))
        inertia = turn @ np.broadcast_to(head["inertia"], (n, 3, 3)) @ np.swapaxes(turn, -1, -2)
        self.head_inverse = np.linalg.inv(inertia)
        v = x["club_speed"]
        self.velocity = np.stack([v * np.cos(attack) * np.cos(path), -v * np.cos(attack) * np.sin(path), v * np.sin(attack)], -1)
        if omega is not None:
            self.velocity_there = self.velocity + np.cross(omega, self.lever)
        else:
            self.velocity_there = self.velocity
        self.u0 = -self.velocity_there
        self.w = -dot(self.u0, self.normal)
        self.u0t = self.u0 + self.w[:, None] * self.normal
        self.obliquity = np.arctan2(np.linalg.norm(self.u0t, axis=-1), self.w)
        # The normal force may pass beside the ball's centre: offset is a multiple of the radius along u0t.
        m, r, f = self.ball["mass"], self.ball["radius"], self.ball["factor"]
        self.ball_inertia = f * m * r * r
        self.arm = -r[:, None] * self.normal
        extra = np.zeros((n, 3, 3))
        self.moment_of_normal = np.zeros((n, 3))
        if offset is not None:
            along = self.u0t / np.maximum(np.linalg.norm(self.u0t, axis=-1, keepdims=True), 1e-12)
            d = (np.asarray(offset) * r)[:, None] * along
            self.moment_of_normal = np.cross(d, self.normal)
            extra = self.moment_of_normal[:, :, None] * self.normal[:, None, :]
        a, c = cross_matrix(self.arm), cross_matrix(self.lever)
        one = np.eye(3)[None]
        self.k = ((1 / m + 1 / self.head_mass)[:, None, None] * one - a @ (a + extra) / self.ball_inertia[:, None, None]
                  - c @ self.head_inverse @ (c + extra))

    def launch(self, impulse):
        m = self.ball["mass"]
        v = impulse / m[:, None]
        jn = dot(impulse, self.normal)
        spin = (np.cross(self.arm, impulse) + self.moment_of_normal * jn[:, None]) / self.ball_inertia[:, None]
        return read(v, spin)

    def stuck(self, e=None, et=0.0, et_along=None):
        """Restitution e along the normal, et across it; et_along: another one along the grooves (Yc)."""
        e = base_restitution(self.w) if e is None else e
        after = -np.broadcast_to(et, (self.n_shots,))[:, None] * self.u0t
        if et_along is not None:
            groove = self.turn[:, :, 1]
            groove = groove - dot(groove, self.normal)[:, None] * self.normal
            groove /= np.linalg.norm(groove, axis=-1, keepdims=True)
            part = dot(self.u0t, groove)
            after = after - ((np.broadcast_to(et_along, (self.n_shots,)) - et) * part)[:, None] * groove
        target = after + (e * self.w)[:, None] * self.normal
        return np.linalg.solve(self.k, (target - self.u0)[..., None])[..., 0]

    def slipping(self, friction, e=None, steps=160):
        """Friction coefficient as a function of slip speed; the impulse grows step by step, as Keller's, until u_n = e w."""
        e = base_restitution(self.w) if e is None else e
        n = self.normal
        t1 = self.turn[:, :, 1] - dot(self.turn[:, :, 1], n)[:, None] * n
        t1 /= np.linalg.norm(t1, axis=-1, keepdims=True)
        t2 = np.cross(n, t1)
        axes = np.stack([n, t1, t2], 1)  # rows
        k = axes @ self.k @ np.swapaxes(axes, 1, 2)
        u = mat_vec(axes, self.u0)
        j = np.zeros_like(u)
        dp = (1 + e) * self.w / k[:, 0, 0] / steps
        inverse = np.linalg.inv(k[:, 1:, 1:])
        goal = e * self.w
        for _ in range(3 * steps):
            left = goal - u[:, 0]
            if np.all(np.abs(left) < 1e-12 * self.w):
                break
            slip = np.linalg.norm(u[:, 1:], axis=-1)
            step = dp.copy()
            for _ in range(3):  # the last step ends at the goal
                t = mat_vec(inverse, -u[:, 1:] - k[:, 1:, 0] * step[:, None])
                size = np.linalg.norm(t, axis=-1)
                limit = friction(slip) * step
                t *= np.where(size > limit, limit / np.maximum(size, 1e-30), 1.0)[:, None]
                rise = k[:, 0, 0] * step + dot(k[:, 0, 1:], t)
                short = rise > left
                step = np.where(short, step * left / np.where(rise == 0, 1, rise), step)
            d = np.concatenate([step[:, None], t], 1)
            j += d
            u += mat_vec(k, d)
        return np.einsum("nij,ni->nj", axes, j)


def read(v, spin):
    """What an ideal monitor reads: m/s, deg, rpm."""
    speed = np.linalg.norm(v, axis=-1)
    rpm = 30 / np.pi
    return {"ball_speed": speed, "launch_angle": np.degrees(np.arcsin(v[:, 2] / speed)),
            "azimuth": np.degrees(np.arctan2(-v[:, 1], v[:, 0])), "back": -spin[:, 1] * rpm, "side": -spin[:, 2] * rpm,
            "rifle": spin[:, 0] * rpm}


def vectors(out):
    """The inverse of read."""
    launch, azimuth = np.radians(out["launch_angle"]), np.radians(out["azimuth"])
    v = out["ball_speed"][:, None] * np.stack([np.cos(launch) * np.cos(azimuth), -np.cos(launch) * np.sin(azimuth), np.sin(launch)], -1)
    return v, np.stack([out["rifle"], -out["back"], -out["side"]], -1) * np.pi / 30


def base(x, head, ball):
    b = Blow(x, head, ball)
    return b.launch(b.stuck())


def added_mass(head, mass, where):
    """The head with a point mass at a place (m, face frame) fixed to it."""
    m0 = np.asarray(head["mass"], float)[..., None]
    cg = (m0 * head["cg"] + mass * where) / (m0 + mass)

    def about(d, m):
        d = np.asarray(d)
        return m[..., None] * (dot(d, d)[..., None, None] * np.eye(3) - d[..., :, None] * d[..., None, :])

    inertia = head["inertia"] + about(head["cg"] - cg, m0) + about(where - cg, np.full_like(m0, mass))
    return dict(head, mass=m0[..., 0] + mass, cg=cg, inertia=inertia)


def selftest():
    """The reference values of verification/rigid-eccentric.md."""
    rows = """50 0 0 0 10 0 0 68.7996625 8.1568547 0 2476.09382 0 0
50 3 0 0 13 0 0 68.7996625 11.1568547 0 2476.09382 0 0
50 0 0 0 10 20 0 67.0417009 8.1044535 4.0202226 2444.23816 -188.28558 -198.66279
50 0 0 0 12 0 10 67.1318532 12.0128637 0 2485.70699 0 0
50 0 0 0 12 0 -10 68.2542186 7.4994374 0 3453.13610 0 0
50 -1 4 -2 11 0 0 68.0572782 8.7779367 -0.8427541 2958.08862 -1492.09525 -186.91199
42 -3 -3 3 14 12 -6 56.1572111 9.4649126 4.2558819 3709.46885 1152.83596 -83.31975"""
    a = np.array([[float(c) for c in r.split()] for r in rows.splitlines()])
    names = ["club_speed", "attack_angle", "club_path", "face_angle", "dynamic_loft", "impact_toe", "impact_high"]
    head = {"mass": 0.2, "cg": np.array([-0.035, 0, 0]), "inertia": np.diag([3.7e-4, 2.9e-4, 4.8e-4]), "bulge": 0.3, "roll": 0.3}
    ball = {"mass": 0.04593, "radius": 0.021335, "factor": 0.4}
    x = {k: a[:, i] for i, k in enumerate(names)}
    keys = ["ball_speed", "launch_angle", "azimuth", "back", "side", "rifle"]

    def worst(out, b):
        return max(np.max(np.abs(out[k] - b[:, 7 + i])) for i, k in enumerate(keys))

    one = worst(base(x, head, ball), a)
    b = Blow(x, head, ball)
    slid = b.launch(b.slipping(lambda s: 10.0 + 0 * s))
    head_b = dict(head, cg=np.array([-38, 3, 4]) * 1e-3,
                  inertia=np.array([[2.9e-4, -2e-5, 3e-5], [-2e-5, 4.1e-4, 1e-5], [3e-5, 1e-5, 5.6e-4]]))
    row = np.array([[46, 2, 2, -1, 12, 8, 5, 63.1286855, 10.9169153, 1.3165128, 2502.76664, -884.02101, -228.06872]])
    two = worst(base({k: row[:, i] for i, k in enumerate(names)}, head_b, ball), row)
    print("reference A %.1e, B %.1e; sticking by steps %.1e" % (one, two, worst(slid, a)))
    assert one < 2e-5 and two < 2e-5 and worst(slid, a) < 1e-3
    both = added_mass(dict(head, mass=np.full(3, 0.2)), 0.02, np.array([0.0, 0.04, 0.02]))
    assert both["inertia"].shape == (3, 3, 3) and np.all(np.linalg.eigvalsh(both["inertia"])[:, 0] > 2.9e-4)


if __name__ == "__main__":
    selftest()
