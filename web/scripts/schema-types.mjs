// node scripts/schema-types.mjs [--check]: writes the TypeScript types of the scene's JSON from its schema. With
// --check it writes nothing, and fails where the types that are there are others. It knows what the schema uses: $ref,
// $defs, enum, const, oneOf, objects, arrays.

import { readFileSync, writeFileSync } from "node:fs";
import { fileURLToPath } from "node:url";

const SCHEMA = "docs/schema/EIGENFIELD_eigen_textures.schema.json";
const path = (name) => fileURLToPath(new URL(`../../${name}`, import.meta.url));
const TYPES = path("web/eigenfield-three/src/schema.ts");
const LONGEST_TUPLE = 4;
const LONGEST_LINE = 120;

const schema = JSON.parse(readFileSync(path(SCHEMA), "utf8"));
const HEAD = `// Generated from ${SCHEMA}
// by \`npm run schema\` in web/: change the schema, not this file.`;

/** Objects become interfaces, enumerations become unions; other definitions stand where they are used. */
function nameOf(key, definition) {
  const pascal = key[0].toUpperCase() + key.slice(1);
  if (definition.properties) return `${pascal}Json`;
  return definition.enum ? pascal : null;
}

function comment(description, indent = "") {
  return description ? `${indent}/** ${description} */\n` : "";
}

function resolve({ $ref }) {
  const key = $ref.replace("#/$defs/", "");
  const definition = schema.$defs[key];
  if (!definition) throw new Error(`${SCHEMA}: nothing at ${$ref}`);
  return { definition, name: nameOf(key, definition) };
}

function typeOf(part) {
  if (part.const !== undefined) return JSON.stringify(part.const);
  if (part.enum) return part.enum.map((value) => JSON.stringify(value)).join(" | ");
  if (part.oneOf) return part.oneOf.map(typeOf).join(" | ");
  if (part.$ref && !part.properties) {
    const { definition, name } = resolve(part);
    return name ?? typeOf(definition);
  }
  if (part.type === "array") {
    const item = typeOf(part.items);
    if (part.minItems === part.maxItems && part.maxItems <= LONGEST_TUPLE) {
      return `[${Array(part.maxItems).fill(item).join(", ")}]`;
    }
    return item.includes(" ") ? `(${item})[]` : `${item}[]`;
  }
  if (part.type === "object") return "JsonObject";
  const simple = { integer: "number", number: "number", string: "string", boolean: "boolean" }[part.type];
  if (!simple) throw new Error(`${SCHEMA}: no type for ${JSON.stringify(part).slice(0, 80)}`);
  return simple;
}

function interfaceOf(name, { description, properties, required = [] }) {
  const members = Object.entries(properties).map(([key, part]) => {
    const said = part.description ?? (part.$ref ? resolve(part).definition.description : undefined);
    return `${comment(said, "  ")}  ${key}${required.includes(key) ? "" : "?"}: ${typeOf(part)};\n`;
  });
  return `${comment(description)}export interface ${name} {\n${members.join("")}}\n`;
}

function unionOf(name, definition) {
  const said = comment(definition.description);
  const short = `${said}export type ${name} = ${typeOf(definition)};\n`;
  if (short.length - said.length <= LONGEST_LINE) return short;
  return `${said}export type ${name} =${definition.enum.map((value) => `\n  | ${JSON.stringify(value)}`).join("")};\n`;
}

function declarations() {
  const made = [interfaceOf("SceneJson", schema)];
  for (const [key, definition] of Object.entries(schema.$defs)) {
    const name = nameOf(key, definition);
    if (definition.enum) made.push(unionOf(name, definition));
    else if (name) made.push(interfaceOf(name, definition));
  }
  return [`${HEAD}\n`, `import type { JsonObject } from "./json.js";\n`, ...made].join("\n");
}

const text = declarations();
if (process.argv.includes("--check")) {
  if (readFileSync(TYPES, "utf8") !== text) {
    console.error(`schema.ts is not what ${SCHEMA} makes: run 'npm run schema' in web/ and commit it`);
    process.exit(1);
  }
} else {
  writeFileSync(TYPES, text);
}
