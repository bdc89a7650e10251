// A cam that is edited: its joints can be dragged; between them it is quintics that keep the slope and the second
// derivative that the cam had there.

const SAMPLES = 40; // between two joints
const GAP = 1e-3; // of the cam's length: nearer to its neighbours no joint gets
const NAME_BYTES = 30;
const SUFFIX = " edited"; // the same every time: the engine keeps one such cam, and those that still run
const ANSWER_MS = 3000; // after which what was sent can be sent again
const AT_ONCE = 20; // points in one command

// Coefficients over the distance from the first joint: y = c0 + c1 d + ... + c5 d⁵.
export function quintic([x0, y0, v0, a0], [x1, y1, v1, a1]) {
  const t = x1 - x0;
  const [d, v, a] = [y1 - y0 - v0 * t - (a0 * t * t) / 2, v1 - v0 - a0 * t, a1 - a0];
  return [y0, v0, a0 / 2, (10 * d - 4 * v * t + (a * t * t) / 2) / t ** 3, (-15 * d + 7 * v * t - a * t * t) / t ** 4, (6 * d - 3 * v * t + (a * t * t) / 2) / t ** 5];
}

// Position, velocity, acceleration and jerk.
function valuesAt(c, d) {
  const of = (power) => c.reduce((sum, one, k) => {
    let factor = one;
    for (let i = 0; i < power; i++) factor *= k - i;
    return k < power ? sum : sum + factor * d ** (k - power);
  }, 0);
  return [0, 1, 2, 3].map(of);
}

// Of an edited cam: within the bytes that a name may have.
export function nameOf(name) {
  let plain = name.endsWith(SUFFIX) ? name.slice(0, -SUFFIX.length) : name;
  while (new TextEncoder().encode(plain).length > NAME_BYTES) plain = [...plain].slice(0, -1).join("");
  return plain + SUFFIX;
}

export class Edit {
  constructor(cam) {
    this.of = cam;
    this.knots = cam.knots.map((knot) => [...knot]);
    this.name = nameOf(cam.name);
    this.dragged = -1;
    this.newer = 0; // cams of this name with a greater number are this one; 0: it was not sent
    this.sentAt = -Infinity;
    this.shape();
  }

  // The cam as the page draws one.
  shape() {
    const x = [];
    const curves = [[], [], [], []];
    const put = (c, begin, d) => {
      x.push(begin + d);
      valuesAt(c, d).forEach((value, i) => curves[i].push(value));
    };
    this.knots.slice(1).forEach((knot, k) => {
      const c = quintic(this.knots[k], knot);
      const length = knot[0] - this.knots[k][0];
      for (let i = 0; i <= SAMPLES; i++) put(c, this.knots[k][0], (length * i) / SAMPLES);
    });
    this.cam = { name: this.name, units: this.of.units, cyclic: this.of.cyclic, x, curves };
  }

  // The ends stay where they are on x; those of a cyclic cam move together, so that its stroke stays.
  drag(k, x, y) {
    const last = this.knots.length - 1;
    const rise = y - this.knots[k][1];
    const ends = k === 0 || k === last;
    if (!ends) {
      const least = GAP * (this.knots[last][0] - this.knots[0][0]);
      this.knots[k][0] = Math.min(Math.max(x, this.knots[k - 1][0] + least), this.knots[k + 1][0] - least);
    }
    for (const one of ends && this.of.cyclic ? [0, last] : [k]) this.knots[one][1] += rise;
    this.shape();
  }

  // It was sent, and the engine may still answer.
  get waits() {
    return performance.now() - this.sentAt < ANSWER_MS;
  }

  // latest: the greatest number of a cam that is known.
  sent(latest) {
    this.newer = latest;
    this.sentAt = performance.now();
  }

  // The commands that make it.
  commands() {
    const [x_unit, y_unit] = this.of.units;
    const points = this.knots.map(([x, y, v, a]) => ({ x, y, v, a }));
    const pieces = [];
    for (let first = 0; first < points.length; first += AT_ONCE) pieces.push(["add_cam_points", { cam: this.name, first, points: points.slice(first, first + AT_ONCE) }]);
    return [
      ["begin_cam", { name: this.name, cyclic: this.of.cyclic, interpolation: "quintic", x_unit, y_unit }],
      ...pieces,
      ["build_cam", { cam: this.name, count: points.length }],
    ];
  }
}
