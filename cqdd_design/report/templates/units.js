// Numbers with units in text, tables and drawings, in inches and pounds. What was there comes back.
(function () {
  "use strict";
  var THIN = "\u202f", MINUS = "\u2212";
  // Factor and unit; an offset where zero lies elsewhere.
  var UNITS = {
    "mm": [1 / 25.4, "in"], "\u00b5m": [1 / 25.4, "thou"], "m": [1 / 0.3048, "ft"],
    "mm\u00b2": [1 / 645.16, "in\u00b2"], "N": [1 / 4.4482216, "lbf"], "kN": [1000 / 4.4482216, "lbf"],
    "N\u00b7m": [8.8507457, "lbf\u00b7in"], "MPa": [0.14503774, "ksi"], "GPa": [145.03774, "ksi"],
    "kg": [2.2046226, "lb"], "g": [0.035273962, "oz"], "\u00b0C": [1.8, "\u00b0F", 32],
    "N\u00b7m/arcmin": [8.8507457, "lbf\u00b7in/arcmin"], "N\u00b7m/rad": [8.8507457, "lbf\u00b7in/rad"],
    "N\u00b7m/A": [8.8507457, "lbf\u00b7in/A"], "m/s": [1 / 0.3048, "ft/s"], "mm/s": [1 / 25.4, "in/s"],
    "kg\u00b7m\u00b2": [3417.1719, "lb\u00b7in\u00b2"], "N\u00b7m/kg": [4.0146, "lbf\u00b7in/lb"],
    "N\u00b7m\u00b7s/rad": [8.8507457, "lbf\u00b7in\u00b7s/rad"], "N/\u00b5m": [5.7101471, "lbf/thou"]
  };
  var names = Object.keys(UNITS).sort(function (a, b) { return b.length - a.length; });
  var NUMBER = "[\u2212-]?\\d+(?:\u202f\\d{3})*(?:\\.\\d+)?(?:\u202f\u00d7\u202f10[\u207b\u2070\u00b9\u00b2\u00b3\u2074-\u2079]+)?";
  // Numbers that share the unit of the last: sides of a box, and "3 of 4 mm", "from 3 to 4 mm".
  var SHARED = "((?:\u2300 ?|R )?(?:" + NUMBER + ") \u00d7 (?:" + NUMBER + " \u00d7 )|\u2300 ?" + NUMBER +
    " \u00d7 |" + NUMBER + " (?:of|to) )?";
  var PATTERN = new RegExp(SHARED + "(" + NUMBER + ")[\u202f ](" + names.join("|").replace(/\//g, "\\/") +
    ")(?![\\w\u00b7/\u00b2\u00b3\u207b])", "g");
  var SUPER = "\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079";

  function value(text) {
    var parts = text.replace(MINUS, "-").split(THIN + "\u00d7" + THIN + "10"), power = 0;
    if (parts.length > 1) {
      power = Number(parts[1].replace("\u207b", "-").replace(/[^-]/g, function (c) { return SUPER.indexOf(c); }));
    }
    return Number(parts[0].split(THIN).join("")) * Math.pow(10, power);
  }
  // As many digits as were there, four at least.
  function converted(text, unit) {
    var digits = text.split("\u00d7")[0].replace(/[^\d]/g, "").replace(/^0+/, "").length;
    var found = value(text) * unit[0] + (unit[2] || 0);
    var shown = Number(found.toPrecision(Math.min(Math.max(digits, 4), 6)));
    if (shown !== 0 && (Math.abs(shown) < 1e-4 || Math.abs(shown) >= 1e7)) {
      var cut = shown.toExponential().split("e");
      return cut[0].replace("-", MINUS) + THIN + "\u00d7" + THIN + "10" + cut[1].replace("+", "")
        .replace("-", "\u207b").replace(/\d/g, function (d) { return SUPER[d]; });
    }
    var halves = String(shown).split(".");
    if (halves[0].replace("-", "").length > 4) {
      halves[0] = halves[0].replace(/\B(?=(\d{3})+$)/g, THIN);
    }
    return halves.join(".").replace("-", MINUS);
  }
  function told(text) {
    return text.replace(PATTERN, function (all, before, number, name) {
      var unit = UNITS[name];
      var first = before && before.replace(new RegExp(NUMBER, "g"), function (one) {
        return converted(one, unit);
      });
      return (first || "") + converted(number, unit) + THIN + unit[1];
    });
  }

  // Columns whose head names the unit of bare numbers: "Offset, \u00b5m".
  function columns(then) {
    Array.prototype.forEach.call(document.querySelectorAll("table"), function (table) {
      Array.prototype.forEach.call(table.querySelectorAll("thead tr > *"), function (head, at) {
        var words = head.textContent.trim(), name = words.split(", ").pop();
        if (head.children.length || !UNITS[name]) { return; }
        then(head, name);
        Array.prototype.forEach.call(table.querySelectorAll("tbody tr"), function (row) {
          var cell = row.children[at];
          if (cell && row.children.length === head.parentNode.children.length &&
              new RegExp("^" + NUMBER + "$").test(cell.textContent.trim())) { then(cell, name); }
        });
      });
    });
  }

  function renamed(text, name) {
    return text.slice(0, text.lastIndexOf(name)) + UNITS[name][1];
  }
  var changed = [], labels = [];
  function set(node, text) {
    if (text !== node.data) {
      changed.push([node, node.data]);
      node.data = text;
    }
  }
  function toInches() {
    columns(function (cell, name) {
      var node = document.createTreeWalker(cell, NodeFilter.SHOW_TEXT).nextNode();
      var text = node.data, bare = cell.closest("thead") === null;
      set(node, bare ? converted(text.trim(), UNITS[name]) : renamed(text, name));
      if (bare && cell.hasAttribute("data-label")) {
        labels.push([cell, cell.getAttribute("data-label")]);
        cell.setAttribute("data-label", renamed(cell.getAttribute("data-label"), name));
      }
    });
    var walker = document.createTreeWalker(document.querySelector(".page"), NodeFilter.SHOW_TEXT);
    var node;
    while ((node = walker.nextNode())) {
      if (!node.parentNode.closest("script, style, thead")) { set(node, told(node.data)); }
    }
  }
  function back() {
    changed.splice(0).reverse().forEach(function (one) { one[0].data = one[1]; });
    labels.splice(0).forEach(function (one) { one[0].setAttribute("data-label", one[1]); });
  }
  var note = document.getElementById("units-note");
  Array.prototype.forEach.call(document.getElementsByName("units"), function (choice) {
    choice.addEventListener("change", function () {
      back();
      if (this.value === "us") { toInches(); }
      note.hidden = this.value !== "us";
      document.documentElement.setAttribute("data-units", this.value);
      document.dispatchEvent(new Event("cqdd-units"));
    });
  });
  // For what other scripts say anew.
  window.cqddUnits = told;
}());
