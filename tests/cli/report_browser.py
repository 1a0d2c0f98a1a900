"""Open a page in a real Chromium and bring back what it drew.

A probe script goes into a copy of the page: it collects errors, measures every figure, moves the
slider, presses play, and posts its findings to the test, which waits for them as long as it takes.
It also draws the page's frames itself, at times of its own: nothing hangs on a busy machine.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import threading
from http.server import BaseHTTPRequestHandler, HTTPServer
from pathlib import Path
from typing import Any

import pytest

BROWSERS = ("chromium", "chromium-browser", "google-chrome")
FLAGS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--hide-scrollbars",
    "--enable-logging=stderr",
    "--v=0",
)

#: Seconds until a page that posts nothing is given up.
LONGEST_WAIT = 600.0

_SENDER = """<script>
window.postFindings = function (found) {
  fetch("http://127.0.0.1:PORT/", { method: "POST", mode: "no-cors",
    body: JSON.stringify(found) });
};
</script>"""
_COLLECTOR = """<script>
window.probeErrors = [];
window.addEventListener("error", function (event) {
  var missing = event.target.src || event.target.href;
  window.probeErrors.push(event.message || "failed to load " + missing);
}, true);
window.probeFrames = [];
window.requestAnimationFrame = function (draw) { return window.probeFrames.push(draw); };
</script>"""

_PROBE = r"""<script>
window.addEventListener("load", function () {
  function texts(svg) {
    return Array.prototype.map.call(svg.querySelectorAll("text"), function (text) {
      var box = text.getBoundingClientRect();
      return { text: text.textContent, left: box.left, right: box.right, top: box.top,
        bottom: box.bottom };
    });
  }
  function figures() {
    return Array.prototype.map.call(document.querySelectorAll("figure"), function (figure) {
      var svg = figure.querySelector("svg"), box = svg.getBoundingClientRect(), drawn = 0;
      svg.querySelectorAll("path, line, circle, rect").forEach(function (shape) {
        var size = shape.getBBox();
        if (size.width + size.height > 0) { drawn += 1; }
      });
      return { id: figure.id, drawn: drawn, width: box.width, height: box.height, left: box.left,
        right: box.right, top: box.top, bottom: box.bottom, texts: texts(svg),
        title: (svg.querySelector("title") || {}).textContent || "",
        labelled: svg.getAttribute("aria-labelledby").split(" ").every(function (id) {
          return document.getElementById(id) !== null; }) };
    });
  }
  function mesh() {
    var svg = document.getElementById("mesh-svg");
    if (!svg) { return null; }
    function all(selector, name) {
      return Array.prototype.map.call(svg.querySelectorAll(selector), function (element) {
        return element.getAttribute(name); });
    }
    return { discs: all(".mesh-disc", "transform"), carrier: all(".mesh-carrier", "transform"),
      arrows: all(".force", "d"), crank: document.getElementById("mesh-crank").textContent,
      ring: document.getElementById("mesh-ring-force").textContent,
      pin: document.getElementById("mesh-pin-force").textContent,
      cam: document.getElementById("mesh-cam-force").textContent,
      carrierAngle: document.getElementById("mesh-carrier").textContent,
      shown: Array.prototype.filter.call(svg.querySelectorAll(".mesh-disc"), function (disc) {
        return getComputedStyle(disc).display !== "none"; }).length };
  }
  function slide(value) {
    var slider = document.getElementById("mesh-slider");
    slider.value = value;
    slider.dispatchEvent(new Event("input", { bubbles: true }));
    return mesh();
  }
  var found = { figures: figures(), overflow: document.documentElement.scrollWidth -
    document.documentElement.clientWidth, outside: [], bars: 0, hiddenBars: 0 };
  document.querySelectorAll(".margin-bar rect").forEach(function (bar) {
    found.bars += 1;
    if (getComputedStyle(bar).display !== "inline") { found.hiddenBars += 1; }
  });
  document.querySelectorAll("a[href^='#']").forEach(function (link) {
    if (!document.getElementById(link.getAttribute("href").slice(1))) {
      found.outside.push(link.getAttribute("href"));
    }
  });
  function finish() {
    found.errors = window.probeErrors;
    postFindings(found);
  }
  if (!document.getElementById("mesh-slider")) { finish(); return; }
  found.start = mesh();
  found.slid = slide(PROBE_ANGLE);
  var second = document.querySelector("input[name='mesh-disc'][value='1']");
  if (second) {
    second.click();
    found.second = mesh();
    document.getElementById("mesh-others").click();
    found.alone = mesh();
    document.getElementById("mesh-others").click();
    document.querySelector("input[name='mesh-disc'][value='0']").click();
  }
  found.back = slide(PROBE_START);
  function frame(time) {
    window.probeFrames.splice(0).forEach(function (draw) { draw(time); });
    return mesh();
  }
  function press() {
    document.getElementById("mesh-play").click();
    return document.getElementById("mesh-play").textContent;
  }
  found.labels = [press()];
  frame(1000);
  found.playing = frame(1050);
  found.labels.push(press());
  found.paused = frame(1100);
  finish();
});
</script>"""


def browser() -> str:
    """The browser's path; a test without one fails, unless CQDD_SKIP_BROWSER is set."""
    for name in BROWSERS:
        place = shutil.which(name)
        if place:
            return place
    if os.environ.get("CQDD_SKIP_BROWSER"):
        pytest.skip("no Chromium, and CQDD_SKIP_BROWSER is set")
    pytest.fail(
        "no Chromium found (looked for " + ", ".join(BROWSERS) + "); install one with "
        "`apt-get install -y chromium`, or set CQDD_SKIP_BROWSER=1 to skip these tests"
    )


def run_browser(folder: Path, *arguments: str, page: Path) -> subprocess.CompletedProcess[str]:
    """Run Chromium once on a page, with a profile of its own in `folder`."""
    done = subprocess.run(
        [browser(), *FLAGS, f"--user-data-dir={folder / 'profile'}", *arguments, page.as_uri()],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done


def findings(page: str, folder: Path, *flags: str) -> dict[str, Any]:
    """What a page's own script posts with `postFindings`, and the browser's console.

    The page is opened as a file, as its reader opens it, and is given as long as it needs.

    Parameters
    ----------
    page : str
        HTML with a script that calls ``postFindings(object)`` once.
    folder : Path
        For the copy and the browser's profile.
    *flags : str
        For Chromium.

    Returns
    -------
    dict
        The object, and under `console` what the page said there.
    """
    posted: list[bytes] = []
    arrived = threading.Event()

    class Receiver(BaseHTTPRequestHandler):
        def do_POST(self) -> None:
            posted.append(self.rfile.read(int(self.headers["Content-Length"])))
            self.send_response(204)
            self.end_headers()
            arrived.set()

        def log_message(self, *_: object) -> None:
            pass

    server = HTTPServer(("127.0.0.1", 0), Receiver)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    path = folder / "page.html"
    sender = _SENDER.replace("PORT", str(server.server_port))
    path.write_text(page.replace("<head>", f"<head>{sender}", 1), encoding="utf-8")
    log = folder / "browser.log"
    with log.open("wb") as stderr:
        process = subprocess.Popen(
            [browser(), *FLAGS, f"--user-data-dir={folder / 'profile'}", *flags, path.as_uri()],
            stdout=subprocess.DEVNULL,
            stderr=stderr,
        )
        try:
            arrived.wait(LONGEST_WAIT)
        finally:
            process.terminate()
            process.wait(60)
            server.shutdown()
            server.server_close()
    said = log.read_text(encoding="utf-8", errors="replace")
    assert posted, f"the page posted nothing: {said[-2000:]}"
    found: dict[str, Any] = json.loads(posted[0])
    # How fast its driver is the browser says of itself, now and then, on a busy machine.
    found["console"] = [
        line
        for line in said.splitlines()
        if "CONSOLE" in line and "GL Driver Message (OpenGL, Performance" not in line
    ]
    return found


def probe(
    page: str, folder: Path, *, angle: float = 100.0, start: float = 30.0, size: str = "1100,1400"
) -> dict[str, Any]:
    """What a page draws and does.

    Parameters
    ----------
    page : str
        HTML.
    folder : Path
        For the copy and the browser's profile.
    angle, start : float
        Crank angles the slider goes to, degrees.
    size : str
        Window in px.

    Returns
    -------
    dict
        `errors` of the page, `console` errors of the browser, `figures` and the states of the
        mesh.
    """
    probe_script = _PROBE.replace("PROBE_ANGLE", f"{angle:g}").replace("PROBE_START", f"{start:g}")
    watched = page.replace("<head>", f"<head>{_COLLECTOR}", 1)
    watched = watched.replace("</body>", f"{probe_script}</body>", 1)
    assert _COLLECTOR in watched
    assert probe_script in watched
    return findings(watched, folder, f"--window-size={size}")


def overlapping(figure: dict[str, Any]) -> list[str]:
    """Pairs of labels of a figure that cover each other, by more than a hair."""
    found = []
    texts = [text for text in figure["texts"] if text["text"].strip()]
    for i, one in enumerate(texts):
        for other in texts[i + 1 :]:
            wide = min(one["right"], other["right"]) - max(one["left"], other["left"])
            high = min(one["bottom"], other["bottom"]) - max(one["top"], other["top"])
            if wide > 1.5 and high > 3.5:
                found.append(f"{one['text']!r} on {other['text']!r}")
    return found


def clipped(figure: dict[str, Any]) -> list[str]:
    """Labels that leave their figure."""
    return [
        text["text"]
        for text in figure["texts"]
        if text["left"] < figure["left"] - 0.5
        or text["right"] > figure["right"] + 0.5
        or text["top"] < figure["top"] - 0.5
        or text["bottom"] > figure["bottom"] + 0.5
    ]
