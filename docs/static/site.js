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
    box.classList.remove("tight");
    box.classList.toggle("tight", box.matches(".table-wrapper") && box.scrollWidth > box.clientWidth);
    if (box.scrollWidth > box.clientWidth) {
      box.setAttribute("tabindex", "0");
    } else {
      box.removeAttribute("tabindex");
    }
  });
}
window.addEventListener("load", reachable);
window.addEventListener("resize", reachable);
