// The viewer: moving by every means, and the limits.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { launch } from "./harness.mjs";
import { apart, holdGamepad, near, openViewer, picture, set, settled, state } from "./viewer-page.mjs";

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser.close());

async function drag(page, [x0, y0], [x1, y1]) {
  await page.mouse.move(x0, y0);
  await page.mouse.down();
  await page.mouse.move(x1, y1, { steps: 3 });
  await page.mouse.up();
}

test("the mouse moves the eye the other way, as one pushes a picture", async () => {
  const { page, close } = await openViewer(browser, "scene.glb");
  const start = await state(page);
  const before = await picture(page);
  await drag(page, [200, 200], [236, 218]); // a tenth and a twentieth of the smaller side
  const now = await state(page);
  near(now.x, start.x - 0.26, 0.01);
  near(now.y, start.y + 0.13, 0.01);
  assert.ok(apart(before, await picture(page)) > 0.3);
  await close();
});

test("a soft stop at the array's edge: a hand pulls a little further, and it comes back", async () => {
  const { page, close } = await openViewer(browser, "scene.glb", { glide: true });
  await settled(page);
  await page.mouse.move(400, 200);
  await page.mouse.down();
  await page.mouse.move(20, 200, { steps: 4 });
  await page.waitForFunction(() => window.eigenfield.state().x > 1.01);
  assert.ok((await page.evaluate(() => window.eigenfield.state().x)) < 1.15);
  await page.mouse.up();
  assert.equal((await state(page)).x, 1);
  await page.evaluate(() => window.eigenfield.goTo(-7, 0.5));
  near((await state(page)).x, -1, 0);
  await page.mouse.move(200, 180);
  await page.mouse.down();
  await page.mouse.move(190, 180);
  await page.keyboard.press("o");
  await page.mouse.up();
  await page.keyboard.press("o");
  await page.keyboard.down("ArrowLeft");
  await page.waitForFunction(() => window.eigenfield.state().x < -1.01);
  await page.keyboard.up("ArrowLeft");
  assert.equal((await state(page)).x, -1, "the hand let go of it, too");
  await close();
});

test("keys: arrows and letters move, held ones go on, Q and E change the size", async () => {
  const { page, close } = await openViewer(browser, "scene.glb", { glide: true });
  const start = await state(page);
  const hold = async (key) => {
    const { frames } = await state(page);
    await page.keyboard.down(key);
    await page.waitForFunction((count) => window.eigenfield.state().frames > count + 4, frames);
    await page.keyboard.up(key);
    return state(page);
  };
  assert.ok((await hold("ArrowRight")).x > start.x + 0.02);
  const up = await hold("w");
  assert.ok(up.y > start.y + 0.02);
  assert.ok((await hold("a")).x < up.x - 0.02);
  assert.ok((await hold("e")).zoom > 1.01);
  const forward = await hold("r");
  assert.ok(forward.dolly > 0.005);
  await page.keyboard.press("Home");
  const home = await state(page);
  assert.deepEqual([home.x, home.y, home.zoom, home.dolly], [start.x, start.y, 1, 0]);
  await close();
});

test("keys of other layouts: brackets under AltGr and Option, letters by what is printed or else by their place", async () => {
  const { page, close } = await openViewer(browser, "scene.glb");
  await state(page);
  const press = (code, key, more = {}) =>
    page.evaluate((pressed) => {
      const event = new KeyboardEvent("keydown", { ...pressed, bubbles: true, cancelable: true });
      document.body.dispatchEvent(event);
      document.body.dispatchEvent(new KeyboardEvent("keyup", pressed));
      return event.defaultPrevented; // it did something
    }, { code, key, ...more });
  const altGr = { ctrlKey: true, altKey: true, modifierAltGraph: true }; // as Windows says it
  const option = { altKey: true };
  const mode = async () => (await state(page)).mode;
  for (const [code, key, modifiers] of [
    ["Digit9", "]", altGr], ["Digit6", "]", option], ["Minus", "]", { ...option, shiftKey: true }], // German, French
    ["BracketRight", "]", altGr], ["BracketRight", "]", option], // Spanish
    ["BracketRight", "\u044a", {}], // Russian
  ]) {
    const before = (await state(page)).camera;
    assert.ok(await press(code, key, modifiers));
    assert.notEqual((await state(page)).camera, before, `${code} ${key}`);
  }
  await press("Escape", "Escape");
  for (const [code, key] of [
    ["KeyO", "\u0449"], ["KeyO", "\u03bf"], ["KeyO", "\u05dd"], ["KeyO", "\u0429"], ["KeyO", "o"], ["KeyS", "o"], // the last: Dvorak
  ]) {
    const before = await mode();
    assert.ok(await press(code, key));
    assert.notEqual(await mode(), before, `${code} ${key}`);
  }
  for (const [code, key, view] of [["Digit2", "\u00e9", "mean"], ["Digit1", "&", "picture"], ["Digit2", "\u06f2", "mean"]]) {
    assert.ok(await press(code, key)); // French twice, Persian
    assert.equal((await state(page)).view, view, `${code} ${key}`);
  }
  assert.ok(await press("Semicolon", "m")); // French
  assert.equal((await state(page)).wireframe, true);
  assert.ok(await press("KeyI", "\u0131")); // Turkish
  assert.ok(await press("KeyH", "\u0440"));
  assert.ok(await page.locator("dialog").isVisible());
  await page.evaluate(() => {
    const pressed = { code: "KeyH", key: "\u0440", bubbles: true };
    document.querySelector("dialog").dispatchEvent(new KeyboardEvent("keydown", pressed));
  });
  assert.ok(await page.locator("dialog").isHidden());
  const before = await state(page);
  for (const [code, key, modifiers] of [
    ["BracketRight", "]", { ctrlKey: true }], ["BracketLeft", "[", { metaKey: true }], ["KeyO", "o", { altKey: true }],
    ["KeyP", "p", { ctrlKey: true }], ["Digit1", "1", { ctrlKey: true }], ["Digit0", "0", { metaKey: true }],
    ["KeyH", "\u0440", { ctrlKey: true }], ["ArrowLeft", "ArrowLeft", { altKey: true }], ["KeyO", "\u00f6", {}],
    ["KeyM", ",", {}], ["Digit1", "!", { shiftKey: true }], ["Digit2", "~", { modifierAltGraph: true }],
  ]) {
    assert.ok(!(await press(code, key, modifiers)), `${code} ${key} ${JSON.stringify(modifiers)}`);
  }
  assert.deepEqual({ ...(await state(page)), frames: 0 }, { ...before, frames: 0 });
  await close();
});

test("the wheel makes larger, with Shift goes forward, each within limits", async () => {
  const { page, close } = await openViewer(browser, "scene.glb");
  await settled(page);
  await page.mouse.move(240, 180);
  await page.mouse.wheel(0, -400);
  await page.waitForFunction(() => window.eigenfield.state().zoom > 1.5);
  for (let i = 0; i < 10; i++) await page.mouse.wheel(0, -900);
  await page.waitForFunction(() => window.eigenfield.state().zoom === 8);
  for (let i = 0; i < 10; i++) await page.mouse.wheel(0, 900);
  await page.waitForFunction(() => window.eigenfield.state().zoom === 1);
  await page.keyboard.down("Shift");
  for (let i = 0; i < 10; i++) await page.mouse.wheel(0, -900);
  await page.keyboard.up("Shift");
  const { dolly, zoom } = await state(page);
  assert.ok(dolly > 0.1 && dolly < 1, `${dolly} of the way to the scene`);
  assert.equal(zoom, 1);
  const mode = await page.evaluate(() => window.eigenfield.field.weightMode);
  assert.equal(mode, "ray", "off the plane each ray has its own");
  await close();
});

test("touch: one finger moves, two pinch", async () => {
  const { page, close } = await openViewer(browser, "scene.glb", { context: { hasTouch: true, isMobile: true } });
  const start = await state(page);
  const client = await page.context().newCDPSession(page);
  const touch = (type, ...points) =>
    client.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
  await touch("touchStart", [240, 180]);
  await touch("touchMove", [220, 180]);
  await touch("touchMove", [204, 180]);
  await touch("touchEnd");
  const moved = await state(page);
  near(moved.x, start.x + 0.26, 0.02);
  near(moved.y, start.y, 0.01);
  await touch("touchStart", [200, 180], [280, 180]);
  await touch("touchMove", [160, 180], [320, 180]);
  await touch("touchEnd");
  near((await state(page)).zoom, 2, 0.1);
  await close();
});

test("a stick of a gamepad moves, and a resting one draws nothing", async () => {
  const { page, close } = await openViewer(browser, "scene.glb", { init: holdGamepad });
  const start = await state(page);
  await page.evaluate(() => {
    window.dispatchEvent(new Event("gamepadconnected"));
    window.pad.axes[0] = 0.05;
  });
  await page.waitForTimeout(200);
  assert.equal((await state(page)).x, start.x);
  await page.evaluate(() => void (window.pad.axes[0] = 1));
  await page.waitForFunction((x) => window.eigenfield.state().x > x + 0.1, start.x);
  await page.evaluate(() => void (window.pad.axes[0] = 0));
  await page.evaluate(() => void (window.pad.buttons[5].pressed = true));
  await page.waitForFunction(() => window.eigenfield.state().camera !== null);
  await close();
});

test("cameras on a line: the eye stays on it", async () => {
  const { page, close } = await openViewer(browser, "line.glb");
  await settled(page);
  await drag(page, [240, 180], [200, 120]);
  const now = await state(page);
  assert.ok(now.x > 0.1);
  assert.equal(now.y, 0);
  await close();
});

test("a click on the map goes there", async () => {
  const { page, close } = await openViewer(browser, "scene.glb");
  await settled(page);
  const box = await page.locator(".map canvas").boundingBox();
  await page.mouse.click(box.x + 12 + (box.width - 24) * 0.75, box.y + 12 + (box.height - 24) * 0.25);
  const now = await state(page);
  near(now.x, 0.5, 0.03);
  near(now.y, 0.5, 0.03);
  await close();
});

test("orbit: starts without a jump, turns about the surface, says when it is outside, and comes back", async () => {
  const { page, close } = await openViewer(browser, "scene.glb");
  await page.evaluate(() => window.eigenfield.goTo(0.3, 0.2));
  await settled(page);
  const eye = () => page.evaluate(() => window.eigenfield.field.lastWeights.map((weights) => [...weights]));
  const before = await eye();
  await page.keyboard.press("o");
  assert.equal((await state(page)).mode, "orbit");
  const [a, b] = [before[0], (await eye())[0]];
  a.forEach((weight, i) => near(weight, b[i], 1e-4));
  assert.equal((await state(page)).outside, false);
  await drag(page, [240, 180], [440, 180]);
  assert.equal((await state(page)).outside, true);
  assert.match(await page.locator(".cue").innerText(), /Outside the captured views/);
  await page.keyboard.press("Escape");
  const back = await state(page);
  assert.deepEqual([back.mode, back.outside], ["plane", false]);
  assert.ok(Math.abs(back.x) <= 1 && Math.abs(back.y) <= 1);
  assert.ok(await page.locator(".cue").isHidden());
  await close();
});

test("every part of the address", async () => {
  const photographs = { view_1_2: "capture/view_1_2.png" };
  const place = "x=0.1&y=0.2&zoom=2&dolly=0.1";
  const hash = `#${place}&n=2&view=eigen&eigen=3&weights=eye&mixing=nearest3&wireframe=1`;
  const { page, close } = await openViewer(browser, "scene.glb", { hash, photographs });
  const { x, y, zoom, dolly, count, view, eigen, weights, mixing, wireframe } = await state(page);
  assert.deepEqual([x, y, zoom, dolly], [0.1, 0.2, 2, 0.1]);
  assert.deepEqual([count, view, eigen, weights, mixing, wireframe], [2, "eigen", 2, "eye", "nearest3", true]);
  await page.evaluate(() => void (location.hash = "#camera=view_1_2&photograph=1"));
  await page.waitForFunction(() => window.eigenfield.state().camera === "view_1_2");
  assert.equal((await state(page)).photograph, true);
  await page.evaluate(() => void (location.hash = "#mode=orbit"));
  await page.waitForFunction(() => window.eigenfield.state().mode === "orbit");
  await close();
});

test("an address that is typed while the page is about to write its own stands", async () => {
  const { page, close } = await openViewer(browser, "scene.glb");
  await settled(page);
  await page.waitForTimeout(400); // nothing is left to write
  await page.evaluate(async () => {
    const { setTimeout } = window;
    const late = []; // what the page does 300 ms after it has drawn
    window.setTimeout = (task, pause) => (pause === 300 ? late.push(task) : setTimeout(task, pause));
    window.eigenfield.goTo(0.25, -0.5);
    await window.eigenfield.settled();
    location.hash = "#camera=view_1_2";
    late.forEach((write) => write()); // before the event that tells of the new address
    if (late.length === 0) throw new Error("nothing was about to be written");
  });
  await page.waitForFunction(() => window.eigenfield.state().camera === "view_1_2");
  await close();
});

test("the view is in the address, and comes from it", async () => {
  const first = await openViewer(browser, "scene.glb");
  await first.page.evaluate(() => window.eigenfield.goTo(0.25, -0.5));
  await set(first.page, { count: 3, view: "mean", weights: "eye", mixing: "bilinear" });
  await first.page.waitForFunction(() => location.hash.includes("x=0.25") && location.hash.includes("view=mean"));
  const hash = await first.page.evaluate(() => location.hash);
  assert.equal(await first.page.evaluate(() => history.length), 2, "no step in the history"); // blank, page
  await first.close();

  const { page, close } = await openViewer(browser, "scene.glb", { hash });
  const now = await state(page);
  assert.deepEqual(
    [now.x, now.y, now.count, now.view, now.weights, now.mixing, now.mode],
    [0.25, -0.5, 3, "mean", "eye", "bilinear", "plane"],
  );
  await page.evaluate(() => void (location.hash = "#camera=view_0_3&n=2"));
  await page.waitForFunction(() => window.eigenfield.state().camera === "view_0_3");
  assert.equal((await state(page)).count, 2);
  await page.evaluate(() => void (location.hash = "#eye=0.2,0.1,-1&at=0,0,-3"));
  await page.waitForFunction(() => window.eigenfield.state().mode === "orbit");
  await page.evaluate(() => void (location.hash = "#x=nonsense&n=-5&mode=%00&view=<b>"));
  const odd = await state(page);
  assert.deepEqual([odd.view, odd.status], ["picture", "ready"]);
  await page.evaluate(() => void (location.hash = "#eye=1e200,0,0&at=0,0,0"));
  await page.waitForTimeout(50);
  await settled(page);
  assert.ok((await page.evaluate(() => window.eigenfield.eyes())).flat().every(Number.isFinite));
  await close();
});
