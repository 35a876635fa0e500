// Beside and below the replay: the numbers that change with it, and the marks of the phases on its slider.

import { raised, readable, withUnit } from "./numbers.js";

// The text of a number of one or several components.
function liveText(number, values) {
  if (!values.every(Number.isFinite)) return "not defined";
  if (number.words) return number.words[values[0] <= 0 ? 0 : values[0] < 1 ? 1 : 2];
  if (values.length === 1) return withUnit(Number(values[0].toPrecision(4)), number.unit);
  return `${values.map((value) => readable(value, 4)).join(", ")} ${raised(number.unit)}`;
}

export class LiveNumbers {
  constructor() {
    this.box = document.createElement("dl");
    this.box.className = "numbers live";
  }

  // The numbers of the run of `motion`.
  choose(motion) {
    this.motion = motion;
    const made = motion.run.live.map((number) => {
      const [name, value] = ["dt", "dd"].map((tag) => document.createElement(tag));
      // what may need two lines has them, so that nothing moves while a run plays
      value.className = number.components.length > 1 ? "several" : "";
      name.textContent = number.components.length > 1 ? `${number.name}: ${number.components.join(", ")}` : number.name;
      return [name, value];
    });
    this.values = made.map(([, value]) => value);
    this.box.replaceChildren(...made.flat());
  }

  goTo(time) {
    this.motion.run.live.forEach((number, index) => (this.values[index].textContent = liveText(number, this.motion.live(number, time))));
  }
}

// The beginnings of phases on a slider, as buttons that go there; a name is left out where the one before it leaves no room.
export class PhaseMarks {
  constructor(goTo) {
    this.goTo = goTo;
    this.box = document.createElement("div");
    this.box.className = "marks";
  }

  choose({ run, last }) {
    this.marks = run.marks.map(({ time, name }) => {
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = name.replaceAll("_", " ");
      button.title = `${button.textContent}: ${readable(time)} s`;
      button.dataset.time = String(time);
      button.style.setProperty("--at", String(Math.min(1, time / last)));
      button.addEventListener("click", () => this.goTo(Math.min(time, last)));
      return button;
    });
    this.box.hidden = this.marks.length === 0;
    this.box.replaceChildren(...this.marks);
    this.layout();
  }

  // Hides names that would cover each other.
  layout() {
    let end = -Infinity;
    for (const button of this.marks ?? []) {
      button.classList.remove("bare");
      const { offsetLeft, offsetWidth } = button;
      const isBare = offsetLeft < end || offsetLeft + offsetWidth > this.box.clientWidth;
      button.classList.toggle("bare", isBare);
      if (!isBare) end = offsetLeft + offsetWidth;
    }
  }
}
