// Contents at hand, looks, downloads, and scrolled boxes that the keyboard reaches.
(function () {
  "use strict";
  function byId(id) { return document.getElementById(id); }
  function each(selector, then) {
    Array.prototype.forEach.call(document.querySelectorAll(selector), then);
  }
  var nav = byId("contents"), button = byId("contents-button"), here = byId("contents-here");

  function opened(open) {
    nav.classList.toggle("open", open);
    button.setAttribute("aria-expanded", String(open));
  }
  button.addEventListener("click", function () { opened(!nav.classList.contains("open")); });
  document.addEventListener("keydown", function (event) {
    if (event.key === "Escape" && nav.classList.contains("open")) { opened(false); button.focus(); }
  });
  nav.addEventListener("click", function (event) {
    if (event.target.closest("a")) { opened(false); }
  });

  // The chapter that is being read: the last whose heading has passed the upper third.
  var links = {}, chapters = [];
  each("nav.contents a", function (link) {
    var chapter = byId(link.getAttribute("href").slice(1));
    if (chapter) { links[chapter.id] = link; chapters.push(chapter); }
  });
  function follow() {
    var now = chapters[0];
    chapters.forEach(function (chapter) {
      if (chapter.getBoundingClientRect().top < window.innerHeight / 3) { now = chapter; }
    });
    each("nav.contents a[aria-current]", function (link) { link.removeAttribute("aria-current"); });
    if (now) {
      links[now.id].setAttribute("aria-current", "true");
      here.textContent = links[now.id].textContent;
    }
  }
  window.addEventListener("scroll", follow, { passive: true });

  // A link to what is folded away opens it.
  function unfold() {
    var target = location.hash.length > 1 && byId(decodeURIComponent(location.hash.slice(1)));
    for (var box = target; box; box = box.parentElement) {
      if (box.tagName === "DETAILS") { box.open = true; }
    }
    if (target) { target.scrollIntoView(); }
  }
  window.addEventListener("hashchange", unfold);

  each("input[name='looks']", function (choice) {
    choice.addEventListener("change", function () {
      document.documentElement.setAttribute("data-look", this.value);
      reachable();
    });
  });

  function reachable() {
    each(".scroll, figure", function (box) {
      if (box.scrollWidth > box.clientWidth + 1) {
        box.setAttribute("tabindex", "0");
      } else {
        box.removeAttribute("tabindex");
      }
    });
  }
  window.addEventListener("resize", reachable);
  document.addEventListener("cqdd-units", reachable);

  var model = byId("save-model");
  if (model) {
    model.addEventListener("click", function () {
      window.cqddModel().then(function (content) {
        var link = document.createElement("a");
        link.href = URL.createObjectURL(new Blob([content], { type: "model/gltf-binary" }));
        link.download = model.getAttribute("data-name");
        link.click();
        URL.revokeObjectURL(link.href);
      });
    });
  }
  reachable();
  // Of a drawing that is wider than the screen the middle is seen first.
  each("#drawings figure, #mesh-section figure, #machine figure", function (box) {
    box.scrollLeft = (box.scrollWidth - box.clientWidth) / 2;
  });
  follow();
  unfold();
}());
