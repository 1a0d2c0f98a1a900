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
    "N\u00b7m\u00b7s/rad": [8.8507457, "lbf\u00b7in\u00b7s/rad"], "N/\u00b5m": [5.7101471, "lbf/thou"],
    "mN\u00b7m": [0.14161193, "ozf\u00b7in"], "mN\u00b7m\u00b7s/rad": [0.14161193, "ozf\u00b7in\u00b7s/rad"],
    "kg\u00b7cm\u00b2": [0.34171719, "lb\u00b7in\u00b2"], "g\u00b7mm": [0.0013887387, "oz\u00b7in"],
    "g\u00b7mm\u00b2": [5.4674751e-5, "oz\u00b7in\u00b2"], "kg/dm3": [0.036127292, "lb/in\u00b3"],
    "N m": [8.8507457, "lbf\u00b7in"], "N mm": [0.0088507457, "lbf\u00b7in"]
  };
  var names = Object.keys(UNITS).sort(function (a, b) { return b.length - a.length; });
  var NUMBER = "[\u2212-]?\\d+(?:\u202f\\d{3})*(?:\\.\\d+)?(?:[\u202f ]\u00d7[\u202f ]10[\u207b\u2070\u00b9\u00b2\u00b3\u2074-\u2079]+)?";
  // Numbers before the last may share its unit: sides of a box, "3 of 4 MPa", "from 3 to 4 mm". In
  // "2 of 4 mm" the first counts pieces, in "2 \u00d7 8 mm" it is a factor, but for
  // parts that are named by their sizes.
  var SIZED = "(?<=(?:needles|ground pin|NdFeB \\w+) )" + NUMBER + " \u00d7 ";
  var PATTERN = new RegExp("(?<![\\w.])(\u2300 ?" + NUMBER + " [\u00d7x] |" + NUMBER + " \u00d7 " + NUMBER +
    " \u00d7 |" + NUMBER + " (?:x|of|to|\u00b1) ?|" + SIZED + "|\u00b1)?(" + NUMBER + ")[\u202f ](" +
    names.join("|").replace(/\//g, "\\/") + ")(?![\\w\u00b7\u00b2\u00b3\u207b]|/[A-Za-z\u00b5])", "g");
  function counts(before, name) {
    var length = /^(mm|\u00b5m|m)$/.test(name);
    return (/ of $/.test(before) && length) || (/ \u00d7 .* \u00d7 $/.test(before) && !length);
  }
  var SUPER = "\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079";

  function value(text) {
    var parts = text.replace(MINUS, "-").split(/[\u202f ]\u00d7[\u202f ]10/), power = 0;
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
      var first = counts(before || "", name) ? before : before && before.replace(new RegExp(NUMBER, "g"), function (one) {
        return converted(one, unit);
      });
      var spread = /\u00b1 ?$/.test(before || "");
      return (first || "") + converted(number, spread ? unit.slice(0, 2) : unit) + THIN + unit[1];
    });
  }

  // Bare numbers whose unit stands elsewhere: limits, ranges, pairs, values with their spread or
  // an asterisk.
  var BARE = new RegExp("^(?:[\u2264\u2265<>] ?)?[+\u00b1]?" + NUMBER + "(?:(?: to | / | ?\u00b1)\\+?" + NUMBER +
    ")*(?:\\*|, the design)?$");
  function rescaled(text, unit) {
    return text.replace(new RegExp("(\u00b1?)(" + NUMBER + ")", "g"), function (all, spread, number) {
      return spread + converted(number, spread ? unit.slice(0, 2) : unit);
    });
  }
  // The unit that words end with, after a comma or alone, or begin with: "Offset, \u00b5m", "g each".
  var ALL = "(10[\u207b\u2070\u00b9\u00b2\u00b3\u2074-\u2079]+ )?(" + names.join("|") + ")";
  var NAMED = [new RegExp("(?:^|, )" + ALL + "$"), new RegExp("^()(g)(?= (?:each|in all)$)")];
  function named(words) {
    for (var k = 0; k < NAMED.length; k += 1) {
      var found = NAMED[k].exec(words);
      if (found) {
        var unit = UNITS[found[2]], power = found[1] ? value("1" + THIN + "\u00d7" + THIN + found[1].trim()) : 1;
        return { words: (found[1] || "") + found[2], unit: [unit[0] * power].concat(unit.slice(1)) };
      }
    }
    return null;
  }
  function plain(cell) { return cell.children.length ? null : cell.textContent.trim(); }
  // Tells the cells of bare numbers, and the cell that names their unit.
  function bare(cells, unit, then) {
    cells.forEach(function (cell) {
      if (cell && plain(cell) !== null && BARE.test(plain(cell))) { then(cell, unit, true); }
    });
  }
  // Units named by the head of a column, by the first cell of a row, or in a column of their own.
  function tables(then) {
    Array.prototype.forEach.call(document.querySelectorAll("table"), function (table) {
      var heads = Array.prototype.slice.call(table.querySelectorAll("thead tr:last-child > *"));
      var rows = Array.prototype.map.call(table.querySelectorAll("tbody tr"), function (row) {
        return Array.prototype.slice.call(row.children);
      }).filter(function (cells) { return !heads.length || cells.length === heads.length; });
      var own = heads.map(function (head) { return plain(head) === null ? null : named(plain(head)); });
      var column = heads.map(plain).indexOf("Unit");
      own.forEach(function (unit, at) {
        if (!unit) { return; }
        then(heads[at], unit, false);
        bare(rows.map(function (cells) { return cells[at]; }), unit, then);
      });
      rows.forEach(function (cells) {
        var teller = cells[Math.max(column, 0)], unit = plain(teller) === null ? null : named(plain(teller));
        if (!unit || own.some(Boolean)) { return; }
        then(teller, unit, false);
        bare(cells.filter(function (cell) { return cell !== teller; }), unit, then);
      });
    });
  }

  function renamed(text, unit) {
    var at = text.lastIndexOf(unit.words);
    return at < 0 ? text : text.slice(0, at) + unit.unit[1] + text.slice(at + unit.words.length);
  }
  var changed = [], labels = [];
  function set(node, text) {
    if (text !== node.data) {
      changed.push([node, node.data]);
      node.data = text;
    }
  }
  function toInches() {
    tables(function (cell, unit, number) {
      var node = cell.firstChild;
      set(node, number ? rescaled(node.data.trim(), unit.unit) : renamed(node.data, unit));
      if (cell.hasAttribute("data-label")) {
        labels.push([cell, cell.getAttribute("data-label")]);
        cell.setAttribute("data-label", renamed(cell.getAttribute("data-label"), unit));
      }
    });
    var walker = document.createTreeWalker(document.querySelector(".page"), NodeFilter.SHOW_TEXT);
    var node;
    while ((node = walker.nextNode())) {
      if (!node.parentNode.closest("script, style, title, desc")) { set(node, told(node.data)); }
    }
  }
  function relabel() {
    Array.prototype.forEach.call(document.querySelectorAll("[data-label]"), function (cell) {
      var label = cell.getAttribute("data-label"), now = told(label);
      if (now !== label) {
        labels.push([cell, label]);
        cell.setAttribute("data-label", now);
      }
    });
  }
  function back() {
    changed.splice(0).reverse().forEach(function (one) { one[0].data = one[1]; });
    labels.splice(0).reverse().forEach(function (one) { one[0].setAttribute("data-label", one[1]); });
  }
  var note = document.getElementById("units-note");
  Array.prototype.forEach.call(document.getElementsByName("units"), function (choice) {
    choice.addEventListener("change", function () {
      back();
      if (this.value === "us") { toInches(); relabel(); }
      note.hidden = this.value !== "us";
      document.documentElement.setAttribute("data-units", this.value);
      document.dispatchEvent(new Event("cqdd-units"));
    });
  });
  // For what other scripts say anew.
  window.cqddUnits = told;
}());
