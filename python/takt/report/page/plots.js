// Curves over time that share a window: drawn by uPlot, with a line at the page's time.

import { css } from "../../view/page/dom.js";
import { rowAt } from "./columns.js";

const AXIS_PX = 62;
const CLICK_PX = 3; // as far as a mouse may move that only clicks

export const digits = (v) => (v === null || v === undefined || Number.isNaN(v) ? "—" : Math.abs(v) >= 1e5 || (v && Math.abs(v) < 1e-3) ? v.toExponential(2) : String(+v.toPrecision(6)));

export const font = (px) => `${px * devicePixelRatio}px ${css("--font")}`;

// All plots of the page, to be drawn anew when colours change.
const everything = [];
export const redrawAll = () => everything.forEach((plot) => plot.redraw(false));

export class Plots {
  // `span`: where a double click leads.
  constructor(clock, span, window = span) {
    this.clock = clock;
    this.span = [...span];
    this.window = [...window];
    this.items = [];
    this.observer = new IntersectionObserver((entries) => {
      for (const entry of entries) {
        const item = this.items.find((one) => one.node === entry.target);
        if (item) item.seen = entry.isIntersecting;
      }
      this.refresh();
    }, { rootMargin: "400px" });
    clock.addEventListener("change", () => this.items.forEach((item) => item.seen && this.mark(item)));
  }

  zoom(from, to) {
    this.window = [from, to];
    for (const item of this.items) item.stale = true;
    this.refresh();
  }

  redraw() {
    for (const { plot } of this.items) plot.redraw(false);
  }

  refresh() {
    for (const item of this.items) {
      if (!item.seen) continue;
      if (item.stale) {
        item.stale = false;
        item.plot.setScale("x", { min: this.window[0], max: this.window[1] });
      }
      this.mark(item);
    }
  }

  // Puts the line where the time is, and tells what the curves are there, unless the mouse asks for another place.
  mark(item) {
    const { plot, line, show } = item;
    const x = plot.valToPos(this.clock.time, "x");
    line.hidden = !(x >= 0 && x <= plot.over.clientWidth);
    line.style.transform = `translateX(${x}px)`;
    if (plot.cursor.idx == null || plot.cursor.left < 0) show?.(rowAt(plot.data[0], this.clock.time));
  }

  // `show(row)`: tells the values of a row, -1 for none.
  add(host, { height, series, columns, time, hooks = {}, yAxis = true, last = true, yRange, show }) {
    const cell = document.createElement("div");
    host.append(cell);
    const line = { stroke: () => css("--grid"), width: 1 };
    const options = {
      width: Math.max(cell.clientWidth, 200),
      height: height + (last ? 30 : 0),
      legend: { show: false },
      padding: [8, 18, last ? 0 : 4, 0],
      cursor: { sync: { key: "takt" }, points: { size: 6 }, drag: { x: true, y: false, setScale: false }, bind: { dblclick: () => () => this.zoom(...this.span) } },
      scales: { x: { time: false, min: this.window[0], max: this.window[1], range: (_, a, b) => [a, b] }, y: yRange ? { range: yRange } : {} },
      axes: [
        { stroke: () => css("--soft"), grid: line, ticks: { show: last, ...line, size: 5 }, size: last ? 30 : 0, values: last ? undefined : (_, splits) => splits.map(() => "") },
        { stroke: () => css("--soft"), grid: { ...line, show: yAxis }, ticks: { ...line, size: 5, show: yAxis }, size: AXIS_PX, space: 24,
          values: (_, splits) => (yAxis ? splits.map((v) => digits(+v.toPrecision(10))) : splits.map(() => "")) },
      ],
      series: [{}, ...series],
      hooks: {
        ...hooks,
        draw: [...(hooks.draw ?? []), () => item && this.mark(item)],
        setCursor: [(u) => { if (item && u.cursor.idx != null) show?.(u.cursor.idx); else if (item) this.mark(item); }],
        setSelect: [(u) => {
          if (u.select.width < CLICK_PX) return;
          const ends = [u.select.left, u.select.left + u.select.width].map((x) => u.posToVal(x, "x"));
          u.setSelect({ left: 0, width: 0, top: 0, height: 0 }, false);
          this.zoom(...ends);
        }],
      },
    };
    let item = null;
    const plot = new uPlot(options, [time, ...columns], cell);
    plot.setScale("x", { min: this.window[0], max: this.window[1] });
    const mark = document.createElement("div");
    mark.className = "now";
    plot.over.append(mark);
    item = { plot, node: cell, seen: true, stale: false, line: mark, show };
    this.items.push(item);
    everything.push(plot);
    this.mark(item);
    this.listen(plot);
    this.observer.observe(cell);
    new ResizeObserver(() => {
      if (cell.clientWidth > 0 && cell.clientWidth !== plot.width) plot.setSize({ width: cell.clientWidth, height: options.height });
    }).observe(cell);
    return plot;
  }

  // A click moves the time.
  listen(plot) {
    let down = null;
    plot.over.addEventListener("mousedown", (event) => { down = event.button === 0 ? event.clientX : null; });
    plot.over.addEventListener("mouseup", (event) => {
      if (down === null || Math.abs(event.clientX - down) >= CLICK_PX) return;
      this.clock.set(plot.posToVal(event.clientX - plot.over.getBoundingClientRect().left, "x"));
    });
  }
}

// Stretches in which states do not change, as bands one below the other. Rows: {times, values, names, holes}.
export function bands(rows) {
  const stretches = rows.map(({ times, values, holes }) => {
    const found = [];
    for (let i = 0, from = 0; i < times.length; i++) {
      if (i < times.length - 1 && values[i + 1] === values[i]) continue;
      found.push([times[from], times[Math.min(i + 1, times.length - 1)], values[i]]);
      from = i + 1;
    }
    return outside(holes, found);
  });
  return (u) => {
    const { ctx } = u;
    const { left, top, width, height } = u.bbox;
    const each = height / rows.length;
    ctx.save();
    ctx.beginPath();
    ctx.rect(left, top, width, height);
    ctx.clip();
    ctx.font = "600 " + font(11);
    ctx.textAlign = "center";
    ctx.textBaseline = "middle";
    stretches.forEach((row, k) => {
      for (const [from, to, value] of row) {
        const known = rows[k].names[value];
        if (!known && value === 0) continue;
        const [name, colour] = known ?? [`?${value}`, "#8b939e"];
        const a = Math.max(u.valToPos(from, "x", true), left);
        const b = Math.min(u.valToPos(to, "x", true), left + width);
        if (b <= a) continue;
        ctx.fillStyle = colour;
        ctx.fillRect(a, top + k * each + 2, b - a, each - 4);
        if (ctx.measureText(name).width + 10 < b - a) {
          ctx.fillStyle = "#ffffff";
          ctx.fillText(name, (a + b) / 2, top + (k + 0.5) * each);
        }
      }
    });
    ctx.restore();
  };
}

// What of stretches is known. Both are in the order of time.
function outside(holes, stretches) {
  let next = 0;
  return stretches.flatMap(([from, to, value]) => {
    const parts = [];
    while (next < holes.length && holes[next][1] <= from) next++;
    for (let i = next; i < holes.length && holes[i][0] < to; i++) {
      parts.push([from, holes[i][0], value]);
      from = holes[i][1];
    }
    return [...parts, [from, to, value]];
  });
}

// Where samples are missing a curve is not joined, nor where a rotary position wraps.
export function breaks(holes, values, modulus) {
  const jumps = [];
  if (modulus) for (let i = 1; i < values.length; i++) if (Math.abs(values[i] - values[i - 1]) > modulus / 2) jumps.push(i);
  return (u, _, from, to, gaps) => {
    const wraps = jumps.filter((i) => i > from && i <= to).map((i) => [u.data[0][i - 1], u.data[0][i]]);
    const more = [...holes, ...wraps].map((ends) => ends.map((t) => Math.round(u.valToPos(t, "x", true))));
    const all = gaps.concat(more).sort((a, b) => a[0] - b[0]);
    for (let i = 1; i < all.length; i++) all[i][1] = Math.max(all[i][1], all[i - 1][1]); // uPlot goes on at the last one's end
    return all;
  };
}
