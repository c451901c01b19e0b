// What a key means on whatever keyboard it is pressed.

const PLACES: Readonly<Record<string, string>> = { BracketLeft: "[", BracketRight: "]", Minus: "-", Equal: "=" };

/**
 * The key in small letters, as its layout prints it. Where the layout has no Latin letters, and for the digits that some
 * layouts have under Shift, the key's place on the keyboard counts instead. Empty with Ctrl, Meta or Alt, which belong to
 * the browser, except for brackets: many layouts have them under AltGr (Ctrl and Alt on Windows) or Option (Alt).
 */
export function keyOf(event: KeyboardEvent): string {
  const key = event.key.toUpperCase().toLowerCase(); // the dotless i of Turkish is an i
  if (key === "[" || key === "]") return event.metaKey || (event.ctrlKey && !event.altKey) ? "" : key;
  if (event.ctrlKey || event.metaKey || event.altKey) return "";
  const [, kind, name = ""] = /^(Key|Digit)(.)$/.exec(event.code) ?? [];
  if (kind === "Digit") return event.shiftKey || event.getModifierState("AltGraph") || /^[-+=?]$/.test(key) ? key : name;
  const foreign = /^[\p{L}\p{M}]/u.test(key) && !/^\p{Script=Latin}/u.test(key);
  return foreign ? (PLACES[event.code] ?? name.toLowerCase()) : key;
}
