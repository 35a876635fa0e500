// A figure as SVG, PNG or CSV.

import { chartOption, heightOf, legendOf } from "./chart.js";
import { colors } from "./theme.js";

const WIDTH = 760;
const FONT_NAME = "system-ui, -apple-system, 'Segoe UI', Roboto, sans-serif";

function download(name, blob) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

// Title and legend as elements of ECharts, in rows; returns them and their height.
function heading(figure, palette) {
  const text = (value, left, top, size, fill) => ({ type: "text", left, top, silent: true, style: { text: value, fill, font: `${size}px ${FONT_NAME}` } });
  const elements = [text(figure.title, 14, 12, 17, palette.text)];
  let [left, top] = [14, 42];
  for (const entry of legendOf(figure, palette)) {
    const width = 24 + 6.8 * entry.label.length;
    if (left + width > WIDTH - 14) [left, top] = [14, top + 20];
    elements.push({ type: "rect", left, top: top + 2, silent: true, shape: { width: 12, height: entry.kind === "line" ? 3 : 10 }, style: { fill: entry.color, opacity: entry.kind === "line" ? 1 : entry.opacity } });
    elements.push(text(entry.label, left + 17, top, 12, palette.text));
    left += width + 14;
  }
  return { elements, height: top + 26 };
}

// The figure as the text of an SVG file: light colours, title and legend in it.
export function svgText(figure, echarts) {
  const palette = colors(false);
  const { elements, height } = heading(figure, palette);
  const size = { width: WIDTH, height: heightOf(figure, WIDTH) + 60 + height };
  const chart = echarts.init(null, null, { renderer: "svg", ssr: true, ...size });
  const option = chartOption(figure, WIDTH, palette);
  chart.setOption({ ...option, backgroundColor: "#ffffff", grid: { ...option.grid, top: height }, graphic: elements });
  const text = chart.renderToSVGString();
  chart.dispose();
  return text;
}

async function pngBlob(figure, echarts) {
  const image = new Image();
  image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(svgText(figure, echarts))}`;
  await image.decode();
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [2 * image.width, 2 * image.height];
  canvas.getContext("2d").drawImage(image, 0, 0, canvas.width, canvas.height);
  return new Promise((resolve) => canvas.toBlob(resolve, "image/png"));
}

// The numbers of a figure: one block of columns for each mark.
export function csvText(figure) {
  const quoted = (text) => `"${String(text).replaceAll('"', '""')}"`;
  const head = (axis) => [axis.quantity, axis.unit && `(${axis.unit})`].filter(Boolean).join(" ");
  const lines = [];
  for (const mark of figure.marks) {
    if (mark.kind === "limit") {
      lines.push(`${quoted(mark.label || "limit")},${mark.at}`, "");
      continue;
    }
    if (mark.kind === "matrix") {
      const names = figure.y.names;
      lines.push(["", ...names].map(quoted).join(","));
      names.forEach((name, row) => lines.push([quoted(name), ...mark.values.slice(row * names.length, (row + 1) * names.length)].join(",")));
      continue;
    }
    const columns = mark.kind === "bars" ? { from: mark.edges, [mark.label]: mark.heights } : {};
    if (mark.kind === "whiskers") Object.assign(columns, { name: figure.y.names.map(quoted), value: mark.x, low: mark.low, high: mark.high });
    if (mark.kind === "flight") Object.assign(columns, { [head(figure.x)]: mark.x, [mark.label]: mark.counts });
    if (mark.samples?.length) columns.sample = mark.samples;
    if (mark.kind === "line" || mark.kind === "points") Object.assign(columns, { [head(figure.x)]: mark.x, [`${mark.label}: ${head(figure.y)}`]: mark.y });
    // a strip of a row of names is what begins and ends there
    const row = mark.kind === "band" && !mark.label ? figure.y.names?.[Math.round((mark.low[0] + mark.high[0]) / 2)] : undefined;
    if (row !== undefined) Object.assign(columns, { name: [quoted(row)], [`begin: ${head(figure.x)}`]: [mark.x[0]], [`end: ${head(figure.x)}`]: [mark.x.at(-1)] });
    else if (mark.kind === "band") Object.assign(columns, { [head(figure.x)]: mark.x, [`${mark.label}, low`]: mark.low, [`${mark.label}, high`]: mark.high });
    lines.push(Object.keys(columns).map(quoted).join(","));
    const values = Object.values(columns);
    for (let k = 0; k < values[0].length; k += 1) lines.push(values.map((column) => column[k] ?? "").join(","));
    lines.push("");
  }
  return `${lines.join("\n")}\n`;
}

// Buttons that save the figure that `current` returns.
export function saveButtons(current, echarts) {
  const makers = {
    SVG: async (figure) => new Blob([svgText(figure, echarts)], { type: "image/svg+xml" }),
    PNG: (figure) => pngBlob(figure, echarts),
    CSV: async (figure) => new Blob([csvText(figure)], { type: "text/csv" }),
  };
  const group = document.createElement("span");
  group.className = "save";
  for (const [name, make] of Object.entries(makers)) {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = name;
    button.title = `Save this figure as ${name}`;
    button.addEventListener("click", async () => download(`${current().name}.${name.toLowerCase()}`, await make(current())));
    group.append(button);
  }
  return group;
}
