"""A page as different readers have it: on a desk and on a phone, light and dark, without a mouse.

The page is opened in a frame as wide as the screen, in a real Chromium. What is measured: text that
is too small, boxes wider than the screen, contrast of letters in drawings (axe leaves SVG out), and
what axe-core finds, the checker of accessibility that browsers' own tools are built on.
"""

from __future__ import annotations

import base64
import json
from pathlib import Path
from typing import Any

import pytest
from report_browser import findings

LEAST_TEXT = 11.0
"""px."""
LEAST_CONTRAST = 4.5

_PAGE = """<!DOCTYPE html><html lang="en"><head><title>readers</title></head><body>
<script type="text/plain" id="axe">AXE</script><script type="text/plain" id="inner">INNER</script>
<script>
function text(id) {
  var raw = atob(document.getElementById(id).textContent), bytes = new Uint8Array(raw.length);
  for (var i = 0; i < raw.length; i += 1) { bytes[i] = raw.charCodeAt(i); }
  return new TextDecoder().decode(bytes);
}
function colour(words) {
  var found = (words.match(/[\\d.]+/g) || []).map(Number);
  return found.length < 3 || found[3] === 0 ? null : found.slice(0, 3);
}
function light(rgb) {
  var c = rgb.map(function (v) {
    v /= 255; return v <= 0.03928 ? v / 12.92 : Math.pow((v + 0.055) / 1.055, 2.4); });
  return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
}
function behind(element, view) {
  for (var box = element; box; box = box.parentElement) {
    var found = colour(view.getComputedStyle(box).backgroundColor);
    if (found && !(box instanceof view.SVGElement)) { return found; }
  }
  return [255, 255, 255];
}
// Text that is shown: its size on the screen, and in drawings its contrast.
function measured(frame) {
  var view = frame.contentWindow, page = frame.contentDocument, small = [], pale = [], least = 99;
  var walker = page.createTreeWalker(page.body, NodeFilter.SHOW_TEXT), node;
  while ((node = walker.nextNode())) {
    var at = node.parentElement;
    if (!node.data.trim() || at.closest("script, style, title, desc, noscript")) { continue; }
    var range = page.createRange();
    range.selectNodeContents(node);
    var box = range.getBoundingClientRect(), style = view.getComputedStyle(at);
    if (!box.width || !box.height || style.visibility === "hidden") { continue; }
    var svg = at.closest("svg"), scale = svg ? Math.abs(svg.getScreenCTM().a) : 1;
    var size = parseFloat(style.fontSize) * scale;
    least = Math.min(least, size);
    if (size < LEAST_TEXT - 0.01) {
      small.push(size.toFixed(2) + " " + (at.getAttribute("class") || at.tagName) + " " +
        node.data.trim().slice(0, 30) + " in " + (at.closest("[id]") || page.body).id);
    }
    // A letter on a coloured cell has no page behind it.
    if (svg && !at.matches(".cell-text, .cell-text *") && style.fill !== "none") {
      var one = light(colour(style.fill)), other = light(behind(svg, view));
      var contrast = (Math.max(one, other) + 0.05) / (Math.min(one, other) + 0.05);
      if (contrast < LEAST_CONTRAST) {
        pale.push(contrast.toFixed(2) + " " + node.data.trim() + " in " + (svg.id || ""));
      }
    }
  }
  var cut = [];
  page.querySelectorAll(".scroll").forEach(function (box) {
    if (box.scrollWidth > box.clientWidth + 1) {
      cut.push((box.closest("[id]") || page.body).id + ": " + box.textContent.trim().slice(0, 40));
    }
  });
  return { least: least, small: small, pale: pale, cut: cut,
    overflow: page.documentElement.scrollWidth - page.documentElement.clientWidth };
}
function opened(width, height, look) {
  return new Promise(function (done) {
    var frame = document.createElement("iframe");
    frame.style.cssText = "border:0;width:" + width + "px;height:" + height + "px";
    frame.onload = function () {
      frame.contentDocument.documentElement.setAttribute("data-look", look);
      setTimeout(function () { done(frame); }, 50);
    };
    frame.srcdoc = text("inner");
    document.body.appendChild(frame);
  });
}
async function read() {
  var found = {}, axe = text("axe");
  for (var one of SCREENS) {
    var frame = await opened(one[0], one[1], one[2]);
    var seen = measured(frame), view = frame.contentWindow;
    if (axe && one[3]) {
      view.eval(axe);
      var told = await view.axe.run(frame.contentDocument, { resultTypes: ["violations"],
        rules: { "frame-tested": { enabled: false } } });
      seen.violations = told.violations.map(function (v) {
        return { id: v.id, impact: v.impact, nodes: v.nodes.slice(0, 6).map(function (n) {
          return n.target.join(" ") + " | " + (n.any[0] ? n.any[0].message : ""); }),
          count: v.nodes.length }; });
    }
    seen.more = MORE(frame);
    found[one.slice(0, 3).join(" ")] = seen;
    frame.remove();
  }
  return found;
}
window.addEventListener("load", function () {
  read().then(postFindings).catch(function (error) {
    postFindings({ error: String(error.stack) });
  });
});
</script></body></html>"""

SCREENS = (
    (1300, 900, "light", True),
    (1300, 900, "dark", False),
    (800, 900, "light", False),
    (400, 800, "light", False),
    (400, 800, "dark", True),
)
"""Width and height in px, looks, and whether axe reads there: outer widths and both looks once."""


def axe_source() -> str:
    """The checker's script; a test without the package that carries it is skipped."""
    package = pytest.importorskip("axe_core_python", reason="axe-core-python is not installed")
    return Path(package.__file__).with_name("axe.min.js").read_text(encoding="utf-8")


def read(page: str, folder: Path, *, axe: str = "", more: str = "null") -> dict[str, Any]:
    """What every reader finds.

    Parameters
    ----------
    page : str
        HTML.
    axe : str
        The checker's script; nothing is checked by it without.
    more : str
        Body of a function of ``frame``, whose value comes back for every screen.

    Returns
    -------
    dict
        ``"1300 900 light"`` and so on to `least` text in px, `small` and `pale` text, boxes that
        are `cut`, `overflow` of the page in px, `more`, and where axe reads its `violations`.
    """

    def packed(text: str) -> str:
        return base64.b64encode(text.encode()).decode("ascii")

    outer = (
        _PAGE.replace("SCREENS", json.dumps(SCREENS), 1)
        .replace("LEAST_TEXT", f"{LEAST_TEXT}")
        .replace("LEAST_CONTRAST", f"{LEAST_CONTRAST}")
        .replace("MORE(frame)", f"(function () {{ {more} }}())")
        .replace("AXE", packed(axe))
        .replace("INNER", packed(page))
    )
    found = findings(outer, folder, "--window-size=1400,1000")
    assert "error" not in found, found["error"]
    assert len([one for one in SCREENS if "violations" in found[_name(one)]]) == (2 if axe else 0)
    return {_name(one): found[_name(one)] for one in SCREENS}


def _name(screen: tuple[int, int, str, bool]) -> str:
    return " ".join(map(str, screen[:3]))
