// What is wider than the screen scrolls by itself; the keyboard has to reach it then.
// Of a drawing the middle is seen first, of a chart its axis.
window.addEventListener("load", function () {
  document.querySelectorAll("p:has(> img)").forEach(function (box) {
    if (/gallery-|theory-/.test(box.firstElementChild.getAttribute("src"))) {
      box.scrollLeft = (box.scrollWidth - box.clientWidth) / 2;
    }
  });
});
function reachable() {
  document.querySelectorAll(".table-wrapper, pre, .equation, p:has(> img)").forEach(function (box) {
    // Keys of a table may be broken where there is no room for them whole.
    box.classList.remove("tight", "wide");
    box.classList.toggle("tight", box.matches(".table-wrapper") && box.scrollWidth > box.clientWidth);
    if (box.scrollWidth > box.clientWidth) {
      // It scrolls all the same: then sentences have room, or a row is taller than the screen.
      box.classList.toggle("wide", box.matches(".table-wrapper"));
      box.setAttribute("tabindex", "0");
    } else {
      box.removeAttribute("tabindex");
    }
  });
}
window.addEventListener("load", function () {
  document.querySelectorAll(".table-wrapper td").forEach(function (cell) {
    cell.classList.toggle("words", cell.textContent.length > 60);
    cell.classList.toggle("sentences", cell.textContent.length > 160);
  });
  reachable();
});
window.addEventListener("resize", reachable);
