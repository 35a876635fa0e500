// The motion of a run between the times at which it is known.

// Hamilton product of quaternions, scalar first.
export function product(p, q) {
  return [
    p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
    p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
    p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
    p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0],
  ];
}

export function rotated(q, v) {
  const [, x, y, z] = product(product(q, [0, ...v]), [q[0], -q[1], -q[2], -q[3]]);
  return [x, y, z];
}

// The quaternion of a rotation vector.
export function ofVector(v) {
  const angle = Math.hypot(...v);
  if (angle < 1e-12) return [1, 0.5 * v[0], 0.5 * v[1], 0.5 * v[2]];
  const s = Math.sin(angle / 2) / angle;
  return [Math.cos(angle / 2), s * v[0], s * v[1], s * v[2]];
}

// The rotation vector from `a` to `b` that is nearest to `guess`: pictures may be more than half a turn apart.
export function turnBetween(a, b, guess) {
  let d = product([a[0], -a[1], -a[2], -a[3]], b);
  if (d[0] < 0) d = d.map((value) => -value);
  const sine = Math.hypot(d[1], d[2], d[3]);
  if (sine < 1e-12) {
    const size = Math.hypot(...guess);
    const turns = Math.round(size / (2 * Math.PI));
    return size > 0 ? guess.map((value) => (value / size) * 2 * Math.PI * turns) : [0, 0, 0];
  }
  const axis = [d[1] / sine, d[2] / sine, d[3] / sine];
  const angle = 2 * Math.atan2(sine, d[0]);
  const along = axis[0] * guess[0] + axis[1] * guess[1] + axis[2] * guess[2];
  const turns = Math.round((along - angle) / (2 * Math.PI));
  return axis.map((value) => value * (angle + 2 * Math.PI * turns));
}

export class Motion {
  constructor(run, wheels) {
    this.run = run;
    this.wheels = wheels;
    this.last = run.times[run.times.length - 1];
  }

  // The index of `times` before `time` and the part of the interval after it.
  place(time, times = this.run.times) {
    let low = 0;
    let high = times.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (times[middle] <= time) low = middle;
      else high = middle;
    }
    const part = (time - times[low]) / (times[high] - times[low]);
    return [low, Math.min(1, Math.max(0, part))];
  }

  slice(name, width, index) {
    return Array.from(this.run[name].subarray(width * index, width * (index + 1)));
  }

  mixed(values, width, [index, part]) {
    return Array.from({ length: width }, (_, k) => {
      const [a, b] = [values[width * index + k], values[width * (index + 1) + k]];
      return a + part * (b - a);
    });
  }

  attitude([index, part]) {
    const [a, b] = [this.slice("attitude", 4, index), this.slice("attitude", 4, index + 1)];
    const step = this.run.times[index + 1] - this.run.times[index];
    const omega = this.mixed(this.run.omega, 3, [index, 0.5]);
    const turn = turnBetween(a, b, omega.map((value) => value * step));
    return product(a, ofVector(turn.map((value) => value * part)));
  }

  // Everything that is seen at `time`.
  at(time) {
    const place = this.place(time);
    const attitude = this.attitude(place);
    const state = {
      attitude,
      s3: rotated(attitude, [0, 0, 1]),
      omega: rotated(attitude, this.mixed(this.run.omega, 3, place)),
      momentum: this.mixed(this.run.momentum, 3, place),
      angles: this.mixed(this.run.angles, this.wheels, place),
    };
    if (this.run.debris) {
      state.debris = this.mixed(this.run.debris.relative, 3, place);
      const [a, b] = [0, 1].map((next) => Array.from(this.run.debris.attitude.subarray(4 * (place[0] + next), 4 * (place[0] + next) + 4)));
      state.debrisAttitude = product(a, ofVector(turnBetween(a, b, [0, 0, 0]).map((value) => value * place[1])));
    }
    if (this.run.orbit) state.sky = this.sky(time);
    return state;
  }

  // The directions about the orbit, and the hidden share of the Sun, at `time`.
  sky(time) {
    const { times, hidden, ...directions } = this.run.orbit;
    const place = this.place(time, times);
    const of = Object.entries(directions).map(([name, values]) => [name, this.mixed(values, 3, place)]);
    return { ...Object.fromEntries(of), hidden: hidden ? this.mixed(hidden, 1, this.place(time))[0] : 0 };
  }

  // The spacecraft relative to the debris at the known times; empty without debris.
  path() {
    const { debris, times } = this.run;
    if (!debris) return [];
    return Array.from(times, (_, index) => [0, 1, 2].map((axis) => -debris.relative[3 * index + axis]));
  }

  // The components of a number that changes, in the unit that is shown; one that is held keeps its value until the next time.
  live(number, time) {
    const [index, part] = this.place(time);
    const width = Math.max(1, number.components.length);
    const at = number.held ? (part < 1 ? [index, 0] : [index, 1]) : [index, part];
    // a value that is not known is not mixed into one that is
    const values = at[1] === 0 ? Array.from(number.values.subarray(width * index, width * (index + 1))) : this.mixed(number.values, width, at);
    return values.map((value) => value * number.factor);
  }

  // The directions of s3 at the known times.
  trail() {
    return Array.from(this.run.times, (_, index) => rotated(this.slice("attitude", 4, index), [0, 0, 1]));
  }
}
