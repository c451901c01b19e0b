// The page that `eigenfield export --as app` writes: it opens files and sends nothing, is installable, and is there
// without a network.

import assert from "node:assert/strict";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { askers } from "./askers.mjs";
import { eigenfield } from "./command.mjs";
import { launch, openPage, sceneBytes, scenePath, serve } from "./harness.mjs";
import { apart, drop, picture, state } from "./viewer-page.mjs";

const SIZE = { width: 480, height: 360 };
const FILES = ["/", "/icon-192.png", "/icon-512.png", "/icon.svg", "/manifest.webmanifest", "/viewer.css", "/viewer.js"];
let browser;
let folder;
before(async () => {
  browser = await launch();
  folder = mkdtempSync(join(tmpdir(), "eigenfield-app-"));
  eigenfield("export", scenePath("scene.glb"), scenePath("line.glb"), "--as", "app", "-o", join(folder, "open"));
});
after(async () => {
  await browser.close();
  rmSync(folder, { recursive: true, force: true });
});

/** The page on a server of its own. asked: all requests of the page, of whatever kind. */
async function open(query = "", options = {}) {
  const server = await serve({ folders: [join(folder, "open")] });
  const opened = await openPage(browser, null, { ...SIZE, ...options });
  const asked = [];
  opened.page.on("request", (request) => asked.push(request));
  await opened.page.emulateMedia({ reducedMotion: "reduce" });
  await opened.page.goto(`${server.url}/${query}`);
  await opened.page.waitForFunction(() => window.eigenfield);
  const close = async () => {
    await opened.close();
    await server.close();
  };
  return { ...opened, server, asked, close };
}

/** Until the service worker has all that the page needs. */
const kept = (page) => page.evaluate(() => navigator.serviceWorker.ready.then(() => undefined));

test("nothing is uploaded, and the page says so: a file that is dropped causes no request", async () => {
  const { page, server, asked, close } = await open();
  await kept(page);
  assert.match(await page.locator(".invitation").innerText(), /Nothing is uploaded/);
  await page.waitForLoadState("networkidle");
  const before = [server.requests.length, asked.length];
  await drop(page, "scene.glb");
  await page.waitForFunction(() => window.eigenfield.state().status === "ready");
  assert.equal((await state(page)).loaded, 6);
  assert.ok(new Set((await picture(page)).data).size > 50, "something is drawn");
  const others = asked.slice(before[1]).filter((request) => !/^(blob|data):/.test(request.url()));
  assert.deepEqual([server.requests.length, others.map((request) => request.url())], [before[0], []]);
  assert.deepEqual([...new Set(server.requests)].sort(), [...FILES, "/samples/line.jpg", "/samples/scene.jpg", "/worker.js"].sort(), "by GET alone");
  for (const request of asked) {
    assert.deepEqual([request.method(), request.postData()], ["GET", null], request.url());
    assert.ok(/^(blob|data):/.test(request.url()) || request.url().startsWith(server.url), request.url());
  }
  await close();
});

test("the network is cut: the page, a file and a sample that was seen are there, another sample is not", async () => {
  const { page, server, close } = await open("", { allowed: /ERR_CONNECTION_REFUSED|ERR_FAILED/ });
  await kept(page);
  const offered = await page.locator(".invitation a").allInnerTexts();
  assert.deepEqual(offered.map((text) => text.split(/\s/)), [["scene", "102", "kB"], ["line", "99.4", "kB"]]);
  await page.getByRole("link", { name: "scene" }).click();
  await page.waitForFunction(() => window.eigenfield?.state().status === "ready");
  const online = await picture(page);
  assert.equal(new URL(page.url()).search, "?load=samples%2Fscene.glb");
  await server.close();

  await page.goto(server.url);
  await page.waitForFunction(() => window.eigenfield?.state().status === "empty");
  await page.setInputFiles("input[type=file]", scenePath("four.glb"));
  await page.waitForFunction(() => window.eigenfield.state().status === "ready");
  assert.equal((await state(page)).title, "four");
  await page.goto(`${server.url}/index.html?load=samples/scene.glb`);
  await page.waitForFunction(() => window.eigenfield?.state().status === "ready");
  assert.equal(apart(online, await picture(page)), 0);
  await page.goto(`${server.url}/?load=samples/line.glb`);
  await page.waitForSelector(".message:not([hidden])");
  assert.match(await page.locator(".message").innerText(), /cannot be fetched; check its address and the connection/);
  await close();
});

test("the first visit keeps its scene, also one beside the page's folder, without asking for it twice", async () => {
  const server = await serve({ folders: [folder] });
  writeFileSync(join(folder, "beside.glb"), sceneBytes("four.glb"));
  for (const scene of ["samples/scene.glb", "../beside.glb"]) {
    const { page, close } = await openPage(browser, `${server.url}/open/?load=${scene}`, { allowed: /ERR_/ });
    await kept(page);
    const online = await picture(page);
    await page.waitForFunction(async (url) => caches.match(url), scene);
    assert.equal(server.requests.filter((path) => path === new URL(scene, "http://a/open/").pathname).length, 1);
    await page.context().setOffline(true);
    await page.reload();
    await page.waitForFunction(() => window.eigenfield);
    assert.equal((await state(page)).status, "ready");
    assert.equal(apart(online, await picture(page)), 0);
    await close();
  }
  await server.close();
});

test("a browser finds nothing that keeps it from installing the page", async () => {
  const { page, close } = await open();
  await kept(page);
  const session = await page.context().newCDPSession(page);
  const { errors, data } = await session.send("Page.getAppManifest");
  assert.deepEqual(errors, []);
  assert.deepEqual(JSON.parse(data).file_handlers, [{ action: "./", accept: { "model/gltf-binary": [".glb"] } }]);
  const { installabilityErrors } = await session.send("Page.getInstallabilityErrors");
  const found = installabilityErrors.map(({ errorId }) => errorId);
  assert.deepEqual(found.filter((id) => id !== "in-incognito"), [], "tests run in a private window");
  await close();
});

test("a file that is opened with the installed page", async () => {
  const init = () => {
    Object.defineProperty(window, "launchQueue", { value: { setConsumer: (take) => (window.launched = take) } });
  };
  const { page, close } = await open("", { init });
  await page.evaluate((text) => {
    const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
    window.launched({ files: [{ getFile: async () => new File([bytes], "launched.glb") }] });
    window.launched({ files: [] }); // as when the page is started by itself
  }, sceneBytes("line.glb").toString("base64"));
  await page.waitForFunction(() => window.eigenfield.state().status === "ready");
  assert.equal((await state(page)).title, "launched");
  await close();
});

test("a file that names another host is refused by name, and nobody is asked: by ?load=, chosen and dropped", async () => {
  const elsewhere = await serve();
  const files = askers(elsewhere.url);
  const headers = { "Access-Control-Allow-Origin": "*" };
  const routes = Object.entries(files).map(([name, body]) => [`/${name}.glb`, { body, headers }]);
  const typed = await serve({ routes: Object.fromEntries(routes) });
  const { page, server, close } = await open("", { allowed: /Content Security Policy|ERR_|Failed to fetch/ });
  const refused = async (name) => {
    await page.waitForFunction(() => window.eigenfield?.state().message?.code === "address");
    assert.match(await page.locator(".message").innerText(), /names another one \(\/.*uri: ".*"\), which is not fetched/, name);
  };
  await kept(page);
  await page.waitForLoadState("networkidle");
  const before = server.requests.length;
  for (const [name, buffer] of Object.entries(files)) {
    await page.setInputFiles("input[type=file]", { name: `${name}.glb`, mimeType: "model/gltf-binary", buffer });
    await refused(name);
    await drop(page, `${name}.glb`, buffer);
    await refused(name);
  }
  assert.deepEqual(server.requests.slice(before), [], "nor its own server");
  for (const name of ["plain image", "scene image"]) {
    await page.goto(`${server.url}/?load=${encodeURIComponent(`${typed.url}/${name}.glb`)}`);
    await refused(name);
    const answer = (url) => page.evaluate((one) => fetch(one).then(() => "answered", () => "forbidden"), url);
    assert.deepEqual([await answer(elsewhere.url), await answer(server.url)], ["forbidden", "answered"], "by the policy too");
  }
  assert.deepEqual(elsewhere.requests, []);
  await close();
  await typed.close();
  await elsewhere.close();
});

test("?load= from another site: drawn where it allows that, else plain words", async () => {
  const body = sceneBytes("line.glb");
  const allowing = { "Access-Control-Allow-Origin": "*" };
  const further = await serve({ routes: { "/open.glb": { body, headers: allowing } } });
  const files = ["scene.glb", "sound.opus", ...[0, 1, 2, 3].map((i) => `groups/0000${i}.eftg`)];
  const other = await serve({
    routes: {
      ...Object.fromEntries(files.map((file) => [`/clip/${file}`, { body: sceneBytes(`folder/${file}`), headers: allowing }])),
      "/moved.glb": { body: "", status: 302, headers: { ...allowing, Location: `${further.url}/open.glb` } },
      "/open.glb": { body, headers: allowing }, "/closed.glb": { body },
      "/gone.glb": { body: "", status: 404, headers: allowing },
    },
  });
  const load = (name) => `?load=${encodeURIComponent(`${other.url}/${name}`)}`;
  for (const name of ["open", "moved"]) {
    const drawn = await open(load(`${name}.glb`));
    const { title, status } = await state(drawn.page);
    assert.deepEqual([title, status], [name, "ready"]);
    await drawn.close();
  }
  const clip = await open(load("clip/scene.glb"));
  await clip.page.waitForFunction(() => window.eigenfield.field?.player);
  const shown = await clip.page.evaluate(() => window.eigenfield.field.player.toFrame(22).then(() => window.eigenfield.field.player.frame));
  assert.equal(shown, 22, "of a group that is a file beside it");
  await clip.close();
  for (const [name, words] of [["closed.glb", /from 127\.0\.0\.1:\d+.*\(CORS\)\. Download/], ["gone.glb", /answered 404/]]) {
    const { page, close } = await open(load(name), { allowed: /CORS|ERR_FAILED|404/ });
    await page.waitForSelector(".message:not([hidden])");
    assert.match(await page.locator(".message").innerText(), words);
    assert.equal((await state(page)).message.code, "network");
    await close();
  }
  await other.close();
  await further.close();
});
