// Labelled controls of the panel, all native: the keyboard and screen readers know them. `keys` do the same.

import { element, keyCaps } from "./dom";

export interface Control<T> {
  readonly root: HTMLElement;
  show(value: T): void;
  enable(enabled: boolean, why?: string): void;
}

const capped = (keys: string | undefined): HTMLElement[] => (keys === undefined ? [] : [keyCaps(keys)]);
let made = 0;
const name = (): string => `control-${++made}`;

/** One of a few, side by side. Single choices can be switched off, with the reason as their title. */
export function choice<T extends string>(
  label: string,
  entries: readonly (readonly [T, string])[],
  chosen: (value: T) => void,
  keys?: string,
): Control<T> & { allow(value: T, allowed: boolean, why: string): void } {
  const group = name();
  const inputs = new Map<T, HTMLInputElement>();
  const row = element("div", { class: "segments" });
  for (const [value, text] of entries) {
    const input = element("input", { type: "radio", name: group, value });
    input.addEventListener("change", () => chosen(value));
    inputs.set(value, input);
    row.append(element("label", {}, input, element("span", {}, text)));
  }
  const root = element("fieldset", { class: "control" }, element("legend", {}, label, ...capped(keys)), row);
  return {
    root,
    show: (value) => {
      const input = inputs.get(value);
      if (input) input.checked = true;
    },
    enable: (enabled, why = "") => {
      root.disabled = !enabled;
      root.title = enabled ? "" : why;
    },
    allow: (value, allowed, why) => {
      const input = inputs.get(value);
      if (!input) return;
      input.disabled = !allowed;
      if (input.parentElement) input.parentElement.title = allowed ? "" : why;
    },
  };
}

export interface Slider extends Control<number> {
  setRange(low: number, high: number): void;
  say(text: string): void;
}

export function slider(label: string, moved: (value: number) => void, keys?: string): Slider {
  const id = name();
  const input = element("input", { type: "range", id, step: "1", min: "0", max: "0" });
  const words = element("output", { for: id });
  input.addEventListener("input", () => moved(Number(input.value)));
  const root = element(
    "div", { class: "control" },
    element("div", { class: "pair" }, element("label", { for: id }, label, ...capped(keys)), words), input,
  );
  return {
    root,
    setRange: (low, high) => {
      input.min = String(low);
      input.max = String(high);
    },
    show: (value) => {
      input.value = String(value);
      const [low, high] = [Number(input.min), Number(input.max)];
      input.style.setProperty("--part", `${high > low ? (100 * (value - low)) / (high - low) : 0}%`);
    },
    say: (text) => {
      words.textContent = text;
      input.setAttribute("aria-valuetext", text);
    },
    enable: (enabled) => void (input.disabled = !enabled),
  };
}

export function tick(label: string, changed: (on: boolean) => void, keys?: string): Control<boolean> {
  const input = element("input", { type: "checkbox" });
  input.addEventListener("change", () => changed(input.checked));
  const root = element("label", { class: "control tick" }, input, element("span", {}, label, ...capped(keys)));
  return {
    root,
    show: (on) => void (input.checked = on),
    enable: (enabled) => void (input.disabled = !enabled),
  };
}

/** One of many. */
export interface MenuGroup {
  label: string | null; // null: its entries stand alone
  entries: readonly (readonly [string, string])[];
}

export function menu(label: string, chosen: (value: string) => void): Control<string> & {
  readonly input: HTMLSelectElement;
  fill(groups: readonly MenuGroup[]): void;
} {
  const input = element("select", { "aria-label": label });
  input.addEventListener("change", () => chosen(input.value));
  return {
    root: input,
    input,
    fill: (groups) => {
      const made = groups.flatMap(({ label: name, entries }) => {
        const options = entries.map(([value, text]) => element("option", { value }, text));
        return name === null ? options : [element("optgroup", { label: name }, ...options)];
      });
      input.replaceChildren(...made);
    },
    show: (value) => void (input.value = value),
    enable: (enabled) => void (input.disabled = !enabled),
  };
}
