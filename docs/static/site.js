// What is wider than the screen scrolls by itself; the keyboard has to reach it then.
function reachable() {
  document.querySelectorAll(".table-wrapper, pre, .equation, p:has(> img)").forEach(function (box) {
    if (box.scrollWidth > box.clientWidth) {
      box.setAttribute("tabindex", "0");
    } else {
      box.removeAttribute("tabindex");
    }
  });
}
window.addEventListener("load", reachable);
window.addEventListener("resize", reachable);
