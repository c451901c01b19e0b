// Steps through instants by their posters. Where it stands still, the page of the instant is opened over its poster; a
// page from the same server keeps the view that the one before had.
const instants = JSON.parse(document.getElementById("instants").textContent);
const stage = document.querySelector(".stage");
const [picture, slider, button, name] = ["img", "input", "button", "output"].map((each) =>
  document.querySelector(`.player ${each}`),
);
const REST_MS = 350, FRAME_MS = 150;
let frame = null, rest = 0, playing = 0, view = "";

function keepView() {
  try {
    view = frame.contentWindow.location.hash;
  } catch {} // from a file, pages may not look into each other
}

function open() {
  const next = document.createElement("iframe");
  next.title = instants[slider.value].name;
  next.allow = "fullscreen";
  next.src = `${instants[slider.value].page}?ui=none${view}`; // this page has name and buttons of its own
  frame = next;
  stage.append(next);
}

function show(index) {
  slider.value = (index + instants.length) % instants.length;
  const instant = instants[slider.value];
  name.textContent = instant.name;
  picture.src = instant.poster;
  if (frame) {
    keepView();
    frame.remove();
    frame = null;
  }
  clearTimeout(rest);
  if (!playing) rest = setTimeout(open, REST_MS);
}

function play(on) {
  clearInterval(playing);
  playing = on ? setInterval(() => show(Number(slider.value) + 1), FRAME_MS) : 0;
  button.textContent = on ? "⏸" : "▶";
  button.setAttribute("aria-label", on ? "Pause" : "Play");
  show(Number(slider.value));
}

slider.addEventListener("input", () => show(Number(slider.value)));
button.addEventListener("click", () => play(!playing));
addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey) return; // Alt and left is the browser's way back
  const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
  if (step) show(Number(slider.value) + step);
  else if (event.key === " " && event.target !== button) play(!playing);
  else return;
  event.preventDefault();
});
for (const { poster } of instants) new Image().src = poster;
show(0);
