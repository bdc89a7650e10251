// How the signals of the scope are laid out, one below the other, and drawn.

import { css, fitCanvas, ticks, tone } from "./dom.js";
import { Envelope } from "./envelope.js";
import { Roll } from "./roll.js";

export const LEFT = 64; // px for the numbers
export const BOTTOM = 22;
const BAND = 20;
const BETWEEN = 8;
const LEAST = 74;
const MANY = 8; // signals: of more of them each has a hairline, which is drawn much faster
const OVER = 4; // px: how far the end of a curve reaches back

export const isBand = (signal) => Boolean(signal.field.names || signal.field.flag);

// Positions of rotary axes wrap: that is no motion.
export const modulusOf = (signal) => (signal.component.modulus && signal.field.quantity === "position" ? signal.component.modulus : Infinity);

// Signals of a quantity and unit share a lane, unless one was given a lane of its own. States and switches are bands.
export function layOut(signals, order, height) {
  const lanes = new Map();
  for (const signal of signals) {
    const band = isBand(signal);
    const quantity = signal.field.quantity;
    const key = band ? "bands" : signal.alone ? `alone ${signal.name}` : `${quantity}|${signal.unit}`;
    if (!lanes.has(key)) {
      const rank = order.indexOf(quantity);
      lanes.set(key, { key, band, title: band ? "" : quantity, unit: band ? "" : signal.unit, signals: [], rank: band ? 1e6 : rank < 0 ? 1e3 : rank });
    }
    lanes.get(key).signals.push(signal);
  }
  const all = [...lanes.values()].sort((a, b) => a.rank - b.rank);
  const numeric = all.filter((lane) => !lane.band);
  const bands = all.reduce((sum, lane) => sum + (lane.band ? lane.signals.length * BAND : 0), 0);
  const free = height - BOTTOM - bands - BETWEEN * (all.length + 1);
  const each = numeric.map((lane) => Math.max(LEAST, lane.signals.length * 17 + 20));
  const least = each.reduce((a, b) => a + b, 0);
  const spare = Math.max(0, free - least) / Math.max(1, numeric.length);
  let top = BETWEEN;
  for (const lane of all) {
    lane.top = top;
    lane.height = lane.band ? lane.signals.length * BAND : each[numeric.indexOf(lane)] + spare;
    top += lane.height + BETWEEN;
  }
  return { lanes: all, height: Math.max(height, top + BOTTOM) };
}

function rangeOf(series, column, from, to) {
  let low = Infinity;
  let high = -Infinity;
  for (let i = from; i < to; ++i) {
    const value = column[i];
    if (value < low) low = value;
    if (value > high) high = value;
  }
  return [low, high];
}

// More cycles than these between two rows, and something between them was not received.
function longestStep({ cycles }, from, to) {
  return to - from > 2 ? Math.max((5 * (cycles[to - 1] - cycles[from])) / (to - from - 1), 50) : Infinity;
}

// The scale of a lane: grows at once, shrinks only when much of it is empty, so that it stands still.
function scaleFor(lane, low, high, scales) {
  if (!(low <= high)) return scales.get(lane.key) ?? [0, 1];
  const reach = high - low || Math.abs(high) * 0.05 || 1;
  const wanted = [low - 0.08 * reach - (high === low ? reach : 0), high + 0.08 * reach + (high === low ? reach : 0)];
  const now = scales.get(lane.key);
  const fits = now && now[0] <= low && now[1] >= high && wanted[1] - wanted[0] > 0.5 * (now[1] - now[0]);
  if (!fits) scales.set(lane.key, wanted);
  return scales.get(lane.key);
}

// As much of a text as there is room for.
function fitting(c, text, room) {
  if (c.measureText(text).width <= room) return text;
  while (text && c.measureText(`${text}…`).width > room) text = text.slice(0, -1);
  return `${text.trimEnd()}…`;
}

export class LaneDrawing {
  constructor(canvas) {
    this.canvas = canvas;
    canvas.getContext("2d", { alpha: false }); // so that nothing has to be mixed with what lies behind it
    this.roll = new Roll();
    this.scales = new Map();
  }

  // window: {from, to} in cycles, which are moved to whole pixels of the screen; layout as from layOut.
  // `seen`: from and to where the lanes are in sight.
  draw(store, layout, window, width, period, marks, seen) {
    const c = fitCanvas(this.canvas, width, seen.height);
    const ratio = c.getTransform().a;
    const pixels = Math.max(10, Math.floor((width - LEFT - 2) * ratio));
    const size = (window.to - window.from) / pixels; // cycles
    const first = Math.ceil(window.to / size) - pixels;
    const inner = pixels / ratio;
    Object.assign(this, { size, inner, ratio, window: { from: first * size, to: (first + pixels) * size } });
    c.fillStyle = css("--card");
    c.fillRect(0, 0, width, seen.height);
    c.translate(0, -seen.top);
    const lanes = layout.lanes.filter((lane) => lane.top + lane.height > seen.top && lane.top < seen.top + seen.height);
    c.font = `11px ${css("--font")}`;
    const x = (cycle) => LEFT + (cycle / size - first) / ratio;
    this.timeGrid(c, layout, period, x);
    const places = layout.lanes.map((lane) => `${lane.key} ${lane.top} ${lane.height}`);
    this.roll.begin(pixels, this.canvas.height, first, size, [seen.top, ...places]);
    for (const lane of lanes) {
      c.save();
      if (lane.band) this.bands(c, lane, store, x);
      else this.curves(c, lane, store, seen.top, layout);
      c.restore();
    }
    c.save();
    c.resetTransform();
    this.roll.show(c, Math.round(LEFT * ratio));
    c.restore();
    this.bottom = Math.min(layout.height, seen.top + seen.height) - BOTTOM;
    this.timeAxis(c, width, period, x);
    for (const mark of marks) this.mark(c, mark, layout, x);
  }

  timeGrid(c, layout, period, x) {
    const { inner, window } = this;
    c.lineWidth = 1;
    c.strokeStyle = css("--grid");
    c.beginPath();
    for (const time of ticks(window.from * period, window.to * period, inner / 90).at) {
      const px = Math.round(x(time / period)) + 0.5;
      for (const lane of layout.lanes) {
        c.moveTo(px, lane.top);
        c.lineTo(px, lane.top + lane.height);
      }
    }
    c.stroke();
  }

  // Below what is in sight of the lanes.
  timeAxis(c, width, period, x) {
    const { inner, window } = this;
    c.fillStyle = css("--card");
    c.fillRect(0, this.bottom, width, BOTTOM);
    c.fillStyle = css("--soft");
    c.textAlign = "center";
    c.textBaseline = "top";
    const { at, decimals } = ticks(window.from * period, window.to * period, inner / 90);
    for (const time of at) {
      const text = time.toFixed(decimals).replace("-", "−");
      const half = c.measureText(text).width / 2;
      c.fillText(text, Math.min(x(time / period), LEFT + inner - half - 12), this.bottom + 5);
    }
    c.textAlign = "right";
    c.fillText("s", LEFT + inner, this.bottom + 5);
  }

  curves(c, lane, store, above, layout) {
    const { ratio, window } = this;
    const found = [];
    let [low, high] = [Infinity, -Infinity];
    for (const signal of lane.signals) {
      const series = store.series.get(signal.component.index);
      const column = series?.columns.get(signal.field.name);
      if (!column) continue;
      const from = Math.max(0, series.find(window.from) - 1);
      const to = Math.min(series.end, series.find(window.to) + 1);
      const one = { signal, series, column, from, to };
      this.envelope(one);
      const [a, b] = one.envelope ? one.envelope.range(...one.envelope.part(window.from, window.to)) : rangeOf(series, column, from, to);
      low = Math.min(low, a);
      high = Math.max(high, b);
      found.push(one);
    }
    const [bottom, top] = scaleFor(lane, low, high, this.scales);
    lane.scale = [bottom, top];
    const y = (value) => lane.top + lane.height * (1 - (value - bottom) / (top - bottom));
    this.frame(c, lane, bottom, top, y);
    const many = layout.lanes.reduce((sum, one) => sum + one.signals.length, 0) > MANY;
    const made = [bottom, top, many, ...found.flatMap(({ signal, series, column, envelope }) => [tone(signal.colour), series, column, envelope])];
    const [upper, lower] = [lane.top - 1, lane.top + lane.height + 1].map((at) => Math.round((at - above) * ratio));
    this.roll.update(lane.key, upper, lower - upper, made, found.map((one) => one.series.last), OVER * Math.ceil(ratio), (roll, x, from, to) => {
      roll.lineJoin = "bevel";
      for (const one of found) {
        roll.strokeStyle = tone(one.signal.colour);
        roll.lineWidth = (one.envelope || many ? 1 : 1.35) * ratio;
        roll.beginPath();
        const py = (value) => (y(value) - above) * ratio;
        if (one.envelope) this.trace(roll, one, from, to, x, py);
        else this.points(roll, one, from, to, x, py);
        roll.stroke();
      }
    });
  }

  // What is drawn of a signal with many more rows than there are pixels; kept with its series.
  envelope(one) {
    const size = this.size * this.ratio; // of a pixel of CSS
    const known = (one.series.envelopes ??= new Map());
    const name = one.signal.field.name;
    const fits = known.get(name)?.size === size && known.get(name).column === one.column;
    if (one.to - one.from < (fits ? 2 : 2.5) * this.inner) return; // does not go to and fro between the two
    if (!fits) known.set(name, Object.assign(new Envelope(size), { column: one.column }));
    one.envelope = known.get(name);
    one.envelope.update(one.series, one.column);
  }

  trace(c, { signal, envelope }, from, to, x, y) {
    const { low, high, first, size } = envelope;
    const jump = modulusOf(signal) / 2;
    const [begin, end] = envelope.part(from, to);
    let down = false;
    let last = NaN;
    for (let i = begin; i < end; ++i) {
      if (low[i] > high[i] || high[i] - low[i] > jump) {
        down = false;
        continue;
      }
      if (i > begin && Math.abs(high[i] - high[i - 1]) > jump) down = false;
      const px = x((first + i + 0.5) * size);
      let [a, b] = [y(high[i]), y(low[i])];
      if (down && Math.abs(b - last) < Math.abs(a - last)) [a, b] = [b, a]; // on from the nearer end: rising and falling edges look alike
      if (!down) c.moveTo(px, a);
      else c.lineTo(px, a);
      if (Math.abs(b - a) > 0.6) c.lineTo(px, b);
      last = Math.abs(b - a) > 0.6 ? b : a;
      down = true;
    }
  }

  points(c, { signal, series, column, ...seen }, from, to, x, y) {
    const stairs = signal.field.whole;
    const modulus = modulusOf(signal);
    const longest = longestStep(series, seen.from, seen.to);
    const begin = Math.max(0, series.find(from) - 1);
    const end = Math.min(series.end, series.find(to) + 1);
    let last = NaN;
    for (let i = begin; i < end; ++i) {
      const value = column[i];
      if (value !== value) {
        last = NaN;
        continue;
      }
      const px = x(series.cycles[i]);
      const hole = i > begin && series.cycles[i] - series.cycles[i - 1] > longest;
      if (last !== last || hole || Math.abs(value - last) > modulus / 2) c.moveTo(px, y(value));
      else {
        if (stairs) c.lineTo(px, y(last));
        c.lineTo(px, y(value));
      }
      last = value;
    }
  }

  frame(c, lane, bottom, top, y) {
    const { inner } = this;
    const { at, decimals } = ticks(bottom, top, Math.max(3, lane.height / 34));
    c.lineWidth = 1;
    c.textAlign = "right";
    c.textBaseline = "middle";
    for (const value of at) {
      const py = Math.round(y(value)) + 0.5;
      if (py < lane.top + 2 || py > lane.top + lane.height - 2) continue;
      c.strokeStyle = Math.abs(value) < 1e-12 ? css("--zero") : css("--grid");
      c.beginPath();
      c.moveTo(LEFT, py);
      c.lineTo(LEFT + inner, py);
      c.stroke();
      c.fillStyle = css("--soft");
      const text = Math.abs(value) >= 1e6 ? value.toExponential(1) : value.toFixed(decimals);
      if (py > lane.top + 6 && py < lane.top + lane.height - 5) c.fillText(text.replace("-", "−"), LEFT - 6, py);
    }
    c.strokeStyle = css("--line");
    c.strokeRect(LEFT + 0.5, Math.round(lane.top) + 0.5, inner - 1, Math.round(lane.height) - 1);
  }

  bands(c, lane, store, x) {
    lane.signals.forEach((signal, row) => {
      const top = lane.top + row * BAND;
      c.fillStyle = css("--soft");
      c.textAlign = "right";
      c.textBaseline = "middle";
      c.fillText(fitting(c, `${signal.component.name} ${signal.field.label}`, LEFT - 10), LEFT - 6, top + BAND / 2);
      c.save();
      c.beginPath();
      c.rect(LEFT, top, this.inner, BAND);
      c.clip();
      this.band(c, signal, store, x, top);
      c.restore();
    });
  }

  band(c, signal, store, x, top) {
    const { window } = this;
    const series = store.series.get(signal.component.index);
    const column = series?.columns.get(signal.field.name);
    if (!column) return;
    const from = Math.max(0, series.find(window.from) - 1);
    const to = Math.min(series.end, series.find(window.to) + 1);
    const longest = longestStep(series, from, to);
    let begin = from;
    for (let i = from; i < to; ++i) {
      const ends = i + 1 >= to || series.cycles[i + 1] - series.cycles[i] > longest;
      if (!ends && Object.is(column[i + 1], column[begin])) continue;
      const value = column[begin];
      const [a, b] = [x(series.cycles[begin]), x(series.cycles[ends ? i : i + 1])];
      begin = i + 1;
      if (value !== value) continue;
      const name = signal.field.names ? (signal.field.names[value] ?? `?${value}`) : value ? signal.field.label : "";
      if (!name) continue;
      c.fillStyle = signal.states[name] ?? signal.palette[Math.abs(value) % signal.palette.length];
      c.globalAlpha = 0.85;
      c.fillRect(a, top + 2, Math.max(1, b - a), BAND - 4);
      c.globalAlpha = 1;
      const visible = Math.min(b, LEFT + this.inner) - Math.max(a, LEFT);
      if (c.measureText(name).width + 8 < visible) {
        c.fillStyle = "#fff";
        c.textAlign = "center";
        c.fillText(name, Math.max(a, LEFT) + visible / 2, top + BAND / 2 + 0.5);
      }
    }
  }

  // A line down all lanes: {cycle, text, colour}; or a level in one: {lane, level, colour}.
  mark(c, mark, layout, x) {
    const { inner } = this;
    c.strokeStyle = c.fillStyle = mark.colour;
    c.lineWidth = 1;
    if (mark.lane !== undefined) {
      const lane = layout.lanes.find((one) => one.signals.some((signal) => signal.name === mark.lane));
      if (!lane?.scale) return;
      const py = lane.top + lane.height * (1 - (mark.level - lane.scale[0]) / (lane.scale[1] - lane.scale[0]));
      if (py < lane.top || py > lane.top + lane.height) return;
      c.setLineDash([4, 4]);
      c.beginPath();
      c.moveTo(LEFT, py);
      c.lineTo(LEFT + inner, py);
      c.stroke();
      c.setLineDash([]);
      c.beginPath();
      c.moveTo(LEFT + inner, py);
      c.lineTo(LEFT + inner - 8, py - 5);
      c.lineTo(LEFT + inner - 8, py + 5);
      c.fill();
      return;
    }
    const px = Math.round(x(mark.cycle)) + 0.5;
    if (px < LEFT || px > LEFT + inner + 1) return;
    c.setLineDash(mark.dashed ? [3, 3] : []);
    c.beginPath();
    c.moveTo(px, 2);
    c.lineTo(px, this.bottom);
    c.stroke();
    c.setLineDash([]);
    if (!mark.text) return;
    c.font = `600 10px ${css("--font")}`;
    const half = c.measureText(mark.text).width / 2 + 4;
    c.fillRect(px - half, this.bottom + 3, 2 * half, 15);
    c.fillStyle = css("--card");
    c.textAlign = "center";
    c.textBaseline = "middle";
    c.fillText(mark.text, px, this.bottom + 11);
  }

  cycleAt(px) {
    return this.window.from + ((px - LEFT) / this.inner) * (this.window.to - this.window.from);
  }
}
