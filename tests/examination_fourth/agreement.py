#!/usr/bin/python3
"""agreement.py HOSEL DIR: the program's base on null sets with exact inputs, beside this base at the recorded inputs. Reads no verdict."""
import csv
import os
import pathlib
import subprocess
import sys

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy: of small matrices, threads wait for each other
import numpy as np

from generate import INPUTS, LAYOUTS, header, make, unit, write
from kinds import KINDS

hosel, out = sys.argv[1], pathlib.Path(sys.argv[2])
for number in range(10):
    LAYOUTS[number] = LAYOUTS[number][:-1] + ("exact",)  # else the program moves the inputs within their noise before it compares
    s, rec, _ = make(KINDS["plain"], number, 1, False)
    write(out / "sets" / f"plain-{number}", s, rec, 1, False)
    subprocess.run([hosel, "run", out / "sets" / f"plain-{number}", "--out", out / "runs" / f"plain-{number}", "--force", "--quiet"],
                   check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    shots = list(csv.DictReader(open(out / "sets" / f"plain-{number}" / "shots.csv")))
    read = {c: np.array([float(r[header(s, c)]) for r in shots]) * unit(s, c) for c in INPUTS}
    f = s.base(read)
    row = {r["shot"]: i for i, r in enumerate(shots)}
    told = list(csv.DictReader(open(out / "runs" / f"plain-{number}" / "residuals.csv")))
    i = np.array([row[r["shot"]] for r in told])
    worst = {}
    for c in s.channels:
        h = header(s, c) + "__before"
        if h in told[0]:
            mine = f[c][i] / unit(s, c)
            worst[c] = max(abs(float(r[h]) - m) for r, m in zip(told, mine) if r[h])
    print(number, s.club, len(told), {c: "%.1e" % w for c, w in worst.items()})
