// From what a figure shows to what ECharts draws.

import { axisOption, DIGIT, FONT, LETTER, NAMES } from "./axes.js";
import { colors, isOnPaper } from "./theme.js";

const LABEL = 15; // height of a row of names above the axes
const FLIGHT = 14; // height of the strip of runs in flight

// Pairs [x, y] that can be shown.
function pairs(mark, figure) {
  const list = [];
  for (let k = 0; k < mark.x.length; k += 1) {
    const [x, y] = [mark.x[k], mark.y[k]];
    if (Number.isFinite(x) && Number.isFinite(y) && !(figure.x.log && x <= 0) && !(figure.y.log && y <= 0)) list.push([x, y]);
  }
  return list;
}

function lineSeries(mark, figure, color) {
  return { type: "line", data: pairs(mark, figure), showSymbol: false, silent: true, lineStyle: { color, width: 1.6, type: mark.dash ?? "solid" }, itemStyle: { color }, clip: true };
}

function pointSeries(mark, figure, color) {
  if (mark.stems) {
    const list = pairs(mark, figure);
    return drawn(list, { x: 0, y: 1 }, (to) =>
      list.flatMap(([value, height]) => {
        const [[x, y], [, bottom]] = [to(value, height), to(value, 0)];
        return [
          { type: "line", shape: { x1: x, y1: bottom, x2: x, y2: y }, style: { stroke: color, lineWidth: 1.6 } },
          { type: "circle", shape: { cx: x, cy: y, r: 3 }, style: { fill: color } },
        ];
      }),
    );
  }
  if (mark.rings) return { type: "scatter", data: pairs(mark, figure), symbol: "circle", symbolSize: 10, silent: true, itemStyle: { color: "transparent", borderColor: color, borderWidth: 2.2 }, clip: true };
  const count = mark.x.length;
  const size = count > 600 ? 4 : count > 100 ? 5 : 8;
  const cross = "path://M-1,-0.75L-0.75,-1L0,-0.25L0.75,-1L1,-0.75L0.25,0L1,0.75L0.75,1L0,0.25L-0.75,1L-1,0.75L-0.25,0Z";
  return { type: "scatter", data: pairs(mark, figure), symbol: mark.crosses ? cross : "circle", symbolSize: mark.crosses ? 8 : size, silent: true, itemStyle: { color, opacity: count > 100 && !mark.crosses ? 0.55 : 1 }, clip: true };
}

// A series whose first element draws all: `shapes(to)` returns them, `to` maps values to pixels; so many pixels `above` the axes are seen too.
function drawn(data, encode, shapes, above = 0) {
  const renderItem = (params, api) => {
    if (params.dataIndexInside !== 0) return null;
    const box = params.coordSys;
    return { type: "group", children: shapes((x, y) => api.coord([x, y]), box, api), clipPath: { type: "rect", shape: { x: box.x, y: box.y - above, width: box.width, height: box.height + above } } };
  };
  return { type: "custom", data, encode, renderItem, silent: true, clip: false, animation: false };
}

function bandSeries(mark, figure, color) {
  const rows = [];
  for (let k = 0; k < mark.x.length; k += 1) {
    const row = [mark.x[k], mark.low[k], mark.high[k]];
    if (row.every(Number.isFinite) && !(figure.x.log && row[0] <= 0) && !(figure.y.log && row[1] <= 0)) rows.push(row);
  }
  return drawn(rows, { x: 0, y: [1, 2] }, (place) => {
    // between the names of an axis there is nothing: places there are those of the first two names, continued
    const [first, next] = figure.y.names ? [place(0, 0)[1], place(0, 1)[1]] : [];
    const step = figure.y.names?.length > 1 ? next - first : 26;
    const to = figure.y.names ? (x, y) => [place(x, 0)[0], first + y * step] : place;
    const points = [...rows.map(([x, low]) => to(x, low)), ...[...rows].reverse().map(([x, , high]) => to(x, high))];
    return points.length > 2 ? [{ type: "polygon", shape: { points }, style: { fill: color, opacity: mark.opacity } }] : [];
  });
}

function barSeries(mark, figure, color) {
  const rows = Array.from(mark.heights, (height, k) => [mark.edges[k], mark.edges[k + 1], height]);
  return drawn(rows, { x: [0, 1], y: 2 }, (to) =>
    rows.filter((row) => row[2] > 0).map(([low, high, height]) => {
      const [[left, bottom], [right, top]] = [to(low, 0), to(high, height)];
      return { type: "rect", shape: { x: left, y: top, width: Math.max(1, right - left - 0.5), height: bottom - top }, style: { fill: color, opacity: mark.opacity ?? 0.55 } };
    }),
  );
}

function whiskerSeries(mark, figure, color, palette) {
  const rows = Array.from(mark.x, (value, k) => [value, k, mark.low[k], mark.high[k]]);
  return drawn(rows, { x: [0, 2, 3], y: 1 }, (to) =>
    rows.filter((row) => Number.isFinite(row[0])).flatMap(([value, row, low, high]) => {
      const [[zero, y], [end]] = [to(0, row), to(value, row)];
      const shapes = [{ type: "rect", shape: { x: Math.min(zero, end), y: y - 7, width: Math.abs(end - zero), height: 14 }, style: { fill: color, opacity: 0.35 } }];
      if (Number.isFinite(low) && Number.isFinite(high)) {
        const [[x1], [x2]] = [to(low, row), to(high, row)];
        shapes.push({ type: "line", shape: { x1, y1: y, x2, y2: y }, style: { stroke: palette.text, lineWidth: 1.5 } });
        for (const x of [x1, x2]) shapes.push({ type: "line", shape: { x1: x, y1: y - 4, x2: x, y2: y + 4 }, style: { stroke: palette.text, lineWidth: 1.5 } });
      }
      shapes.push({ type: "circle", shape: { cx: end, cy: y, r: 4 }, style: { fill: color } });
      return shapes;
    }),
  );
}

// The name of a limit as it fits into `room` pixels: without when it holds, then with a sign for "at most" and "at least".
export function fittedName(name, room) {
  const shorter = [[/ at the [a-z ]+$/, ""], [/^at most /, "\u2264 "], [/^at least /, "\u2265 "]];
  return shorter.reduce((text, [from, to]) => (LETTER * (text.length + 2) > room ? text.replace(from, to) : text), name);
}

// The name of a vertical limit at `x` as it fits beside its line.
function nameBeside(mark, x, box) {
  const isInside = x >= box.x - 1 && x <= box.x + box.width + 1;
  return fittedName(mark.label, isInside ? Math.max(x - box.x, box.x + box.width - x) : box.width);
}

// Where the name of a vertical limit at `x`, so many pixels wide, begins: right of its line, or left of it, or within the axes where it has room on
// neither side.
function nameStart(x, width, box) {
  const right = box.x + box.width;
  if (x - width >= box.x && (x > box.x + 0.7 * box.width || x + width > right)) return Math.min(x, right) - width;
  return Math.max(box.x, Math.min(x, right - width));
}

// The rows of the names of vertical limits, which stand above the axes, where they cover no bar, no line crosses them and they cover each other neither: for each mark its row from below.
// `place` gives where a value is, pixels; `box` is what the axes enclose.
function labelRows(figure, place, box) {
  const [rows, found] = [[], new Map()];
  const open = figure.marks.filter((mark) => mark.kind === "limit" && mark.vertical && mark.label).map((mark) => {
    const x = place(mark.at);
    const width = LETTER * (nameBeside(mark, x, box).length + 3);
    const start = nameStart(x, width, box);
    return { mark, x, start, end: start + width };
  });
  const covers = (name, { x }) => name.start < x && x < name.end;
  const placed = [];
  while (open.length > 0) {
    // the line of a name ends at its row: what follows stands above
    const next = open.find((one) => !open.some((other) => other !== one && covers(one, other))) ?? open[0];
    open.splice(open.indexOf(next), 1);
    let row = Math.max(0, ...placed.filter((other) => covers(next, other)).map((other) => found.get(other.mark) + 1));
    while (rows[row]?.some(({ start, end }) => next.start < end && next.end > start)) row += 1;
    (rows[row] ??= []).push(next);
    placed.push(next);
    found.set(next.mark, row);
  }
  return found;
}

// Where a value of the axis `option` is in `box`, pixels.
function placeOn(option, box) {
  const map = option.type === "log" ? Math.log : (value) => value;
  const [low, high] = [map(option.min), map(option.max)];
  return (value) => box.x + (box.width * (map(value) - low)) / (high - low);
}

// The value in the middle of an axis.
function middleOf(axis) {
  return axis.type === "category" ? 0 : axis.type === "log" ? Math.sqrt(axis.min * axis.max) : 0.5 * (axis.min + axis.max);
}

// `across` are the limits across the figure.
function limitSeries(mark, palette, [xs, ys], row, across) {
  // the series has a point within the axes: one outside of them would not be drawn
  const data = [[middleOf(xs), middleOf(ys)]];
  return drawn(data, { x: 0, y: 1 }, (to, box) => {
    const [x, y] = to(...(mark.vertical ? [mark.at, data[0][1]] : [data[0][0], mark.at]));
    const dash = { stroke: palette.quiet, lineWidth: 1, lineDash: [5, 4] };
    // a halo, so that a curve behind it does not cross it out
    const name = mark.vertical ? nameBeside(mark, x, box) : fittedName(mark.label, box.width);
    const text = { text: name, fill: palette.quiet, font: `12px ${FONT}`, stroke: palette.background, lineWidth: 3 };
    const above = box.y - LABEL * row - 4;
    const [isLow, isHigh] = mark.vertical ? [!(x >= box.x - 1), x > box.x + box.width + 1] : [y > box.y + box.height + 1, y < box.y - 1];
    if (isLow || isHigh) {
      // outside of the axes: named at the edge beyond which it is
      const arrow = mark.vertical ? (isLow ? "←" : "→") : isLow ? "↓" : "↑";
      const named = { ...text, text: name ? `${arrow} ${name}` : "" };
      const isRight = mark.vertical && isHigh;
      const isBottom = !mark.vertical && isLow;
      return [{ type: "text", x: isRight ? box.x + box.width - 4 : box.x + 4, y: mark.vertical ? above : isBottom ? box.y + box.height - 4 : box.y + 4, style: { ...named, align: isRight ? "right" : "left", verticalAlign: mark.vertical || isBottom ? "bottom" : "top" } }];
    }
    if (mark.vertical) {
      const width = LETTER * (name.length + 3);
      const start = nameStart(x, width, box);
      // its end is at the line, or at the edge of the axes
      const end = start + width <= x + 1 ? x - 4 : start < x - 1 ? box.x + box.width : null;
      return [
        { type: "line", shape: { x1: x, y1: above - (mark.label ? 10 : 0), x2: x, y2: box.y + box.height }, style: dash },
        { type: "text", x: end ?? x + 4, y: above, style: { ...text, align: end === null ? "left" : "right", verticalAlign: "bottom" } },
      ];
    }
    // lines that have no room for a name between them have theirs above all of them, or below, in their order
    const levelOf = (one) => to(data[0][0], one.at)[1];
    const near = across.filter((other) => Math.abs(levelOf(other) - y) < LABEL + 3).sort((one, other) => levelOf(other) - levelOf(one));
    const levels = [y, ...near.map(levelOf)];
    const isTop = Math.min(...levels) - LABEL * Math.max(1, near.length) - 5 < box.y;
    const rank = Math.max(0, isTop ? near.length - 1 - near.indexOf(mark) : near.indexOf(mark));
    const named = isTop ? Math.max(...levels) + 3 + LABEL * rank : Math.min(...levels) - 3 - LABEL * rank;
    return [
      { type: "line", shape: { x1: box.x, y1: y, x2: box.x + box.width, y2: y }, style: dash },
      { type: "text", x: box.x + box.width - 4, y: named, style: { ...text, align: "right", verticalAlign: isTop ? "top" : "bottom" } },
    ];
  }, mark.vertical ? LABEL * (row + 1) + 4 : 0);
}

// The runs in flight, as a strip under the axis whose height is their share.
function flightSeries(mark, color, axes) {
  // the series has a point within the axes: one outside of them would not be drawn
  const middle = axes.map(middleOf);
  const rows = Array.from(mark.x, (time, k) => [time, mark.counts[k] / mark.runs]);
  const renderItem = (params, api) => {
    if (params.dataIndexInside !== 0) return null;
    const box = params.coordSys;
    const floor = box.y + box.height + FLIGHT - 2;
    const inside = (x) => Math.min(Math.max(x, box.x), box.x + box.width);
    const places = rows.map(([time, share]) => [inside(api.coord([time, middle[1]])[0]), floor - (FLIGHT - 4) * share]);
    const points = [...places, [places.at(-1)[0], floor], [places[0][0], floor]];
    return { type: "polygon", shape: { points }, style: { fill: color, opacity: mark.opacity } };
  };
  return { type: "custom", data: [middle], encode: { x: 0, y: 1 }, renderItem, silent: true, clip: false, animation: false };
}

function matrixSeries(mark, figure, palette) {
  const count = figure.y.names.length;
  const rows = Array.from(mark.values, (r, k) => [k % count, Math.floor(k / count), r]);
  return drawn(rows, { x: 0, y: 1 }, (to) => {
    const [[x0, y0], [x1, y1]] = [to(0, 0), to(1, 1)];
    const [width, height] = [Math.abs(x1 - x0), Math.abs(y1 - y0)];
    return rows.flatMap(([column, row, r]) => {
      const [x, y] = to(column, row);
      const fill = r < 0 ? palette.hues[1] : palette.hues[0];
      const cell = { type: "rect", shape: { x: x - width / 2 + 0.5, y: y - height / 2 + 0.5, width: width - 1, height: height - 1 }, style: { fill, opacity: Math.min(1, Math.abs(r)) } };
      const text = { type: "text", x, y, style: { text: r.toFixed(2).replace("-0.00", "0.00"), fill: Math.abs(r) > 0.6 ? palette.background : palette.text, font: `11px ${FONT}`, align: "center", verticalAlign: "middle" } };
      return width >= 34 && height >= 14 ? [cell, text] : [cell];
    });
  });
}

// Marks that the legend names, each name once.
export function legendOf(figure, palette) {
  const seen = new Set();
  const entries = [];
  const beneath = new Map();
  for (const mark of figure.marks) {
    // a band on top of others of its colour is as dark as all of them together
    const left = mark.kind === "band" && !mark.stacked ? (beneath.get(mark.hue) ?? 1) * (1 - mark.opacity) : 1 - (mark.opacity ?? 0.55);
    if (mark.kind === "band" && !mark.stacked) beneath.set(mark.hue, left);
    if (!mark.label || mark.kind === "limit" || mark.kind === "matrix" || seen.has(mark.label)) continue;
    seen.add(mark.label);
    entries.push({ label: mark.label, color: palette.hues[mark.hue], kind: mark.kind, opacity: 1 - left, dash: mark.dash, crosses: mark.crosses });
  }
  return entries.length > 1 || entries.some((entry) => entry.kind !== "bars") ? entries : [];
}

// The height of the strip of runs in flight; zero without one.
function flightOf(figure) {
  return figure.marks.some((mark) => mark.kind === "flight") ? FLIGHT : 0;
}

// The height of a figure that is `width` pixels wide.
export function heightOf(figure, width) {
  // on paper, too, the names of limits leave room for the plot
  const limits = figure.marks.filter((mark) => mark.kind === "limit" && mark.vertical && mark.label).length;
  const plot = (width < 300 ? 168 : width < 600 ? 190 : 260) + LABEL * Math.max(0, limits - 1);
  if (isOnPaper() && !figure.x.names) return figure.y.names ? 62 + 17 * figure.y.names.length + flightOf(figure) : plot;
  if (figure.x.names) return Math.min(640, 60 + Math.max(18, Math.min(34, (width - 260) / figure.y.names.length)) * figure.y.names.length);
  if (figure.y.names) return 70 + 26 * figure.y.names.length + flightOf(figure);
  return Math.round(Math.max(210, Math.min(320, 0.56 * width)));
}

// The option of ECharts for `figure` at `width` pixels.
export function chartOption(figure, width, palette = colors()) {
  const axes = [axisOption(figure, "x", palette, width), axisOption(figure, "y", palette, width)];
  const color = (mark) => palette.hues[mark.hue];
  const makers = {
    line: (mark) => lineSeries(mark, figure, color(mark)),
    points: (mark) => pointSeries(mark, figure, color(mark)),
    band: (mark) => bandSeries(mark, figure, color(mark)),
    bars: (mark) => barSeries(mark, figure, color(mark)),
    whiskers: (mark) => whiskerSeries(mark, figure, color(mark), palette),
    limit: (mark) => limitSeries(mark, palette, axes, rows.get(mark) ?? 0, figure.marks.filter((one) => one.kind === "limit" && !one.vertical && one.label)),
    matrix: (mark) => matrixSeries(mark, figure, palette),
    flight: (mark) => flightSeries(mark, color(mark), axes),
  };
  const strip = flightOf(figure);
  const right = Math.max(18, Math.ceil(0.5 * DIGIT * (axes[0].texts?.at(-1) ?? "").length) + 2);
  const extra = (axis) => 15 * ((axis.name ?? "").split("\n").length - 1); // of a title in two lines
  const names = figure.y.names ? Math.min(NAMES * width, 16 + LETTER * Math.max(...axes[1].data.map((name) => name.length))) : axes[1].nameGap + 20 + extra(axes[1]);
  const box = { x: names, width: width - names - right };
  const rows = labelRows(figure, placeOn(axes[0], box), box);
  const top = 14 + LABEL * (rows.size > 0 ? Math.max(...rows.values()) + 1 : 0);
  const zoom = figure.x.names || figure.y.names ? [] : [{ type: "inside", xAxisIndex: 0, filterMode: "none", zoomOnMouseWheel: "ctrl", moveOnMouseMove: "ctrl", moveOnMouseWheel: false, preventDefaultMouseMove: false }];
  return {
    animation: false,
    backgroundColor: "transparent",
    grid: { left: names, right, top, bottom: 46 + strip + extra(axes[0]), outerBoundsMode: "none" },
    xAxis: strip ? { ...axes[0], nameGap: axes[0].nameGap + strip, axisLabel: { ...axes[0].axisLabel, margin: 8 + strip } } : axes[0],
    yAxis: axes[1],
    dataZoom: zoom,
    series: figure.marks.map((mark) => ({ ...makers[mark.kind](mark), z: 2 })),
  };
}
