// The mesh turning under load: poses and rigid-law forces from the design's own numbers, in mm and N.
(function () {
  "use strict";
  var data = JSON.parse(document.getElementById("mesh-data").textContent);
  var figure = document.getElementById("mesh-svg");
  var n = data.lobe_count, teeth = n + 1, pins = data.pin_count;
  var angle = data.poster_angle_deg, turn = 0, shown = 0, playing = false, before = null;
  var radian = Math.PI / 180;

  function all(selector) { return Array.prototype.slice.call(figure.querySelectorAll(selector)); }
  function byId(id) { return document.getElementById(id); }
  var discs = all(".mesh-disc"), carrier = figure.querySelector(".mesh-carrier");
  var cams = all(".mesh-cam");
  var ringArrows = all(".force-ring"), pinArrows = all(".force-pin");
  var camArrow = figure.querySelector(".force-cam"), crank = figure.querySelector(".mesh-crank");

  // F_i = T h_i / sum h^2 over the loaded side, as in the checks; no factor for uneven sharing.
  function shared(arms, torque) {
    var sum = 0;
    arms.forEach(function (h) { if (h > 0) { sum += h * h; } });
    return arms.map(function (h) { return h > 0 ? torque * h / sum : 0; });
  }

  function state(crankAngle, disc) {
    var torque = 1000 * data.torque_Nm / data.disc_count;
    var own = crankAngle + 2 * Math.PI * disc / data.disc_count;
    var u = [Math.cos(own), Math.sin(own)], i, x, y, length;
    var pitch = teeth * data.eccentricity, ring = [], arms = [], normals = [], points = [];
    for (i = 0; i < teeth; i += 1) {
      x = data.ring_pitch_radius * Math.cos(2 * Math.PI * i / teeth);
      y = data.ring_pitch_radius * Math.sin(2 * Math.PI * i / teeth);
      length = Math.hypot(pitch * u[0] - x, pitch * u[1] - y);
      normals.push([(pitch * u[0] - x) / length, (pitch * u[1] - y) / length]);
      arms.push(n * data.eccentricity * (u[0] * normals[i][1] - u[1] * normals[i][0]));
      points.push([x + data.tooth_radius * normals[i][0], y + data.tooth_radius * normals[i][1]]);
    }
    ring = shared(arms, torque);
    var pinArms = [], pinPoints = [], at;
    for (i = 0; i < pins; i += 1) {
      at = -crankAngle / n + data.hole_clocking + 2 * Math.PI * i / pins;
      pinArms.push(data.pin_circle_radius * Math.sin(own - at));
      pinPoints.push([data.pin_circle_radius * Math.cos(at) - data.pin_contact_radius * u[0],
        data.pin_circle_radius * Math.sin(at) - data.pin_contact_radius * u[1]]);
    }
    var pin = shared(pinArms, torque), cam = [0, 0];
    ring.forEach(function (f, k) { cam[0] -= f * normals[k][0]; cam[1] -= f * normals[k][1]; });
    pin.forEach(function (f) { cam[0] += f * u[0]; cam[1] += f * u[1]; });
    return { u: u, ring: ring, normals: normals, points: points, pin: pin, pinPoints: pinPoints,
      cam: cam, centre: [data.eccentricity * u[0], data.eccentricity * u[1]] };
  }

  // An arrow whose tip stands at the place where the force acts; y points down on the page.
  function arrow(tip, force, along) {
    var length = force * data.mm_per_newton;
    if (length < 0.05) { return "M0 0"; }
    var head = Math.min(2.4, 0.6 * length), w = 0.28, v = Math.min(0.85, 0.3 * length);
    function at(back, side) {
      var x = tip[0] - back * along[0] - side * along[1];
      var y = tip[1] - back * along[1] + side * along[0];
      return x.toFixed(3) + " " + (-y).toFixed(3);
    }
    return "M" + [at(0, 0), at(head, v), at(head, w), at(length, w), at(length, -w), at(head, -w),
      at(head, -v)].join("L") + "Z";
  }

  function most(values) {
    var at = 0;
    values.forEach(function (v, i) { if (v > values[at]) { at = i; } });
    return at;
  }
  function grouped(value) {
    var text = Math.round(value).toString();
    return text.length > 4 ? text.replace(/\B(?=(\d{3})+$)/g, "\u202f") : text;
  }
  function say(id, text) {
    var us = document.documentElement.getAttribute("data-units") === "us";
    byId(id).textContent = us ? window.cqddUnits(text) : text;
  }
  function signed(value) { return value.toFixed(1).replace("-", "\u2212"); }

  function draw() {
    var phi = angle * radian;
    discs.forEach(function (element) {
      var d = Number(element.getAttribute("data-disc"));
      var own = phi + 2 * Math.PI * d / data.disc_count;
      element.setAttribute("transform", "translate(" +
        (data.eccentricity * Math.cos(own)).toFixed(4) + " " +
        (-data.eccentricity * Math.sin(own)).toFixed(4) + ") rotate(" +
        (own / radian / n).toFixed(4) + ")");
    });
    cams.forEach(function (element) {
      var own = phi + 2 * Math.PI * Number(element.getAttribute("data-disc")) / data.disc_count;
      element.setAttribute("transform", "translate(" +
        (data.eccentricity * Math.cos(own)).toFixed(4) + " " +
        (-data.eccentricity * Math.sin(own)).toFixed(4) + ")");
    });
    carrier.setAttribute("transform", "rotate(" + (angle / n).toFixed(4) + ")");
    crank.setAttribute("transform", "rotate(" + (-angle).toFixed(4) + ")");
    var now = state(phi, shown);
    ringArrows.forEach(function (path, i) {
      path.setAttribute("d", arrow(now.points[i], now.ring[i], now.normals[i]));
    });
    pinArrows.forEach(function (path, i) {
      path.setAttribute("d", arrow(now.pinPoints[i], now.pin[i], [-now.u[0], -now.u[1]]));
    });
    var load = Math.hypot(now.cam[0], now.cam[1]);
    camArrow.setAttribute("d", arrow(now.centre, load, [now.cam[0] / load, now.cam[1] / load]));
    var tooth = most(now.ring), pin = most(now.pin);
    byId("mesh-crank").textContent = signed(angle) + "\u00b0";
    byId("mesh-carrier").textContent = signed(-angle / n) + "\u00b0";
    say("mesh-ring-force", grouped(now.ring[tooth]) + "\u202fN on tooth " + (tooth + 1));
    say("mesh-pin-force", grouped(now.pin[pin]) + "\u202fN on pin " + (pin + 1));
    say("mesh-cam-force", grouped(load) + "\u202fN");
    figure.setAttribute("data-crank-deg", angle.toFixed(3));
  }

  function step(time) {
    if (!playing) { return; }
    if (before !== null) {
      angle = (angle + 0.06 * Math.min(time - before, 100)) % (360 * n);
      turn = Math.floor(angle / 360);
      byId("mesh-slider").value = angle - 360 * turn;
      draw();
    }
    before = time;
    window.requestAnimationFrame(step);
  }

  byId("mesh-slider").addEventListener("input", function () {
    angle = 360 * turn + Number(this.value);
    draw();
  });
  byId("mesh-play").addEventListener("click", function () {
    playing = !playing;
    before = null;
    this.textContent = playing ? "Pause" : "Play";
    if (playing) { window.requestAnimationFrame(step); }
  });
  Array.prototype.forEach.call(document.getElementsByName("mesh-disc"), function (choice) {
    choice.addEventListener("change", function () {
      shown = Number(this.value);
      discs.forEach(function (element) {
        var top = Number(element.getAttribute("data-disc")) === shown;
        element.classList.toggle("behind", !top);
        if (top) { element.parentNode.appendChild(element); }
      });
      draw();
    });
  });
  var others = byId("mesh-others");
  if (others) {
    others.addEventListener("change", function () {
      figure.classList.toggle("one-disc", !this.checked);
    });
  }
  document.addEventListener("cqdd-units", draw);
  document.documentElement.classList.add("scripted");
  draw();
}());
