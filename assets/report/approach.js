// The approach at scale: the debris at the origin, the path of the spacecraft relative to it, the axis A_d, the station and the keep-out sphere.

import { curve, sphere } from "./bodies.js";
import { HUE_PLACES } from "./theme.js";

// The middle of `points`, and the distance of the farthest from it.
function boundsOf(points) {
  const ends = [Math.min, Math.max].map((end) => [0, 1, 2].map((axis) => points.reduce((found, point) => end(found, point[axis]), points[0][axis])));
  const center = [0, 1, 2].map((axis) => 0.5 * (ends[0][axis] + ends[1][axis]));
  return { center, reach: points.reduce((most, point) => Math.max(most, Math.hypot(...point.map((value, axis) => value - center[axis]))), 0) };
}

export class Approach {
  constructor(three, scene, palette) {
    this.three = three;
    this.scene = scene;
    this.palette = palette;
    this.group = new three.Group();
    this.bounds = { center: [0, 0, 0], reach: 1 };
  }

  // Draws the path of `motion`, and that of `nominal` where it is given.
  show(motion, nominal) {
    const { three, palette, group, scene } = this;
    const hue = palette.hues[HUE_PLACES.debris];
    group.clear();
    this.path = motion.path();
    this.line = curve(three, this.path, 1, palette.hues[HUE_PLACES.body]);
    group.add(this.line);
    if (nominal) group.add(curve(three, nominal.path(), 1, palette.quiet));
    if (scene.keep_out > 0) group.add(sphere(three, scene.keep_out, palette.hues[1], 0.18));
    const { goal } = motion.run;
    this.station = goal ? goal.axis.map((value) => -goal.distance * value) : null;
    if (goal) {
      const ends = [1.4 * goal.distance, -0.5 * goal.distance].map((length) => goal.axis.map((value) => -length * value));
      group.add(curve(three, ends, 1, hue));
      const mark = sphere(three, 0.035 * goal.distance, palette.hues[2], 0.8);
      mark.position.set(...this.station);
      group.add(mark);
    }
    const around = [-1, 1].flatMap((sign) => [0, 1, 2].map((axis) => [0, 1, 2].map((other) => (other === axis ? sign * scene.keep_out : 0))));
    this.bounds = boundsOf([...this.path, ...around, ...(goal ? [this.station] : [])]);
  }

  // From where the whole approach is seen.
  camera(size) {
    const distance = 2.4 * (this.bounds.reach + size);
    return [0.75, 0.5, 0.42].map((value, axis) => this.bounds.center[axis] + value * distance);
  }
}
