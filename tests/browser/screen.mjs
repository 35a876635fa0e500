// The first screen of a report page as a picture.
//
//   node screen.mjs PAGE PICTURE WIDTH HEIGHT [dark]
//
// CHROMIUM names the browser.

import { resolve } from "node:path";
import { pathToFileURL } from "node:url";
import puppeteer from "puppeteer-core";

const [file, picture, width, height, scheme = "light"] = process.argv.slice(2);
const browser = await puppeteer.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox", "--force-color-profile=srgb"] });
const page = await browser.newPage();
await page.setViewport({ width: Number(width), height: Number(height) });
await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: scheme }]);
await page.goto(pathToFileURL(resolve(file)).href);
await page.waitForFunction(() => document.documentElement.dataset.ready === "true");
await page.evaluate(() => globalThis.spindriftPage.drawAll());
await page.screenshot({ path: picture });
await browser.close();
