// Laws of figures: what they show, say, select and save.

import { colorsIn, problems, screenshots } from "./open_page.mjs";

const FEWEST_COLORS = 3; // background, axes and at least one mark

// Draws every figure and checks it; and that the browser shows more than an empty plot.
export async function checkFigures(page, name, stem) {
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

export async function checkHover(page, name) {
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
export async function checkSaid(page, name) {
  const wrong = await page.evaluate(() => {
    const found = [];
    // what figures say of themselves in titles of axes, legends and captions
    const figureLaws = () => {
      const wrong = [];
      const dispersed = Number(document.querySelector(".facts").innerText.match(/^([\d,]+) dispersed runs/)?.[1].replaceAll(",", "") ?? NaN);
      const isAll = document.querySelector("#status").innerText.includes("All ");
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
          const said = shown < dispersed ? `${shown} of ${dispersed} runs have this value.` : `${shown} runs.`;
          if (!figure.caption.startsWith(said)) wrong.push(`of ${shown} of ${dispersed} runs ${figure.name} says "${figure.caption}"`);
        }
        // no figure has bands at fewer than four times in each oscillation of the nominal run that is seen beside them
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
        if (isCoarse) wrong.push(`${figure.name} has bands at ${times} times for ${turns / 2} oscillations`);
      }
      // neighbours that say the same share one legend, and no other has none
      const keys = views.map(({ figure }) => legendKey(figure));
      const isRepeated = ({ box, legend }, k) => k > 0 && box.previousElementSibling === views[k - 1].box && keys[k] === keys[k - 1] && legend.textContent !== "";
      if (views.some(isRepeated)) wrong.push(`the legend of ${views.find(isRepeated).figure.name} is that of the figure before it`);
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

// A click on a point selects its run in all figures, and a second one replays it or copies its command; a click on a bar selects the runs of that bar.
export async function checkSelection(page, name) {
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
export async function checkTexts(page, name) {
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
