// A figure on the page: title, legend, plot, caption; drawn when it comes into view.

import { chartOption, heightOf, legendOf } from "./chart.js";
import { described } from "./hover.js";
import { readable } from "./numbers.js";
import { saveButtons } from "./save.js";
import { clicked, onSelection, runsAt, selectionMarks } from "./select.js";
import { colors, isOnPaper, onTheme } from "./theme.js";

const PAPER_WIDTH = 240;
const WHOLE_PAPER = 700;
const HALF_PAPER = 344; // of figures of drivers, two in a row (page.css)
const views = [];

function element(tag, className, text) {
  const made = document.createElement(tag);
  if (className) made.className = className;
  if (text) made.textContent = text;
  return made;
}

// A title whose long names may be broken after dots and underscores.
function breakable(text) {
  return text.replace(/([._])(?=\w)/g, "$1\u200b");
}

function legendElement(figure) {
  const list = element("ul", "legend");
  const palette = colors();
  for (const entry of legendOf(figure, palette)) {
    const item = element("li");
    const shape = entry.kind === "whiskers" ? `<path d="M1 7h20M1 3v8M21 3v8" stroke="${palette.text}" stroke-width="1.5"/><circle cx="11" cy="7" r="4" fill="${entry.color}"/>` : entry.kind === "line" ? `<line x1="0" y1="7" x2="22" y2="7" stroke="${entry.color}" stroke-width="2"${entry.dash ? ` stroke-dasharray="${entry.dash.join(" ")}"` : ""}/>` : entry.kind === "points" ? (entry.crosses ? `<path d="M7 3l8 8M15 3l-8 8" stroke="${entry.color}" stroke-width="2"/>` : `<circle cx="11" cy="7" r="4" fill="${entry.color}"/>`) : `<rect x="2" y="1" width="18" height="12" fill="${entry.color}" opacity="${entry.opacity}"/>`;
    item.innerHTML = `<svg class="key wide" viewBox="0 0 22 14" aria-hidden="true">${shape}<\/svg>`;
    item.append(entry.label);
    list.append(item);
  }
  return list;
}

// What a legend says, whatever the colour of the body is: neighbours that say the same share one.
function legendKey(figure) {
  return legendOf(figure, colors()).map(({ kind, label, dash, opacity }) => [kind, label, dash, opacity].join()).join(";");
}

// The plot of a figure within `box`, which follows the width of the page.
export class FigureView {
  constructor(figure, echarts) {
    this.figure = figure;
    this.echarts = echarts;
    this.box = element("figure");
    this.box.id = figure.name;
    this.box.style.setProperty("--columns", figure.columns);
    const head = element("div", "head");
    const title = element("h3");
    const link = element("a", "", breakable(figure.title));
    link.href = `#${figure.name}`;
    title.append(link);
    head.append(title, saveButtons(() => this.figure, echarts));
    this.legend = element("div", "legends");
    this.plot = element("div", "plot");
    this.plot.tabIndex = 0;
    this.plot.setAttribute("role", "img");
    this.plot.setAttribute("aria-label", `${figure.title}. ${figure.caption}`);
    this.tip = element("div", "tip");
    this.tip.hidden = true;
    this.cursor = element("div", "cursor");
    this.cursor.hidden = true;
    const caption = element("figcaption", "", figure.caption);
    caption.addEventListener("click", () => caption.classList.toggle("open"));
    this.box.append(head, this.legend, this.plot, caption);
    this.plot.classList.toggle("of-runs", this.isOfRuns());
    this.listen();
    views.push(this);
  }

  // Its legend, unless that of the figure before says it.
  drawLegend() {
    this.legend.replaceChildren(...(this.sharesLegend ? [] : [legendElement(this.figure)]));
  }

  // Takes the room that the drawn figure needs: its legend, and the height of its plot.
  reserve() {
    this.drawLegend();
    this.plot.style.height = `${heightOf(this.figure, Math.max(240, Math.floor(this.plot.clientWidth || 560)))}px`;
  }

  draw() {
    // on paper three figures share the width, or two: each so wide that its text has the size of the text around
    const paper = this.figure.columns === 12 ? WHOLE_PAPER : this.figure.section === "influence" ? HALF_PAPER : PAPER_WIDTH;
    const width = isOnPaper() ? paper : Math.max(240, Math.floor(this.plot.clientWidth));
    if (this.chart && width === this.width && this.palette === colors().background) return;
    [this.width, this.palette] = [width, colors().background];
    const height = heightOf(this.figure, width);
    this.plot.style.height = `${height}px`;
    this.chart?.dispose();
    this.chart = this.echarts.init(this.plot, null, { renderer: "svg", width, height });
    this.selection = selectionMarks(this.figure);
    this.chart.setOption(chartOption({ ...this.figure, marks: [...this.figure.marks, ...this.selection] }, width));
    // so that a printed page may scale it
    this.plot.querySelector("svg").setAttribute("viewBox", `0 0 ${width} ${height}`);
    this.plot.append(this.tip, this.cursor);
    this.drawLegend();
    if (this.time !== undefined) this.moveCursor(this.time);
  }

  // Shows another figure in the same place.
  show(figure) {
    this.figure = figure;
    this.width = 0;
    this.box.querySelector("h3 a").textContent = breakable(figure.title);
    this.box.querySelector("figcaption").textContent = figure.caption;
    this.draw();
  }

  toPixel(x, y) {
    return this.chart.convertToPixel({ gridIndex: 0 }, [x, y]);
  }

  listen() {
    this.plot.addEventListener("pointermove", (event) => {
      const box = this.plot.getBoundingClientRect();
      this.hover([event.clientX - box.left, event.clientY - box.top]);
    });
    this.plot.addEventListener("pointerleave", () => this.leave());
    this.plot.addEventListener("blur", () => this.leave());
    // a figure over time leads the replay, as the replay leads its cursor
    this.plot.addEventListener("click", (event) => {
      if (!this.chart) return;
      const box = this.plot.getBoundingClientRect();
      const at = [event.clientX - box.left, event.clientY - box.top];
      const value = this.chart.convertFromPixel({ gridIndex: 0 }, at);
      // a point may lie on the edge of the axes
      if (!this.figure.time) return this.isOfRuns() && clicked(runsAt(this.figure, at, value, (x, y) => this.toPixel(x, y)));
      if (this.chart.containPixel({ gridIndex: 0 }, at)) document.dispatchEvent(new CustomEvent("replaytime", { detail: value[0] }));
      return undefined;
    });
    this.plot.addEventListener("dblclick", () => this.chart?.dispatchAction({ type: "dataZoom", start: 0, end: 100 }));
    this.plot.addEventListener("keydown", (event) => {
      const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
      if (!step || !this.chart) return;
      event.preventDefault();
      const at = this.pointer ?? [this.width / 2, 100];
      this.hover([Math.min(this.width - 20, Math.max(68, at[0] + step * 6)), at[1]]);
    });
  }

  // Whether it shows runs that a click selects.
  isOfRuns() {
    return this.figure.marks.some((mark) => (mark.kind === "points" && mark.samples.length > 0) || (mark.kind === "bars" && /^(histogram|input)_/.test(this.figure.name)));
  }

  hover(at) {
    if (!this.chart || !this.chart.containPixel({ gridIndex: 0 }, at)) return this.leave();
    this.pointer = at;
    const value = this.chart.convertFromPixel({ gridIndex: 0 }, at);
    const lines = described(this.figure, at, value, (x, y) => this.toPixel(x, y));
    if (lines.length === 0) return this.leave();
    this.tip.replaceChildren(...lines.map((line) => element("div", "", line)));
    this.tip.hidden = false;
    const left = at[0] + 14 + this.tip.offsetWidth > this.width ? at[0] - 14 - this.tip.offsetWidth : at[0] + 14;
    this.tip.style.transform = `translate(${Math.max(0, left)}px, ${Math.max(0, at[1] - 20)}px)`;
    return undefined;
  }

  leave() {
    this.tip.hidden = true;
  }

  // Moves the cursor of a figure over time to `time`.
  moveCursor(time) {
    this.time = time;
    if (!this.figure.time || !this.chart) return;
    const [x] = this.toPixel(time, 0);
    const isInside = time > 0 && !(time > this.figure.x.range?.[1]) && Number.isFinite(x) && x >= 60 && x <= this.width;
    this.cursor.hidden = !isInside;
    if (isInside) {
      this.cursor.style.transform = `translateX(${x}px)`;
      this.cursor.dataset.time = `${readable(time, 4)} s`;
    }
  }
}

export function moveCursors(time) {
  for (const view of views) view.moveCursor(time);
}

// Draws one figure after the other whenever the browser has nothing else to do, so that a capture of the whole page and a search in it see all.
function drawWhenIdle() {
  const next = views.find((view) => !view.chart && view.plot.clientWidth > 0);
  if (!next) return;
  next.draw();
  (globalThis.requestIdleCallback ?? setTimeout)(drawWhenIdle);
}

// Puts the figures into their sections; each is drawn when it comes near the screen or the browser is idle, all of them for print.
export function showFigures(figures, echarts) {
  const near = new IntersectionObserver(
    (entries) => {
      for (const entry of entries) if (entry.isIntersecting) views.find((view) => view.plot === entry.target)?.draw();
    },
    { rootMargin: "800px" },
  );
  const said = new Set();
  const before = new Map();
  for (const figure of figures) {
    const view = new FigureView(figure, echarts);
    // what a section has said of bands need not be said at each of its figures
    const caption = `${figure.section} ${figure.caption}`;
    view.box.querySelector("figcaption").hidden = figure.time && said.has(caption);
    said.add(caption);
    const place = document.querySelector(`[data-figure~="${figure.name}"]`) ?? document.querySelector(`#${figure.section} .figures`);
    const key = legendKey(figure);
    view.sharesLegend = before.get(place) === key;
    before.set(place, key);
    place.append(view.box);
  }
  // so that nothing moves when they are drawn: links land where they point
  for (const view of views) view.reserve();
  for (const view of views) near.observe(view.plot);
  const redraw = () => views.filter((view) => view.chart).forEach((view) => view.draw());
  new ResizeObserver(() => requestAnimationFrame(redraw)).observe(document.querySelector("main"));
  onTheme(redraw);
  onSelection(() => {
    for (const view of views) {
      if (!view.chart || (view.selection.length === 0 && selectionMarks(view.figure).length === 0)) continue;
      view.width = 0;
      view.draw();
    }
  });
  for (const fold of document.querySelectorAll("details.fold, details.input")) fold.addEventListener("toggle", drawWhenIdle);
  (globalThis.requestIdleCallback ?? setTimeout)(drawWhenIdle);
  addEventListener("beforeprint", () => drawAll());
}

// Draws every figure, in view or not.
export function drawAll() {
  for (const view of views) view.draw();
}

// Where a point of a run is in the first scatter plot, pixels of its plot; null without one: for tests of the page.
export function placeOfRun() {
  for (const view of views) {
    const mark = view.chart && view.figure.name.startsWith("scatter_") && view.figure.marks.find((one) => one.kind === "points" && one.samples.length > 0);
    if (mark) return { figure: view.figure.name, at: Array.from(view.toPixel(mark.x[0], mark.y[0])) };
  }
  return null;
}
