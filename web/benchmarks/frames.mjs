// node frames.mjs FOLDER WIDTH HEIGHT SECONDS NAME.glb...: figures of each scene as JSON. FOLDER holds the scenes and
// mean.png; `benchmarks/render_browser.py` makes it and calls this.

import { buildPage, launch, openPage, serve } from "../tests/harness.mjs";

const [folder, width, height, seconds, ...names] = process.argv.slice(2);
const built = await buildPage("benchmarks", "frames.html");
const server = await serve({ folders: [built.folder, folder] });
const browser = await launch();
const figures = {};
try {
  for (const name of names) {
    const { page, close } = await openPage(browser, `${server.url}/frames.html`);
    await page.waitForFunction("window.measure");
    page.setDefaultTimeout(0);
    figures[name] = await page.evaluate(
      ([url, w, h, s]) => window.measure(url, w, h, s),
      [name, Number(width), Number(height), Number(seconds)],
    );
    await close();
  }
  figures.browser = browser.version();
} finally {
  await browser.close();
  await server.close();
  await built.close();
}
console.log(JSON.stringify(figures));
