// The runs that the reader has selected by a click on a point or a bar: every figure shows them, and a bar at the lower edge says what can be done with them.

import { nearestPoint } from "./hover.js";

const SELECTED = 5; // place of their colour in the palette
const REACH = 14; // pixels around a point
const followers = [];
let runs = null; // samples, columns and fates of the runs that the page has
let chosen = new Set();

export function onSelection(listener) {
  followers.push(listener);
}

// The samples that are selected, ascending.
export function selected() {
  return Array.from(chosen).sort((a, b) => a - b);
}

export function select(samples) {
  chosen = new Set(samples);
  for (const listener of followers) listener();
}

// The values of the runs along the axis of a histogram or a curve of one column; null where the figure shows none.
function valuesOf(figure) {
  const name = /^(?:histogram|input|cumulative)_(.+)$/.exec(figure.name)?.[1];
  const column = name && runs?.columns.find((one) => one.column === name);
  if (!column) return null;
  return figure.x.quantity.startsWith("|") ? Array.from(column.values, Math.abs) : column.values;
}

// Where a curve that rises from left to right is at `value`.
function heightAt(curve, value) {
  let place = 0;
  while (place < curve.x.length - 1 && curve.x[place + 1] <= value) place += 1;
  return curve.y[place];
}

// The counts of `values` between neighbouring edges.
function counted(values, edges) {
  const heights = new Float64Array(edges.length - 1);
  for (const value of values) {
    if (!(value >= edges[0] && value <= edges.at(-1))) continue;
    let bar = 0;
    while (bar < heights.length - 1 && edges[bar + 1] <= value) bar += 1;
    heights[bar] += 1;
  }
  return heights;
}

// What a figure shows of the selected runs, as marks in front of its own.
export function selectionMarks(figure) {
  if (chosen.size === 0 || !runs) return [];
  const marks = [];
  for (const mark of figure.marks) {
    if (mark.kind !== "points" || mark.samples.length === 0) continue;
    const places = Array.from(mark.samples.keys()).filter((k) => chosen.has(mark.samples[k]));
    if (places.length > 0) marks.push({ kind: "points", label: "selected", hue: SELECTED, rings: true, x: places.map((k) => mark.x[k]), y: places.map((k) => mark.y[k]), samples: [] });
  }
  const values = valuesOf(figure);
  if (!values) return marks;
  const own = Array.from(values).filter((value, row) => chosen.has(runs.samples[row]) && Number.isFinite(value));
  const bars = figure.marks.find((mark) => mark.kind === "bars");
  if (bars) {
    // of thinned runs the bars show as many as all have
    const scale = bars.heights.reduce((sum, height) => sum + height, 0) / Math.max(1, counted(values, bars.edges).reduce((sum, height) => sum + height, 0));
    marks.push({ kind: "bars", label: "selected", hue: SELECTED, opacity: 1, edges: bars.edges, heights: counted(own, bars.edges).map((height) => Math.max(1, scale) * height) });
  }
  const curve = figure.marks.find((mark) => mark.kind === "line" && mark.x.length > 2);
  if (!bars && curve) marks.push({ kind: "points", label: "selected", hue: SELECTED, rings: true, x: own, y: own.map((value) => heightAt(curve, value)), samples: [] });
  return marks;
}

// The samples at pixel `at`, whose value is `value`: of the nearest point, or of a bar; null where there are none.
export function runsAt(figure, at, value, toPixel) {
  for (const mark of figure.marks) {
    if (mark.kind !== "points" || mark.samples.length === 0) continue;
    const found = nearestPoint(mark, toPixel, at, REACH);
    if (found) return [mark.samples[found.index]];
  }
  const bars = figure.marks.find((mark) => mark.kind === "bars");
  const values = bars && valuesOf(figure);
  if (!values || !(value[0] >= bars.edges[0] && value[0] <= bars.edges.at(-1))) return null;
  let bar = 0;
  while (bar < bars.heights.length - 1 && bars.edges[bar + 1] <= value[0]) bar += 1;
  const isIn = (one) => one >= bars.edges[bar] && (one < bars.edges[bar + 1] || (bar === bars.heights.length - 1 && one === bars.edges[bar + 1]));
  return Array.from(runs.samples).filter((_, row) => isIn(values[row]));
}

// A click on the runs `samples`: selects them; on a run that is selected alone already, replays it or copies its command; on nothing, selects nothing.
export function clicked(samples) {
  if (samples?.length === 1 && chosen.size === 1 && chosen.has(samples[0])) return again(samples[0]);
  return select(samples ?? []);
}

let again = () => {};

function command(sample) {
  return `spindrift simulate plan.toml --sample ${sample}`;
}

// `replayed` are the samples that the replay has; `show` shows one of them.
export function startSelection(pairs, replayed, show) {
  runs = pairs;
  if (!runs) return;
  const bar = document.createElement("div");
  bar.className = "selection";
  bar.setAttribute("role", "status");
  bar.hidden = true;
  const button = (text, act) => {
    const made = document.createElement("button");
    made.type = "button";
    made.textContent = text;
    made.addEventListener("click", act);
    return made;
  };
  const copy = async () => {
    const text = selected().slice(0, 20).map(command).join("\n");
    try {
      await navigator.clipboard.writeText(text);
      said.textContent = "copied";
    } catch {
      said.textContent = text;
    }
  };
  const [text, said] = [document.createElement("span"), document.createElement("code")];
  const replay = button("replay", () => show(selected()[0]));
  const buttons = [replay, button("copy the command", copy), button("clear", () => select([]))];
  bar.append(text, ...buttons, said);
  document.body.append(bar);
  onSelection(() => {
    const samples = selected();
    bar.hidden = samples.length === 0;
    said.textContent = "";
    const rows = Array.from(runs.samples.keys()).filter((row) => chosen.has(runs.samples[row]));
    const count = (fate) => rows.filter((row) => runs.fates[row] === fate).length;
    const shares = runs.fateWords.flatMap((words, fate) => (runs.judged && count(fate) > 0 ? [`${samples.length > 1 ? `${count(fate)} ` : ""}${words}`] : []));
    text.textContent = `${samples.length === 1 ? `Sample ${samples[0]}` : `${samples.length} runs`}${shares.length > 0 ? `: ${shares.join(", ")}` : ""}`;
    replay.hidden = !(samples.length === 1 && replayed.includes(samples[0]));
  });
  again = (sample) => (replayed.includes(sample) ? show(sample) : copy());
  addEventListener("keydown", (event) => event.key === "Escape" && chosen.size > 0 && select([]));
}
