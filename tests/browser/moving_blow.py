#!/usr/bin/env python3
"""The page of a blow in a browser: the moving picture draws, the slider moves it, it turns, nothing is complained of; without
WebGL the still picture stands alone; no page is wider than its window.

usage: moving_blow.py HOSEL CASE SCRATCH; 77 is a skip: no browser on this machine.
"""
import base64
import io
import json
import os
import shutil
import socket
import subprocess
import sys
import time
import urllib.request

hosel, case, scratch = sys.argv[1:4]
driver, browser = shutil.which("chromedriver"), shutil.which("chromium") or shutil.which("google-chrome")
if not driver or not browser:
    print("SKIPPED: no headless browser (packages chromium and chromium-driver)")
    sys.exit(77)
try:
    import matplotlib.image
    import numpy
except ImportError:
    print("SKIPPED: no NumPy and matplotlib to read the pictures with")
    sys.exit(77)


class Browser:
    """A session of the WebDriver protocol (W3C), spoken as JSON over HTTP."""

    def __init__(self, *arguments):
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        self.process = subprocess.Popen([driver, "--port=%d" % port, "--log-level=OFF"], stdout=subprocess.DEVNULL)
        self.root = "http://127.0.0.1:%d" % port
        for _ in range(100):
            try:
                urllib.request.urlopen(self.root + "/status", timeout=5)
                break
            except OSError:
                time.sleep(0.1)
        options = ["--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
        wanted = {"goog:chromeOptions": {"binary": browser, "args": options + list(arguments)}, "goog:loggingPrefs": {"browser": "ALL"}}
        self.root += "/session/" + self.ask("POST", "/session", {"capabilities": {"alwaysMatch": wanted}})["sessionId"]

    def ask(self, method, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(self.root + path, data, {"Content-Type": "application/json"}, method=method)
        with urllib.request.urlopen(request, timeout=120) as answer:
            return json.load(answer)["value"]

    def close(self):
        try:
            self.ask("DELETE", "")
        finally:
            self.process.terminate()
            self.process.wait()

    def open(self, page, width=1280, dark=False):
        self.ask("POST", "/window/rect", {"width": width, "height": 1400})
        self.command("Emulation.setDeviceMetricsOverride", width=width, height=1400, deviceScaleFactor=1, mobile=False)
        self.command("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])
        self.ask("POST", "/url", {"url": "file://" + os.path.abspath(page)})

    def command(self, name, **parameters):
        return self.ask("POST", "/goog/cdp/execute", {"cmd": name, "params": parameters})

    def run(self, script):
        return self.ask("POST", "/execute/sync", {"script": script, "args": []})

    def element(self, selector):
        return "/element/" + next(iter(self.ask("POST", "/element", {"using": "css selector", "value": selector}).values()))

    def picture(self, selector, name):
        png = base64.b64decode(self.ask("GET", self.element(selector) + "/screenshot"))
        with open(os.path.join(scratch, name + ".png"), "wb") as file:
            file.write(png)
        return matplotlib.image.imread(io.BytesIO(png), format="png")[:, :, :3]

    def whole_page(self, name):
        png = base64.b64decode(self.command("Page.captureScreenshot", captureBeyondViewport=True)["data"])
        with open(os.path.join(scratch, name + ".png"), "wb") as file:
            file.write(png)

    def complaints(self):
        return [entry["message"] for entry in self.ask("POST", "/se/log", {"type": "browser"}) if entry["level"] in ("SEVERE", "WARNING")]


def check(good, what):
    if not good:
        sys.exit("FAILED: " + what)


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

seen = Browser()
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

still = Browser("--disable-3d-apis")
try:
    still.open(page)
    check(still.run("return document.querySelector('figure.moving').hidden"), "without WebGL the moving picture is not hidden")
    check(still.run("return document.querySelector(\"svg[aria-label^='the ball cut open']\").getBoundingClientRect().width") > 100,
          "without WebGL there is no still picture")
    check(not still.complaints(), "without WebGL the browser complains: %s" % still.complaints())
finally:
    still.close()
print("drawn in %s" % browser)
