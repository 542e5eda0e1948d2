"""Which library effects, in their plainest form, fit a set without noise as well as its truth: linear fits, own mechanics. No program is
asked. A careful expert would accept such a twin, so the set's truth lists it."""

import numpy as np

from physics import Blow, base_restitution, read, rotation, vectors


INPUTS = ["club_speed", "attack_angle", "dynamic_loft", "club_path", "face_angle", "impact_toe", "impact_high"]
BEYOND = 9.0  # of squared noise units: less is no evidence for one against the other


def columns(s, rec):
    """effect: list of the changes of the channels by its parameters."""
    x = {c: rec[c] for c in INPUTS}
    f = s.channels_of((b := Blow(x, s.head, s.ball)).launch(b.stuck()))
    e0 = base_restitution(b.w)

    def d(out):
        c = s.channels_of(out)
        return np.stack([c[k] - f[k] for k in s.channels], -1)

    def law(**k):
        return d(b.launch(b.stuck(**k)))

    def other(head=None, ball=None, **k):
        o = Blow(x, dict(s.head, **(head or {})), dict(s.ball, **(ball or {})), **k)
        return d(o.launch(o.stuck()))

    def turned(axis):
        v, w = vectors(b.launch(b.stuck()))
        r = rotation(axis, np.full(s.n, 2e-3))
        return d(read(np.einsum("nij,nj->ni", r, v), np.einsum("nij,nj->ni", r, w)))

    rho2 = (x["impact_toe"] / 20) ** 2 + (x["impact_high"] / 20) ** 2
    one, eye, zero = np.ones(s.n), np.eye(3), np.zeros((s.n, 5))
    drift = zero.copy()
    drift[:, 0] = s.shot / s.n - 0.5
    closing = [other(omega=np.tile(v, (s.n, 1))) for v in ([0, 0.55, 0.83], [0, 0, 1.0])]
    return {
        "restitution-law": [law(e=e0 + 1e-3), law(e=e0 + 1e-4 * b.w)],
        "restitution-falloff": [law(e=e0 - 1e-3 * rho2)],
        "face-compliance": [law(e=e0 + 1e-3 * np.exp(-rho2 / 2))],
        "head-mass": [other(head={"mass": s.head["mass"] * 1.01})],
        "head-inertia": [other(head={"inertia": s.head["inertia"] * 1.02})],
        "cg-shift": [other(head={"cg": s.head["cg"] + 2e-4 * v}) for v in eye],
        "head-closure": closing[:1],
        "ball-inertia": [other(ball={"factor": 0.402})],
        "normal-force-offset": [other(offset=1e-3 * one)],
        "ball-tangential-compliance": [law(et=5e-3)],
        "loft-bias": [d((o := Blow(dict(x, dynamic_loft=x["dynamic_loft"] + 0.02), s.head, s.ball)).launch(o.stuck()))],
        "monitor-misalignment": [turned("y"), turned("z")],
        "session-drift": [drift],
    }


def twins(s, kind, clean, white):
    """Names beside the kind's own; per set."""
    f = s.base(clean)

    def flat(r):
        return np.einsum("nij,nj->ni", white, r).ravel()

    r = flat(np.stack([clean[c] - f[c] for c in s.channels], -1))
    shapes = {}
    for name, cols in columns(s, clean).items():
        a = np.stack([flat(c) for c in cols], 1)
        shapes[name] = a / np.maximum(np.linalg.norm(a, axis=0), 1e-30)

    def left(names):
        a = np.concatenate([shapes[n] for n in names], 1)
        return float(np.sum((r - a @ np.linalg.lstsq(a, r, rcond=None)[0]) ** 2))

    names, found = list(kind.names), set()
    others = [n for n in shapes if n not in names]
    if kind.family == 2:
        if all(n in shapes for n in names):
            best = left(names)
            for t in names:
                rest = [n for n in names if n != t]
                if left(rest) - best >= BEYOND:  # else it does not matter, and another in its place is an invention
                    found |= {o for o in others if left(rest + [o]) - best < BEYOND}
            return found
        return set()
    known = [n for n in names if n in shapes]
    best = min([left([n]) for n in known]) if kind.listed == "library" and known else 0.0
    return {o for o in others if left([o]) - best < BEYOND}
