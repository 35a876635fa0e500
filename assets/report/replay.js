// The 3D replay: nominal and worst runs, with a time slider that moves the cursor of every figure over time.

import { moveCursors } from "./figure.js";
import { readable } from "./numbers.js";
import { HUE_PLACES, colors, onTheme } from "./theme.js";
import { Motion, rotated } from "./motion.js";
import { Approach } from "./approach.js";
import { LiveNumbers, PhaseMarks } from "./live.js";
import { Sky, skyEntries } from "./sky.js";
import { arrow, axes, bodyGroup, curve, debrisGroup, plateGroup, pointTo, quaternionOf, sphere, thrusterGroup, wheelGroup } from "./bodies.js";

// the speed at first: all of the run in this time, s
const WHOLE_IN = 20;
const SPEEDS = [0.05, 0.1, 0.25, 0.5, 1, 2, 5, 10, 50, 100];
// faster than this a wheel is a blur, and pictures of it seem to stand still or turn backwards
const FASTEST_SEEN = 2 * Math.PI;

function control(tag, attributes, text) {
  const made = document.createElement(tag);
  Object.assign(made, attributes);
  if (text) made.textContent = text;
  return made;
}

// The size of the spacecraft, m: what fills the picture.
function sizeOf(scene) {
  const reach = (position, size) => Math.hypot(...position.map((value, axis) => value - scene.center[axis])) + Math.max(0.05, ...size) * 0.7;
  const all = [...scene.parts.map((part) => reach(part.position, part.size)), ...scene.plates.map((plate) => reach(plate.center, [plate.side])), ...scene.wheels.map((wheel) => reach(wheel.position, [wheel.radius])), ...scene.thrusters.map((thruster) => reach(thruster.position, [0.1]))];
  return Math.max(0.2, ...all);
}

export class Replay {
  constructor(data, three, place) {
    this.three = three;
    this.data = data;
    this.place = place;
    this.size = sizeOf(data.scene);
    this.time = 0;
    this.isPlaying = false;
    this.camera = new three.PerspectiveCamera(40, 1.6, 0.01 * this.size, 400 * this.size);
    // the nominal run, where it is one of those that are shown
    this.nominal = data.runs[0].sample === 0 ? new Motion(data.runs[0], data.scene.wheels.length) : null;
    this.camera.up.set(0, 0, 1);
    this.renderer = new three.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
    this.controls = new three.OrbitControls(this.camera, this.renderer.domElement);
    this.controls.enableDamping = false;
    this.controls.addEventListener("change", () => this.render());
    this.build();
    this.layout();
    // the worst run is the one to look at
    this.choose(Math.min(1, data.runs.length - 1));
    this.view("inertial");
    onTheme(() => {
      this.build();
      this.show();
    });
    new ResizeObserver(() => this.resize()).observe(this.stage);
    place.addEventListener("fullscreenchange", () => this.resize());
  }

  build() {
    const { three, data, size } = this;
    const palette = colors();
    this.palette = palette;
    this.world = new three.Scene();
    this.world.add(new three.AmbientLight("#ffffff", 1.6));
    const sun = new three.DirectionalLight("#ffffff", 2.2);
    sun.position.set(3, 2, 4);
    this.world.add(sun);
    this.craft = new three.Group();
    const inner = new three.Group();
    inner.position.set(...data.scene.center.map((value) => -value));
    inner.add(bodyGroup(three, data.scene, palette), plateGroup(three, data.scene, palette));
    this.wheels = data.scene.wheels.map((wheel, index) => wheelGroup(three, wheel, index, palette));
    this.thrusters = data.scene.thrusters.map((thruster) => thrusterGroup(three, thruster, size, palette));
    for (const { group } of [...this.wheels, ...this.thrusters]) inner.add(group);
    this.craft.add(inner, axes(three, 0.75 * size, palette.hues[HUE_PLACES.body]));
    this.ghost = new three.Group();
    const ghost = bodyGroup(three, data.scene, palette, palette.quiet);
    ghost.position.copy(inner.position);
    this.ghost.add(ghost);
    // what is drawn about the spacecraft, and is too large beside an approach at scale
    this.local = new three.Group();
    this.local.add(axes(three, 1.5 * size, palette.quiet), sphere(three, 1.6 * size, palette.quiet));
    this.approach = data.scene.debris ? new Approach(three, data.scene, palette) : null;
    if (this.approach) this.world.add(this.approach.group);
    this.world.add(this.craft, this.ghost, this.local);
    this.arrows = { s3: palette.hues[6], momentum: palette.hues[7], omega: palette.hues[HUE_PLACES.omega] };
    for (const [name, color] of Object.entries(this.arrows)) {
      this.arrows[name] = arrow(three, color, 0.012);
      this.local.add(this.arrows[name]);
    }
    this.debris = data.scene.debris ? debrisGroup(three, data.scene.debris, palette) : null;
    if (this.debris) this.world.add(this.debris);
    // the line of sight, and the launch axis through the debris
    this.sight = this.debris ? arrow(three, palette.quiet, 0.006) : null;
    this.launchAxis = this.debris && data.runs.some((run) => run.goal) ? arrow(three, palette.hues[HUE_PLACES.debris], 0.008) : null;
    for (const line of [this.sight, this.launchAxis]) if (line) this.local.add(line);
    this.sky = new Sky(three, data.runs, size, palette);
    this.local.add(this.sky.group);
    this.trailGroup = new three.Group();
    this.local.add(this.trailGroup);
    this.renderer.setClearColor(palette.background);
    if (this.motion) this.drawPaths();
  }

  drawPaths() {
    this.approach?.show(this.motion, this.hasGhost() ? this.nominal : null);
    const points = this.motion.trail();
    this.trailGroup.clear();
    this.trailGroup.add(curve(this.three, points, 1.6 * this.size, this.palette.hues[6]));
  }

  // Whether the nominal run is shown beside this one.
  hasGhost() {
    return Boolean(this.wantsGhost && this.nominal && this.motion.run.sample !== 0);
  }

  layout() {
    this.stage = control("div", { className: "stage" });
    this.stage.append(this.renderer.domElement);
    this.stage.tabIndex = 0;
    this.stage.setAttribute("role", "application");
    this.stage.setAttribute("aria-label", "Replay in three dimensions. Space plays and pauses, arrows step, 1 2 3 4 choose the camera.");
    const bar = control("div", { className: "controls" });
    const button = (text, title, action) => {
      const made = control("button", { type: "button", title }, text);
      made.addEventListener("click", action);
      bar.append(made);
      return made;
    };
    this.runs = control("select", { title: "Run", className: "run" });
    this.runs.setAttribute("aria-label", "Run");
    this.data.runs.forEach((run, index) => this.runs.append(new Option(run.sample === 0 ? run.name : `${run.name}: ${run.why}`, index)));
    this.runs.addEventListener("change", () => this.choose(Number(this.runs.value)));
    bar.append(this.runs);
    this.playButton = button("Play", "Play or pause (space)", () => this.toggle());
    button("◀", "One step back (left arrow)", () => this.step(-1));
    button("▶", "One step forward (right arrow)", () => this.step(1));
    this.speed = control("select", { title: "Speed" });
    this.speed.setAttribute("aria-label", "Speed");
    this.speed.append(new Option(`all in ${WHOLE_IN} s`, "whole", true, true));
    SPEEDS.forEach((speed) => this.speed.append(new Option(`${speed} ×`, speed)));
    bar.append(this.speed);
    const cameras = this.data.scene.debris ? ["inertial", "body", "chase", "approach"] : ["inertial", "body", "chase"];
    for (const name of cameras) button(name, `Camera: ${name}`, () => this.view(name)).dataset.camera = name;
    this.ghostButton = button("nominal too", "Show the nominal run beside this one", () => this.toggleGhost());
    this.skyButton = skyEntries(this.data.runs).length > 0 ? button("orbit", "Show the directions of the orbit", () => this.toggleSky()) : null;
    this.skyButton?.setAttribute("aria-pressed", "true");
    if (this.place.requestFullscreen) button("full screen", "Full screen (f)", () => this.fullScreen());
    this.slider = control("input", { type: "range", min: 0, step: "any", value: 0, className: "time" });
    this.slider.setAttribute("aria-label", "Time");
    this.slider.addEventListener("input", () => this.goTo(Number(this.slider.value)));
    this.clock = control("output", { className: "clock" });
    this.notes = control("p", { className: "caption" });
    const legend = control("ul", { className: "legend" });
    const entries = [
      ["s3, spin axis, with its trail on the sphere", 6], ["H, angular momentum", 7], ["omega, angular velocity", HUE_PLACES.omega], ["body, axes of F_s", HUE_PLACES.body],
      ...this.data.scene.wheels.map((wheel, index) => [`wheel ${wheel.name}`, HUE_PLACES.wheels[index % HUE_PLACES.wheels.length]]),
      ...(this.data.scene.debris ? [["debris", HUE_PLACES.debris]] : []), ...skyEntries(this.data.runs).map(([, entry]) => entry), ["axes of F_e", 8],
    ];
    const paint = () => legend.replaceChildren(...entries.map(([text, hue]) => {
      const item = control("li", {}, text);
      item.insertAdjacentHTML("afterbegin", `<svg class="key" viewBox="0 0 14 14" aria-hidden="true"><rect y="5" width="14" height="4" fill="${colors().hues[hue]}"/><\/svg>`);
      return item;
    }));
    paint();
    onTheme(paint);
    this.live = new LiveNumbers();
    this.marks = new PhaseMarks((time) => this.goTo(time));
    this.numbers = control("dl", { className: "numbers ends" });
    const beside = control("div", { className: "beside" });
    const column = control("div");
    column.append(this.live.box, this.numbers);
    beside.append(this.stage, column);
    this.place.replaceChildren(bar, beside, this.slider, this.marks.box, this.clock, legend, this.notes);
    this.stage.addEventListener("keydown", (event) => this.key(event));
    this.resize();
  }

  key(event) {
    const cameras = { 1: "inertial", 2: "body", 3: "chase", ...(this.approach ? { 4: "approach" } : {}) };
    if (event.key === " ") this.toggle();
    else if (event.key === "ArrowLeft") this.step(-1);
    else if (event.key === "ArrowRight") this.step(1);
    else if (event.key === "Home") this.goTo(0);
    else if (event.key === "End") this.goTo(this.motion.last);
    else if (event.key === "f") this.fullScreen();
    else if (cameras[event.key]) this.view(cameras[event.key]);
    else return;
    event.preventDefault();
  }

  resize() {
    const width = Math.max(240, this.stage.clientWidth);
    const isFull = document.fullscreenElement === this.place;
    const height = Math.round(isFull ? Math.max(240, innerHeight - 230) : Math.min(560, 0.6 * width));
    this.renderer.setPixelRatio(Math.min(2, devicePixelRatio));
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.marks.layout();
    this.render();
  }

  fullScreen() {
    if (document.fullscreenElement === this.place) document.exitFullscreen();
    else this.place.requestFullscreen();
  }

  // Seconds of the run in a second.
  rate() {
    return this.speed.value === "whole" ? this.motion.last / WHOLE_IN : Number(this.speed.value);
  }

  toggleGhost() {
    this.wantsGhost = !this.wantsGhost;
    this.ghostButton.setAttribute("aria-pressed", String(this.wantsGhost));
    this.drawPaths();
    this.show();
  }

  toggleSky() {
    this.skyButton.setAttribute("aria-pressed", String(!this.sky.group.visible));
    this.show();
  }

  // Shows the run of this index.
  choose(index) {
    const run = this.data.runs[index];
    this.runs.value = String(index);
    this.motion = new Motion(run, this.data.scene.wheels.length);
    this.slider.max = this.motion.last;
    this.fastest = 0;
    for (let wheel = 0; wheel < this.data.scene.wheels.length; wheel += 1) {
      const count = this.data.scene.wheels.length;
      const [first, final] = [run.angles[wheel], run.angles[run.angles.length - count + wheel]];
      this.fastest = Math.max(this.fastest, Math.abs(final - first) / this.motion.last);
    }
    this.slowed = Math.max(1, Math.ceil(this.fastest / FASTEST_SEEN));
    const notes = [run.sample === 0 ? "Nominal run." : `Sample ${run.sample}: ${run.why}.`];
    if (run.status !== "ok") notes.push(`It ended with ${run.status}: ${run.reason}; shown up to ${readable(this.motion.last)} s.`);
    if (this.slowed > 1) notes.push(`Wheels are slowed ${this.slowed} times to be visible; the ratios of their speeds are true.`);
    if (this.data.scene.is_equivalent) notes.push("The file gives the body by its inertia: the box shown has the same mass and inertia.");
    if (this.data.scene.thrusters.length > 0) notes.push(run.loop ? "Plumes show thrusters fired by the loop." : "Plumes show the nominal schedule.");
    if (run.goal) notes.push("Grey line: line of sight to the debris. Line at the debris: launch axis A_d.");
    if (this.data.scene.plates.length > 0) notes.push("Squares have the areas of the plates that air and light push.");
    notes.push("Arrows show directions only; the sphere shows where s3 points in F_e.");
    if (this.approach) notes.push("The approach view is to scale, centred on the debris, with the axes of F_e.");
    if (run.sample !== 0 && this.nominal) notes.push("Grey edges, with \u201cnominal too\u201d: the nominal run at the same time.");
    this.wantsGhost = run.failed;
    this.ghostButton.hidden = run.sample === 0 || !this.nominal;
    this.ghostButton.setAttribute("aria-pressed", String(this.wantsGhost));
    this.notes.textContent = notes.join(" ");
    this.numbers.replaceChildren(...run.numbers.flatMap(([name, value]) => [control("dt", {}, name), control("dd", {}, value)]));
    this.live.choose(this.motion);
    this.marks.choose(this.motion);
    this.drawPaths();
    if (this.cameraName === "approach") this.view("approach");
    this.goTo(Math.min(this.time, this.motion.last));
  }

  chooseSample(sample) {
    const index = this.data.runs.findIndex((run) => run.sample === sample);
    if (index >= 0) this.choose(index);
  }

  view(name) {
    this.cameraName = name;
    const isApproach = name === "approach";
    const near = [0.75, 0.5, 0.42].map((value) => 5.6 * value * this.size);
    this.controls.target.set(...(isApproach ? this.approach.bounds.center : [0, 0, 0]));
    this.camera.position.set(...(isApproach ? this.approach.camera(this.size) : near));
    this.camera.far = Math.max(400 * this.size, isApproach ? 20 * this.approach.bounds.reach : 0);
    this.camera.updateProjectionMatrix();
    for (const button of this.place.querySelectorAll("[data-camera]")) button.setAttribute("aria-pressed", String(button.dataset.camera === name));
    this.controls.update();
    this.show();
  }

  toggle() {
    this.isPlaying = !this.isPlaying;
    this.playButton.textContent = this.isPlaying ? "Pause" : "Play";
    if (!this.isPlaying) return;
    if (this.time >= this.motion.last) this.time = 0;
    let before = null;
    const frame = (now) => {
      if (!this.isPlaying) return;
      const step = before === null ? 0 : (now - before) / 1000;
      before = now;
      const next = this.time + step * this.rate();
      this.goTo(Math.min(next, this.motion.last));
      if (next >= this.motion.last) this.toggle();
      else requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
  }

  // To the next time at which the motion is known, or the one before.
  step(by) {
    if (this.isPlaying) this.toggle();
    const { times } = this.motion.run;
    const [index, part] = this.motion.place(this.time);
    const next = by > 0 ? (part > 0.999 ? index + 2 : index + 1) : part > 0.001 ? index : index - 1;
    this.goTo(times[Math.min(times.length - 1, Math.max(0, next))]);
  }

  goTo(wanted) {
    const time = Math.min(this.motion.last, Math.max(0, wanted));
    this.time = time;
    this.slider.value = String(time);
    const { loop } = this.motion.run;
    const phase = loop ? `, phase ${loop.phases[loop.phase[this.motion.place(time)[0]]]}` : "";
    this.clock.textContent = `${time.toFixed(this.motion.last < 100 ? 3 : 1)} s of ${readable(this.motion.last)} s${phase}`;
    this.live.goTo(time);
    moveCursors(time);
    this.show();
  }

  // Puts everything where it is at the current time.
  show() {
    const { three, size, motion } = this;
    if (!motion) return;
    const state = motion.at(this.time);
    // in the body's frame the world turns instead
    const inverse = [state.attitude[0], -state.attitude[1], -state.attitude[2], -state.attitude[3]];
    const frame = this.cameraName === "body" ? inverse : [1, 0, 0, 0];
    this.world.quaternion.copy(quaternionOf(three, frame));
    this.craft.quaternion.copy(quaternionOf(three, state.attitude));
    const isApproach = this.cameraName === "approach";
    this.local.visible = !isApproach;
    if (this.approach) this.approach.group.visible = isApproach;
    this.craft.position.set(...(isApproach ? state.debris.map((value) => -value) : [0, 0, 0]));
    this.placeGhost(isApproach);
    this.wheels.forEach(({ spinning }, index) => spinning.rotation.set(0, 0, state.angles[index] / this.slowed));
    const arc = this.data.scene.arcs.find((each) => each.start <= this.time && this.time < each.end);
    const { loop } = motion.run;
    const first = motion.place(this.time)[0] * this.thrusters.length;
    const fires = (index) => (loop ? loop.firing[first + index] > 0 : Boolean(arc && arc.thrust[index] > 0));
    this.thrusters.forEach(({ plume }, index) => (plume.visible = fires(index)));
    pointTo(three, this.arrows.s3, state.s3, 1.6 * size);
    pointTo(three, this.arrows.momentum, state.momentum, 1.45 * size);
    pointTo(three, this.arrows.omega, state.omega, 1.3 * size);
    this.sky.show(state, this.skyButton?.getAttribute("aria-pressed") === "true");
    if (this.debris) this.placeDebris(state);
    if (this.cameraName === "chase") this.chase(state);
    this.render();
  }

  // The nominal run at the same time, or at its end.
  placeGhost(isApproach) {
    this.ghost.visible = this.hasGhost();
    if (!this.ghost.visible) return;
    const state = this.nominal.at(Math.min(this.time, this.nominal.last));
    this.ghost.quaternion.copy(quaternionOf(this.three, state.attitude));
    this.ghost.position.set(...(isApproach ? state.debris.map((value) => -value) : [0, 0, 0]));
  }

  // The debris to scale; where it is out of the picture, at the edge of the sphere in its direction.
  placeDebris(state) {
    const distance = Math.hypot(...state.debris);
    this.debris.quaternion.copy(quaternionOf(this.three, state.debrisAttitude));
    if (this.cameraName === "approach") {
      this.debris.position.set(0, 0, 0);
      this.clock.dataset.debris = "";
      return;
    }
    const isFar = distance > 1.75 * this.size;
    const place = isFar ? state.debris.map((value) => (value / distance) * 1.75 * this.size) : state.debris;
    this.debris.position.set(...place);
    if (distance > 0) pointTo(this.three, this.sight, state.debris, Math.hypot(...place));
    if (this.launchAxis) {
      const { goal } = this.motion.run;
      this.launchAxis.visible = Boolean(goal);
      if (goal) pointTo(this.three, this.launchAxis, goal.axis, this.size);
      this.launchAxis.position.set(...place);
    }
    this.clock.dataset.debris = isFar ? `debris ${readable(distance, 4)} m away, shown nearer` : "";
  }

  // Behind the spin axis, looking along it.
  chase(state) {
    const side = rotated(state.attitude, [1, 0, 0]);
    const from = state.s3.map((value, axis) => -4.2 * this.size * value + 1.6 * this.size * side[axis]);
    this.camera.position.set(...from);
    this.camera.lookAt(0, 0, 0);
  }

  render() {
    if (this.world && this.cameraName) this.renderer.render(this.world, this.camera);
  }
}

// Puts the replay into its section; a sentence where there is no WebGL.
export function startReplay(data, three) {
  const place = document.querySelector(".replay");
  if (!place || !data) return null;
  try {
    return new Replay(data, three, place);
  } catch (error) {
    place.querySelector(":scope > p").textContent = `This browser shows no 3D graphics (WebGL), so the replay is left out.${/webgl/i.test(error.message) ? "" : ` (${error.message})`}`;
    return null;
  }
}
