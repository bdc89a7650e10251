// What was judged: those that failed with their curves at once, the others folded.

import { byId, css, el } from "../../view/page/dom.js";
import { bands, breaks, digits, Plots } from "./plots.js";

const HEIGHT = 210; // px of a lane
const PLACE_PX = 10; // that a place is wide at least
const SEVERAL = 12; // that passed; more are folded

export class Verdicts {
  // `goTo(verdict)`: shows its place in the rest of the page.
  constructor(data, columns, clock, goTo) {
    Object.assign(this, { data, columns, clock, goTo });
    const assertion = data.assertion ?? (data.complaint && { title: "assert", sentence: data.complaint, components: [], place: null, view: null, lanes: [] });
    this.cards = [...(assertion ? [assertion] : []), ...data.verdicts].map((verdict) => (verdict.passed ? this.folded(verdict) : this.open(verdict)));
    const passed = data.verdicts.filter((verdict) => verdict.passed).length;
    byId("passed-section").hidden = !passed;
    byId("passed-section").open = passed <= SEVERAL;
    byId("passed-title").textContent = `${passed} passed`;
  }

  open(verdict) {
    const host = el("div", { className: "curves" });
    const go = el("button", { type: "button", textContent: "Go to place", hidden: !verdict.place });
    const node = el("article", { className: "verdict card" },
      el("header", {}, el("b", { className: "bad", textContent: "failed" }), el("strong", { textContent: verdict.title }), el("span", { className: "soft", textContent: verdict.when ?? "" }), el("span", { className: "right" }), go),
      el("p", { className: "sentence", textContent: verdict.sentence }), host);
    byId("failed").append(node);
    const card = { verdict, node, host };
    go.onclick = () => this.goTo(verdict);
    new IntersectionObserver((entries, observer) => {
      if (!entries.some((entry) => entry.isIntersecting)) return;
      observer.disconnect();
      this.make(card);
    }, { rootMargin: "400px" }).observe(node);
    return card;
  }

  folded(verdict) {
    const host = el("div", { className: "curves" });
    const go = el("button", { type: "button", textContent: "Go to place", hidden: !verdict.place });
    const node = el("details", { className: "verdict" },
      el("summary", {}, el("b", { className: "good", textContent: "passed" }), el("strong", { textContent: verdict.title }), el("span", { textContent: verdict.sentence }), el("span", { className: "soft when", textContent: verdict.when ?? "" })),
      host, el("p", {}, go));
    byId("passed").append(node);
    const card = { verdict, node, host };
    go.onclick = () => this.goTo(verdict);
    node.ontoggle = () => { if (node.open) this.make(card); };
    return card;
  }

  make(card) {
    if (card.made) return;
    card.made = true;
    const { verdict, host } = card;
    const ends = verdict.lanes.flatMap((lane) => lane.traces).map(({ time }) => this.columns.times(time)).filter((times) => times.length).flatMap((times) => [times[0], times.at(-1)]);
    if (!ends.length) return;
    const span = [Math.min(...ends), Math.max(...ends)];
    card.plots = new Plots(this.clock, span, verdict.passed || !verdict.view ? span : verdict.view);
    verdict.lanes.forEach((lane, i) => this.addLane(card, lane, i === verdict.lanes.length - 1));
    if (verdict.passed || !verdict.view) return;
    const whole = el("button", { type: "button", textContent: "Whole run" });
    const place = el("button", { type: "button", textContent: "Its place" });
    whole.onclick = () => card.plots.zoom(...span);
    place.onclick = () => card.plots.zoom(...verdict.view);
    host.after(el("p", {}, place, " ", whole));
  }

  addLane({ verdict, plots, host }, lane, last) {
    const curves = lane.traces.map((trace) => {
      const times = this.columns.times(trace.time);
      return { ...trace, times, values: this.columns.curve(trace.values, times.length) };
    });
    const bounds = lane.bounds.map((bound) => {
      const times = this.columns.times(bound.time);
      return { ...bound, times, values: this.columns.numbers(bound.values, times.length) };
    });
    const row = el("div", { className: "lane" });
    host.append(row);
    const states = Object.keys(lane.names).length > 0;
    // One column of times for all: where a curve has no sample of its own, uPlot goes on to the next one it has.
    const same = curves.every(({ times }) => times === curves[0].times || (times.length === curves[0].times.length && times.every((t, i) => t === curves[0].times[i])));
    const [time, ...columns] = same ? [curves[0].times, ...curves.map((c) => c.values)] : uPlot.join(curves.map((c) => [c.times, c.values]));
    const outputs = curves.map(() => el("output"));
    const colour = (i) => this.data.palette[i % this.data.palette.length];
    plots.add(row, {
      height: states ? 30 * curves.length : HEIGHT,
      time,
      columns,
      last,
      yAxis: !states,
      yRange: states ? [0, 1] : () => range(curves, bounds, plots.window, verdict.passed),
      series: curves.map((trace, i) => (states
        ? { paths: () => null, points: { show: false } }
        : { label: trace.label, stroke: colour(i), width: 1.7, points: { show: false }, gaps: breaks(trace.holes, columns[i], trace.modulus) })),
      hooks: {
        drawAxes: [background(verdict, bounds)], // over the grid, which would hide limits at round values
        ...(states ? { draw: [bands(curves.map((c) => ({ times: c.times, values: c.values, names: lane.names, holes: c.holes })))] } : {}),
      },
      show: (at) => outputs.forEach((out, i) => {
        const value = at < 0 ? null : columns[i][at];
        out.textContent = value === null || value === undefined ? "" : states ? lane.names[value]?.[0] ?? String(value) : digits(value);
      }),
    });
    const entry = (className, style, label, ...more) => {
      const mark = el("i", { className });
      mark.style.borderColor = style;
      return el("div", { className: "entry" }, mark, el("span", { textContent: label }), ...more);
    };
    row.append(el("div", { className: "legend" },
      el("strong", { textContent: lane.unit ? `${lane.quantity} [${lane.unit}]` : lane.quantity }),
      ...curves.map((trace, i) => entry("", states ? "transparent" : colour(i), trace.label, outputs[i])),
      ...[...new Set(bounds.map((bound) => bound.label).filter(Boolean))].map((label) => entry("dashed", "var(--bad)", label))));
    plots.refresh();
  }
}

// Of the curves in view, of those bounds that are near enough not to flatten them, and of what was broken the nearest.
function range(curves, bounds, [from, to], passed) {
  let [low, high] = [Infinity, -Infinity];
  for (const { times, values } of curves) {
    for (let i = 0; i < times.length; ++i) {
      if (times[i] < from || times[i] > to || values[i] === null) continue;
      low = Math.min(low, values[i]);
      high = Math.max(high, values[i]);
    }
  }
  if (!(low <= high)) [low, high] = [0, 0];
  const extent = high - low;
  const [least, most] = [low, high];
  const near = (level) => level >= least - 1.5 * extent - Math.abs(level) * 1e-3 && level <= most + 1.5 * extent + Math.abs(level) * 1e-3;
  const breaks = { above: (level) => level < most, below: (level) => level > least, none: () => true };
  const away = (level) => Math.max(least - level, level - most, 0);
  let nearest = null;
  for (const { times, values, forbidden } of bounds) {
    for (const level of levels(times, values, from, to).filter(Number.isFinite)) {
      if (near(level)) [low, high] = [Math.min(low, level), Math.max(high, level)];
      if (!passed && breaks[forbidden](level) && (nearest === null || away(level) < away(nearest))) nearest = level;
    }
  }
  if (nearest !== null) [low, high] = [Math.min(low, nearest), Math.max(high, nearest)];
  const room = 0.12 * (high - low) || Math.abs(high) * 1e-3 || 1;
  return [low - room, high + room];
}

// The values of a bound in a window; those at its ends where none of its points is inside.
function levels(times, values, from, to) {
  const inside = [...values].filter((_, i) => times[i] >= from && times[i] <= to);
  if (inside.length || !values.length) return inside;
  const next = times.findIndex((t) => t > from);
  return next > 0 ? [values[next - 1], values[next]] : [values[next < 0 ? values.length - 1 : 0]];
}

// The place, the bounds, and what they forbid.
function background(verdict, bounds) {
  return (u) => {
    const { ctx } = u;
    const { left, top, width, height } = u.bbox;
    ctx.save();
    ctx.beginPath();
    ctx.rect(left, top, width, height);
    ctx.clip();
    if (verdict.place) {
      const [a, b] = verdict.place.map((t) => u.valToPos(t, "x", true));
      ctx.fillStyle = verdict.passed ? css("--good") : css("--bad");
      ctx.globalAlpha = 0.16;
      const room = Math.max(1, (PLACE_PX * devicePixelRatio - (b - a)) / 2); // to be seen beside the line of the time
      ctx.fillRect(a - room, top, b - a + 2 * room, height);
    }
    for (const { times, values, forbidden } of bounds) {
      const line = [...times].map((t, i) => [u.valToPos(t, "x", true), u.valToPos(values[i], "y", true)]);
      if (!line.length) continue;
      const path = () => {
        ctx.beginPath();
        line.forEach(([x, y], i) => (i ? ctx.lineTo(x, y) : ctx.moveTo(x, y)));
      };
      ctx.fillStyle = ctx.strokeStyle = css("--bad");
      if (forbidden !== "none") {
        const edge = forbidden === "above" ? top : top + height;
        path();
        ctx.lineTo(line.at(-1)[0], edge);
        ctx.lineTo(line[0][0], edge);
        ctx.globalAlpha = 0.07;
        ctx.fill();
      }
      path();
      ctx.globalAlpha = 0.95;
      ctx.lineWidth = 1.3 * devicePixelRatio;
      ctx.setLineDash([6 * devicePixelRatio, 4 * devicePixelRatio]);
      ctx.stroke();
      ctx.setLineDash([]);
    }
    ctx.restore();
  };
}
