// The viewer: what it opens, what it says while it does, and what it says when it cannot.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { launch, sceneBytes, scenePath } from "./harness.mjs";
import { apart, drop, openViewer, picture, state } from "./viewer-page.mjs";

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser.close());

const message = (page) => page.locator(".message:not([hidden])").innerText();

test("a scene loads, and starts inside the captured hull", async () => {
  const { page, close, server } = await openViewer(browser, "scene.glb");
  const now = await state(page);
  assert.equal(now.status, "ready");
  assert.deepEqual([now.loaded, now.total, now.mode], [6, 6, "plane"]);
  assert.ok(Math.abs(now.x) <= 1 && Math.abs(now.y) <= 1);
  assert.equal(await page.title(), "scene – eigenfield");
  assert.ok(new Set((await picture(page)).data).size > 50, "something is drawn");
  const asked = ["/", "/scene.glb", "/viewer.css", "/viewer.js"];
  assert.deepEqual(server.requests.sort(), asked, "and nothing else is asked for");
  await close();
});

test("the picture is there before the eigen textures, and becomes better as they come", async () => {
  const bytes = sceneBytes("scene.glb");
  let release;
  const rest = new Promise((resolve) => (release = resolve));
  const first = bytes.length - 20_000;
  const slow = async (request, response) => {
    response.writeHead(200, { "Content-Type": "model/gltf-binary", "Content-Length": bytes.length });
    response.write(bytes.subarray(0, first));
    await rest;
    response.end(bytes.subarray(first));
  };
  const { page, close } = await openViewer(browser, "scene.glb", { routes: { "/scene.glb": slow } });
  await page.waitForFunction(() => window.eigenfield.state().loaded > 0);
  const early = await page.evaluate(() => window.eigenfield.state());
  assert.ok(early.loaded < 6, `${early.loaded} textures of a file that is not there yet`);
  const words = await page.locator(".progress").innerText();
  assert.match(words, /[\d.]+\skB of [\d.]+\s[kM]B · eigen texture \d of 6/);
  assert.ok((await page.locator("progress").evaluate((bar) => bar.value / bar.max)) > 0.2);
  const before = await page.evaluate(() => Array.from(window.eigenfield.pixels().data));
  release();
  assert.equal((await state(page)).loaded, 6);
  assert.ok(await page.locator(".progress").isHidden());
  const now = await page.evaluate(() => Array.from(window.eigenfield.pixels().data));
  assert.ok(before.some((value, i) => Math.abs(value - now[i]) > 2), "the picture has changed");
  await close();
});

for (const [file, code, words] of [
  ["truncated.glb", "truncated", /cut off|shorter/i],
  ["damaged.glb", "damaged", /./],
  ["newer.glb", "version", /version|newer/i],
  ["needs.glb", "needs", /./],
  ["not-ours.bin", "not-glb", /./],
]) {
  test(`${file}: a sentence and the code ${code}`, async () => {
    const { page, close } = await openViewer(browser, file);
    await page.waitForSelector(".message:not([hidden])");
    const text = await message(page);
    assert.ok(text.includes(code), text);
    assert.match(text, words);
    assert.equal((await state(page)).message.code, code);
    await close();
  });
}

test("an address that leads nowhere", async () => {
  const options = { config: { scene: "missing.glb" }, allowed: /404/ };
  const { page, close } = await openViewer(browser, "scene.glb", options);
  await page.waitForSelector(".message:not([hidden])");
  assert.match(await message(page), /404/);
  await close();
});

test("a plain glTF file is shown as it is", async () => {
  const { page, close } = await openViewer(browser, "plain.glb", { width: 900, height: 600 });
  const now = await state(page);
  assert.deepEqual([now.status, now.mode, now.total], ["ready", "orbit", 0]);
  assert.match(await page.locator(".panel").innerText(), /plain glTF file: no eigen textures/);
  assert.ok(await page.locator(".own").isHidden(), "nothing to set that it does not have");
  const still = await picture(page);
  assert.ok(new Set(still.data).size > 3);
  await page.mouse.move(200, 180);
  await page.mouse.down();
  await page.mouse.move(320, 180, { steps: 2 });
  await page.mouse.up();
  assert.ok(apart(still, await picture(page)) > 0.5, "dragging turns it");
  await close();
});

test("without a scene it asks for one; a chosen file and a dropped one open", async () => {
  const { page, close } = await openViewer(browser, null);
  assert.match(await page.locator(".invitation").innerText(), /Drop a \.glb here, or choose a file/);
  await page.setInputFiles("input[type=file]", scenePath("line.glb"));
  await page.waitForFunction(() => window.eigenfield.state().status === "ready");
  assert.equal((await state(page)).title, "line");
  await drop(page, "scene.glb");
  await page.waitForFunction(() => window.eigenfield.state().title === "scene");
  assert.equal((await state(page)).loaded, 6);
  await drop(page, "not-ours.bin");
  await page.waitForSelector(".message:not([hidden])");
  assert.match(await message(page), /^not-ours\.bin cannot be opened: The file is no GLB/);
  const kept = await state(page);
  assert.deepEqual([kept.status, kept.title, kept.loaded], ["ready", "scene", 6], "the open scene stays");
  await drop(page, "line.glb");
  await page.waitForFunction(() => window.eigenfield.state().title === "line");
  assert.equal((await state(page)).status, "ready", "an error is not for ever");
  assert.ok(await page.locator(".message").isHidden());
  for (const none of ["http://[", "https://example.org:99999/a.glb"]) {
    await page.evaluate((address) => window.eigenfield.open(address), none);
    assert.match(await message(page), /cannot be fetched; check its address/, none);
    assert.equal((await state(page)).title, "line");
  }
  await close();
});

test("while a file arrives the context goes and comes back, and another file is opened: the page knows what it waits for", async () => {
  const bytes = sceneBytes("scene.glb");
  let go;
  const more = new Promise((resolve) => (go = resolve));
  const slow = async (request, response) => {
    response.writeHead(200, { "Content-Type": "model/gltf-binary", "Content-Length": bytes.length });
    response.write(bytes.subarray(0, 3000));
    await more;
    response.write(bytes.subarray(3000, -20_000)); // no more comes
  };
  const { page, close } = await openViewer(browser, "scene.glb", { routes: { "/scene.glb": slow }, allowed: /context.(lost|restored)/i });
  await page.evaluate(async () => {
    const canvas = document.querySelector("canvas.view");
    const loss = canvas.getContext("webgl2").getExtension("WEBGL_lose_context");
    for (const [act, told] of [["loseContext", "webglcontextlost"], ["restoreContext", "webglcontextrestored"]]) {
      const heard = new Promise((resolve) => canvas.addEventListener(told, resolve, { once: true }));
      await new Promise((resolve) => setTimeout(resolve, 50));
      loss[act]();
      await heard;
    }
  });
  assert.equal(await page.evaluate(() => window.eigenfield.state().status), "loading");
  assert.ok(await page.locator(".invitation").isHidden());
  go();
  await page.waitForFunction(() => window.eigenfield.state().loaded > 0);
  await page.evaluate(() => void (window.waiting = window.eigenfield.settled()));
  await drop(page, "line.glb");
  await page.evaluate(() => window.waiting);
  const { title, message: said } = await page.evaluate(() => window.eigenfield.state());
  assert.deepEqual([title, said], ["line", null]);
  await close();
});

test("?load= names a scene", async () => {
  const { page, close } = await openViewer(browser, null, {
    query: "?load=other.glb", routes: { "/other.glb": { body: sceneBytes("line.glb") }, "/another.glb": { body: sceneBytes("four.glb") } },
  });
  const now = await state(page);
  assert.deepEqual([now.status, now.title], ["ready", "other"]);
  const link = page.getByRole("button", { name: "Copy a link" });
  assert.ok(await link.isVisible());
  for (const [address, leads] of [["another.glb", false], ["other.glb", true]]) {
    await page.evaluate((url) => window.eigenfield.open(url), address);
    assert.equal(await link.isVisible(), leads, "the page's address leads to its own scene alone");
  }
  await close();
});

test("names that want to be HTML stay names", async () => {
  const { page, close } = await openViewer(browser, "names.glb", {
    width: 900, height: 600, config: { title: "<img src=x onerror=alert(1)>" },
  });
  await state(page);
  assert.equal(await page.locator("img").count(), 0);
  assert.equal(await page.locator("h1").innerText(), "<img src=x onerror=alert(1)>");
  const names = await page.evaluate(() => window.eigenfield.field.info.names);
  const shown = await page.locator("select option").allTextContents();
  assert.deepEqual(shown.slice(1), names);
  for (const name of names) {
    assert.ok(await page.evaluate((one) => window.eigenfield.goToCamera(one), name));
    assert.equal((await state(page)).camera, name);
  }
  await close();
});

test("no WebGL 2: a sentence", async () => {
  const { page, close } = await openViewer(browser, "scene.glb", {
    allowed: /WebGL/,
    init: () => {
      HTMLCanvasElement.prototype.getContext = () => null;
    },
  });
  assert.match(await page.locator("[role=alert]").innerText(), /needs WebGL 2/);
  await close();
});

const without = (pattern) => `
  const { prototype } = WebGL2RenderingContext, { getExtension } = prototype;
  prototype.getExtension = function (name) { return ${pattern}.test(name) ? null : getExtension.call(this, name); };`;

test("graphics that draw no floats: a sentence; those that draw halves alone: the scene", async () => {
  for (const scene of ["scene.glb", "sheets.glb"]) {
    const init = { content: without(/color_buffer/) };
    const { page, close } = await openViewer(browser, scene, { init, query: "?lang=de" });
    const { status, message } = await state(page);
    assert.deepEqual([status, message.code], ["failed", "unsupported"]);
    assert.match(message.detail, /draw no half-floats/);
    assert.ok(await page.locator(".message").isVisible());
    await close();
  }
  const options = { init: { content: without(/color_buffer_float/) }, allowed: /EXT_color_buffer_float/ };
  const { page, close } = await openViewer(browser, "scene.glb", options);
  assert.equal((await state(page)).message, null);
  await close();
});

test("what goes wrong with textures before anyone listens is said, too", async () => {
  const init = { content: "WebGL2RenderingContext.prototype.texStorage3D = () => { throw new Error('nothing left'); };" };
  const { page, close } = await openViewer(browser, "scene.glb", { init });
  assert.match((await state(page)).message.text, /nothing left/);
  await close();
});

const DRAFT = {
  config: { draft: "draft" },
  routes: { "/draft": { body: '{"seconds":130}', type: "application/json" } },
  allowed: /404|ERR_FAILED/, // by which the page knows that the scene is done, or the command
};

test("a draft says when the scene comes, which then stands at the same view", async () => {
  const { page, server, close } = await openViewer(browser, "scene.glb", DRAFT);
  await page.waitForFunction(() => /^A draft.*about 3 min/.test(document.querySelector(".draft").textContent));
  await page.evaluate(() => window.eigenfield.goTo(0.5, -0.25));
  await page.locator("canvas.view").press("ArrowRight"); // a view of one's own
  const before = await state(page);
  assert.notEqual(before.x, 0);
  await page.route(`${server.url}/`, async (route) => { // from now on as the server answers when the scene is done
    const answer = await route.fetch();
    await route.fulfill({ response: answer, body: (await answer.text()).replace('"draft":"draft"', '"bytes":1') });
  });
  await page.route("**/draft", (route) => route.fulfill({ status: 404, body: "" }));
  await page.waitForFunction(() => window.eigenfield && document.querySelector(".draft")?.textContent === "");
  const after = await state(page);
  for (const key of ["x", "y"]) assert.ok(Math.abs(after[key] - before[key]) < 0.1, `${key}: ${after[key]}`);
  await close();
});

test("a draft whose command has ended says so and stays", async () => {
  const { page, close } = await openViewer(browser, "scene.glb", DRAFT);
  await page.route("**/draft", (route) => route.abort());
  await page.waitForFunction(() => /has ended/.test(document.querySelector(".draft").textContent));
  assert.equal((await state(page)).status, "ready");
  await close();
});
