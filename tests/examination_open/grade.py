#!/usr/bin/python3
"""Grades the loop's reports against the truths: right, acceptable or wrong, by the rules of README.md.

    grade.py OUT/1 [OUT/2 ...] [--kinds]        each holds truth/ and runs/, as `run` makes them
"""

import argparse
import collections
import json
import pathlib
import re
import sys

BEYOND = 5.0  # noise units in the whole set: with less, nothing need be seen
MANY = 0.10  # of the rows: flagged for one column, they are an accusation of it
# Naming these columns is naming the effect: the bias is the column's.
COLUMNS_OF = {"loft-bias": {"dynamic_loft"}, "monitor-misalignment": {"launch_angle", "azimuth", "backspin", "sidespin"},
              "session-drift": {"ball_speed"}}


def plain(column):
    """Without its unit."""
    return re.sub(r"_(mps|kmh|mph|mm|deg|rpm)$", "", column)


def accusations(report):
    """Columns accused as a whole or as computed, then those of which many rows are flagged."""
    whole = {plain(c["column"]) for c in report.get("columns", [])}
    computed = [{plain(c["column"]), *(plain(f) for f in c["from"])} for c in report.get("derived_columns", [])]
    rows = collections.Counter(plain(r["column"]) for r in report.get("flagged_rows", []))
    flagged = {c for c, n in rows.items() if n >= MANY * report["rows"]["read"]}
    return whole, computed, flagged


def grade(report, truth):
    """The grade and a sentence; report None: the run left none."""
    if report is None:
        return "wrong", "no report"
    names, kin, guilty = set(truth["names"]), set(truth["kin"]), set(truth["guilty"])
    for name in names:
        guilty |= COLUMNS_OF.get(name, set())
    verdict, adopted, ties = report["verdict"], report["adopted"], report["ties"]
    doubtful = verdict in ("unexplained", "insufficient", "ambiguous")
    fits = names | (kin if doubtful else set())

    false = [n for n in adopted if n not in fits]
    if false:
        return "wrong", f"adopted {', '.join(false)}"
    for tie in ties:
        if not (names | kin) & set(tie):
            return "wrong", f"tie of {', '.join(tie)}"

    whole, computed, flagged = accusations(report)
    caught = bool(guilty & (whole | flagged)) or any(guilty & c for c in computed)
    innocent = (whole | (flagged if truth["listed"] == "instrument" else set())) - guilty
    if not caught and (innocent or computed):
        return "wrong", f"accused {', '.join(sorted(innocent | set().union(*computed)))}"

    if verdict == "no-residual" and not caught and truth["total"] > BEYOND:
        return "wrong", f"content at {truth['total']} noise units"

    listed = truth["listed"]
    if listed == "library":
        wanted = names if truth["family"] == 2 else set()  # several at once: all of them; forms of one: any
        found = set(adopted) | {n for n in names if COLUMNS_OF.get(n, set()) & whole}
        if found & names and found >= wanted:
            return "right", verdict
        if found & names or any(names & set(t) for t in ties):
            return "acceptable", f"{verdict}: part of the truth"
    elif listed == "instrument" and caught:
        return "right", verdict
    elif listed == "none" and verdict == "unexplained":
        entries = [(plain(u.get("regressor", "")), u.get("detail", "")) for u in report["unexplained"]]
        if any(p == r or (p == "mixture" and p in d) for p in truth["place"] for r, d in entries):
            return "right", verdict
    elif listed == "null" and verdict == "no-residual":
        return "right", verdict
    if verdict in truth["acceptable"]:
        return "acceptable", verdict
    if verdict == "no-residual":  # and nothing beyond BEYOND is there
        return "acceptable", verdict
    if doubtful and (adopted or ties):
        return "acceptable", f"{verdict}: part of the truth"
    return "wrong", f"{verdict} is no answer here"


def told(report):
    if report is None:
        return "no report"
    words = [report["verdict"]] + report["adopted"] + ["(" + " or ".join(t) + ")" for t in report["ties"]]
    words += [f"[{u['channel']} against {u['regressor']}]" for u in report["unexplained"][:1]]
    words += [f"[{c['column']}: {c['finding']}]" for c in report.get("columns", [])]
    words += [f"[{c['column']} computed]" for c in report.get("derived_columns", [])]
    return " ".join(words)


def graded(folders):
    """(seed, set, truth, report, grade, why) of every set that was run."""
    for folder in folders:
        for f in sorted((folder / "truth").glob("*.json")):
            run = folder / "runs" / f.stem
            if not (folder / "runs" / f"{f.stem}.log").exists():
                continue  # not yet run
            path = run / "report.json"
            report = json.loads(path.read_text()) if path.exists() else None
            truth = json.loads(f.read_text())
            yield folder.name, f.stem, truth, report, *grade(report, truth)


FAMILIES = {1: "one effect, another form", 2: "several at once", 3: "instruments", 4: "in no list", 5: "noise alone"}


def table(rows, key, title):
    counts = collections.defaultdict(collections.Counter)
    for r in rows:
        counts[key(r)][r[4]] += 1
    print(f"\n| {title} | sets | right | acceptable | wrong |\n|---|---|---|---|---|")
    for k in sorted(counts):
        c = counts[k]
        print(f"| {k} | {sum(c.values())} | {c['right']} | {c['acceptable']} | {c['wrong']} |")


def main():
    p = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    p.add_argument("folders", nargs="+", type=pathlib.Path)
    p.add_argument("--kinds", action="store_true", help="a table of the kinds as well")
    a = p.parse_args()
    rows = list(graded(a.folders))
    if not rows:
        sys.exit("nothing was run in " + ", ".join(map(str, a.folders)))
    table(rows, lambda r: f"{r[2]['family']} {FAMILIES[r[2]['family']]}", "family")
    table(rows, lambda r: f"seed {r[0]}", "seed")
    table(rows, lambda r: f"{r[2]['shots']:3d} shots", "size")
    table(rows, lambda r: ("bag" if r[2]["bag"] else "one club") + (", clusters" if r[2]["clusters"] else ""), "layout")
    table(rows, lambda r: next((f"to {limit:2d}" for limit in (0, 5, 8, 20, 50) if r[2]["total"] <= limit), "beyond"), "noise units")
    if a.kinds:
        table(rows, lambda r: f"{r[2]['family']} {r[2]['kind']}", "kind")
    causes = collections.Counter(" ".join(why.split()[: 2 if why.startswith("no") else 1]) for *_, mark, why in rows if mark == "wrong")
    print("\nwrong by its first word:", ", ".join(f"{w} {n}" for w, n in causes.most_common()))
    print("\nwrong (seed, set, truth, what the loop said):")
    for seed, name, truth, report, mark, why in rows:
        if mark == "wrong":
            there = ", ".join(truth["names"] or truth["guilty"] or truth["place"]) or "nothing"
            print(f"  {seed} {name}: {there} ({truth['total']}); {told(report)}: {why}")


if __name__ == "__main__":
    main()
