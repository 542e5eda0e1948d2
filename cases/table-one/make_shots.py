#!/usr/bin/env python3
"""Sixty shots as instruments would have seen them, from the finite-element drives of `table-one-shots`.

usage: make_shots.py SWEEP.csv [SCALE] >shots.csv      SCALE multiplies every error: 0 is the truth

Independent normal errors, one standard deviation: of the club as a motion-capture system with a marker on the head sees
it, of the ball as makers of camera launch monitors state. The seed is fixed: the same file every time.
"""
import csv
import math
import random
import sys

ERRORS = {  # in the column's unit
    "club_speed_mps": 0.15,
    "attack_angle_deg": 0.3,
    "club_path_deg": 0.3,
    "face_angle_deg": 0.3,
    "dynamic_loft_deg": 0.3,
    "impact_toe_mm": 1.0,
    "impact_high_mm": 1.0,
    "ball_speed_mps": 0.22,  # half a mile per hour
    "launch_angle_deg": 0.2,
    "azimuth_deg": 0.3,
    "backspin_rpm": 60.0,
    "sidespin_rpm": 60.0,
}

scale = float(sys.argv[2]) if len(sys.argv) > 2 else 1.0
random.seed(1)
with open(sys.argv[1]) as file:
    rows = list(csv.DictReader(file))
names = {name: next(key for key in rows[0] if key.endswith("." + name)) for name in ERRORS}
out = csv.writer(sys.stdout, lineterminator="\n")
out.writerow(["shot", *ERRORS, "spin_rate_rpm"])
for shot, row in enumerate(rows, 1):
    seen = {name: float(row[key]) + scale * random.gauss(0, ERRORS[name]) for name, key in names.items()}
    seen["spin_rate_rpm"] = math.hypot(seen["backspin_rpm"], seen["sidespin_rpm"])
    out.writerow([shot, *("%.4f" % value for value in seen.values())])
