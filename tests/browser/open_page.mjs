// A report page in the browser, and its pixels. What is wrong is collected in `problems`.

import { writeFileSync } from "node:fs";
import { basename, dirname } from "node:path";
import { pathToFileURL } from "node:url";

const SLICE = 8000; // pixels of a screenshot

export const problems = [];

export async function opened(browser, file, viewport, scheme, scripts = true) {
  const page = await browser.newPage();
  await page.setViewport(viewport);
  await page.setJavaScriptEnabled(scripts);
  await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: scheme }, { name: "prefers-reduced-motion", value: "reduce" }]);
  const name = basename(dirname(file));
  page.on("console", (message) => {
    if (!["warn", "error", "assert"].includes(message.type())) return;
    // chromium's own remarks on software rendering
    if (!/GPU stall|WebGL-|swiftshader/i.test(message.text())) problems.push(`${name}: console: ${message.text()}`);
  });
  page.on("pageerror", (error) => problems.push(`${name}: error: ${error.message}`));
  page.on("request", (request) => {
    if (!/^(file|data|blob):/.test(request.url())) problems.push(`${name}: it asks for ${request.url()}`);
  });
  await page.goto(pathToFileURL(file).href);
  if (scripts) await page.waitForFunction(() => document.documentElement.dataset.ready === "true", { timeout: 30_000 });
  return page;
}

// The number of colours within each of `boxes` of a screenshot (base64), from the pixels that the browser itself decodes.
export async function colorsIn(page, png, boxes) {
  return page.evaluate(async (data, list) => {
    const image = new Image();
    image.src = `data:image/png;base64,${data}`;
    await image.decode();
    return list.map(({ x, y, width, height }) => {
      const canvas = document.createElement("canvas");
      [canvas.width, canvas.height] = [Math.ceil(width), Math.ceil(height)];
      const context = canvas.getContext("2d", { willReadFrequently: true });
      context.drawImage(image, -x, -y);
      const pixels = context.getImageData(0, 0, canvas.width, canvas.height).data;
      const counts = new Map();
      for (let k = 0; k < pixels.length; k += 4) {
        const color = (pixels[k] << 16) | (pixels[k + 1] << 8) | pixels[k + 2];
        counts.set(color, (counts.get(color) ?? 0) + 1);
      }
      return [...counts.values()].filter((count) => count > 8).length;
    });
  }, png, boxes);
}

export async function colorsOf(page, handle) {
  const { width, height } = await handle.boundingBox();
  const [count] = await colorsIn(page, await handle.screenshot({ encoding: "base64" }), [{ x: 0, y: 0, width, height }]);
  return count;
}

// Screenshots of the whole page from top to bottom, as files `stem_0.png` and so on: Chromium draws no more than 16,384 pixels at once.
export async function screenshots(page, stem) {
  const [width, height] = await page.evaluate(() => [document.documentElement.clientWidth, document.documentElement.scrollHeight]);
  const slices = [];
  for (let top = 0; top < height; top += SLICE) {
    const box = { x: 0, y: top, width, height: Math.min(SLICE, height - top) };
    const png = await page.screenshot({ clip: box, captureBeyondViewport: true, encoding: "base64" });
    writeFileSync(`${stem}_${slices.length}.png`, Buffer.from(png, "base64"));
    slices.push({ box, png });
  }
  return slices;
}
