// What the browser tests share: Chromium, a server for folders and bytes, pictures and their differences.
//
// Environment:
//   EIGENFIELD_CHROMIUM   the browser; else /usr/bin/chromium, or `chromium` on the PATH
//   EIGENFIELD_SCENES     the folder that `write` of the modules in tests/support made, as tests/viewer/test_browser.py calls them

import assert from "node:assert/strict";
import { existsSync, readFileSync } from "node:fs";
import { mkdtemp, readFile, rm } from "node:fs/promises";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { delimiter, extname, join, normalize, sep } from "node:path";
import { fileURLToPath } from "node:url";
import { inflateRawSync, inflateSync } from "node:zlib";
import { chromium } from "playwright-core";

export const WEB = fileURLToPath(new URL("..", import.meta.url));
export const STATIC = fileURLToPath(new URL("../../src/eigenfield/viewer/static", import.meta.url));

const FLAGS = [
  "--no-sandbox",
  "--use-angle=swiftshader",
  "--enable-unsafe-swiftshader",
  "--ignore-gpu-blocklist",
  "--disable-background-networking",
];

const SOURCE = readFileSync(join(WEB, "eigenfield-three/src/packed.ts"), "utf8");
const DICTIONARY = Buffer.from([...SOURCE.matchAll(/^  '(.*)',$/gm)].map(([, line]) => line).join(""));

const TYPES = {
  ".html": "text/html; charset=utf-8",
  ".js": "text/javascript; charset=utf-8",
  ".css": "text/css; charset=utf-8",
  ".json": "application/json",
  ".png": "image/png",
  ".svg": "image/svg+xml",
  ".webmanifest": "application/manifest+json",
  ".glb": "model/gltf-binary",
};

/** A file of the test scenes' folder. */
export function scenePath(name) {
  const folder = process.env.EIGENFIELD_SCENES;
  assert.ok(folder, "EIGENFIELD_SCENES must name the folder that tests/viewer/test_browser.py makes");
  return join(folder, name);
}

export function sceneBytes(name) {
  return readFileSync(scenePath(name));
}

export function chromiumPath() {
  const candidates = [
    process.env.EIGENFIELD_CHROMIUM,
    "/usr/bin/chromium",
    ...(process.env.PATH ?? "").split(delimiter).map((folder) => join(folder, "chromium")),
  ];
  const found = candidates.find((path) => path && existsSync(path));
  assert.ok(found, "no Chromium: install it, or name it by EIGENFIELD_CHROMIUM");
  return found;
}

/** Starts Chromium; close it in `after`. */
export function launch(options = {}) {
  const { args = [], ...rest } = options;
  return chromium.launch({ executablePath: chromiumPath(), headless: true, args: [...FLAGS, ...args], ...rest });
}

/**
 * Opens a page of its own context. Returns { page, problems, close }: `problems` lists uncaught errors, console errors
 * and failed requests; `close` fails the test if there is one that `allowed` (a regular expression) does not cover.
 */
export async function openPage(browser, url, options = {}) {
  const { width = 320, height = 240, allowed = null, init = null, context = {} } = options;
  const own = await browser.newContext({ viewport: { width, height }, deviceScaleFactor: 1, ...context });
  const page = await own.newPage();
  const problems = [];
  page.on("pageerror", (error) => problems.push(`uncaught: ${error.message}`));
  page.on("console", (message) => {
    if (message.type() === "error" || /\[Violation\]|THREE\.|GL_INVALID/.test(message.text())) {
      problems.push(`console: ${message.text()}`);
    }
  });
  if (init) await page.addInitScript(init);
  if (url) await page.goto(url);
  const close = async () => {
    await own.close();
    const unexpected = problems.filter((problem) => !allowed?.test(problem));
    assert.deepEqual(unexpected, [], "the page reported problems");
  };
  return { page, problems, close };
}

/**
 * Serves on the loopback: `routes` maps a path to bytes, to { body, type, status, headers } or to a function
 * (request, response); other paths are files of `folders`, first come. Returns { url, requests, close }.
 */
export async function serve({ routes = {}, folders = [] } = {}) {
  const requests = [];
  const server = createServer(async (request, response) => {
    const path = decodeURIComponent(new URL(request.url, "http://localhost").pathname);
    requests.push(request.method === "GET" ? path : `${request.method} ${path}`);
    const route = Object.hasOwn(routes, path) ? routes[path] : await fileOf(folders, path);
    if (typeof route === "function") return route(request, response);
    if (route === null) {
      response.writeHead(404).end();
      return undefined;
    }
    const answer = route instanceof Uint8Array || typeof route === "string" ? { body: route } : route;
    const { body, type = TYPES[extname(path)] ?? "application/octet-stream", status = 200, headers = {} } = answer;
    response.writeHead(status, { "Content-Type": type, "Content-Length": Buffer.byteLength(body), ...headers });
    response.end(body);
    return undefined;
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  const close = () =>
    new Promise((resolve) => {
      server.close(resolve);
      server.closeAllConnections();
    });
  return { url: `http://127.0.0.1:${server.address().port}`, requests, close };
}

async function fileOf(folders, path) {
  const name = path.endsWith("/") ? `${path}index.html` : path;
  for (const folder of folders) {
    const file = normalize(join(folder, name));
    if (!file.startsWith(normalize(folder + sep))) continue;
    try {
      return { body: await readFile(file), type: TYPES[extname(file)] };
    } catch (error) {
      if (!["ENOENT", "EISDIR", "ENOTDIR"].includes(error.code)) throw error;
    }
  }
  return null;
}

/** Builds a page from source with Vite into a folder of its own. Returns { folder, close }. */
export async function buildPage(root, entry = "index.html") {
  const { build } = await import("vite");
  const folder = await mkdtemp(join(tmpdir(), "eigenfield-page-"));
  await build({
    root: join(WEB, root),
    configFile: false,
    logLevel: "error",
    base: "./",
    resolve: { alias: { "eigenfield-three": join(WEB, "eigenfield-three/src/index.ts") } },
    build: {
      outDir: folder,
      emptyOutDir: true,
      target: "es2022",
      minify: false,
      chunkSizeWarningLimit: 4000,
      rolldownOptions: { input: join(WEB, root, entry) },
    },
  });
  return { folder, close: () => rm(folder, { recursive: true, force: true }) };
}

/** What a canvas shows, as { width, height, data } with 3 bytes a pixel, row 0 on top. */
export async function canvasPixels(page, selector = "canvas") {
  return decodePng(await page.locator(selector).first().screenshot());
}

/** An 8-bit PNG as { width, height, data } with 3 bytes a pixel; alpha is dropped. */
export function decodePng(bytes) {
  const file = Buffer.from(bytes);
  const [width, height, depth, kind] = [file.readUInt32BE(16), file.readUInt32BE(20), file[24], file[25]];
  const channels = { 0: 1, 2: 3, 4: 2, 6: 4 }[kind];
  assert.ok(depth === 8 && channels && file[28] === 0, "an 8-bit PNG without palette and interlacing");
  const parts = [];
  for (let at = 8; at < file.length; ) {
    const length = file.readUInt32BE(at);
    if (file.toString("latin1", at + 4, at + 8) === "IDAT") parts.push(file.subarray(at + 8, at + 8 + length));
    at += 12 + length;
  }
  const rows = unfilter(inflateSync(Buffer.concat(parts)), width, height, channels);
  const data = new Uint8Array(width * height * 3);
  for (let i = 0; i < width * height; i++) {
    for (let c = 0; c < 3; c++) data[3 * i + c] = rows[channels * i + (channels < 3 ? 0 : c)];
  }
  return { width, height, data };
}

function unfilter(raw, width, height, channels) {
  const stride = width * channels;
  const out = new Uint8Array(stride * height);
  for (let y = 0; y < height; y++) {
    const filter = raw[y * (stride + 1)];
    for (let x = 0; x < stride; x++) {
      const a = x >= channels ? out[y * stride + x - channels] : 0;
      const b = y ? out[(y - 1) * stride + x] : 0;
      const c = x >= channels && y ? out[(y - 1) * stride + x - channels] : 0;
      const guess = [0, a, b, (a + b) >> 1, paeth(a, b, c)][filter];
      out[y * stride + x] = raw[y * (stride + 1) + 1 + x] + guess;
    }
  }
  return out;
}

function paeth(a, b, c) {
  const [pa, pb, pc] = [Math.abs(b - c), Math.abs(a - c), Math.abs(a + b - 2 * c)];
  return pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
}

/**
 * Largest and mean difference of two pictures, in grey levels, over the pixels whose neighbourhood is `inside` in both
 * (no pixel of the background within `margin`): at the outline of the mesh renderers may differ by a pixel.
 */
export function difference(a, b, { background = [0, 0, 0], margin = 2 } = {}) {
  assert.deepEqual([a.width, a.height], [b.width, b.height], "pictures of one size");
  const { width, height } = a;
  const empty = (picture, i) => background.every((value, c) => picture.data[3 * i + c] === value);
  const outside = Uint8Array.from({ length: width * height }, (_, i) => (empty(a, i) || empty(b, i) ? 1 : 0));
  let [largest, sum, count] = [0, 0, 0];
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      if (isNear(outside, width, height, x, y, margin)) continue;
      for (let c = 0; c < 3; c++) {
        const off = Math.abs(a.data[3 * (y * width + x) + c] - b.data[3 * (y * width + x) + c]);
        [largest, sum, count] = [Math.max(largest, off), sum + off, count + 1];
      }
    }
  }
  return { largest, mean: sum / Math.max(1, count), pixels: count / 3 };
}

function isNear(outside, width, height, x, y, margin) {
  for (let v = Math.max(0, y - margin); v <= Math.min(height - 1, y + margin); v++) {
    for (let u = Math.max(0, x - margin); u <= Math.min(width - 1, x + margin); u++) {
      if (outside[v * width + u]) return true;
    }
  }
  return false;
}

/** A GLB as { json, binary }. */
export function readGlb(bytes) {
  const data = Buffer.from(bytes);
  const length = data.readUInt32LE(12);
  const json = JSON.parse(data.toString("utf8", 20, 20 + length));
  const binary = data.subarray(28 + length, 28 + length + data.readUInt32LE(20 + length));
  return { json: unpacked(json, binary), binary };
}

/** The JSON that a plain file would have. */
function unpacked(json, binary) {
  const { EIGENFIELD_eigen_textures: extension, ...others } = json.extensions ?? {};
  if (extension?.packed === undefined) return json;
  const { byteOffset: start } = json.bufferViews[extension.packed];
  const end = start + 4 + binary.readUInt32LE(start);
  const { lengths, ...inner } = JSON.parse(inflateRawSync(binary.subarray(start + 4, end), { dictionary: DICTIONARY }));
  let at = end;
  const streams = lengths.map((byteLength) => ({ buffer: 0, byteOffset: (at += byteLength) - byteLength, byteLength }));
  const made = { version: extension.version, ...inner };
  const bufferViews = [...json.bufferViews.slice(0, -1), ...streams];
  return { ...json, bufferViews, extensions: { ...others, EIGENFIELD_eigen_textures: made } };
}

/** The bytes of a GLB; `text` replaces the JSON's own. */
export function writeGlb({ json, binary, text = JSON.stringify(json) }) {
  const encoded = Buffer.from(text, "utf8");
  const padded = Buffer.concat([encoded, Buffer.alloc((4 - (encoded.length % 4)) % 4, 0x20)]);
  const head = Buffer.alloc(28 + padded.length);
  head.writeUInt32LE(0x46546c67, 0);
  head.writeUInt32LE(2, 4);
  head.writeUInt32LE(head.length + binary.length, 8);
  head.writeUInt32LE(padded.length, 12);
  head.writeUInt32LE(0x4e4f534a, 16);
  padded.copy(head, 20);
  head.writeUInt32LE(binary.length, 20 + padded.length);
  head.writeUInt32LE(0x004e4942, 24 + padded.length);
  return Buffer.concat([head, binary]);
}

/** A server with the test page of `tests/pages`, a browser, and the scenes; `close` ends all. */
export async function startLab(routes = {}) {
  const built = await buildPage("tests/pages", "plain.html");
  const server = await serve({ routes, folders: [built.folder, scenePath("")] });
  const browser = await launch();
  const close = async () => {
    await browser.close();
    await server.close();
    await built.close();
  };
  const open = async (options) => {
    const opened = await openPage(browser, `${server.url}/plain.html`, options);
    await opened.page.waitForFunction(() => window.lab);
    return opened;
  };
  return { browser, server, open, close };
}
