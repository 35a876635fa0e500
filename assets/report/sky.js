// What is about a spacecraft on an orbit: arrows of nadir, velocity, Sun and magnetic field in F_e.

import { arrow, pointTo } from "./bodies.js";

// What each arrow shows, and its place in the palette.
const SKY = { nadir: ["nadir, to the Earth's centre", 14], velocity: ["velocity on the orbit", 15], sun: ["Sun (ball), faint in shadow", 16], field: ["magnetic field", 17] };
const FAINT = 0.2; // opacity of the Sun that is hidden

// The arrows that `runs` have: their names with text and hue; none of a scene that is not on an orbit.
export function skyEntries(runs) {
  const { orbit } = runs[0];
  return Object.entries(SKY).filter(([name]) => orbit?.[name]);
}

export class Sky {
  constructor(three, runs, size, palette) {
    this.three = three;
    this.length = 1.75 * size;
    this.group = new three.Group();
    this.arrows = skyEntries(runs).map(([name, [, hue]]) => {
      const made = arrow(three, palette.hues[hue], 0.007);
      // a ball at the tip of the arrow to the Sun
      if (name === "sun") made.add(new three.Mesh(new three.SphereGeometry(0.045, 20, 12).translate(0, 0, 1), made.children[0].material.clone()));
      for (const { material } of made.children) material.transparent = true;
      this.group.add(made);
      return [name, made];
    });
  }

  // Turns the arrows to where they point in `state`, where they are wanted.
  show({ sky }, isWanted) {
    this.group.visible = isWanted;
    for (const [name, made] of this.arrows) {
      pointTo(this.three, made, sky[name], this.length);
      const opacity = name === "sun" ? 1 - (1 - FAINT) * sky.hidden : 1;
      for (const { material } of made.children) material.opacity = opacity;
    }
  }
}
