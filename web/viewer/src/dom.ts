// Elements made from data. Text becomes text nodes and never markup: names in files come from strangers.

type Child = Node | string;
type Attributes = Readonly<Record<string, string>>;

export function element<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  made.append(...children);
  return made;
}

/** A line drawing of 24 x 24, in the colour of the text around it. */
export function icon(path: string): SVGSVGElement {
  const space = "http://www.w3.org/2000/svg";
  const drawing = document.createElementNS(space, "svg");
  drawing.setAttribute("viewBox", "0 0 24 24");
  drawing.setAttribute("aria-hidden", "true");
  const line = document.createElementNS(space, "path");
  line.setAttribute("d", path);
  drawing.append(line);
  return drawing;
}

/** keys: which do the same. */
export function button(label: string, path: string, act: () => void, keys?: string): HTMLButtonElement {
  const made = element("button", { type: "button", class: "icon", "aria-label": label, title: label }, icon(path));
  if (keys !== undefined) made.append(keyCaps(keys));
  made.addEventListener("click", act);
  return made;
}

/** What is on the keys that do the same as a control: it shows once somebody has pressed a key. */
export const keyCaps = (keys: string): HTMLElement => element("kbd", { "aria-hidden": "true" }, keys);

export const ICONS = {
  home: "M4 11.5 12 5l8 6.5M6.5 10v9h11v-9M10 19v-5h4v5",
  orbit: "M12 10a2 2 0 1 0 0 4 2 2 0 0 0 0-4ZM19.5 8.5a8.5 8.5 0 0 0-15 0M4.5 15.5a8.5 8.5 0 0 0 15 0M19.5 4v4.5H15",
  tilt: "M8 3.5h8v17H8zM3 9l-1 3 1 3M21 9l1 3-1 3M11 17.5h2",
  camera: "M4 8h3.5L9 5.5h6L16.5 8H20v11H4zM12 10a3.2 3.2 0 1 0 0 6.4 3.2 3.2 0 0 0 0-6.4Z",
  headset: "M3 8h18v9h-6l-2-2.5h-2L9 17H3zM7.5 11v2.5M16.5 11v2.5",
  open: "M4 19V6h6l2 2.5h8V19zM12 17v-5M9.8 14 12 11.8l2.2 2.2",
  help: "M12 3.5a8.5 8.5 0 1 0 0 17 8.5 8.5 0 0 0 0-17ZM9.6 9.6c0-3.2 5-3.2 5 0 0 2-2.6 2.1-2.6 4.1M12 16.4v.4",
  panel: "M4 7h10M18 7h2M14 5v4h4V5zM4 17h2M10 17h10M6 15v4h4v-4z",
  nearest: "M12 8a4 4 0 1 0 0 8 4 4 0 0 0 0-8ZM12 3v3M12 18v3M3 12h3M18 12h3",
  previous: "M14.5 6 8.5 12l6 6",
  next: "M9.5 6l6 6-6 6",
  fullscreen: "M4 9V4h5M15 4h5v5M20 15v5h-5M9 20H4v-5",
  share: "M12 4v11M8 8l4-4 4 4M6 12H4.5v8h15v-8H18",
  embed: "M8.5 7.5 4 12l4.5 4.5M15.5 7.5 20 12l-4.5 4.5M13.5 6l-3 12",
  download: "M12 4v11M8 11l4 4 4-4M5 19.5h14",
  info: "M12 3.5a8.5 8.5 0 1 0 0 17 8.5 8.5 0 0 0 0-17ZM12 11v5.5M12 7.6v.4",
  close: "M6 6l12 12M18 6 6 18",
  play: "M8 5.5v13l10.5-6.5z",
  pause: "M8.5 6v12M15.5 6v12",
  sound: "M4 9.5v5h3.5l4.5 4v-13l-4.5 4zM15.5 9.5a4 4 0 0 1 0 5M18 7a8 8 0 0 1 0 10",
  muted: "M4 9.5v5h3.5l4.5 4v-13l-4.5 4zM15.5 9.5l5 5M20.5 9.5l-5 5",
  loop: "M5 12V9.5A3 3 0 0 1 8 6.5h10.5L16 4M19 12v2.5a3 3 0 0 1-3 3H5.5L8 20",
};
