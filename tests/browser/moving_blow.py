#!/usr/bin/env python3
"""The page of a blow in a browser: the moving picture draws, the slider moves it, it turns, nothing is complained of; without
WebGL the still picture stands alone; no page is wider than its window.

usage: moving_blow.py HOSEL CASE SCRATCH; 77 is a skip: no browser on this machine.
"""
import os
import shutil
import subprocess
import sys
import time

import numpy

from browser import Browser, browser, check

hosel, case, scratch = sys.argv[1:4]


def differ(one, other):
    """Share of the pixels that differ."""
    return float(numpy.mean(numpy.abs(one - other).max(axis=2) > 0.05))


VIEW, SLIDER = "figure.moving [data-part=view]", "figure.moving [data-part=time]"
HOME, END, RIGHT = "\ue011", "\ue010", "\ue014"

shutil.rmtree(scratch, ignore_errors=True)
os.makedirs(scratch)
page = os.path.join(scratch, "out", "report.html")
subprocess.run([hosel, "run", case, "--out", os.path.dirname(page), "--quiet", "--set", 'models=["fe-full-club"]', "--set", "mesh.sector=2",
                "--set", "mesh.rings=2", "--set", "mesh.harmonics=2", "--set", "mesh.antisymmetric=2", "--set",
                "time.steps_per_contact=40"], check=True)
check(os.path.getsize(page) < 6e6, "the page has %d bytes" % os.path.getsize(page))

seen = Browser(scratch)
try:
    seen.open(page)
    check(seen.run("return !document.querySelector('figure.moving').hidden"), "the moving picture is hidden: %s" % seen.complaints())
    largest = seen.picture(VIEW, "largest-force")
    ground = largest[-12, -12]
    drawn = float(numpy.mean(numpy.abs(largest - ground).max(axis=2) > 0.05))
    check(drawn > 0.1, "the picture is blank: %.1f %% of it is drawn" % (100 * drawn))
    check(len(numpy.unique((largest * 15).astype(int).reshape(-1, 3), axis=0)) > 30, "the ball has no colours")

    slider, time_said = seen.element(SLIDER), "return document.querySelector('figure.moving output').textContent"
    at_largest = seen.run(time_said)
    seen.ask("POST", slider + "/value", {"text": HOME})
    first, at_first = seen.picture(VIEW, "first"), seen.run(time_said)
    check(at_first != at_largest and at_first.startswith("0.000 ms"), "the slider says %s after %s" % (at_first, at_largest))
    check(differ(first, largest) > 0.02, "the slider does not move the picture")
    seen.ask("POST", slider + "/value", {"text": RIGHT})
    check(seen.run(time_said) != at_first, "one step of the slider moves nothing")

    view = {list({"element-6066-11e4-a52e-4f735466cecf": 0})[0]: seen.element(VIEW).split("/")[-1]}
    move = lambda x, y: {"type": "pointerMove", "duration": 50, "origin": view, "x": x, "y": y}
    before = seen.picture(VIEW, "before-turn")
    seen.ask("POST", "/actions", {"actions": [{"type": "pointer", "id": "mouse", "parameters": {"pointerType": "mouse"}, "actions": [
        move(0, 0), {"type": "pointerDown", "button": 0}, move(60, 20), move(120, 40), {"type": "pointerUp", "button": 0}]}]})
    check(differ(seen.picture(VIEW, "after-turn"), before) > 0.02, "dragging does not turn the picture")

    pictures = []
    for name in ("side", "face", "club"):
        seen.ask("POST", seen.element("button[data-view=%s]" % name) + "/click", {})
        pictures.append(seen.picture(VIEW, "view-" + name))
    check(min(differ(pictures[0], pictures[1]), differ(pictures[1], pictures[2])) > 0.02, "two views are the same picture")

    number = "return Number(document.querySelector('%s').value)" % SLIDER
    stood = seen.run(number)
    seen.ask("POST", seen.element("[data-part=play]") + "/click", {})
    for _ in range(100):
        if seen.run(number) != stood:
            break
        time.sleep(0.1)
    check(seen.run(number) != stood, "play moves nothing")
    seen.ask("POST", seen.element("[data-part=play]") + "/click", {})

    for width in (1280, 400):
        for dark in (False, True):
            seen.open(page, width, dark)
            check(seen.run("return document.documentElement.scrollWidth") <= width, "the page is wider than %d px" % width)
            seen.whole_page("page-%d-%s" % (width, "dark" if dark else "light"))
            ground = seen.picture(VIEW, "view-%d-%s" % (width, "dark" if dark else "light"))[-12, -12]
            check((ground.mean() < 0.3) == dark, "the picture's ground is not the page's")
    check(not seen.complaints(), "the browser complains: %s" % seen.complaints())
finally:
    seen.close()

still = Browser(scratch, "--disable-3d-apis")
try:
    still.open(page)
    check(still.run("return document.querySelector('figure.moving').hidden"), "without WebGL the moving picture is not hidden")
    check(still.run("return document.querySelector(\"svg[aria-label^='the ball cut open']\").getBoundingClientRect().width") > 100,
          "without WebGL there is no still picture")
    check(not still.complaints(), "without WebGL the browser complains: %s" % still.complaints())
finally:
    still.close()
print("drawn in %s" % browser)
