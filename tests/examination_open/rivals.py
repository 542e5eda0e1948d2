#!/usr/bin/python3
"""Held-out error of the loop beside that of regressions on the base model's residual.

    rivals.py OUT/1 [OUT/2 ...]                 each holds truth/, sets/ and runs/, as `run` makes them
    rivals.py --run SHOTS.csv OUT [--rivals quadratic]    one run of the loop on these shots

Base predictions, the loop's own (named effects, and the remainder beside them where there is one) and the split are those of
the loop's residuals.csv. The rivals see the training rows alone: recorded inputs, shot number, every other numeric column that is
no output. A ratio is the loop's root mean square error on the rows held out over the best rival's, chosen on those rows: the
choice favours the rivals.
"""

import argparse
import collections
import csv
import json
import pathlib

import numpy as np

from grade import FAMILIES, plain
from physics import CHANNELS


def quadratic_features(x):
    i, j = np.triu_indices(x.shape[1])
    return np.hstack([x, x[:, i] * x[:, j]])


def scaled(train, other):
    mean, sd = train.mean(0), train.std(0)
    sd = np.where(sd > 1e-12, sd, 1)
    return (train - mean) / sd, (other - mean) / sd


def quadratic(x, y, z):
    """Ridge on the quadratic features, its weight by generalised cross-validation (Golub, Heath and Wahba 1979)."""
    f, g = scaled(quadratic_features(x), quadratic_features(z))
    u, s, vt = np.linalg.svd(f, full_matrices=False)
    mean, best = y.mean(), None
    c = u.T @ (y - mean)
    for weight in len(y) * 10.0 ** np.arange(-4, 3, 0.5):
        shrink = s**2 / (s**2 + weight)
        left = y - mean - u @ (shrink * c)
        score = np.sum(left**2) / (1 - (1 + shrink.sum()) / len(y)) ** 2 if shrink.sum() < len(y) - 2 else np.inf
        if best is None or score < best[0]:
            best = score, mean + g @ (vt.T @ (shrink * c / np.maximum(s, 1e-12)))
    return best[1]


def shrunk(gram, xy, weights):
    """LASSO at all weights at once: proximal gradient with momentum (Beck and Teboulle 2009), 400 steps."""
    step = 1 / np.linalg.eigvalsh(gram)[-1]
    limit = step * weights[:, None]
    b = ahead = np.zeros((len(weights), len(xy)))
    t = 1.0
    for _ in range(400):
        c = ahead - step * (ahead @ gram - xy)
        old, b = b, np.sign(c) * np.maximum(np.abs(c) - limit, 0)
        new = (1 + np.sqrt(1 + 4 * t * t)) / 2
        ahead, t = b + (t - 1) / new * (b - old), new
    return b


def lasso(x, y, z):
    """LASSO on the quadratic features, its weight by five-fold cross-validation."""
    f, g = scaled(quadratic_features(x), quadratic_features(z))
    n, mean = len(y), y.mean()
    weights = np.max(np.abs(f.T @ (y - mean))) / n * 10.0 ** -np.linspace(0, 2, 12)
    fit = lambda a, b: shrunk(a.T @ a / len(b), a.T @ (b - b.mean()) / len(b), weights)
    error = np.zeros(len(weights))
    for fold in range(5):
        out = np.arange(n) % 5 == fold
        error += np.sum((y[out] - y[~out].mean() - fit(f[~out], y[~out]) @ f[out].T) ** 2, axis=1)
    return mean + g @ fit(f, y)[np.argmin(error)]


def gaussian_process(x, y, z):
    """Squared exponential plus linear kernel; scale, length and noise by the marginal likelihood over a grid [@gp-ml]."""
    f, g = scaled(x, z)
    mean, sd = y.mean(), y.std()
    t, best = (y - mean) / sd, None
    square = lambda a, b: np.sum(a**2, 1)[:, None] + np.sum(b**2, 1) - 2 * a @ b.T
    for length in (1.0, 2.0, 4.0, 8.0):
        for linear in (0.0, 0.1, 1.0):
            kernel = lambda a, b: np.exp(-square(a, b) / (2 * length**2)) + linear * (a @ b.T)
            values, q = np.linalg.eigh(kernel(f, f))
            values, c = np.maximum(values, 0), q.T @ t
            for ratio in 10.0 ** np.arange(-6, 3.1, 0.5):  # noise variance over the kernel's
                v = values + ratio
                likelihood = -0.5 * len(t) * np.log(np.mean(c**2 / v)) - 0.5 * np.sum(np.log(v))
                if best is None or likelihood > best[0]:
                    best = likelihood, mean + sd * (kernel(g, f) @ (q @ (c / v)))
    return best[1]


RIVALS = {"Gaussian process": gaussian_process, "LASSO": lasso, "quadratic": quadratic}


def columns(path):
    with open(path) as f:
        return list(csv.DictReader(f))


def value(cell):
    try:
        return float(cell)
    except ValueError:
        return np.nan


def compare(shots, run, rivals=RIVALS):
    """{channel: {"base", "loop", rival: error on the rows held out}}, or None where too few rows were used."""
    shots, rows = columns(shots), columns(run / "residuals.csv")
    outputs = {*CHANNELS, *(plain(c[: -len("__measured")]) for c in rows[0] if c.endswith("__measured"))}
    regressors = [c for c in shots[0] if plain(c) not in outputs and c != "club"]
    where = {s["shot"]: i for i, s in enumerate(shots)}
    x = np.array([[value(shots[where[r["shot"]]][c]) for c in regressors] for r in rows])
    x = x[:, np.isfinite(x).any(axis=0)]
    x = np.where(np.isfinite(x), x, np.nanmean(x, axis=0))
    held = np.array([r["set"] == "holdout" for r in rows])
    if held.sum() < 5 or (~held).sum() < 15:
        return None
    errors = {}
    for channel in [c[: -len("__measured")] for c in rows[0] if c.endswith("__measured")]:
        last = "with_remainder" if f"{channel}__with_remainder" in rows[0] else "after"
        m, b, a = (np.array([value(r[f"{channel}__{k}"]) for r in rows]) for k in ("measured", "before", last))
        good = np.isfinite(m) & np.isfinite(b) & np.isfinite(a)
        t, h = good & ~held, good & held
        if t.sum() < 15 or h.sum() < 5:
            continue
        rms = lambda d: float(np.sqrt(np.mean(d**2)))
        errors[plain(channel)] = {"base": rms((m - b)[h]), "loop": rms((m - a)[h]), **{
            name: rms((m - b)[h] - rival(x[t], (m - b)[t], x[h])) for name, rival in rivals.items()}}
    return errors or None


def main():
    p = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    p.add_argument("folders", nargs="*", type=pathlib.Path, help="of examinations")
    p.add_argument("--run", nargs=2, type=pathlib.Path, metavar=("SHOTS.csv", "OUT"), help="one run of the loop on these shots")
    p.add_argument("--rivals", nargs="+", choices=RIVALS, default=list(RIVALS), help="of --run (a Gaussian process takes a matrix of all rows)")
    a = p.parse_args()
    if bool(a.run) == bool(a.folders):
        p.error("either folders of examinations or --run")
    if a.run:
        errors = compare(*a.run, {name: RIVALS[name] for name in a.rivals})
        if errors is None:
            p.error(f"{a.run[1]}: too few rows")
        print("held-out error (RMS)\n\n| channel | base | loop | " + " | ".join(a.rivals) + " |\n" + "|---" * (3 + len(a.rivals)) + "|")
        for channel, e in errors.items():
            print(f"| {channel} | " + " | ".join(f"{e[k]:.4g}" for k in ["base", "loop", *a.rivals]) + " |")
        return
    channels, families, missing = collections.defaultdict(list), collections.defaultdict(list), 0
    for folder in a.folders:
        for f in sorted((folder / "truth").glob("*.json")):
            run = folder / "runs" / f.stem
            if not (run / "report.json").exists() or not (run / "residuals.csv").exists():
                missing += 1
                continue
            errors = compare(folder / "sets" / f.stem / "shots.csv", run)
            if errors is None:
                missing += 1
                continue
            for c, e in errors.items():
                channels[c].append([e["loop"] / min(e[r] for r in RIVALS)] + [e["loop"] / e[r] for r in ["base", *RIVALS]])
            mean = lambda k: np.exp(np.mean([np.log(e[k]) for e in errors.values()]))  # geometric, over the channels
            ratios = [mean("loop") / min(mean(r) for r in RIVALS)] + [mean("loop") / mean(r) for r in ["base", *RIVALS]]
            families[json.loads(f.read_text())["family"]].append(ratios)
    head = "| " + " | ".join(["", "sets", "loop / best rival", "worse by 10 %", "loop / base", *(f"loop / {r}" for r in RIVALS)]) + " |"

    def line(name, values):
        v = np.array(values)
        middle = np.median(v, axis=0)
        print(f"| {name} | {len(v)} | {middle[0]:.3f} | {100 * np.mean(v[:, 0] > 1.1):.0f} % | " + " | ".join(f"{q:.3f}" for q in middle[1:]) + " |")
    print(f"\nheld-out error, medians over the sets ({missing} without a report or with too few rows)\n\n{head}\n" + "|---" * 8 + "|")
    for c in CHANNELS:
        if channels[c]:
            line(c, channels[c])
    for k in sorted(families):
        line(f"{k} {FAMILIES[k]}", families[k])
    if families:
        line("all", [r for v in families.values() for r in v])


if __name__ == "__main__":
    main()
