// Laws of the replay: what it shows is the run.

import { colorsOf, problems } from "./open_page.mjs";

export async function checkReplay(page, name) {
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

// The replay is the mission: it starts at a speed that plays in 20 s, its numbers are those of the run at the time of the slider, phases are marked
// where they begin, the path is the recorded one, and a failed run is beside the nominal one.
export async function checkMission(page, name) {
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
        const read = texts.map((text) => Number(text.replace(number.unit, "").replaceAll("−", "-").replaceAll(",", "").replace(/\s×\s10/, "e").replace(/[⁰¹²³⁴⁵⁶⁷⁸⁹⁻]/g, (digit) => "0123456789-"["⁰¹²³⁴⁵⁶⁷⁸⁹⁻".indexOf(digit)])));
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
export async function checkFullScreen(page, name) {
  const before = await page.$eval(".stage canvas", (canvas) => canvas.getBoundingClientRect().height);
  const toggle = async (isFull) => {
    await page.$eval(".replay button[title^='Full screen']", (button) => button.scrollIntoView({ block: "center" }));
    await page.click(".replay button[title^='Full screen']");
    const isRight = (full, known) => {
      const { height } = document.querySelector(".stage canvas").getBoundingClientRect();
      return Boolean(document.fullscreenElement?.matches(".replay")) === full && (full ? height > known : Math.abs(height - known) <= 2);
    };
    // the picture follows in one of the next frames, which software rendering makes slowly
    await page.waitForFunction(isRight, { timeout: 60_000 }, isFull, before).catch(() => problems.push(`${name}: ${isFull ? "full screen is not larger" : "full screen is not left"}`));
  };
  await toggle(true);
  await toggle(false);
}

// A figure over time leads the replay: a click goes to that time.
export async function checkCursor(page, name) {
  const plot = await page.$("#time figure .plot");
  if (!plot) return;
  await page.evaluate(async () => (await globalThis.spindriftPage.replay())?.goTo(0));
  await plot.scrollIntoView();
  const box = await plot.boundingBox();
  await page.mouse.click(box.x + 0.5 * box.width, box.y + 0.5 * box.height);
  const time = await page.evaluate(async () => (await globalThis.spindriftPage.replay())?.time);
  if (time === 0) problems.push(`${name}: a click into a figure over time does not lead the replay`);
}

// The numbers beside the replay are those of the run that is shown.
export async function checkNumbers(page, name) {
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
