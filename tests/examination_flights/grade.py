#!/usr/bin/python3
"""Grades the reports of loops on flights: alone, tied, nothing or wrong, by the rules of README.md.

    grade.py OUT/1 [OUT/2 ...] [--sets]        each holds truth/ and runs/, as `run` makes them
"""

import argparse
import collections
import json
import pathlib


def grade(report, truth):
    """alone, tied, answered, nothing, wrong; of noise alone clean or wrong."""
    if report is None:
        return "wrong"
    right, adopted, ties = truth["right"], report["adopted"], report["ties"]
    if right is None:
        return "clean" if report["verdict"] == "no-residual" and not adopted and not ties else "wrong"
    if any(name != right for name in adopted):
        return "wrong"
    if right in adopted:
        return "alone"
    if any(right in tie for tie in ties):
        return "tied"
    if ties:
        return "wrong"
    return "answered" if truth["form"] and report["verdict"] == "unexplained" else "nothing"


def told(report):
    if report is None:
        return "no report"
    words = [report["verdict"]] + report["adopted"] + ["(" + " or ".join(t) + ")" for t in report["ties"]]
    words += [f"[{u['channel']} against {u['regressor']}]" for u in report["unexplained"][:1]]
    return " ".join(words)


def graded(folders):
    for folder in folders:
        for f in sorted((folder / "truth").glob("*.json")):
            if not (folder / "runs" / f"{f.stem}.log").exists():
                continue  # not yet run
            path = folder / "runs" / f.stem / "report.json"
            report = json.loads(path.read_text()) if path.exists() else None
            truth = json.loads(f.read_text())
            yield folder.name, f.stem, truth, report, grade(report, truth)


def main():
    p = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    p.add_argument("folders", nargs="+", type=pathlib.Path)
    p.add_argument("--sets", action="store_true", help="every set in a line, with what was told")
    a = p.parse_args()
    rows = list(graded(a.folders))
    heads = ["alone", "tied", "answered", "nothing", "clean", "wrong"]
    counts = collections.defaultdict(collections.Counter)
    for _, _, truth, _, g in rows:
        counts[truth["kind"]][g] += 1
        if truth["right"] and not truth["form"]:
            counts["six effects together"][g] += 1
    print(f"| kind | sets | {' | '.join(heads)} |\n|---|---|{'---|' * len(heads)}")
    for kind in sorted(counts, key=lambda k: (k in ("noise", "six effects together"), k.endswith("form"), k)):
        c = counts[kind]
        print(f"| {kind} | {sum(c.values())} | {' | '.join(str(c[h] or '') for h in heads)} |")
    for seed, name, truth, report, g in rows:
        if a.sets or g in ("wrong", "nothing"):
            print(f"{seed}/{name}: {g}: {told(report)}; true: {truth['nature']}, {truth['law']}, {truth['flights']} flights"
                  f"{', paths' if truth['path'] else ''}{'' if truth['axis_seen'] else ', axis not seen'}")


if __name__ == "__main__":
    main()
