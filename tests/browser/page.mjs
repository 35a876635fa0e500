// Opens report pages in headless Chromium and checks what a reader would see.
//
//   node page.mjs FOLDER PAGE...
//
// For each page: no message on the console and no request, the first screen without scripts, pixels in every figure, hover, the time slider
// of the replay, the size of the file; screenshots in light, dark and narrow, and the printed page as PDF go to FOLDER. CHROMIUM names the browser.
// Exit code 1 with one line for each thing that is wrong.

import { mkdirSync, readFileSync, statSync } from "node:fs";
import { basename, dirname, join, resolve } from "node:path";
import puppeteer from "puppeteer-core";
import { checkFigures, checkHover, checkSaid, checkSelection, checkTexts } from "./figure_laws.mjs";
import { checkInputs, checkLinks, checkNarrowTables, checkPaper, checkTables, checkWithoutScripts } from "./layout_laws.mjs";
import { opened, problems, screenshots } from "./open_page.mjs";
import { checkCursor, checkFullScreen, checkNumbers, checkReplay } from "./replay_laws.mjs";

const LARGEST = 2_000_000; // bytes of a page
const MOST_SHEETS = 8; // of paper, of missions with all their figures
const [folder, ...pages] = process.argv.slice(2);

async function checked(browser, file) {
  const name = basename(dirname(file));
  const size = statSync(file).size;
  if (size >= LARGEST) problems.push(`${name}: ${size} bytes`);
  if (/(src|href)="https?:/.test(readFileSync(file, "latin1"))) problems.push(`${name}: it refers to the network`);
  await checkWithoutScripts(browser, file, name);
  const shot = (part) => join(folder, `${name}_${part}`);
  const page = await opened(browser, file, { width: 1300, height: 900 }, "light");
  await page.screenshot({ path: `${shot("first")}.png` });
  await page.evaluate(async () => globalThis.spindriftPage.replay());
  const figures = await checkFigures(page, name, shot("light"));
  await checkHover(page, name);
  await checkSaid(page, name);
  await checkTexts(page, name);
  await checkInputs(page, name);
  await checkSelection(page, name);
  await checkTables(page, name);
  await checkReplay(page, name);
  await checkNumbers(page, name);
  if (await page.$(".replay")) {
    await checkFullScreen(page, name);
    await checkCursor(page, name);
  }
  await page.mouse.move(0, 0);
  // as it opens, with what is folded
  await page.evaluate(() => document.querySelectorAll("details.fold, details.input").forEach((fold) => { fold.open = false; }));
  await page.emulateMediaType("print");
  const lost = await page.$$eval("main > section", (list) => list.filter((section) => section.querySelector(":scope > .figures figure") && getComputedStyle(section).display === "none").map((section) => section.id));
  if (lost.length > 0) problems.push(`${name}: sections with figures are not printed: ${lost}`);
  await page.emulateMediaType(null);
  await checkPaper(page, name);
  const pdf = await page.pdf({ path: join(folder, `${name}_print.pdf`), preferCSSPageSize: true, printBackground: true });
  const sheets = Buffer.from(pdf).toString("latin1").match(/\/Type\s*\/Page\b(?!s)/g)?.length ?? 0;
  if (sheets === 0 || (name === "net_launch" && sheets > MOST_SHEETS)) problems.push(`${name}: it is printed on ${sheets} sheets`);
  await page.close();
  const dark = await opened(browser, file, { width: 1300, height: 900 }, "dark");
  await dark.evaluate(() => globalThis.spindriftPage.drawAll());
  await dark.evaluate(async () => globalThis.spindriftPage.replay());
  await screenshots(dark, shot("dark"));
  await dark.close();
  const middle = await opened(browser, file, { width: 800, height: 900 }, "light");
  await checkLinks(middle, `${name}, 800 pixels`);
  await middle.close();
  const narrow = await opened(browser, file, { width: 390, height: 800 }, "light");
  await checkFigures(narrow, `${name}, narrow`, shot("narrow"));
  await checkTexts(narrow, `${name}, narrow`);
  await checkNarrowTables(narrow, `${name}, narrow`);
  await narrow.close();
  console.log(`${name}: ${figures} figures, ${size} bytes`);
}

mkdirSync(folder, { recursive: true });
const browser = await puppeteer.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--force-color-profile=srgb"],
});
try {
  for (const file of pages) await checked(browser, resolve(file));
} finally {
  await browser.close();
}
problems.forEach((problem) => console.error(problem));
process.exitCode = problems.length > 0 ? 1 : 0;
