"""A headless browser for the tests of pages; a script that imports this ends with 77, a skip, where none is on the machine."""
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

driver, browser = shutil.which("chromedriver"), shutil.which("chromium") or shutil.which("google-chrome")
if not driver or not browser:
    print("SKIPPED: no headless browser (packages chromium and chromium-driver)")
    sys.exit(77)
try:
    import matplotlib.image
except ImportError:
    print("SKIPPED: no matplotlib to read the pictures with")
    sys.exit(77)


class Browser:
    """A session of the WebDriver protocol (W3C), spoken as JSON over HTTP."""

    def __init__(self, scratch, *arguments):
        """`scratch`: the folder of the pictures; `arguments`: of the browser."""
        self.scratch = scratch
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
        with open(os.path.join(self.scratch, name + ".png"), "wb") as file:
            file.write(png)
        return matplotlib.image.imread(io.BytesIO(png), format="png")[:, :, :3]

    def whole_page(self, name):
        png = base64.b64decode(self.command("Page.captureScreenshot", captureBeyondViewport=True)["data"])
        with open(os.path.join(self.scratch, name + ".png"), "wb") as file:
            file.write(png)

    def complaints(self):
        return [entry["message"] for entry in self.ask("POST", "/se/log", {"type": "browser"}) if entry["level"] in ("SEVERE", "WARNING")]


def check(good, what):
    if not good:
        sys.exit("FAILED: " + what)
