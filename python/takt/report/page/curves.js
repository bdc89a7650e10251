// All that was recorded, a block for each component, made when it comes into sight.

import { byId, css, el } from "../../view/page/dom.js";
import { bands, breaks, digits, font, Plots } from "./plots.js";

const BLOCK_PX = 60; // of a block beside its lanes
const [TALL, LOW, MARKS, BAND] = [150, 104, 40, 28]; // px: lanes of positions, others, marks, a state

const rgb = (hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16));
const mix = (a, b, share) => `rgb(${rgb(a).map((v, i) => Math.round(v * (1 - share) + rgb(b)[i] * share)).join()})`;

export class Curves {
  constructor(data, recorded, clock) {
    this.data = data;
    this.recorded = recorded;
    this.chosen = null; // the verdict whose place is marked more strongly
    this.plots = new Plots(clock, data.span);
    this.blocks = new Map();
    this.chips = new Map();
    this.observer = new IntersectionObserver((entries) => {
      for (const entry of entries) if (entry.isIntersecting) this.blocks.get(entry.target.dataset.name).make();
    }, { rootMargin: "600px" });
    for (const component of data.components) this.addBlock(component);
    byId("reset").onclick = () => this.plots.zoom(...data.span);
  }

  choose(verdict) {
    this.chosen = verdict;
    if (verdict.view) this.plots.zoom(...verdict.view);
    else this.plots.zoom(...this.data.span);
    this.plots.redraw();
    const name = verdict.components[0];
    const block = this.blocks.get(name);
    if (block?.node.hidden) this.chips.get(name).click();
    return block?.node;
  }

  addBlock(component) {
    const node = el("article", { className: "component card" });
    node.dataset.name = component.name;
    const dot = el("i");
    dot.style.background = component.colour;
    const chip = el("button", { type: "button", ariaPressed: "true" }, dot, component.name);
    chip.onclick = () => {
      node.hidden = !node.hidden;
      chip.ariaPressed = String(!node.hidden);
    };
    const block = new Block(this, component, node);
    this.blocks.set(component.name, block);
    this.chips.set(component.name, chip);
    byId("chips").append(chip);
    byId("curves").append(node);
    this.observer.observe(node);
  }
}

class Block {
  constructor(curves, component, node) {
    Object.assign(this, { curves, component, node });
    const { data } = curves;
    this.table = curves.recorded.get(component.name);
    this.events = data.events.filter((e) => e[1] === component.name || e[1] === "");
    const moving = component.fields.filter((f) => !("constant" in f));
    this.still = component.fields.filter((f) => "constant" in f);
    this.states = moving.filter((f) => f.names);
    const lanes = new Map();
    for (const field of moving.filter((f) => !f.names)) {
      const key = `${field.quantity} ${field.unit}`;
      if (!lanes.has(key)) lanes.set(key, { quantity: field.quantity, unit: field.unit, fields: [] });
      lanes.get(key).fields.push(field);
    }
    const rank = (lane) => (data.quantities.indexOf(lane.quantity) + 99) % 99;
    this.lanes = [...lanes.values()].sort((a, b) => rank(a) - rank(b));
    const height = this.lanes.reduce((sum, lane) => sum + this.heightOf(lane), 0) + BAND * this.states.length + (this.events.length ? MARKS : 0);
    node.append(this.head());
    if (this.drawable) node.style.minHeight = `${BLOCK_PX + height}px`; // so that nothing moves when it is made
  }

  get drawable() {
    return this.table.time.length > 1;
  }

  heightOf(lane) {
    return lane.quantity === "position" ? TALL : LOW;
  }

  head() {
    const { component, still, table } = this;
    const said = still.map((f) => `${f.label} = ${stillOf(f)}${f.unit && f.unit !== "1" ? ` ${f.unit}` : ""}`).join(", ");
    const text = !this.drawable ? `${table.time.length} ${table.time.length === 1 ? "sample" : "samples"}: nothing to draw` : said ? `throughout: ${said}` : "";
    return el("h3", {}, component.name, text ? el("small", { textContent: text }) : null);
  }

  make() {
    if (this.made || !this.drawable) return;
    this.made = true;
    const { lanes, states, node, table } = this;
    const flat = { series: [{ paths: () => null, points: { show: false } }], columns: [new Uint8Array(table.time.length)], yAxis: false, time: table.time, yRange: [0, 1] };
    if (this.events.length) {
      const row = el("div", { className: "lane" });
      node.append(row);
      this.curves.plots.add(row, { ...flat, height: MARKS, last: false, hooks: { drawAxes: [this.background(null)], draw: [this.labels()] } });
    }
    lanes.forEach((lane, i) => this.addLane(lane, !states.length && i === lanes.length - 1));
    if (!states.length) return;
    const row = el("div", { className: "lane" });
    node.append(row);
    const outputs = states.map(() => el("output"));
    const rows = states.map((f) => ({ times: table.time, values: table.values(f.name), names: f.names, holes: this.component.holes }));
    this.curves.plots.add(row, {
      ...flat, height: BAND * states.length,
      hooks: { drawAxes: [this.background(null)], draw: [bands(rows)] },
      show: (at) => rows.forEach(({ values, names }, i) => { outputs[i].textContent = at < 0 ? "" : names[values[at]]?.[0] ?? String(values[at]); }),
    });
    row.append(el("div", { className: "legend" }, ...states.map((f, i) => el("div", {}, el("span", { textContent: `${f.label}  ` }), outputs[i]))));
  }

  // Set point and measured value of a thing have one colour: the first thing of a lane the component's, others the next ones.
  tone(field, lane, pair) {
    const { palette } = this.curves.data;
    const sources = [...new Set(lane.fields.map((f) => f.source))];
    const colour = palette[(palette.indexOf(this.component.colour) + sources.indexOf(field.source)) % palette.length];
    return field.set && pair ? mix(colour, css("--ink"), 0.55) : colour;
  }

  addLane(lane, last) {
    const { component, table } = this;
    const row = el("div", { className: "lane" });
    const legend = el("div", { className: "legend" }, el("strong", { textContent: lane.unit ? `${lane.quantity} [${lane.unit}]` : lane.quantity }));
    this.node.append(row);
    const pair = lane.fields.some((f) => f.set) && lane.fields.some((f) => !f.set);
    // Measured curves first, so that the dashed set points lie on top.
    const fields = [...lane.fields].sort((a, b) => a.set - b.set);
    const columns = fields.map((f) => table.curve(f.name));
    const outputs = [];
    const plot = this.curves.plots.add(row, {
      height: this.heightOf(lane),
      time: table.time,
      columns,
      series: fields.map((f, i) => ({
        label: f.label,
        stroke: () => this.tone(f, lane, pair),
        width: f.set && pair ? 1.25 : 1.5,
        dash: f.set && pair ? [6, 4] : undefined,
        points: { show: false },
        gaps: breaks(component.holes, columns[i], f.quantity === "position" ? component.modulus : null),
      })),
      hooks: { drawAxes: [this.background(lane)] },
      last,
      show: (at) => outputs.forEach((out, i) => { out.textContent = at < 0 ? "" : digits(columns[i][at]); }),
    });
    fields.forEach((field, i) => {
      const out = el("output");
      const line = el("i", { className: field.set && pair ? "dashed" : "" });
      line.style.borderColor = this.tone(field, lane, pair);
      outputs.push(out);
      const button = el("button", { type: "button" }, line, el("span", { textContent: field.label }), out);
      button.onclick = () => {
        plot.setSeries(i + 1, { show: !plot.series[i + 1].show });
        button.classList.toggle("off", !plot.series[i + 1].show);
      };
      legend.append(button);
    });
    row.append(legend);
    this.curves.plots.refresh();
  }

  // Marks and places behind the curves of a lane.
  background(lane) {
    const { name } = this.component;
    return (u) => {
      const { ctx } = u;
      const { left, top, width, height } = u.bbox;
      const { chosen, data } = this.curves;
      ctx.save();
      ctx.beginPath();
      ctx.rect(left, top, width, height);
      ctx.clip();
      for (const verdict of data.verdicts) {
        if (!verdict.place || !verdict.components.includes(name)) continue;
        if (verdict !== chosen && verdict.passed) continue;
        const [a, b] = verdict.place.map((t) => u.valToPos(t, "x", true));
        ctx.fillStyle = verdict.passed ? css("--good") : css("--bad");
        ctx.globalAlpha = verdict === chosen ? 0.2 : 0.09;
        ctx.fillRect(a - 1, top, Math.max(b - a, 0) + 2, height);
      }
      ctx.globalAlpha = 0.4;
      ctx.lineWidth = devicePixelRatio;
      for (const [time, , , kind] of this.events) {
        const x = Math.round(u.valToPos(time, "x", true)) + 0.5;
        if (x < left || x > left + width) continue;
        ctx.strokeStyle = kind === "error" ? css("--bad") : css("--soft");
        line(ctx, x, top, x, top + height);
      }
      if (chosen && lane && chosen.components.includes(name)) {
        ctx.globalAlpha = 0.9;
        ctx.strokeStyle = css("--bad");
        ctx.setLineDash([6 * devicePixelRatio, 4 * devicePixelRatio]);
        for (const like of chosen.lanes.filter((one) => one.quantity === lane.quantity && one.unit === lane.unit)) {
          for (const { values } of like.bounds.filter((bound) => "constant" in bound.values)) {
            const y = Math.round(u.valToPos(values.constant, "y", true)) + 0.5;
            line(ctx, left, y, left + width, y);
          }
        }
      }
      ctx.restore();
    };
  }

  // Labels of the marks, in two rows, as many as there is room for.
  labels() {
    return (u) => {
      const { ctx } = u;
      const free = [-Infinity, -Infinity];
      ctx.save();
      ctx.font = font(11.5);
      ctx.textBaseline = "middle";
      ctx.textAlign = "left";
      for (const [time, , text, kind] of this.events) {
        const x = u.valToPos(time, "x", true);
        if (x < u.bbox.left - 1 || x > u.bbox.left + u.bbox.width) continue;
        const row = free.findIndex((until) => until <= x);
        if (row < 0) continue;
        free[row] = x + ctx.measureText(text).width + 14 * devicePixelRatio;
        ctx.fillStyle = kind === "error" ? css("--bad") : kind === "end" ? css("--soft") : css("--ink");
        ctx.fillText(text, x + 4 * devicePixelRatio, u.bbox.top + (9 + 16 * row) * devicePixelRatio);
      }
      ctx.restore();
    };
  }
}

function line(ctx, x, y, toX, toY) {
  ctx.beginPath();
  ctx.moveTo(x, y);
  ctx.lineTo(toX, toY);
  ctx.stroke();
}

// What a field said throughout: states by name, switches as yes or no.
function stillOf({ names, constant }) {
  const known = Object.keys(names ?? {});
  if (known.length === 1 && known[0] === "1") return constant ? "yes" : "no";
  return names?.[String(constant)]?.[0] ?? digits(constant);
}
