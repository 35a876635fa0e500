// What is under the pointer of a figure, with exact values and units, and the cursor that the replay moves.

import { raised, readable, withUnit } from "./numbers.js";

// The index of the element of ascending `values` that is nearest to `value`.
export function nearest(values, value) {
  let low = 0;
  let high = values.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (values[middle] <= value) low = middle;
    else high = middle;
  }
  return Math.abs(values[low] - value) <= Math.abs(values[high] - value) ? low : high;
}

function isAscending(values) {
  for (let k = 1; k < values.length; k += 1) if (values[k] < values[k - 1]) return false;
  return true;
}

// The nearest point of `mark` within `reach` pixels, as {index, distance}.
export function nearestPoint(mark, toPixel, at, reach) {
  let found = null;
  for (let k = 0; k < mark.x.length; k += 1) {
    const [x, y] = toPixel(mark.x[k], mark.y[k]);
    const distance = Math.hypot(x - at[0], y - at[1]);
    if (distance <= reach && (!found || distance < found.distance)) found = { index: k, distance };
  }
  return found;
}

// Whether a line is the interval of a quantile: from one abscissa to another at one height.
function isInterval(mark) {
  return mark.kind === "line" && mark.x.length === 2 && mark.y[0] === mark.y[1];
}

// Lines of text about what is at pixel `at`, whose value is `value`, in `figure`.
export function described(figure, at, value, toPixel) {
  const lines = [];
  const { x, y } = figure;
  const marks = figure.marks;
  // on a map no abscissa is that of one point alone
  const series = marks.filter((mark) => !x.step && (mark.kind === "line" || mark.kind === "band") && mark.x.length > 1 && isAscending(mark.x));
  const points = marks.filter((mark) => mark.kind === "points");
  for (const mark of points) {
    const found = nearestPoint(mark, toPixel, at, 14);
    if (!found) continue;
    const sample = mark.samples.length > found.index ? `sample ${mark.samples[found.index]}` : mark.label;
    lines.push(sample, `${x.quantity}: ${withUnit(mark.x[found.index], x.unit)}`, `${y.quantity}: ${withUnit(mark.y[found.index], y.unit)}`);
    return lines;
  }
  // the abscissa that is named is that of the series with the most points; another that stands elsewhere says where
  const isThere = (mark) => !y.names && !(isInterval(mark) && !figure.time) && !(figure.time && (value[0] < mark.x[0] || value[0] > mark.x[mark.x.length - 1]));
  const shown = series.filter(isThere);
  const finest = shown.reduce((most, mark) => (most && most.x.length >= mark.x.length ? most : mark), null);
  const named = finest ? finest.x[nearest(finest.x, value[0])] : null;
  // a bar has ends of its own
  if (finest && !marks.some((mark) => mark.kind === "bars")) lines.push(`${x.quantity}: ${withUnit(named, x.unit)}`);
  for (const mark of marks) {
    if (mark.kind === "bars" && mark.edges.length > 1) {
      let bar = 0;
      while (bar < mark.heights.length - 1 && mark.edges[bar + 1] <= value[0]) bar += 1;
      if (value[0] < mark.edges[0] || value[0] > mark.edges[mark.edges.length - 1]) continue;
      lines.push(`${withUnit(mark.edges[bar], x.unit)} to ${withUnit(mark.edges[bar + 1], x.unit)}`, mark.label === y.quantity ? `${withUnit(mark.heights[bar], "")} ${y.quantity}` : `${mark.label}: ${withUnit(mark.heights[bar], "")} ${y.quantity}`);
    }
    if (mark.kind === "whiskers" && y.names) {
      const row = Math.round(value[1]);
      if (row < 0 || row >= mark.x.length) continue;
      lines.push(y.names[row], `${x.quantity}: ${withUnit(mark.x[row], x.unit)}`);
      if (Number.isFinite(mark.low[row])) lines.push(`${mark.label}: [${readable(mark.low[row])}, ${readable(mark.high[row])}]`);
    }
    if (mark.kind === "flight") {
      const index = nearest(mark.x, value[0]);
      if (!finest) lines.push(`${x.quantity}: ${withUnit(mark.x[index], x.unit)}`);
      lines.push(`${mark.label}: ${mark.counts[index]} of ${mark.runs}`);
    }
    if (mark.kind === "matrix") {
      const count = y.names.length;
      const [column, row] = [Math.round(value[0]), Math.round(value[1])];
      if (column < 0 || row < 0 || column >= count || row >= count) continue;
      lines.push(y.names[row], x.names[column], `correlation: ${mark.values[row * count + column].toFixed(3)}`);
    }
  }
  for (const mark of series) {
    const [from, to] = [mark.x[0], mark.x[mark.x.length - 1]];
    if (figure.time && (value[0] < from || value[0] > to)) continue;
    if (y.names) {
      const row = Math.round((mark.low[0] + mark.high[0]) / 2);
      lines.push(`${y.names[row]}: ${withUnit(from, x.unit)} to ${withUnit(to, x.unit)}`);
      continue;
    }
    if (isInterval(mark) && !figure.time) {
      lines.push(`${mark.label}: [${readable(from)}, ${readable(to)}]${x.unit ? ` ${raised(x.unit)}` : ""}`);
      continue;
    }
    let index = nearest(mark.x, value[0]);
    // of a fraction that steps at an abscissa the larger one is "at most" or "at least" this value
    const heights = mark.y ?? mark.high;
    const isStep = (next) => mark.x[next] === mark.x[index] && heights[next] > heights[index];
    while (isStep(index + 1)) index += 1;
    while (isStep(index - 1)) index -= 1;
    const label = Math.abs(mark.x[index] - named) <= 1e-6 * Math.abs(named) ? mark.label : `${mark.label} at ${withUnit(mark.x[index], x.unit)}`;
    if (mark.kind === "line") lines.push(`${label}: ${withUnit(mark.y[index], y.unit)}`);
    else if (mark.stacked) lines.push(`${label}: ${withUnit(mark.high[index] > 0 ? mark.high[index] - mark.low[index] : mark.low[index] - mark.high[index], y.unit)}`);
    else lines.push(`${label}: [${readable(mark.low[index])}, ${readable(mark.high[index])}]${y.unit ? ` ${raised(y.unit)}` : ""}`);
  }
  if (lines.length === 0) {
    for (const mark of marks.filter((other) => other.kind === "line")) {
      const found = nearestPoint(mark, toPixel, at, 20);
      if (found) lines.push(mark.label, `${x.quantity}: ${withUnit(mark.x[found.index], x.unit)}`, `${y.quantity}: ${withUnit(mark.y[found.index], y.unit)}`);
    }
  }
  return lines;
}
