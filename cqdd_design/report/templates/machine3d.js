// Starts the view of the machine when it comes into sight; the picture stays where it cannot.
(function () {
  "use strict";
  var view = document.getElementById("machine-view"), stage = document.getElementById("machine-stage");
  var started = false, playing = false, before = null, handle = null;
  function byId(id) { return document.getElementById(id); }
  var crank = byId("machine-crank"), words = byId("machine-picked"), hint = words.textContent;
  var turns = Number(crank.max) / 360, angle = 0;

  // What stands in the page as gzip in base64.
  function unpacked(id) {
    var raw = atob(byId(id).textContent.trim()), bytes = new Uint8Array(raw.length), i;
    for (i = 0; i < raw.length; i += 1) { bytes[i] = raw.charCodeAt(i); }
    return new Response(
      new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip")));
  }
  // Corners of triangles are told as distances from the next vertex not yet used.
  function restored(glb) {
    var size = new DataView(glb).getUint32(12, true), start = 28 + size;
    var model = JSON.parse(new TextDecoder().decode(new Uint8Array(glb, 20, size)));
    model.accessors.forEach(function (accessor) {
      var part = model.bufferViews[accessor.bufferView], next = 0, i, back;
      if (part.target !== 34963) { return; }
      var Kind = accessor.componentType === 5123 ? Uint16Array : Uint32Array;
      var corners = new Kind(glb, start + part.byteOffset, accessor.count);
      for (i = 0; i < corners.length; i += 1) {
        back = corners[i];
        corners[i] = next - back;
        if (back === 0) { next += 1; }
      }
    });
    return glb;
  }
  // The model as a file of its own, for the list of downloads.
  window.cqddModel = function () {
    return unpacked("machine-glb").arrayBuffer().then(restored);
  };

  function show() {
    handle.set({ crank: angle * Math.PI / 180 });
    byId("machine-crank-shown").textContent = angle.toFixed(0) + "\u00b0, carrier " +
      (-angle / turns).toFixed(1).replace("-", "\u2212") + "\u00b0";
  }
  function step(time) {
    if (!playing) { return; }
    if (before !== null) {
      angle = (angle + 0.09 * Math.min(time - before, 100)) % Number(crank.max);
      crank.value = angle;
      show();
    }
    before = time;
    window.requestAnimationFrame(step);
  }
  function picked(piece) {
    words.textContent = piece === null ? hint
      : piece.name + ": " + piece.designation + ", " + piece.material;
  }
  function failed(why) {
    var canvas = stage.querySelector("canvas");
    if (canvas) { canvas.remove(); }
    view.setAttribute("data-failed", String(why));
  }
  function start() {
    if (started) { return; }
    started = true;
    if (!window.DecompressionStream) { failed("nothing to unpack with"); return; }
    unpacked("machine-script").text()
      .then(function (code) {
        var script = document.createElement("script");
        script.textContent = code;
        document.head.appendChild(script);
        if (!cqddMachine.canDraw()) { throw "no WebGL"; }
        return window.cqddModel();
      })
      .then(function (glb) { return cqddMachine.start(stage, glb, picked); })
      .then(function (found) {
        handle = found;
        window.cqddMachineHandle = found;
        view.classList.add("machine-live");
        show();
      })
      .catch(failed);
  }
  crank.addEventListener("input", function () { angle = Number(this.value); show(); });
  byId("machine-explode").addEventListener("input", function () {
    handle.set({ explode: Number(this.value) });
  });
  byId("machine-section-cut").addEventListener("input", function () {
    handle.set({ section: Number(this.value) });
  });
  byId("machine-home").addEventListener("click", function () { handle.home(); });
  byId("machine-play").addEventListener("click", function () {
    playing = !playing;
    before = null;
    this.textContent = playing ? "Pause" : "Play";
    if (playing) { window.requestAnimationFrame(step); }
  });
  if ("IntersectionObserver" in window) {
    new IntersectionObserver(function (entries, observer) {
      if (entries.some(function (entry) { return entry.isIntersecting; })) {
        observer.disconnect();
        start();
      }
    }, { rootMargin: "200px" }).observe(stage);
  } else {
    start();
  }
}());
