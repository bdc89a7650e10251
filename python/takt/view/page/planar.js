// What lies and moves in the plane: stators, tracks, movers with what they keep free and have reserved.

import { css, tone } from "./dom.js";

const STATOR = 240; // mm

export class Surface {
  // view: where it is drawn, a Plan.
  constructor(view) {
    this.view = view;
  }

  get c() {
    return this.view.c;
  }

  get model() {
    return this.view.model;
  }

  get plan() {
    return this.view.plan;
  }

  // All that should be seen, in mm.
  places() {
    const { plan, model } = this;
    const found = [];
    for (const track of model.shapes.values()) {
      const shift = this.shiftOf(track);
      for (let i = 0; shift && i < track.points.length; i += 3) found.push([track.points[i + 1] + shift[0], track.points[i + 2] + shift[1]]);
    }
    const stators = [...plan.stators, ...plan.parts.flatMap((part) => this.statorsOf(part))];
    for (const [x, y] of stators) found.push([x, y], [x + STATOR, y + STATOR]);
    for (const { name, width } of plan.movers) {
      const component = model.byName.get(name);
      if (!this.isHere(component)) continue;
      const [x, y] = [model.liveOf(component, "x"), model.liveOf(component, "y")];
      found.push([x - width, y - width], [x + width, y + width]);
    }
    return found;
  }

  // Whether a mover or a part is in the coordinate system that is looked at; machines without any have one.
  isHere(component) {
    const system = this.model.liveOf(component, "coordinate_system");
    return this.plan.systems.length < 2 || system === this.view.system;
  }

  // How far a track has gone with its part; null: it is elsewhere.
  shiftOf(track) {
    const part = this.plan.parts.find((one) => one.name === track.part);
    if (!part) return [0, 0];
    const component = this.model.byName.get(part.name);
    if (!this.isHere(component)) return null;
    const [x, y] = [this.model.liveOf(component, "x"), this.model.liveOf(component, "y")];
    return [x, y];
  }

  statorsOf(part) {
    const component = this.model.byName.get(part.name);
    const [x, y] = [this.model.liveOf(component, "x"), this.model.liveOf(component, "y")];
    if (!this.isHere(component) || !Number.isFinite(x)) return [];
    return part.stators.map(([dx, dy]) => [x + dx, y + dy]);
  }

  stators() {
    const { c } = this;
    const all = [...this.plan.stators, ...this.plan.parts.flatMap((part) => this.statorsOf(part))];
    c.fillStyle = css("--stator");
    c.strokeStyle = css("--line");
    for (const [x, y] of all) {
      const [px, py] = this.view.at(x, y + STATOR);
      const size = STATOR * this.view.camera.scale;
      c.fillRect(px, py, size, size);
      c.strokeRect(px, py, size, size);
    }
  }

  tracks() {
    const { c, model } = this;
    (model.numbers.track ?? []).forEach(({ name }, i) => {
      const colour = model.machine.palette[i % model.machine.palette.length];
      const track = model.shapes.get(name);
      if (!track?.points.length) return;
      const { points } = track;
      const line = [];
      const shift = this.shiftOf(track);
      if (!shift) return;
      for (let k = 0; k < points.length; k += 3) line.push(this.view.at(points[k + 1] + shift[0], points[k + 2] + shift[1]));
      c.strokeStyle = c.fillStyle = tone(colour);
      c.globalAlpha = 0.75;
      c.lineWidth = 1.5;
      this.view.line(line, track.closed);
      c.stroke();
      this.arrows(track, shift, 130 / this.view.camera.scale);
      c.globalAlpha = 1;
      const middle = line[line.length >> 1];
      c.textAlign = "left";
      c.fillText(track.name, middle[0] + 8, middle[1] - 9);
    });
  }

  arrows({ points }, shift, every) {
    const { c } = this;
    for (let k = 3, next = every / 2; k < points.length; k += 3) {
      if (points[k] < next) continue;
      next += every;
      const place = (i) => this.view.at(points[i] + shift[0], points[i + 1] + shift[1]);
      const [a, b] = [place(k - 2), place(k + 1)];
      const angle = Math.atan2(b[1] - a[1], b[0] - a[0]);
      c.save();
      c.translate(...b);
      c.rotate(angle);
      this.view.line([[4, 0], [-4, -3.5], [-4, 3.5]], true);
      c.fill();
      c.restore();
    }
  }

  // A stretch of a track, as points of the screen.
  stretch(track, from, to) {
    const { points, closed } = track;
    const length = points[points.length - 3];
    const [dx, dy] = this.shiftOf(track) ?? [NaN, NaN];
    const place = (s) => {
      let low = 0;
      let high = points.length / 3 - 1;
      while (high - low > 1) {
        const middle = (low + high) >> 1;
        if (points[3 * middle] <= s) low = middle;
        else high = middle;
      }
      const [a, b] = [3 * low, 3 * high];
      const share = points[b] > points[a] ? (s - points[a]) / (points[b] - points[a]) : 0;
      return this.view.at(dx + points[a + 1] + share * (points[b + 1] - points[a + 1]), dy + points[a + 2] + share * (points[b + 2] - points[a + 2]));
    };
    const found = [];
    for (let i = 0; i <= 12; ++i) {
      const s = from + ((to - from) * i) / 12;
      if (s > length && !closed) break;
      found.push(place(closed ? s % length : s));
    }
    return found;
  }

  movers() {
    const { c, model, plan } = this;
    const all = plan.movers.map((mover) => {
      const component = model.byName.get(mover.name);
      const of = (field) => model.liveOf(component, field);
      const reserved = ["lower_x", "lower_y", "upper_x", "upper_y"].map((side) => of(`reserved_${side}`));
      return {
        ...mover, component, reserved, row: model.rows[component.index], x: of("x"), y: of("y"), c: of("c"), s: of("track_position"), track: of("track"),
        route: of("on_route") ? this.ahead(mover.name, of("route_visit"), of("route_granted")) : null, waits: of("waits_for"), gap: of("gap"), target: { x: of("target_x"), y: of("target_y"), c: of("target_c") },
      };
    });
    const known = all.filter((mover) => Number.isFinite(mover.x) && this.isHere(mover.component));
    // What each keeps free before it, centre to centre.
    c.lineCap = "butt";
    for (const mover of known) this.reserved(mover);
    for (const mover of known) {
      const track = model.shapes.get(model.numbers.track?.[mover.track - 1]?.name);
      if (!track?.points.length || !Number.isFinite(mover.s)) continue;
      c.strokeStyle = css("--accent");
      c.globalAlpha = 0.16;
      c.lineWidth = mover.height * this.view.camera.scale * 0.8;
      this.view.line(this.stretch(track, mover.s, mover.s + mover.gap));
      c.stroke();
      c.globalAlpha = 1;
    }
    for (const mover of known) this.route(mover);
    for (const mover of known) this.mover(mover);
    for (const mover of known) {
      const other = known.find((one) => one.component === model.numbers.mover[mover.waits - 1]);
      if (other) this.arrow(mover, other);
    }
  }

  // What a mover has reserved of the plane: from where it is to where it goes; dashed the rectangle around all of it
  // where that is more.
  reserved({ x, y, c: turned, width, height, target, reserved }) {
    const { c } = this;
    const [left, lower, right, upper] = reserved;
    if (!(right > left) || (left > x - width && right < x + width && lower > y - height && upper < y + height)) return;
    const corners = (at) => {
      const [cos, sin] = [Math.cos((at.c * Math.PI) / 180), Math.sin((at.c * Math.PI) / 180)];
      return [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([i, k]) => [at.x + (i * width * cos - k * height * sin) / 2, at.y + (i * width * sin + k * height * cos) / 2]);
    };
    c.globalAlpha = 0.16;
    c.fillStyle = css("--accent");
    const swept = hull([...corners({ x, y, c: turned }), ...corners(target)]);
    this.view.line(swept.map(([px, py]) => this.view.at(px, py)), true);
    c.fill();
    c.globalAlpha = 1;
    const [xs, ys] = [swept.map(([px]) => px), swept.map(([, py]) => py)];
    const more = Math.max(Math.min(...xs) - left, Math.min(...ys) - lower, right - Math.max(...xs), upper - Math.max(...ys));
    if (more < 1) return; // mm; else it swings out on its way, or turns
    c.globalAlpha = 0.6;
    c.strokeStyle = css("--accent");
    c.lineWidth = 1;
    c.setLineDash([4, 4]);
    this.view.line([[left, lower], [right, lower], [right, upper], [left, upper]].map(([px, py]) => this.view.at(px, py)), true);
    c.stroke();
    c.setLineDash([]);
    c.globalAlpha = 1;
  }

  // The places of a mover's route that it has still to reach: those that are its turn, and the others.
  ahead(name, visit, granted) {
    const route = this.model.routes.get(name);
    if (!route) return null;
    const places = [];
    for (let i = Math.max(0, visit + 1 - route.first); 2 * i < route.points.length; ++i) places.push(route.points.slice(2 * i, 2 * i + 2));
    const turns = Math.min(Math.max(0, granted - Math.max(visit, route.first - 1)), places.length);
    return { granted: places.slice(0, turns), later: places.slice(turns) };
  }

  // Its way: solid as far as it is its turn, then dashed, to an outline of itself.
  route({ x, y, c: turned, width, height, route }) {
    if (!route) return;
    const { c } = this;
    const granted = [[x, y], ...route.granted];
    const later = [granted[granted.length - 1], ...route.later];
    c.strokeStyle = css("--accent");
    c.lineWidth = 1.5;
    c.globalAlpha = 0.7;
    for (const [places, dashes] of [[granted, []], [later, [3, 5]]]) {
      if (places.length < 2) continue;
      c.setLineDash(dashes);
      this.view.line(places.map(([px, py]) => this.view.at(px, py)));
      c.stroke();
    }
    c.setLineDash([]);
    const end = this.view.at(...later[later.length - 1]);
    const [w, h] = [width * this.view.camera.scale, height * this.view.camera.scale];
    c.save();
    c.translate(...end);
    c.rotate((-turned * Math.PI) / 180);
    c.globalAlpha = 0.5;
    c.strokeRect(-w / 2, -h / 2, w, h);
    c.restore();
    c.globalAlpha = 1;
  }

  mover(mover) {
    const { c, model } = this;
    const [px, py] = this.view.at(mover.x, mover.y);
    const [w, h] = [mover.width * this.view.camera.scale, mover.height * this.view.camera.scale];
    const colour = model.machine.states[mover.row?.state] ?? css("--soft");
    c.save();
    c.translate(px, py);
    c.rotate((-mover.c * Math.PI) / 180);
    c.fillStyle = css("--card");
    c.fillRect(-w / 2, -h / 2, w, h);
    c.globalAlpha = mover.waits ? 0.25 : 0.6;
    c.fillStyle = colour;
    c.fillRect(-w / 2, -h / 2, w, h);
    c.globalAlpha = 1;
    c.lineWidth = 1.2;
    c.strokeStyle = mover.row?.waits ? css("--warn") : colour;
    c.strokeRect(-w / 2, -h / 2, w, h);
    this.view.line([[w / 2 - 4, 0], [w / 2, 0]]);
    c.stroke();
    c.restore();
    if (w > 22) {
      c.fillStyle = css("--ink");
      c.textAlign = "center";
      c.textBaseline = "middle";
      c.fillText(mover.name, px, py);
    }
  }

  arrow(from, to) {
    const { c } = this;
    const [a, b] = [this.view.at(from.x, from.y), this.view.at(to.x, to.y)];
    const angle = Math.atan2(b[1] - a[1], b[0] - a[0]);
    c.strokeStyle = c.fillStyle = css("--warn");
    c.lineWidth = 1.5;
    this.view.line([a, b]);
    c.stroke();
    c.save();
    c.translate(...b);
    c.rotate(angle);
    this.view.line([[0, 0], [-9, -4], [-9, 4]], true);
    c.fill();
    c.restore();
  }
}

// The corners of the convex hull of some places, counterclockwise.
function hull(places) {
  const sorted = [...places].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const turn = (o, a, b) => (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
  const half = (all) => {
    const side = [];
    for (const place of all) {
      while (side.length > 1 && turn(side[side.length - 2], side[side.length - 1], place) <= 0) side.pop();
      side.push(place);
    }
    return side.slice(0, -1);
  };
  return [...half(sorted), ...half(sorted.reverse())];
}
