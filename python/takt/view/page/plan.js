// The machine from above, or from a side: what stands where, and what moves.

import { byId, css, el, fitCanvas, ticks } from "./dom.js";
import { Surface } from "./planar.js";

const VIEWS = { above: [0, 1], front: [0, 2], side: [1, 2] };
const TRAIL_S = 3;
const BELT_WIDTH = 120; // mm, to be seen; how wide belts are nobody says

// The live page and reports draw with this. `series` says the columns that trails of tools are made of, by
// component; `ctrlZooms`: the wheel alone scrolls the page; `onchange` is called when what is to be seen was moved.
export class Plan {
  constructor(model, series, { ctrlZooms = false, onchange = () => {} } = {}) {
    this.model = model;
    this.series = series;
    this.ctrlZooms = ctrlZooms;
    this.onchange = onchange;
    this.canvas = byId("plan-canvas");
    this.box = byId("plan-box");
    this.view = "above";
    this.camera = null; // {x, y, scale}
    this.systemSelect = byId("plan-system");
    this.surface = new Surface(this);
    this.controls();
  }

  begin() {
    this.plan = this.model.machine.plan;
    const { plan } = this;
    this.shapes = this.model.shapes.size;
    this.something = (this.model.numbers.track ?? []).length + plan.stators.length + plan.parts.length + plan.movers.length + plan.belts.length + plan.groups.length > 0;
    byId("plan-empty").hidden = this.something;
    const { systems } = plan;
    this.system = 1;
    this.systemSelect.hidden = systems.length < 2;
    this.systemSelect.replaceChildren(...systems.map((name, i) => el("option", { value: i + 1, textContent: name })));
    for (const button of byId("plan-views").children) button.hidden = button.value !== "above" && !plan.groups.length;
    this.setView("above");
  }

  // Signals that the trails of tools are made of.
  signals() {
    return this.plan?.groups.flatMap((group) => ["x", "y", "z"].map((field) => [this.model.byName.get(group.name).index, field])) ?? [];
  }

  setView(view) {
    this.view = view;
    this.camera = null;
    for (const button of byId("plan-views").children) button.setAttribute("aria-pressed", String(button.value === view));
    this.onchange();
  }

  // Everything is to be seen again.
  fitAgain() {
    this.camera = null;
    this.onchange();
  }

  // --- where things are on the screen ---

  at(x, y, z = 0) {
    const place = [x, y, z];
    const [h, v] = VIEWS[this.view];
    return [this.width / 2 + (place[h] - this.camera.x) * this.camera.scale, this.height / 2 - (place[v] - this.camera.y) * this.camera.scale];
  }

  fit() {
    const [h, v] = VIEWS[this.view];
    const box = [Infinity, Infinity, -Infinity, -Infinity];
    const add = (...place) => {
      if (!place.every(Number.isFinite)) return;
      box[0] = Math.min(box[0], place[h]);
      box[1] = Math.min(box[1], place[v]);
      box[2] = Math.max(box[2], place[h]);
      box[3] = Math.max(box[3], place[v]);
    };
    const { plan, model } = this;
    for (const [x, y] of this.surface.places()) add(x, y, 0);
    for (const belt of plan.belts) for (const place of this.beltCorners(belt)) add(...place);
    for (const links of Object.values(model.links)) for (const link of links) [0, 3].forEach((k) => add(link[k], link[k + 1], link[k + 2]));
    if (!(box[0] <= box[2])) return null;
    const [w, t] = [Math.max(box[2] - box[0], 100), Math.max(box[3] - box[1], 100)];
    return { x: (box[0] + box[2]) / 2, y: (box[1] + box[3]) / 2, scale: Math.min((this.width - 110) / w, (this.height - 90) / t) };
  }

  beltCorners({ frame, range, turning }) {
    const place = (x, y) => [0, 1, 2].map((r) => frame[4 * r] * x + frame[4 * r + 1] * y + frame[4 * r + 3]);
    if (turning) return [[-300, -300], [300, 300]].map(([x, y]) => place(x, y));
    const [from, to] = [Math.min(0, range[0] ?? 0), Math.max(range[1] ?? 800, 100)];
    return [[from, -BELT_WIDTH / 2], [to, -BELT_WIDTH / 2], [to, BELT_WIDTH / 2], [from, BELT_WIDTH / 2]].map(([x, y]) => place(x, y));
  }

  // --- drawing ---

  draw() {
    this.width = this.box.clientWidth;
    this.height = this.box.clientHeight;
    if (this.width < 50 || !this.plan) return;
    const c = fitCanvas(this.canvas, this.width, this.height);
    this.c = c;
    c.fillStyle = css("--card");
    c.fillRect(0, 0, this.width, this.height);
    if (!this.something) return;
    const known = Object.values(this.model.links).filter((links) => links.length).length;
    if (known !== this.knownArms || this.model.shapes.size !== this.shapes) this.camera = null; // one more to be seen
    this.knownArms = known;
    this.shapes = this.model.shapes.size;
    this.camera ??= this.fit();
    if (!this.camera) return;
    c.font = `11px ${css("--font")}`;
    this.grid();
    if (this.view === "above") {
      this.surface.stators();
      this.surface.tracks();
    }
    for (const belt of this.plan.belts) this.belt(belt);
    if (this.view === "above") this.surface.movers();
    this.trails();
    for (const group of this.plan.groups) this.arm(group);
  }

  line(points, closed = false) {
    this.c.beginPath();
    points.forEach(([x, y], i) => (i ? this.c.lineTo(x, y) : this.c.moveTo(x, y)));
    if (closed) this.c.closePath();
  }

  grid() {
    const { c, camera } = this;
    const names = "XYZ";
    const [h, v] = VIEWS[this.view];
    c.lineWidth = 1;
    c.textBaseline = "middle";
    const across = ticks(camera.x - this.width / 2 / camera.scale, camera.x + this.width / 2 / camera.scale, this.width / 100);
    for (const value of across.at) {
      const px = Math.round(this.width / 2 + (value - camera.x) * camera.scale) + 0.5;
      c.strokeStyle = css("--grid");
      this.line([[px, 0], [px, this.height]]);
      c.stroke();
      c.fillStyle = css("--soft");
      c.textAlign = "center";
      if (px > 50 && px < this.width - 76) c.fillText(value.toFixed(across.decimals).replace("-", "−"), px, this.height - 10);
    }
    const up = ticks(camera.y - this.height / 2 / camera.scale, camera.y + this.height / 2 / camera.scale, this.height / 100);
    for (const value of up.at) {
      const py = Math.round(this.height / 2 - (value - camera.y) * camera.scale) + 0.5;
      c.strokeStyle = css("--grid");
      this.line([[0, py], [this.width, py]]);
      c.stroke();
      c.fillStyle = css("--soft");
      c.textAlign = "left";
      if (py > 26 && py < this.height - 24) c.fillText(value.toFixed(up.decimals).replace("-", "−"), 6, py);
    }
    c.textAlign = "right";
    c.fillText(`${names[h]}, mm`, this.width - 8, this.height - 10);
    c.textAlign = "left";
    c.fillText(`${names[v]}, mm`, 6, 12);
  }

  belt(belt) {
    const { c, model } = this;
    const corners = this.beltCorners(belt).map((place) => this.at(...place));
    const name = belt.name;
    c.fillStyle = css("--stator");
    c.strokeStyle = css("--line");
    c.lineWidth = 1;
    const { frame } = belt;
    const world = (x, y) => this.at(...[0, 1, 2].map((r) => frame[4 * r] * x + frame[4 * r + 1] * y + frame[4 * r + 3]));
    if (belt.turning) {
      const radius = 300 * this.camera.scale;
      c.beginPath();
      c.arc(...world(0, 0), radius, 0, 7);
      c.stroke();
    } else {
      this.line(corners, true);
      c.fill();
      c.stroke();
      const half = BELT_WIDTH / 2;
      const [from, to] = belt.range;
      c.strokeStyle = css("--accent");
      c.setLineDash([4, 3]);
      for (const s of [from, to]) {
        if (s === null) continue;
        this.line([world(s, -half), world(s, half)]);
        c.stroke();
      }
      c.setLineDash([]);
      // Marks that go along with it.
      const component = model.byName.get(name);
      const travel = model.liveOf(component, "position");
      const [begin, end] = [Math.min(0, from ?? 0), to ?? 800];
      c.strokeStyle = css("--line");
      for (let s = begin + ((((travel - begin) % 50) + 50) % 50); Number.isFinite(travel) && s < end; s += 50) {
        this.line([world(s, -half), world(s, -half + 10)]);
        c.stroke();
        this.line([world(s, half), world(s, half - 10)]);
        c.stroke();
      }
    }
    const [lx, ly] = corners.reduce(([x, y], [a, b]) => [Math.min(x, a), Math.min(y, b)], [1e9, 1e9]);
    c.fillStyle = css("--soft");
    c.textAlign = "left";
    c.textBaseline = "bottom";
    c.fillText(name, lx, ly - 4);
    for (const object of model.objects[name] ?? []) this.object(object);
  }

  object([number, x, y, z, turn, taken, inRange]) {
    const { c } = this;
    const size = Math.max(7, 24 * this.camera.scale);
    const [px, py] = this.at(x, y, z);
    c.save();
    c.translate(px, py);
    c.rotate((-turn * Math.PI) / 180);
    c.fillStyle = taken ? css("--soft") : inRange ? css("--good") : css("--warn");
    c.globalAlpha = 0.8;
    c.fillRect(-size / 2, -size / 2, size, size);
    c.restore();
    if (size > 16) {
      c.fillStyle = css("--soft");
      c.textAlign = "center";
      c.textBaseline = "top";
      c.fillText(String(number), px, py + size / 2 + 2);
    }
  }

  arm(group) {
    const { c, model } = this;
    const links = model.links[group.name];
    if (!links?.length) return;
    c.lineCap = c.lineJoin = "round";
    const ends = (name, from) => links.filter((_, i) => name.test(group.links[i])).map((link) => this.at(...link.slice(from, from + 3)));
    c.strokeStyle = css("--link");
    c.fillStyle = css("--stator");
    c.lineWidth = 1.2;
    for (const corners of [ends(/^upper_arm/, 0), ends(/^lower_arm.*_a$/, 3)]) {
      if (corners.length < 3) continue; // base and platform of a Delta
      this.line(corners, true);
      c.globalAlpha = 0.25;
      c.fill();
      c.globalAlpha = 1;
      c.stroke();
    }
    links.forEach((link, i) => {
      const name = group.links[i];
      const [a, b] = [this.at(...link.slice(0, 3)), this.at(...link.slice(3, 6))];
      const heavy = !/^lower_arm|^tool$|^base$|^[xyz]+$|^platform$/.test(name);
      c.strokeStyle = css("--link");
      c.lineWidth = heavy ? 6 : 2;
      this.line([a, b]);
      if (Math.hypot(b[0] - a[0], b[1] - a[1]) > 0.5) c.stroke();
      if (heavy) {
        c.fillStyle = css("--ink");
        c.beginPath();
        c.arc(...a, 3.5, 0, 7);
        c.fill();
      }
    });
    const tool = links.at(-1);
    const [px, py] = this.at(...tool.slice(3, 6));
    c.fillStyle = css("--bad");
    c.strokeStyle = css("--card");
    c.lineWidth = 1.5;
    c.beginPath();
    c.arc(px, py, 5, 0, 7);
    c.fill();
    c.stroke();
    c.textAlign = "left";
    c.textBaseline = "middle";
    const text = `${group.name}  ${tool.slice(3, 6).map((v) => v.toFixed(1).replace("-", "−")).join("  ")}`;
    c.strokeStyle = css("--card");
    c.lineWidth = 4;
    c.strokeText(text, px + 12, py - 12);
    c.fillStyle = css("--ink");
    c.fillText(text, px + 12, py - 12);
  }

  trails() {
    const { c, model } = this;
    const since = model.cycle - TRAIL_S / model.period;
    this.plan.groups.forEach((group) => {
      const series = this.series().get(model.byName.get(group.name).index);
      const [x, y, z] = ["x", "y", "z"].map((field) => series?.columns.get(field));
      if (!x || !y || !z) return;
      const { base } = group;
      const step = Math.max(1, Math.floor(0.004 / model.period));
      const first = series.find(since);
      const end = series.find(model.cycle + 1e-6);
      if (end <= first) return;
      c.strokeStyle = css("--bad");
      c.lineWidth = 1.4;
      for (let part = 0; part < 6; ++part) {
        const [from, to] = [part, part + 1].map((k) => first + Math.floor(((end - 1 - first) * k) / 6));
        const line = [];
        for (let i = from; i <= to; i = i < to ? Math.min(to, i + step) : to + 1) {
          if (Number.isNaN(x[i])) continue;
          line.push(this.at(...[0, 1, 2].map((r) => base[4 * r] * x[i] + base[4 * r + 1] * y[i] + base[4 * r + 2] * z[i] + base[4 * r + 3])));
        }
        c.globalAlpha = 0.12 + 0.13 * part;
        this.line(line);
        c.stroke();
      }
      c.globalAlpha = 1;
    });
  }

  // --- what the user does ---

  controls() {
    for (const button of byId("plan-views").children) button.onclick = () => this.setView(button.value);
    this.systemSelect.onchange = () => {
      this.system = Number(this.systemSelect.value);
      this.fitAgain();
    };
    byId("plan-fit").onclick = () => this.fitAgain();
    this.canvas.onpointerdown = (event) => {
      this.drag = [event.offsetX, event.offsetY];
      this.canvas.setPointerCapture(event.pointerId);
    };
    this.canvas.onpointermove = (event) => {
      if (!this.drag || !this.camera) return;
      this.camera.x -= (event.offsetX - this.drag[0]) / this.camera.scale;
      this.camera.y += (event.offsetY - this.drag[1]) / this.camera.scale;
      this.drag = [event.offsetX, event.offsetY];
      this.onchange();
    };
    this.canvas.onpointerup = () => (this.drag = null);
    this.canvas.addEventListener("wheel", (event) => {
      if (this.ctrlZooms && !event.ctrlKey && !event.metaKey) return;
      event.preventDefault();
      if (!this.camera) return;
      const factor = event.deltaY > 0 ? 0.85 : 1.18;
      const [dx, dy] = [event.offsetX - this.width / 2, event.offsetY - this.height / 2];
      this.camera.x += (dx / this.camera.scale) * (1 - 1 / factor);
      this.camera.y -= (dy / this.camera.scale) * (1 - 1 / factor);
      this.camera.scale *= factor;
      this.onchange();
    }, { passive: false });
    new ResizeObserver(() => this.fitAgain()).observe(this.box);
  }
}
