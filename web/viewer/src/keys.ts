// What a key means on whatever keyboard it is pressed.

const PLACES: Readonly<Record<string, string>> = { BracketLeft: "[", BracketRight: "]", Minus: "-", Equal: "=" };

/**
 * The key in small letters, as its layout prints it. Where the layout has no Latin letters, and for the digits that some
 * layouts have under Shift, the key's place on the keyboard counts instead. Empty with Ctrl, Meta or Alt, which are the
 * browser's, but for brackets: many layouts have them under AltGr (Ctrl and Alt on Windows) or Option (Alt).
 */
export function keyOf(event: KeyboardEvent): string {
  const { code, ctrlKey, altKey, metaKey, shiftKey } = event;
  const key = event.key.toUpperCase().toLowerCase(); // the dotless i of Turkish is an i
  if (key === "[" || key === "]") return metaKey || (ctrlKey && !altKey) ? "" : key;
  if (ctrlKey || metaKey || altKey) return "";
  const [, kind, name = ""] = /^(Key|Digit)(.)$/.exec(code) ?? [];
  if (kind === "Digit") return shiftKey || event.getModifierState("AltGraph") || "-+=?".includes(key) ? key : name;
  const foreign = /^[\p{L}\p{M}]/u.test(key) && !/^\p{Script=Latin}/u.test(key);
  return foreign ? (PLACES[code] ?? name.toLowerCase()) : key;
}
