#!/usr/bin/env python3
"""The page of a sampled study in a browser: its sliders answer what the model itself answers there, within the error that the page
tells, the line follows, and nothing is complained of.

usage: sliders.py HOSEL SCRATCH; 77 is a skip: no browser on this machine.
"""
import json
import os
import re
import shutil
import subprocess
import sys

from browser import Browser, browser, check

hosel, scratch = sys.argv[1:3]
BLOW = """models = ["rigid-eccentric"]
[delivery]
club_speed_mps = 45
dynamic_loft_deg = 14
[head]
name = "driver-460"
"""
STUDY = """kind = "study"
outputs = ["ball_speed_mps", "spin_rate_rpm"]
""" + BLOW + """[sample]
points = 60
seed = 1
[[axis]]
key = "delivery.club_speed_mps"
range = [40, 50]
[[axis]]
key = "delivery.dynamic_loft_deg"
range = [8, 20]
[[axis]]
key = "delivery.impact_toe_mm"
range = [-15, 15]
"""
END, HOME = "\ue010", "\ue011"

shutil.rmtree(scratch, ignore_errors=True)
os.makedirs(scratch)
for name, text in (("study", STUDY), ("blow", BLOW)):
    with open(os.path.join(scratch, name + ".toml"), "w") as file:
        file.write(text)
page = os.path.join(scratch, "out", "report.html")
subprocess.run([hosel, "run", os.path.join(scratch, "study.toml"), "--out", os.path.dirname(page), "--quiet"], check=True)


def model(speed, loft, toe):
    """What the model answers there: ball speed [m/s], spin [rpm]."""
    out = os.path.join(scratch, "one")
    at = {"club_speed_mps": speed, "dynamic_loft_deg": loft, "impact_toe_mm": toe}
    words = [w for key, value in at.items() for w in ("--set", "delivery.%s=%g" % (key, value))]
    subprocess.run([hosel, "run", os.path.join(scratch, "blow.toml"), "--out", out, "--quiet", "--force", *words], check=True)
    with open(os.path.join(out, "summary.json")) as file:
        said = json.load(file)["models"]["rigid-eccentric"]
    return said["ball_speed_mps"], said["spin_rate_rpm"]


def shown(seen):
    """(value, error) of every answer, as the page says it."""
    rows = seen.run("return [...document.querySelectorAll('figure.sliders td:nth-child(2)')].map((c) => c.textContent)")
    return [tuple(float(v) for v in re.match(r"(\S+) \u00b1 (\S+)", row).groups()) for row in rows]


seen = Browser(scratch)
try:
    seen.open(page)
    check(seen.run("return !document.querySelector('figure.sliders').hidden"), "the sliders are hidden: %s" % seen.complaints())
    check(seen.run("return document.querySelectorAll('figure.sliders input').length") == 3, "there is not a slider a parameter")
    amid, line = shown(seen), "return document.querySelector('figure.sliders polyline').getAttribute('points')"
    before = seen.run(line)
    for name, keys, at in (("middle", {}, (45, 14, 0)), ("fast and lofted", {1: END, 2: END}, (50, 20, 0)),
                           ("towards the heel", {3: HOME}, (50, 20, -15))):
        for slider, key in keys.items():
            seen.ask("POST", seen.element("figure.sliders label:nth-child(%d) input" % slider) + "/value", {"text": key})
        for (value, error), true in zip(shown(seen), model(*at)):
            check(abs(value - true) <= 4 * error, "%s: the page says %g +- %g, the model %g" % (name, value, error, true))
            check(error < 0.02 * abs(true), "%s: an error of %g says nothing" % (name, error))
    check(abs(shown(seen)[0][0] - amid[0][0]) > 1, "the sliders move nothing")
    check(seen.run(line) != before, "the line does not follow")
    for width in (1280, 400):
        for dark in (False, True):
            seen.open(page, width, dark)
            check(seen.run("return document.documentElement.scrollWidth") <= width, "the page is wider than %d px" % width)
            seen.picture("figure.sliders", "sliders-%d-%s" % (width, "dark" if dark else "light"))
            seen.whole_page("page-%d-%s" % (width, "dark" if dark else "light"))
    check(not seen.complaints(), "the browser complains: %s" % seen.complaints())
finally:
    seen.close()
print("drawn in %s" % browser)
