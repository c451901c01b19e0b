// What the page says, in the language of who reads it: `?lang=` of the address, else the first of the browser's
// languages that there is a catalogue for, else English. The plug-in speaks English; the other catalogues have a
// sentence for each of its codes.

import type { EigenField, Reduction, SceneErrorCode } from "eigenfield-three";
import de from "./languages/de.json";
import en from "./languages/en.json";
import fr from "./languages/fr.json";
import ja from "./languages/ja.json";
import zh from "./languages/zh.json";

type Key = keyof typeof en;
type PluginCode = SceneErrorCode | "limited" | `limited.${Reduction["kind"]}`;
type Catalogue = Readonly<Record<Key, string>>;

const TRANSLATED: Readonly<Record<string, Catalogue & Readonly<Record<`plugin.${PluginCode}`, string>>>> = { de, fr, ja, zh };
const TAGS: Readonly<Record<string, string>> = { zh: "zh-Hans" };

const asked = new URLSearchParams(location.search).get("lang");
const language =
  [asked ?? "", ...navigator.languages]
    .map((tag) => tag.toLowerCase().split("-")[0] ?? "")
    .find((tag) => tag === "en" || Object.hasOwn(TRANSLATED, tag)) ?? "en";
const translated = TRANSLATED[language];
const catalogue: Catalogue = translated ?? en;
const plural = new Intl.PluralRules(language);

/** Of BCP 47. */
export const LANGUAGE = TAGS[language] ?? language;

/** A text of the catalogue, its {names} replaced. Of two forms, "one|more", `count` takes one. */
export function words(key: Key, values: Readonly<Record<string, string | number>> = {}): string {
  const [one = "", more = one] = catalogue[key].split("|");
  const form = plural.select(Number(values["count"])) === "one" ? one : more;
  return filled(form, values);
}

function filled(text: string, values: Readonly<Record<string, unknown>>): string {
  return text.replaceAll(/\{(\w+)\}/g, (_, name: string) => String(values[name]));
}

/** What the plug-in says, `english`, by its code. */
export const pluginWords = (code: PluginCode, english: string): string => translated?.[`plugin.${code}`] ?? english;

/** What a scene is drawn without where memory is little; null: nothing. */
export function limitationWords({ limitation, reductions }: EigenField): string | null {
  if (limitation === null || !translated) return limitation;
  const parts = reductions.map((one) => filled(translated[`plugin.limited.${one.kind}`], { ...one }));
  return filled(translated["plugin.limited"], { what: new Intl.ListFormat(language).format(parts) });
}
