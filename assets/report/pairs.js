// Any two columns against each other, on demand.

import { FigureView } from "./figure.js";
import { readable } from "./numbers.js";

// The figure of two columns.
export function pairFigure(pairs, first, second) {
  const [x, y] = [pairs.columns[first], pairs.columns[second]];
  const rows = Array.from(pairs.samples.keys());
  const kept = (fate) => rows.filter((row) => pairs.fates[row] === fate && Number.isFinite(x.values[row]) && Number.isFinite(y.values[row]));
  const points = (label, hue, crosses, list) => ({ kind: "points", label, hue, crosses, x: list.map((row) => x.values[row]), y: list.map((row) => y.values[row]), samples: list.map((row) => pairs.samples[row]) });
  const positive = (column) => {
    const values = Array.from(column.values).filter(Number.isFinite);
    const [low, high] = [Math.min(...values), Math.max(...values)];
    return low > 0 && high > 100 * low;
  };
  const axis = (column) => ({ quantity: column.name, unit: column.unit, log: positive(column), names: null, range: null });
  const [met, missed, failed] = [0, 1, 2].map(kept);
  const marks = [points(missed.length > 0 ? pairs.fateWords[0] : "computed", 0, false, met)];
  if (missed.length > 0) marks.push(points(pairs.fateWords[1], 1, true, missed));
  if (failed.length > 0) marks.push(points(pairs.fateWords[2], 8, true, failed));
  return { name: `pair_${x.column}_${y.column}`, section: "influence", title: `${y.name} against ${x.name}`, caption: rows.length === pairs.all ? `${readable(pairs.all)} samples.` : `${readable(rows.length)} of ${readable(pairs.all)} samples, chosen by sample number.`, columns: 12, time: false, x: axis(x), y: axis(y), marks };
}

export function startPairs(pairs, echarts) {
  const details = document.getElementById("pairs");
  if (!details) return;
  if (!pairs || pairs.columns.length < 2) {
    details.remove();
    return;
  }
  const place = details.querySelector("div");
  const select = (label, chosen) => {
    const made = document.createElement("select");
    made.setAttribute("aria-label", label);
    pairs.columns.forEach((column, index) => made.append(new Option(column.unit ? `${column.name} (${column.unit})` : column.name, index, false, index === chosen)));
    return made;
  };
  const outcome = Math.max(1, pairs.columns.findIndex((column) => !column.input));
  const [x, y] = [select("horizontal", 0), select("vertical", outcome)];
  const bar = document.createElement("p");
  bar.append(y, " against ", x);
  let view = null;
  const show = () => {
    const figure = pairFigure(pairs, Number(x.value), Number(y.value));
    if (view) return view.show(figure);
    view = new FigureView(figure, echarts);
    place.append(view.box);
    return view.draw();
  };
  place.append(bar);
  for (const control of [x, y]) control.addEventListener("change", show);
  details.addEventListener("toggle", () => details.open && show());
}
