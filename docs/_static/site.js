// What the theme leaves out: boxes that scroll can be reached by keys, and headings and sidebars say what they are.
const reach = () => {
  for (const box of document.querySelectorAll("pre, .table-wrapper")) {
    if (box.scrollWidth > box.clientWidth) box.tabIndex = 0;
    else box.removeAttribute("tabindex");
  }
};
document.addEventListener("DOMContentLoaded", () => {
  for (const caption of document.querySelectorAll(".caption[role=heading]")) caption.ariaLevel = "2";
  document.querySelector(".sidebar-drawer")?.setAttribute("aria-label", "Pages");
  document.querySelector(".toc-drawer")?.setAttribute("aria-label", "On this page");
  reach();
});
addEventListener("resize", reach);

// A scene begins to load when its poster is on the screen: starting WebGL would keep the whole page from being drawn.
const scene = document.querySelector(".scene iframe");
scene?.previousElementSibling
  .decode()
  .catch(() => undefined)
  .then(() => requestAnimationFrame(() => setTimeout(() => (scene.src = scene.dataset.src))));
