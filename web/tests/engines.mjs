// Firefox by WebDriver BiDi and WebKitGTK's MiniBrowser by WebDriver: as much of either as `engine-page.mjs` needs.
//
// Environment:
//   EIGENFIELD_FIREFOX   Firefox; else `firefox-esr` or `firefox` on the PATH
//   EIGENFIELD_WEBKIT    WebKit's MiniBrowser; else Debian's, where libwebkit2gtk has it

import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { existsSync, readdirSync } from "node:fs";
import { mkdtemp, rm } from "node:fs/promises";
import { createServer } from "node:net";
import { tmpdir } from "node:os";
import { delimiter, join } from "node:path";
import utils from "playwright-core/lib/utilsBundle"; // has the WebSocket that Node.js has from 22 on

const PATIENCE = 60_000; // milliseconds for a browser to start
const LIBRARIES = "/usr/lib";

/**
 * Each returns { open, evaluate, press, close }: `open` goes to a URL, `evaluate` is Playwright's, and works on the page,
 * `press` holds a key down for a moment (a character, of WebDriver's table for keys that have none).
 */
export async function firefox() {
  const profile = await mkdtemp(join(tmpdir(), "eigenfield-firefox-"));
  const program = process.env.EIGENFIELD_FIREFOX ?? onPath("firefox-esr", "firefox");
  const args = ["--no-remote", "--profile", profile, "--remote-debugging-port=0"];
  const screen = await makeScreen(); // without one Firefox has no WebGL
  const { child, found } = await started(program, args, /WebDriver BiDi listening on (\S+)/, screen.env);
  const socket = new utils.ws(`${found}/session`);
  await new Promise((resolve, reject) => socket.once("open", resolve).once("error", reject));
  const waiting = new Map();
  socket.on("message", (text) => {
    const { id, type, result, error, message } = JSON.parse(text);
    const { resolve, reject } = waiting.get(id) ?? {};
    waiting.delete(id);
    if (type === "success") resolve?.(result);
    else reject?.(new Error(`${error}: ${message}`));
  });
  let id = 0;
  const send = (method, params = {}) =>
    new Promise((resolve, reject) => {
      waiting.set(++id, { resolve, reject });
      socket.send(JSON.stringify({ id, method, params }));
    });
  await send("session.new", { capabilities: {} });
  const { context } = await send("browsingContext.create", { type: "tab" });
  return {
    open: (url) => send("browsingContext.navigate", { context, url, wait: "complete" }),
    evaluate: async (act, given) => {
      const expression = `(async () => JSON.stringify(await (${act})(${JSON.stringify(given)})))()`;
      const answer = await send("script.evaluate", { expression, target: { context }, awaitPromise: true });
      if (answer.type === "exception") throw new Error(answer.exceptionDetails.text);
      return answer.result.type === "string" ? JSON.parse(answer.result.value) : undefined;
    },
    press: (value) => {
      const actions = ["keyDown", "pause", "keyUp"].map((type) => (type === "pause" ? { type, duration: 300 } : { type, value }));
      return send("input.performActions", { context, actions: [{ type: "key", id: "keys", actions }] });
    },
    close: async () => {
      socket.terminate();
      await ended(child);
      await screen.close();
      await rm(profile, { recursive: true, force: true, maxRetries: 5 });
    },
  };
}

export async function webkit() {
  const screen = await makeScreen();
  const port = await freePort();
  const driver = spawn("WebKitWebDriver", [`--port=${port}`], { env: screen.env, stdio: "ignore" });
  process.once("exit", () => driver.kill());
  const send = async (method, path, body) => {
    const answer = await fetch(`http://127.0.0.1:${port}${path}`, { method, body: body && JSON.stringify(body) });
    const { value } = await answer.json();
    if (!answer.ok) throw new Error(`${value.error}: ${value.message}`);
    return value;
  };
  const binary = process.env.EIGENFIELD_WEBKIT ?? miniBrowser();
  const capabilities = { alwaysMatch: { "webkitgtk:browserOptions": { binary, args: ["--automation"] } } };
  const { sessionId } = await patiently(() => send("POST", "/session", { capabilities }));
  const session = `/session/${sessionId}`;
  await send("POST", `${session}/timeouts`, { script: 10 * PATIENCE });
  return {
    open: (url) => send("POST", `${session}/url`, { url }),
    evaluate: async (act, given) => {
      const script =
        `const done = arguments[0];` +
        `(async () => JSON.stringify({ value: await (${act})(${JSON.stringify(given)}) }))()` +
        `.then(done, (error) => done(JSON.stringify({ error: String(error) })));`;
      const { value, error } = JSON.parse(await send("POST", `${session}/execute/async`, { script, args: [] }));
      if (error !== undefined) throw new Error(error);
      return value;
    },
    press: (value) => {
      const actions = ["keyDown", "pause", "keyUp"].map((type) => (type === "pause" ? { type, duration: 300 } : { type, value }));
      return send("POST", `${session}/actions`, { actions: [{ type: "key", id: "keys", actions }] });
    },
    close: async () => {
      await send("DELETE", session).catch(() => undefined);
      await ended(driver);
      await screen.close();
    },
  };
}

function onPath(...names) {
  const folders = (process.env.PATH ?? "").split(delimiter);
  const found = names.flatMap((name) => folders.map((folder) => join(folder, name))).find((path) => existsSync(path));
  assert.ok(found, `no ${names[0]}: install it`);
  return found;
}

/** Debian has it in a folder of the library's version and the machine's kind. */
function miniBrowser() {
  const folders = readdirSync(LIBRARIES).flatMap((machine) =>
    ["webkit2gtk-4.1", "webkit2gtk-4.0", "webkitgtk-6.0"].map((name) => join(LIBRARIES, machine, name, "MiniBrowser")),
  );
  const found = folders.find((path) => existsSync(path));
  assert.ok(found, "no MiniBrowser of WebKitGTK: install it");
  return found;
}

/** Starts a program; `found` is what it says of where it listens. */
async function started(program, args, says, env = process.env) {
  const child = spawn(program, args, { stdio: ["ignore", "pipe", "pipe"], env });
  let said = "";
  const found = await new Promise((resolve, reject) => {
    const listen = (data) => {
      said += data;
      const match = says.exec(said);
      if (match) resolve(match[1]);
    };
    child.stdout.on("data", listen);
    child.stderr.on("data", listen);
    child.on("error", reject);
    child.on("exit", (code) => reject(new Error(`${program} ended with ${code}: ${said}`)));
    setTimeout(() => reject(new Error(`${program} says nothing: ${said}`)), PATIENCE).unref();
  });
  process.once("exit", () => child.kill()); // a test that failed leaves nothing behind
  return { child, found };
}

/** The surroundings of a program that draws into memory, where there is no display. */
async function makeScreen() {
  if (process.env.DISPLAY) return { env: process.env, close: async () => undefined };
  const size = ["-screen", "0", "1280x1024x24"];
  const { child, found } = await started("Xvfb", ["-displayfd", "1", ...size, "-nolisten", "tcp"], /^(\d+)\n/m);
  return { env: { ...process.env, DISPLAY: `:${found}` }, close: () => ended(child) };
}

function ended(child) {
  const over = new Promise((resolve) => child.once("exit", resolve));
  child.kill();
  return over;
}

async function patiently(act) {
  for (const start = Date.now(); ; ) {
    try {
      return await act();
    } catch (error) {
      if (Date.now() - start > PATIENCE || !/fetch failed/.test(error.message)) throw error;
      await new Promise((resolve) => setTimeout(resolve, 200));
    }
  }
}

function freePort() {
  const server = createServer();
  return new Promise((resolve) => {
    server.listen(0, "127.0.0.1", () => {
      const { port } = server.address();
      server.close(() => resolve(port));
    });
  });
}
