// From an axis of a figure to what ECharts draws.

import { raised, readable, superscript, tickScale, tickText } from "./numbers.js";

export const LETTER = 6.6; // width of a letter of 12 pixels, about
export const DIGIT = 7.6; // that of a digit, of the widest fonts
export const NAMES = 0.55; // share of the width that the names of rows may take
export const FONT = "system-ui, -apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', sans-serif";

// The finite values that an axis has to show.
function extent(figure, which) {
  let [low, high] = [Infinity, -Infinity];
  const take = (values) => {
    for (const value of values) {
      if (!Number.isFinite(value)) continue;
      if (value < low) low = value;
      if (value > high) high = value;
    }
  };
  const isLog = figure[which].log;
  for (const mark of figure.marks) {
    if (mark.kind === "limit" && which === "x" && mark.vertical && !(isLog && mark.at <= 0)) take([mark.at]);
    for (const name of which === "x" ? ["x", "edges"] : ["y", "heights"]) if (mark[name] && !(mark.kind === "whiskers" && which === "y")) take(isLog ? mark[name].filter((value) => value > 0) : mark[name]);
    const ends = mark.kind === "whiskers" ? "x" : "y";
    if (which === ends && mark.low) for (const name of ["low", "high"]) take(isLog ? mark[name].filter((value) => value > 0) : mark[name]);
    if (mark.kind === "bars" && which === "y") take([0]);
    if (mark.kind === "whiskers" && which === "x") take([0]);
  }
  return low <= high ? [low, high] : [0, 1];
}

// A round step for about `count` ticks.
function roundStep(span, count) {
  const raw = span / count;
  const power = 10 ** Math.floor(Math.log10(raw));
  const digit = raw / power;
  return (digit < 1.5 ? 1 : digit < 3.5 ? 2 : digit < 7.5 ? 5 : 10) * power;
}

const LINES = 3; // of the title of an axis, at most

// Quantity and unit of an axis that is `room` pixels long, in as many lines as it needs; then the quantity is shortened, the unit is not.
function titleOf(axis, unit, room) {
  const most = Math.max(6, Math.floor(room / 7.2));
  const end = unit ? ` / ${raised(unit)}` : "";
  if (axis.quantity.length + end.length <= most) return axis.quantity + end;
  // the unit stays beside the last word
  const words = axis.quantity.split(" ");
  words.push(words.pop() + end);
  const broken = (width) => words.slice(1).reduce((lines, word) => (lines.at(-1).length + 1 + word.length <= width ? [...lines.slice(0, -1), `${lines.at(-1)} ${word}`] : [...lines, word]), [words[0]]);
  // as few lines as there have to be, of lengths as equal as they can be
  let width = most;
  while (width > 1 && broken(width - 1).length === broken(most).length) width -= 1;
  const lines = broken(width);
  const cut = (line) => (line.length > most && !line.endsWith(end) ? `${line.slice(0, Math.max(2, most - 1))}\u2026` : line);
  return [...lines.slice(0, LINES - 1).map(cut), ...(lines.length < LINES ? [] : [lines.length > LINES ? `\u2026 ${lines.at(-1)}` : lines.at(-1)])].join("\n");
}

function linearAxis(axis, [low, high], { isTime, isAcross, count, room }) {
  // what varies by rounding alone is constant
  if (!(high - low > 1e-10 * Math.max(Math.abs(low), Math.abs(high)))) {
    const half = low === 0 ? 1 : 0.05 * Math.abs(low);
    [low, high] = [low >= 0 ? Math.max(0, low - half) : low - half, high + half];
  }
  // of a given step a multiple, where it has no room
  const stepOf = (some) => {
    if (axis.step) return axis.step * Math.ceil((high - low) / (2 * axis.step * some) - 1e-9);
    return axis.isCount ? Math.max(1, roundStep(high - low, some)) : roundStep(high - low, some);
  };
  const scale = tickScale(low, high, axis.unit);
  const name = titleOf(axis, scale.unit, room);
  // numbers side by side are fewer where they are long: none is left out between others
  const widthOf = (step) => ((high - low) / step + 1) * (DIGIT * Math.max(...[low, high].map((end) => tickText(Math.round(end / step) * step, step, scale.factor).length)) + 8);
  let step = stepOf(count);
  for (let some = count - 1; isAcross && some >= 2 && widthOf(step) > room; some -= 1) step = stepOf(some);
  const text = (value) => tickText(value, step, scale.factor);
  const [first, last] = [Math.floor(low / step + 1e-9) * step, Math.ceil(high / step - 1e-9) * step];
  // a run ends where it ends: the last tick may be before it
  const [min, max] = isTime ? [first, high] : [first, last];
  const texts = Array.from({ length: Math.floor((max - first) / step + 1e-6) + 1 }, (_, k) => text(first + k * step));
  return { type: "value", min, max, interval: step, name, texts, axisLabel: { formatter: text, hideOverlap: true, showMaxLabel: last - max < 1e-6 * step } };
}

const FEW = 5; // values of an input that has steps, at most

// The axis of an input that has few values: a tick at each of them, and room beside the first and the last.
function steppedAxis(axis, values, room) {
  const beside = 0.08 * (values.at(-1) - values[0]);
  const text = (value) => readable(value, 4);
  const customValues = values;
  return { type: "value", min: values[0] - beside, max: values.at(-1) + beside, name: titleOf(axis, axis.unit, room), texts: values.map(text), axisTick: { customValues }, axisLabel: { formatter: text, customValues } };
}

// The abscissae of a scatter plot in which these are few, ascending; nothing of others.
function stepsOf(figure) {
  const values = new Set();
  for (const mark of figure.name.startsWith("scatter_") && !figure.x.log ? figure.marks : []) {
    for (const value of mark.x ?? []) if (Number.isFinite(value)) values.add(value);
    if (values.size > FEW) return [];
  }
  return values.size > 1 ? [...values].sort((a, b) => a - b) : [];
}

// Ticks of a logarithmic axis: decades, no more than nine; where there are fewer than two, also 2 and 5 times a decade, and if need be
// round values.
function logTicks(min, max) {
  const [first, last] = [Math.ceil(Math.log10(min)), Math.floor(Math.log10(max))];
  if (last > first) {
    const every = Math.max(1, Math.ceil((last - first) / 8));
    return Array.from({ length: Math.floor((last - first) / every) + 1 }, (_, k) => 10 ** (first + k * every));
  }
  const multiples = [first - 1, first].flatMap((power) => [1, 2, 5].map((digit) => digit * 10 ** power));
  const inside = multiples.filter((value) => value >= min && value <= max);
  if (inside.length > 1) return inside;
  const step = roundStep(max - min, 4);
  const start = Math.ceil(min / step);
  return Array.from({ length: Math.max(0, Math.floor(max / step) - start + 1) }, (_, k) => (start + k) * step);
}

function logAxis(axis, [low, high], room) {
  const name = titleOf(axis, axis.unit, room);
  const [min, max] = [low / 1.12, high * 1.12];
  const customValues = logTicks(min, max);
  const text = (value) => {
    const power = Math.round(Math.log10(value));
    // a short axis in plain numbers: no 10² between 50 and 200
    if (min >= 1e-2 && max <= 1e4) return readable(value, 3);
    return Math.abs(Math.log10(value) - power) < 1e-9 ? `10${superscript(power)}` : readable(value, 3);
  };
  return { type: "log", min, max, name, texts: customValues.map(text), axisTick: { customValues }, axisLabel: { formatter: text, customValues, hideOverlap: true } };
}

export function axisOption(figure, which, palette, width) {
  const axis = figure[which];
  const style = { axisLine: { onZero: false, lineStyle: { color: palette.quiet } }, axisTick: { lineStyle: { color: palette.quiet } }, splitLine: { lineStyle: { color: palette.grid } }, nameTextStyle: { color: palette.text, fontFamily: FONT, fontSize: 13, lineHeight: 15 }, nameLocation: "middle" };
  const label = { color: palette.quiet, fontFamily: FONT, fontSize: 12 };
  if (axis.names) {
    const longest = Math.max(14, Math.min(34, Math.floor((NAMES * width - 16) / LETTER)));
    const half = (longest - 1) / 2;
    // the count goes before a number loses digits
    const fits = (name) => (name.length > longest ? name.replace(/: \d+ of \d+$/, "") : name);
    const cut = (name) => (name.length > longest ? `${name.slice(0, Math.floor(half))}…${name.slice(-Math.ceil(half))}` : name);
    const short = (name) => cut(fits(name));
    const names = which === "x" ? axis.names.map((_, index) => String(index + 1)) : axis.names.map((name, index) => (figure.x.names ? `${short(name)}  ${index + 1}` : short(name)));
    return { ...style, type: "category", data: names, inverse: which === "y", splitLine: { show: false }, axisLabel: { ...label, interval: which === "x" ? Math.max(0, Math.ceil((DIGIT * 2 + 4) / Math.max(1, (0.5 * width) / axis.names.length)) - 1) : 0 }, axisTick: { show: false } };
  }
  const given = axis.range && axis.range[0] < axis.range[1] ? axis.range : null;
  let range = given ?? extent(figure, which);
  // what is never negative begins at 0, unless most of the axis would be empty
  if (!given && !axis.log && range[0] > 0 && range[0] < 0.5 * range[1]) range = [0, range[1]];
  const room = which === "x" ? width - (figure.y.names ? 0.5 * width : 84) : heightOf(figure, width) - 58;
  const steps = which === "x" ? stepsOf(figure) : [];
  const isCount = which === "y" && !axis.unit && axis.quantity === "runs";
  const found = steps.length > 0 ? steppedAxis(axis, steps, room) : axis.log ? logAxis(axis, range, room) : linearAxis({ ...axis, isCount }, range, { isTime: which === "x" && figure.time, isAcross: which === "x", count: which === "x" ? Math.max(3, width / 90) : room < 140 ? 3 : 5, room });
  // the title of a vertical axis is beside the longest of its numbers
  const widest = DIGIT * Math.max(0, ...found.texts.map((text) => text.length));
  const beside = Math.max(56, Math.ceil(widest) + 20);
  return { ...style, ...found, axisTick: { ...style.axisTick, ...found.axisTick }, nameGap: which === "x" ? 28 : beside, nameMoveOverlap: false, axisLabel: { ...label, ...found.axisLabel } };
}
