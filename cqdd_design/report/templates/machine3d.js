// Starts the view of the machine when it comes into sight; the poster stays where that fails.
(function () {
  "use strict";
  var view = document.getElementById("machine-view");
  var stage = document.getElementById("machine-stage");
  var started = false, playing = false, before = null, handle = null;
  function byId(id) { return document.getElementById(id); }
  var crank = byId("machine-crank"), words = byId("machine-picked"), hint = words.textContent;
  var turns = Number(crank.max) / 360, angle = 0;

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
  function start() {
    if (started) { return; }
    started = true;
    if (!window.cqddMachine || !cqddMachine.canDraw()) { return; }
    cqddMachine.start(stage, cqddMachine.decode(byId("machine-glb").textContent), picked)
      .then(function (found) {
        handle = found;
        window.cqddMachineHandle = found;
        view.classList.add("machine-live");
        show();
      })
      .catch(function (error) {
        var canvas = stage.querySelector("canvas");
        if (canvas) { canvas.remove(); }
        view.setAttribute("data-failed", String(error));
      });
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
