// Opens report pages in headless Chromium and checks what a reader would see.
//
//   node page.mjs FOLDER PAGE...
//
// For each page: no message on the console and no request, the first screen without scripts, pixels in every figure, hover, the time slider
// of the replay, the size of the file; screenshots in light, dark and narrow, and the printed page as PDF go to FOLDER. CHROMIUM names the browser.
// Exit code 1 with one line for each thing that is wrong.

import { existsSync, mkdirSync, readFileSync, statSync, writeFileSync } from "node:fs";
import { basename, dirname, join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import puppeteer from "puppeteer-core";

const LARGEST = 2_000_000; // bytes of a page
const MOST_SHEETS = 8; // of paper, of missions with all their figures
const FEWEST_COLORS = 3; // background, axes and at least one mark
const SLICE = 8000; // pixels of a screenshot
const [folder, ...pages] = process.argv.slice(2);
const problems = [];

// The number of colours within each of `boxes` of a screenshot (base64), from the pixels that the browser itself decodes.
async function colorsIn(page, png, boxes) {
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

async function colorsOf(page, handle) {
  const { width, height } = await handle.boundingBox();
  const [count] = await colorsIn(page, await handle.screenshot({ encoding: "base64" }), [{ x: 0, y: 0, width, height }]);
  return count;
}

async function opened(browser, file, viewport, scheme, scripts = true) {
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

async function checkWithoutScripts(browser, file, name) {
  const page = await opened(browser, file, { width: 1300, height: 900 }, "light", false);
  const text = await page.evaluate(() => document.body.innerText);
  for (const part of ["computed", "spindrift", "Statistics"]) if (!text.includes(part)) problems.push(`${name}: without scripts there is no "${part}"`);
  if (text.includes("The replay needs")) {
    const still = await page.$eval(".replay svg.still", (element) => element.getBoundingClientRect().height);
    if (still < 100) problems.push(`${name}: without scripts there is no still of the replay`);
  }
  const cards = await page.$$eval(".card", (list) => list.map((card) => card.getBoundingClientRect().top));
  if (cards.length === 0) problems.push(`${name}: there is no card`);
  if (cards.some((top) => top > 900)) problems.push(`${name}: a card is below the first screen`);
  await page.close();
}

// Screenshots of the whole page from top to bottom, as files `stem_0.png` and so on: Chromium draws no more than 16,384 pixels at once.
async function screenshots(page, stem) {
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

// Draws every figure and checks it; and that the browser shows more than an empty plot.
async function checkFigures(page, name, stem) {
  await page.evaluate(() => {
    for (const fold of document.querySelectorAll("details.fold, details.input")) fold.open = true;
    globalThis.spindriftPage.drawAll();
  });
  const figures = await page.evaluate(() =>
    Array.from(document.querySelectorAll("figure"), (figure) => {
      const plot = figure.querySelector(".plot");
      const { x, y, width, height } = plot.getBoundingClientRect();
      return { id: figure.id, marks: plot.querySelectorAll("svg path, svg circle").length, box: { x: x + scrollX, y: y + scrollY, width, height } };
    }),
  );
  if (figures.length === 0) problems.push(`${name}: there are no figures`);
  for (const { id, marks } of figures) if (marks < 3) problems.push(`${name}: figure ${id} has ${marks} elements`);
  await page.evaluate(() => scrollTo(0, 0));
  for (const { box, png } of await screenshots(page, stem)) {
    // a figure at an edge is seen by the half that is within
    const inside = figures.filter((figure) => figure.box.y + 0.5 * figure.box.height >= box.y && figure.box.y + 0.5 * figure.box.height < box.y + box.height);
    const places = inside.map((figure) => ({ ...figure.box, y: figure.box.y - box.y }));
    (await colorsIn(page, png, places)).forEach((count, k) => {
      if (count < FEWEST_COLORS) problems.push(`${name}: figure ${inside[k].id} has ${count} colours`);
    });
  }
  const text = await page.evaluate(() => document.body.innerText);
  for (const wrong of ["NaN", "undefined", "Infinity", "[object"]) if (text.includes(wrong)) problems.push(`${name}: the page says ${wrong}`);
  const width = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
  if (width > 0) problems.push(`${name}: the page is ${width} pixels wider than the window`);
  return figures.length;
}

// Each link of the menu ends with the heading of its section below the menu, though figures above are drawn on the way; and the menu is one line.
async function checkLinks(page, name) {
  const menu = await page.$eval("nav", (nav) => nav.getBoundingClientRect().height);
  if (menu > 60) problems.push(`${name}: the menu is ${menu} pixels high`);
  for (const link of await page.$$("nav a")) {
    const anchor = await link.evaluate((element) => element.hash.slice(1));
    await link.evaluate((element) => element.click());
    let top = Infinity;
    for (let tries = 0; tries < 40; tries += 1) {
      await new Promise((resolve) => setTimeout(resolve, 100));
      const now = await page.$eval(`#${anchor}`, (section) => section.getBoundingClientRect().top);
      if (Math.abs(now - top) < 0.5) break;
      top = now;
    }
    const isEnd = await page.evaluate(() => scrollY + innerHeight > document.documentElement.scrollHeight - 4);
    const below = await page.$eval("nav", (nav) => (nav.getBoundingClientRect().top < 2 ? nav.getBoundingClientRect().bottom : 0));
    const heading = await page.$eval(`#${anchor} h2`, (element) => element.getBoundingClientRect().top);
    if (!isEnd && (heading < below - 1 || heading > below + 120)) problems.push(`${name}: the link to ${anchor} ends ${Math.round(heading - below)} pixels below the menu`);
  }
}

// The replay is the mission: it starts at a speed that plays in 20 s, its numbers are those of the run at the time of the slider, phases are marked
// where they begin, the path is the recorded one, and a failed run is beside the nominal one.
async function checkMission(page, name) {
  const wrong = await page.evaluate(async () => {
    const replay = await globalThis.spindriftPage.replay();
    const found = [];
    const expect = (isRight, text) => isRight || found.push(text);
    const near = (value, expected) => Math.abs(value - expected) <= 1e-3 * Math.abs(expected) + 1e-9;
    expect(near(replay.rate() * 20, replay.motion.last), `it starts at ${replay.rate()} times the speed of ${replay.motion.last} s`);
    for (const [index, run] of replay.data.runs.entries()) {
      replay.choose(index);
      const place = Math.floor(run.times.length / 3);
      replay.goTo(run.times[place]);
      const shown = Array.from(document.querySelectorAll(".live dd"), (element) => element.textContent);
      expect(shown.length === run.live.length && shown.length > 0, `${shown.length} live numbers`);
      run.live.forEach((number, k) => {
        if (number.words) {
          const share = number.values[place];
          expect(shown[k] === number.words[share === 0 ? 0 : share === 1 ? 2 : 1], `${number.name} is ${shown[k]} for ${share}`);
          return;
        }
        const width = Math.max(1, number.components.length);
        const known = Array.from(number.values.subarray(width * place, width * (place + 1)), (value) => value * number.factor);
        const texts = width === 1 ? [shown[k]] : shown[k].slice(0, shown[k].length - number.unit.length).split(", ");
        // numbers with a power of ten are read as they are written
        const read = texts.map((text) => Number(text.replace(number.unit, "").replaceAll(",", "").replace(/ × 10/, "e").replace(/[⁰¹²³⁴⁵⁶⁷⁸⁹⁻]/g, (digit) => "0123456789-"["⁰¹²³⁴⁵⁶⁷⁸⁹⁻".indexOf(digit)])));
        expect(known.every((value, part) => !Number.isFinite(value) || near(read[part], value)), `${number.name} is ${shown[k]} for ${known}`);
      });
      const marks = Array.from(document.querySelectorAll(".marks button"), (button) => [Number(button.dataset.time), parseFloat(button.style.getPropertyValue("--at"))]);
      expect(marks.length === run.marks.length, `${marks.length} marks for ${run.marks.length}`);
      // it is shown to the end of the mission
      expect(run.marks.every((mark) => mark.time <= replay.motion.last * (1 + 1e-6)), `${run.name} ends at ${replay.motion.last} s, before ${run.marks.at(-1)?.name} at ${run.marks.at(-1)?.time} s`);
      marks.forEach(([time, at], k) => expect(time === run.marks[k].time && near(at, Math.min(1, time / replay.motion.last)), `the mark ${run.marks[k].name} is at ${at}`));
      // numbers that change move nothing below them
      const heightAt = (part) => (replay.goTo(part * replay.motion.last), document.querySelector(".live").getBoundingClientRect().height);
      const heights = [0, 0.2, 0.4, 0.6, 0.8, 1].map(heightAt);
      expect(Math.max(...heights) - Math.min(...heights) < 1, `${run.name}: the numbers are ${heights} pixels high`);
      replay.goTo(run.times[place]);
      if (replay.approach) {
        replay.view("approach");
        const drawn = replay.approach.line.geometry.attributes.position.array;
        expect(drawn.length === 3 * run.times.length && drawn.every((value, k) => near(value, -run.debris.relative[k])), "the path is not the recorded one");
        const craft = replay.craft.position.toArray();
        expect(craft.every((value, axis) => near(value, -run.debris.relative[3 * place + axis])), `the spacecraft is at ${craft}`);
        if (run.goal) expect(near(Math.hypot(...replay.approach.station), run.goal.distance), "the station is not at its distance");
        replay.view("inertial");
      }
      if (run.orbit) {
        const at = Math.floor(run.orbit.times.length / 2);
        replay.goTo(run.orbit.times[at]);
        expect(replay.sky.arrows.length === Object.keys(run.orbit).filter((key) => key !== "times" && key !== "hidden").length, `${replay.sky.arrows.length} arrows of the orbit`);
        for (const [key, drawn] of replay.sky.arrows) {
          const { x, y, z, w } = drawn.quaternion;
          const tip = [2 * (x * z + w * y), 2 * (y * z - w * x), w * w - x * x - y * y + z * z];
          expect(drawn.visible && tip.every((value, axis) => Math.abs(value - run.orbit[key][3 * at + axis]) < 1e-3), `${key} points to ${tip}`);
        }
        const [, sun] = replay.sky.arrows.find(([key]) => key === "sun") ?? [];
        for (const share of sun ? [0, 1] : []) {
          const moment = run.orbit.hidden.indexOf(share);
          if (moment < 0) continue;
          replay.goTo(run.times[moment]);
          expect(share === 0 ? sun.children[0].material.opacity === 1 : sun.children[0].material.opacity < 0.5, `the Sun has the opacity ${sun.children[0].material.opacity} with ${share} of it hidden`);
        }
        replay.toggleSky();
        expect(!replay.sky.group.visible, "the directions of the orbit are not hidden");
        replay.toggleSky();
        expect(replay.sky.group.visible, "the directions of the orbit are not shown again");
      }
      expect(replay.ghost.visible === (run.failed && run.sample !== 0 && replay.data.runs[0].sample === 0), `${run.name}: the nominal run is ${replay.ghost.visible ? "" : "not "}beside it`);
    }
    replay.choose(0);
    return found;
  });
  problems.push(...wrong.map((text) => `${name}: replay: ${text}`));
}

// Full screen shows the replay alone, larger than before; leaving it restores the page.
async function checkFullScreen(page, name) {
  const before = await page.$eval(".stage canvas", (canvas) => canvas.getBoundingClientRect().height);
  const toggle = async (isFull) => {
    await page.$eval(".replay button[title^='Full screen']", (button) => button.scrollIntoView({ block: "center" }));
    await page.click(".replay button[title^='Full screen']");
    const isRight = (full, known) => {
      const { height } = document.querySelector(".stage canvas").getBoundingClientRect();
      return Boolean(document.fullscreenElement?.matches(".replay")) === full && (full ? height > known : Math.abs(height - known) <= 2);
    };
    // the picture follows in one of the next frames, which software rendering makes slowly
    await page.waitForFunction(isRight, { timeout: 15_000 }, isFull, before).catch(() => problems.push(`${name}: ${isFull ? "full screen is not larger" : "full screen is not left"}`));
  };
  await toggle(true);
  await toggle(false);
}

// A figure over time leads the replay: a click goes to that time.
async function checkCursor(page, name) {
  const plot = await page.$("#time figure .plot");
  if (!plot) return;
  await page.evaluate(async () => (await globalThis.spindriftPage.replay())?.goTo(0));
  await plot.scrollIntoView();
  const box = await plot.boundingBox();
  await page.mouse.click(box.x + 0.5 * box.width, box.y + 0.5 * box.height);
  const time = await page.evaluate(async () => (await globalThis.spindriftPage.replay())?.time);
  if (time === 0) problems.push(`${name}: a click into a figure over time does not lead the replay`);
}

// Without WebGL, and on paper, a still is there instead.
async function checkStill(page, name) {
  const isShown = () => page.$eval(".replay svg.still", (still) => getComputedStyle(still).display !== "none" && still.getBoundingClientRect().height > 100);
  if (await isShown()) problems.push(`${name}: the still is there beside the replay`);
  await page.emulateMediaType("print");
  if (!(await isShown())) problems.push(`${name}: there is no still on paper`);
  await page.emulateMediaType("screen");
}

// The numbers beside the replay are those of the run that is shown.
async function checkNumbers(page, name) {
  const shown = await page.evaluate(async () => {
    const replay = await globalThis.spindriftPage.replay();
    if (!replay) return [];
    return replay.data.runs.map((run, index) => {
      replay.choose(index);
      const text = (tag) => Array.from(document.querySelectorAll(`.numbers.ends ${tag}`), (element) => element.textContent);
      return { expected: run.numbers, names: text("dt"), values: text("dd") };
    });
  });
  for (const { expected, names, values } of shown) {
    if (expected.length === 0 || expected.some(([of, value], k) => names[k] !== of || values[k] !== value)) problems.push(`${name}: ${names} = ${values} beside a run with ${expected}`);
  }
}

async function checkHover(page, name) {
  const plots = await page.$$("figure .plot");
  let shown = 0;
  for (const plot of plots.slice(0, 6)) {
    await plot.scrollIntoView();
    const box = await plot.boundingBox();
    for (const part of [0.5, 0.35, 0.65]) {
      await page.mouse.move(box.x + part * box.width, box.y + 0.5 * box.height);
      const tip = await plot.$eval(".tip", (element) => (element.hidden ? "" : element.innerText));
      if (/\d/.test(tip)) {
        shown += 1;
        break;
      }
    }
  }
  if (plots.length > 0 && shown === 0) problems.push(`${name}: no figure answers the pointer`);
}

// What is said of a figure is what it is made of: ticks of an axis have labels of their own, the tip beside a point of a curve names that point and not its neighbour, each column of a saved table is
// the mark's own, and runs that are selected are called what the figure of two columns calls them.
async function checkSaid(page, name) {
  const wrong = await page.evaluate(() => {
    const found = [];
    // what figures say of themselves in titles of axes, legends and captions
    const figureLaws = () => {
      const wrong = [];
      const dispersed = Number(document.querySelector(".facts").innerText.match(/^([\d,]+) dispersed runs/)?.[1].replaceAll(",", "") ?? NaN);
      const isAll = document.querySelector("#status").innerText.startsWith("All");
      for (const { figure, chart, legend } of views) {
        const [xAxis, yAxis] = ["xAxis", "yAxis"].map((part) => chart?.getOption()[part][0]);
        for (const axis of [xAxis, yAxis]) if (axis?.name?.includes("\u2026")) wrong.push(`an axis of ${figure.name} is called "${axis.name}"`);
        if (chart && figure.y.quantity === "runs" && !Number.isInteger(yAxis.interval)) wrong.push(`${figure.name} counts runs in steps of ${yAxis.interval}`);
        if (figure.marks.some((mark) => mark.kind === "whiskers") && legend.querySelector("rect")) wrong.push(`the whiskers of ${figure.name} are a bar in the legend`);
        // an input with few values has a tick at each of them, and no point on the frame
        const values = [...new Set(figure.marks.flatMap((mark) => (mark.kind === "points" ? Array.from(mark.x) : [])))];
        if (chart && figure.name.startsWith("scatter_") && values.length > 1 && values.length < 6 && !(xAxis.min < Math.min(...values) && xAxis.max > Math.max(...values))) wrong.push(`points of ${figure.name} are on the frame`);
        const bars = figure.marks.find((mark) => mark.kind === "bars" && mark.label === "runs");
        if (bars && isAll && figure.name.startsWith("histogram_")) {
          const shown = bars.heights.reduce((sum, height) => sum + height, 0);
          const said = shown < dispersed ? `${shown.toLocaleString("en-US")} of ${dispersed.toLocaleString("en-US")} runs have this value.` : `${shown.toLocaleString("en-US")} runs.`;
          if (!figure.caption.startsWith(said)) wrong.push(`of ${shown} of ${dispersed} runs ${figure.name} says "${figure.caption}"`);
        }
        // bands at fewer than four times in each oscillation say so
        const [median, nominal] = ["median", "nominal run"].map((label) => figure.marks.find((mark) => mark.kind === "line" && mark.label === label));
        const band = figure.marks.find((mark) => mark.kind === "band" && mark.label === "5 to 95%");
        const times = Number(figure.caption.match(/at each of (\d+) times/)?.[1] ?? Infinity);
        // errors are round-off, which does not oscillate
        if (figure.section === "numerics" || !median || !nominal || !band || times >= nominal.x.length) continue;
        const steps = Array.from(nominal.y.slice(1), (value, k) => value - nominal.y[k]).filter((step) => step !== 0);
        const turns = steps.filter((step, k) => k > 0 && step > 0 !== steps[k - 1] > 0).length;
        const width = Math.max(...Array.from(band.high, (high, k) => high - band.low[k]));
        const [least, most] = [Math.min(...nominal.y), Math.max(...nominal.y)];
        const isCoarse = 4 * turns > 2.2 * (times - 1) && most - least > Math.max(0.1 * width, 1e-8 * Math.max(Math.abs(least), Math.abs(most)));
        if (isCoarse && !figure.caption.includes("raise [bands] points")) wrong.push(`${figure.name} has bands at ${times} times for ${turns / 2} oscillations and says "${figure.caption}"`);
      }
      // what is saved of a strip says whose it is
      const phases = views.find(({ figure }) => figure.name === "phases");
      if (phases && !csvText(phases.figure).startsWith(`"name","begin: time (s)","end: time (s)"\n"${phases.figure.y.names[0]}",0,`)) wrong.push(`phases are saved as ${csvText(phases.figure).slice(0, 60)}`);
      const bar = document.querySelector(".replay .controls");
      if (bar && bar.getBoundingClientRect().height > 60) wrong.push(`the controls of the replay are ${bar.getBoundingClientRect().height} pixels high`);
      return wrong;
    };
    const columns = { line: (mark) => [mark.x, mark.y], points: (mark) => [...(mark.samples.length > 0 ? [mark.samples] : []), mark.x, mark.y], band: (mark) => [mark.x, mark.low, mark.high], bars: (mark) => [mark.edges, mark.heights], flight: (mark) => [mark.x, mark.counts], whiskers: (mark) => [mark.x, mark.low, mark.high] };
    for (const { figure, chart } of views) {
      for (const part of ["xAxis", "yAxis"]) {
        const labels = chart?.getModel().getComponent(part)?.axis.getViewLabels().map((label) => label.formattedLabel).filter(Boolean).slice(0, -1) ?? []; // the last is the end of the axis, which may be next to a tick
        if (new Set(labels).size < labels.length) found.push(`two ticks of ${figure.name} have the same label: ${labels.join(", ")}`);
      }
      const isAscending = (x) => x.length > 2 && x.every((value, k) => k === 0 || value > x[k - 1]);
      for (const mark of figure.marks.filter((one) => one.kind === "line" && !figure.x.step && isAscending(one.x) && !figure.y.names)) {
        const k = Math.floor(mark.x.length / 2);
        for (const [part, at] of [[0.2, k], [0.8, k + 1]]) {
          if (at >= mark.x.length) continue;
          const lines = described(figure, [-1e6, -1e6], [mark.x[k] + part * (mark.x[k + 1] - mark.x[k]), 0], () => [0, 0]);
          const known = `${mark.label}: ${withUnit(mark.y[at], figure.y.unit)}`;
          // under the abscissa that is named, or with its own; within the ends of a bar
          const own = withUnit(mark.x[at], figure.x.unit);
          const isInBar = figure.marks.some((one) => one.kind === "bars");
          const isNamed = isInBar || lines.includes(`${figure.x.quantity}: ${own}`) ? lines.includes(known) : lines.includes(known.replace(":", ` at ${own}:`));
          if (!isNamed) found.push(`the tip of ${figure.name} says ${lines.join("; ")} for ${known}`);
        }
      }
      // a fraction of runs at a value that several have is that of all of them
      for (const mark of figure.marks.filter((one) => one.kind === "line" && one.x.length > 2 && /^(cumulative|tail)_/.test(figure.name))) {
        const k = mark.x.findIndex((value, at) => value === mark.x[at + 1]);
        if (k < 0) continue;
        const most = Math.max(...Array.from(mark.y).filter((_, at) => mark.x[at] === mark.x[k]));
        const lines = described(figure, [-1e6, -1e6], [mark.x[k], 0], () => [0, 0]);
        if (!lines.includes(`${mark.label}: ${withUnit(most, "")}`)) found.push(`the tip of ${figure.name} says ${lines.join("; ")} for ${most}`);
      }
      // of bodies one upon the other each has its own share, with the sign of a loss
      for (const mark of figure.marks.filter((one) => one.kind === "band" && one.stacked)) {
        for (const isLoss of [false, true]) {
          const k = mark.x.findIndex((_, at) => (isLoss ? mark.low[at] < 0 && mark.high[at] <= 0 : mark.high[at] > 0) && mark.high[at] !== mark.low[at]);
          if (k < 0) continue;
          const share = (isLoss ? -1 : 1) * Math.abs(mark.high[k] - mark.low[k]);
          const lines = described(figure, [-1e6, -1e6], [mark.x[k], 0], () => [0, 0]);
          if (!lines.includes(`${mark.label}: ${withUnit(share, figure.y.unit)}`)) found.push(`the tip of ${figure.name} says ${lines.join("; ")} for ${share} of ${mark.label}`);
        }
      }
      // a limit outside of the axes is named with an arrow to where it is
      const texts = chart ? Array.from(chart.getDom().querySelectorAll("svg text"), (text) => text.textContent) : [];
      for (const mark of chart ? figure.marks.filter((one) => one.kind === "limit" && one.label && !(one.vertical ? figure.x : figure.y).log) : []) {
        const [low, high] = chart.getModel().getComponent(mark.vertical ? "xAxis" : "yAxis").axis.scale.getExtent();
        const arrows = mark.vertical ? ["\u2190", "\u2192"] : ["\u2193", "\u2191"];
        const arrow = mark.at > high + 0.02 * (high - low) ? arrows[1] : mark.at < low - 0.02 * (high - low) ? arrows[0] : "";
        const word = mark.label.split(" ").at(-1);
        if (arrow && !texts.some((text) => text.startsWith(arrow))) found.push(`${figure.name}: no ${arrow} for ${mark.label}, beyond ${low} to ${high}: ${texts.filter((text) => text.includes(word))}`);
      }
      const blocks = figure.x.names ? [] : csvText(figure).split("\n\n");
      figure.marks.forEach((mark, index) => {
        const own = figure.name === "phases" && mark.kind === "band" ? [[mark.x[0]], [mark.x.at(-1)]] : (columns[mark.kind]?.(mark) ?? []);
        const rows = own.length > 0 && blocks.length > 0 ? blocks[index].split("\n").slice(1) : [];
        for (const k of rows.keys()) {
          const cells = rows[k].split(",").slice(-own.length);
          if (!cells.every((cell, column) => cell === String(own[column][k] ?? ""))) found.push(`row ${k} of ${mark.label} of ${figure.name} is saved as ${rows[k]}`);
        }
      });
    }
    found.push(...figureLaws());
    const marks = runs ? pairFigure(runs, 0, runs.columns.length - 1).marks : [];
    const fateOf = { computed: 0, ...Object.fromEntries((runs?.fateWords ?? []).map((words, fate) => [words, fate])) };
    for (const mark of marks) {
      const other = Array.from(mark.samples).find((sample) => runs.fates[runs.samples.indexOf(sample)] !== fateOf[mark.label]);
      if (other !== undefined) found.push(`sample ${other} is called "${mark.label}"`);
    }
    const isJudged = marks.some((mark) => mark.label === runs.fateWords[1]);
    for (const mark of marks.filter((one) => isJudged && one.samples.length > 1)) {
      select(mark.samples);
      const said = document.querySelector(".selection").innerText;
      if (!said.includes(`${mark.samples.length} runs: ${mark.samples.length} ${mark.label}`)) found.push(`of runs of which each ${mark.label} it says ${said}`);
    }
    select([]);
    return found;
  });
  problems.push(...wrong.slice(0, 8).map((text) => `${name}: ${text}`));
}

// On paper nothing can be opened: no caption is cut, no card loses an edge or a part of its scale, no word stands on another, and what only a screen needs is not there.
async function checkPaper(page, name) {
  await page.setViewport({ width: 718, height: 1000 }); // A4 less its margins
  await page.emulateMediaType("print");
  const wrong = await page.evaluate(() => {
    const found = [];
    const isSeen = (element) => element.getClientRects().length > 0;
    for (const caption of document.querySelectorAll("figcaption")) {
      const style = getComputedStyle(caption);
      if (isSeen(caption) && (style.display === "-webkit-box" || style.overflow !== "visible" || caption.scrollHeight > caption.clientHeight + 1)) found.push(`a caption is cut: ${caption.textContent}`);
    }
    for (const text of document.querySelectorAll("main p, .beside p")) if (isSeen(text) && /needs JavaScript/.test(text.textContent)) found.push(`it says "${text.textContent}"`);
    const width = document.documentElement.clientWidth;
    for (const card of document.querySelectorAll(".card")) {
      const box = card.getBoundingClientRect();
      if (box.right > width - 1) found.push(`the edge of a card is at ${box.right} of ${width}`);
      const lines = parseFloat(getComputedStyle(card.querySelector("h3")).lineHeight) / parseFloat(getComputedStyle(card.querySelector("h3")).fontSize);
      if (lines > 1.5) found.push(`lines of the title of a card are ${lines} letters apart`);
      const scale = card.querySelector(".scale");
      const texts = Array.from(card.querySelectorAll(".scale text"), (text) => text.getBoundingClientRect());
      if (scale && getComputedStyle(scale).overflow !== "visible" && texts.some((text) => text.top < scale.getBoundingClientRect().top - 0.5)) found.push("a word of a scale is cut");
      if (texts.some((a, i) => texts.some((b, j) => i < j && Math.min(a.right, b.right) - Math.max(a.left, b.left) > -2 && Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 2))) found.push(`words of a scale stand on each other: ${scale.textContent}`);
    }
    return found;
  });
  problems.push(...wrong.slice(0, 8).map((text) => `${name}: on paper: ${text}`));
  await page.emulateMediaType(null);
  await page.setViewport({ width: 1300, height: 900 });
}

// No table is cut: it has room for all of its cells, or is in a box that scrolls and whose edge says so; the worst runs have room. Folded ones too.
async function checkNarrowTables(page, name) {
  const wrong = await page.evaluate(() => {
    for (const details of document.querySelectorAll("details")) details.open = true;
    const width = document.documentElement.clientWidth;
    const found = document.documentElement.scrollWidth > width ? [`the page is ${document.documentElement.scrollWidth} pixels wide`] : [];
    for (const table of document.querySelectorAll("table")) {
      const what = table.closest("section")?.id ?? "a table";
      const box = table.closest(".table");
      const style = box ? getComputedStyle(box) : null;
      const scrolls = style?.overflowX === "auto" && style.backgroundImage !== "none" && box.getBoundingClientRect().right <= width + 1;
      const right = Math.max(...Array.from(table.querySelectorAll("th, td"), (cell) => cell.getBoundingClientRect().right));
      if (right > width + 1 && (what === "worst" || !scrolls)) found.push(`${what} is cut at ${width} of ${right} pixels`);
      const cut = Array.from(table.querySelectorAll("th, td")).find((cell) => cell.clientWidth > 0 && (cell.scrollWidth > cell.clientWidth + 1 || cell.scrollHeight > cell.clientHeight + 1));
      if (cut) found.push(`a cell of ${what} is cut: ${cut.innerText}`);
    }
    return found;
  });
  problems.push(...wrong.map((text) => `${name}: ${text}`));
}

// What scripts make of a page - texts, buttons, what figures draw and say of their middle - is what somebody has read and found right: tests/golden/views. With
// SPINDRIFT_WRITE_VIEWS=1 it is written; the difference is read before it is committed.
async function checkView(page, name) {
  if (!["net_launch", "orbit", "failing"].includes(name)) return;
  const view = await page.evaluate(() => {
    const lines = [];
    const digits = (value) => (typeof value === "number" && Number.isFinite(value) ? Number(value.toPrecision(6)) : value);
    const brief = (value) => {
      if (Array.isArray(value)) return value.length > 6 ? `${value.length}: ${[0, value.length >> 1, value.length - 1].map((k) => JSON.stringify(brief(value[k]))).join(" .. ")}` : value.map(brief);
      if (ArrayBuffer.isView(value)) return brief(Array.from(value));
      if (typeof value === "function") return "function";
      if (value && typeof value === "object") return Object.fromEntries(Object.entries(value).map(([key, part]) => [key, brief(part)]));
      return digits(value);
    };
    const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_ELEMENT, (element) => (element.matches("script, style, pre, table, p, dl, .card, .plot, .live, .clock, .numbers, figcaption") ? NodeFilter.FILTER_REJECT : NodeFilter.FILTER_ACCEPT));
    while (walker.nextNode()) {
      const element = walker.currentNode;
      const own = Array.from(element.childNodes, (node) => (node.nodeType === Node.TEXT_NODE ? node.textContent.trim() : "")).filter(Boolean).join(" ");
      const said = ["title", "aria-label", "placeholder", "data-sample", "data-camera", "data-time", "href", "disabled"].filter((key) => element.hasAttribute(key)).map((key) => `${key}="${element.getAttribute(key)}"`);
      if (own || said.length > 0) lines.push(`${element.localName}.${element.className.baseVal ?? element.className}: ${own} ${said.join(" ")}`.trimEnd());
    }
    for (const { figure, chart } of views) {
      const { series, xAxis, yAxis } = chart?.getOption() ?? {};
      const axes = [xAxis, yAxis].map((list) => (list ?? []).map(({ type, name, min, max, data }) => ({ type, name, min, max, data })));
      lines.push(`figure ${figure.name}: ${figure.title}`, `  axes ${JSON.stringify(brief(axes))}`);
      for (const { type, name, data, step, symbol, stack } of series ?? []) lines.push(`  ${JSON.stringify(brief({ type, name, data, step, symbol, stack }))}`);
      const text = csvText(figure).split("\n");
      for (const k of [0, 1, text.length >> 1, text.length - 2]) lines.push(`  saved ${k}: ${text[k] ?? ""}`);
      for (const mark of figure.marks) {
        const k = (mark.x?.length ?? 0) >> 1;
        if (mark.x?.length > 0 && mark.y?.length > 0) lines.push(`  tip: ${described(figure, [-1e6, -1e6], [mark.x[k], mark.y[k]], () => [0, 0]).join("; ")}`);
      }
    }
    return `${lines.join("\n")}\n`;
  });
  // the version and the plan's identity are another in another version of the program
  const steady = view.replaceAll(/(?<![.\d])\b([0-9a-f]{64}|[0-9a-f]{8})\b(?!\.)/g, "ID").replaceAll(/spindrift \d+\.\d+\.\d+/g, "spindrift VERSION");
  const path = join("tests", "golden", "views", `browser_${name}.txt`);
  if (process.env.SPINDRIFT_WRITE_VIEWS) return writeFileSync(path, steady);
  const [approved, found] = [existsSync(path) ? readFileSync(path, "utf8").split("\n") : [], steady.split("\n")];
  const at = found.findIndex((line, k) => line !== approved[k]);
  if (at >= 0 || approved.length !== found.length) problems.push(`${name}: line ${at + 1} of ${path} is "${found[at]}", and was "${approved[at]}"`);
}

async function checkReplay(page, name) {
  const stage = await page.$(".replay");
  if (!stage) return;
  await page.evaluate(async () => globalThis.spindriftPage.replay());
  await stage.scrollIntoView();
  await page.waitForSelector(".stage canvas", { timeout: 30_000 });
  const canvas = await page.$(".stage canvas");
  const before = await canvas.screenshot({ encoding: "base64" });
  if ((await colorsOf(page, canvas)) < 5) problems.push(`${name}: the replay is empty`);
  await page.$eval("input.time", (slider) => {
    slider.value = String(Number(slider.max) * 0.37);
    slider.dispatchEvent(new Event("input"));
  });
  const after = await canvas.screenshot({ encoding: "base64" });
  if (before === after) problems.push(`${name}: the time slider does not move the replay`);
  const cursors = await page.$$eval("#time .cursor", (list) => list.filter((cursor) => !cursor.hidden).length);
  const figures = await page.$$eval("#time figure", (list) => list.length);
  if (figures > 0 && cursors === 0) problems.push(`${name}: the time slider does not move the cursors`);
  for (const camera of ["body", "chase", "inertial"]) await page.click(`[data-camera="${camera}"]`);
  await checkMission(page, name);
  await page.focus(".stage");
  const clock = () => page.$eval(".clock", (element) => element.textContent);
  const time = await clock();
  await page.keyboard.press("ArrowRight");
  if ((await clock()) === time) problems.push(`${name}: the keyboard does not step the replay`);
}

// A click on a point selects its run in all figures, and a second one replays it or copies its command; a click on a bar selects the runs of that bar.
async function checkSelection(page, name) {
  const plots = await page.$$("#influence figure[id^='scatter_'] .plot, #outcome figure[id^='histogram_'] .plot");
  if (plots.length === 0) return;
  const expect = (isRight, text) => isRight || problems.push(`${name}: selection: ${text}`);
  const rings = () => page.$$eval("figure .plot", (list) => list.filter((plot) => plot.innerHTML.includes("#e69f00") || plot.innerHTML.includes("#f2b233")).length);
  const state = () => page.evaluate(() => ({ samples: globalThis.spindriftPage.selected(), text: document.querySelector(".selection").innerText, hidden: document.querySelector(".selection").hidden }));
  const before = await rings();
  const point = await page.evaluate(() => globalThis.spindriftPage.placeOfRun());
  if (point) {
    const plot = await page.$(`figure[id="${point.figure}"] .plot`);
    await plot.scrollIntoView();
    const box = await plot.boundingBox();
    await page.mouse.click(box.x + point.at[0], box.y + point.at[1]);
    const one = await state();
    expect(one.samples.length === 1 && one.text.includes(`Sample ${one.samples[0]}`) && !one.hidden, `a click on a point gives ${JSON.stringify(one)}`);
    expect((await rings()) > before + 1, `${await rings()} figures show the run, ${before} before`);
    const command = await page.evaluate(() => {
      let copied = "";
      Object.defineProperty(navigator, "clipboard", { configurable: true, value: { writeText: async (text) => { copied = text; } } });
      globalThis.copiedText = () => copied;
      return Array.from(document.querySelectorAll("button.load"), (button) => Number(button.dataset.sample));
    });
    await page.mouse.click(box.x + point.at[0], box.y + point.at[1]);
    await new Promise((done) => setTimeout(done, 500));
    const copied = await page.evaluate(() => globalThis.copiedText());
    expect(command.includes(one.samples[0]) || copied === `spindrift simulate plan.toml --sample ${one.samples[0]}`, `a second click copies "${copied}"`);
    await page.keyboard.press("Escape");
    expect((await state()).hidden, "Escape leaves it");
  }
  const bar = await page.$("#outcome figure[id^='histogram_'] .plot");
  if (bar) {
    await bar.scrollIntoView();
    const box = await bar.boundingBox();
    for (const part of [0.4, 0.5, 0.6, 0.3, 0.7]) {
      await page.mouse.click(box.x + part * box.width, box.y + 0.6 * box.height);
      if ((await state()).samples.length > 1) break;
    }
    const many = await state();
    expect(many.samples.length > 1 && many.text.includes(`${many.samples.length} runs`), `a click on a bar gives ${JSON.stringify(many)}`);
    await page.evaluate(() => globalThis.spindriftPage.select([]));
  }
  expect((await rings()) === before, "what is no longer selected is still shown");
}

// No two texts of a figure cover each other, no line of a limit crosses one, and the name of a limit is above the bars.
async function checkTexts(page, name) {
  const found = await page.evaluate(() => {
    const [wrong, cut, crossed] = [[], [], []];
    for (const figure of document.querySelectorAll("figure")) {
      const texts = Array.from(figure.querySelectorAll(".plot svg text"), (text) => ({ text: text.textContent, box: text.getBoundingClientRect() })).filter(({ text, box }) => text.trim() && box.width > 0);
      const plot = figure.querySelector(".plot").getBoundingClientRect();
      for (const { text, box } of texts) if (box.left < plot.left - 1.5 || box.right > plot.right + 1.5) cut.push(`${figure.id}: "${text}"`);
      const dashed = Array.from(figure.querySelectorAll(".plot svg path[stroke-dasharray]"), (line) => line.getBoundingClientRect());
      const upright = dashed.filter((line) => line.width < 2 && line.height > 20);
      const isOn = (line, box) => line.left > box.left + 2 && line.right < box.right - 2 && line.top < box.bottom - 4 && line.bottom > box.top + 4;
      for (const { text, box } of texts) if (upright.some((line) => isOn(line, box))) crossed.push(`${figure.id}: "${text}"`);
      for (let i = 0; i < texts.length; i += 1) {
        for (let j = i + 1; j < texts.length; j += 1) {
          const [a, b] = [texts[i].box, texts[j].box];
          const [x, y] = [Math.min(a.right, b.right) - Math.max(a.left, b.left), Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top)];
          if (x > 1.5 && y > 4) wrong.push(`${figure.id}: "${texts[i].text}" and "${texts[j].text}"`);
        }
      }
    }
    return { wrong, cut, crossed };
  });
  for (const text of found.crossed.slice(0, 8)) problems.push(`${name}: a line of a limit crosses a name: ${text}`);
  for (const text of found.wrong.slice(0, 8)) problems.push(`${name}: texts cover each other: ${text}`);
  for (const text of found.cut.slice(0, 8)) problems.push(`${name}: a text leaves its figure: ${text}`);
}

// An input is one line: a small histogram, nominal value, distribution and fit; it opens to its figure.
async function checkInputs(page, name) {
  const rows = await page.$$eval("details.input", (list) => list.map((row) => ({ height: row.querySelector("summary").getBoundingClientRect().height, bars: row.querySelectorAll("svg.small rect").length, text: row.innerText, figures: row.querySelectorAll("figure").length })));
  // what an open line shows does not reach into the next one
  const over = await page.$$eval("details.input[open] figcaption", (list) => list.filter((caption) => caption.getBoundingClientRect().bottom > caption.closest("details").getBoundingClientRect().bottom + 1).map((caption) => caption.textContent));
  if (over.length > 0) problems.push(`${name}: a caption of an input is over the next line: ${over[0]}`);
  for (const { height, bars, text, figures } of rows) if (height > 60 || (bars < 1 && !/(^|\D)0 dispersed/.test(text)) || figures !== 1) problems.push(`${name}: the line of an input is ${height} pixels high with ${bars} bars and ${figures} figures: ${text}`);
}

async function checkTables(page, name) {
  const search = await page.$("input[type=search]");
  if (!search) return;
  const rows = () => page.$$eval("#statistics tbody tr", (list) => list.filter((row) => !row.hidden).length);
  const all = await rows();
  await search.type("energy");
  const some = await rows();
  if (some === 0 || some >= all) problems.push(`${name}: searching "energy" leaves ${some} of ${all} rows`);
  await page.$eval("input[type=search]", (input) => {
    input.value = "";
    input.dispatchEvent(new Event("input"));
  });
  await page.click("#statistics thead th:nth-child(2) button");
}

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
  await checkView(page, name);
  await checkTexts(page, name);
  await checkInputs(page, name);
  await checkSelection(page, name);
  await checkTables(page, name);
  await checkReplay(page, name);
  await checkNumbers(page, name);
  if (await page.$(".replay")) {
    await checkFullScreen(page, name);
    await checkCursor(page, name);
    await checkStill(page, name);
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
