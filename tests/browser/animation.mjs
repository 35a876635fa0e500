// The replay of a report page as an animated picture (APNG, as PNG third edition has it).
//
//   node animation.mjs PAGE PICTURE
//
// The nominal run in the camera "approach", or "inertial" without debris, with its numbers, from start to end. CHROMIUM names the browser.

import { writeFileSync } from "node:fs";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { crc32 } from "node:zlib";
import puppeteer from "puppeteer-core";

const FRAMES = 42;
const DELAY_MS = 200;
const LAST_MS = 2500; // the last picture stays
const STILL = Math.round(0.54 * (FRAMES - 1)); // the picture that is seen where nothing moves: on the way, not at the start
const [file, picture] = process.argv.slice(2);

function chunk(type, data) {
  const body = Buffer.concat([Buffer.from(type, "latin1"), data]);
  const [length, check] = [Buffer.alloc(4), Buffer.alloc(4)];
  length.writeUInt32BE(data.length);
  check.writeUInt32BE(crc32(body));
  return Buffer.concat([length, body, check]);
}

function chunksOf(png) {
  const chunks = [];
  for (let at = 8; at < png.length; ) {
    const length = png.readUInt32BE(at);
    chunks.push({ type: png.toString("latin1", at + 4, at + 8), data: png.subarray(at + 8, at + 8 + length) });
    at += 12 + length;
  }
  return chunks;
}

// Pictures of one size after each other; `still` is no part of the animation, and what a viewer shows that has none.
function animated(frames, still) {
  let sequence = 0;
  const header = chunksOf(frames[0]).find((each) => each.type === "IHDR").data;
  const control = Buffer.alloc(8);
  control.writeUInt32BE(frames.length, 0);
  const of = (frame) => chunksOf(frame).filter(({ type }) => type === "IDAT");
  const parts = [frames[0].subarray(0, 8), chunk("IHDR", header), chunk("acTL", control), ...of(still).map(({ data }) => chunk("IDAT", data))];
  frames.forEach((frame, index) => {
    const about = Buffer.alloc(26);
    about.writeUInt32BE(sequence++, 0);
    header.copy(about, 4, 0, 8);
    about.writeUInt16BE(index === frames.length - 1 ? LAST_MS : DELAY_MS, 20);
    about.writeUInt16BE(1000, 22);
    parts.push(chunk("fcTL", about));
    for (const { data } of of(frame)) {
      const number = Buffer.alloc(4);
      number.writeUInt32BE(sequence++);
      parts.push(chunk("fdAT", Buffer.concat([number, data])));
    }
  });
  return Buffer.concat([...parts, chunk("IEND", Buffer.alloc(0))]);
}

const browser = await puppeteer.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--force-color-profile=srgb"] });
const page = await browser.newPage();
await page.setViewport({ width: 720, height: 700 });
await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: "light" }]);
await page.goto(pathToFileURL(resolve(file)).href);
await page.waitForFunction(() => document.documentElement.dataset.ready === "true");
await page.evaluate(async () => {
  const replay = await globalThis.spindriftPage.replay();
  replay.chooseSample(0);
  document.querySelector("nav").remove();
  document.querySelector(".numbers.ends").remove();
  replay.view(replay.approach ? "approach" : "inertial");
  // the picture: what is seen, the numbers, the slider with its phases
  document.querySelectorAll(".replay > :not(.beside, .time, .marks, .clock)").forEach((element) => element.remove());
});
// pictures of one size: what is below moves where a number needs another line
const clip = await page.$eval(".replay", (replay) => {
  const { x, y, width, height } = replay.getBoundingClientRect();
  return { x: x + scrollX, y: y + scrollY, width, height };
});
const frames = [];
for (let frame = 0; frame < FRAMES; frame += 1) {
  await page.evaluate(async (part) => {
    const replay = await globalThis.spindriftPage.replay();
    replay.goTo(part * replay.motion.last);
  }, frame / (FRAMES - 1));
  frames.push(Buffer.from(await page.screenshot({ clip, captureBeyondViewport: true })));
}
await browser.close();
writeFileSync(picture, animated(frames, frames[STILL]));
