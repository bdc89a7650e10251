// The scope: signals over time, live, held by a trigger, or paused to be looked at and measured.

import { byId, css, duration, el, exact, number } from "./dom.js";
import { LaneDrawing, LEFT, layOut, modulusOf } from "./lanes.js";
import { Store } from "./store.js";
import { MODES, Trigger } from "./trigger.js";

const SPANS = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 40]; // s
const ORDER = ["position", "x position", "y position", "velocity", "acceleration", "jerk", "error", "following error", "torque", "voltage"];
const DRAG = 4; // px that make a drag of a click

export class Scope extends EventTarget {
  constructor(model) {
    super();
    this.model = model;
    this.store = new Store();
    this.trigger = new Trigger();
    this.signals = []; // {name, component, field, unit, colour, alone, ...}
    this.span = 10;
    this.held = null; // {store, from, to}: what is looked at instead of what is new
    this.paused = false;
    this.zoom = null; // {from, to} in cycles, of what is held
    this.a = this.b = null;
    this.hover = null;
    this.newest = 0;
    this.redraws = 0;
    this.said = 0; // when values were last put into the legend
    this.drawing = new LaneDrawing(byId("lanes"));
    this.box = byId("lane-box");
    this.controls();
    this.pointer();
  }

  get period() {
    return this.model.period;
  }

  get spanCycles() {
    return Math.max(1, Math.round(this.span / this.period));
  }

  // --- signals ---

  describe(component, fieldName) {
    const { palette, states } = this.model.machine;
    const field = this.model.field(component, fieldName);
    return { name: `${component.name}.${fieldName}`, component, field, unit: this.model.unit(component, fieldName), alone: false, palette, states };
  }

  has(name) {
    return this.signals.some((signal) => signal.name === name);
  }

  choose(names) {
    const kept = new Map(this.signals.map((signal) => [signal.name, signal]));
    this.signals = names.flatMap((name) => {
      const dot = name.lastIndexOf(".");
      const component = this.model.byName.get(name.slice(0, dot));
      if (!component || !this.model.field(component, name.slice(dot + 1))) return [];
      return [kept.get(name) ?? this.describe(component, name.slice(dot + 1))];
    });
    this.dispatchEvent(new Event("chosen"));
    this.layOut();
    this.fillTriggerSignals();
  }

  toggle(name) {
    const names = this.signals.map((signal) => signal.name);
    this.choose(this.has(name) ? names.filter((one) => one !== name) : [...names, name]);
  }

  forget() {
    this.store.clear();
    this.signals = [];
    this.held = this.zoom = this.a = this.b = null;
    this.paused = false;
    this.drawing.scales.clear();
    this.trigger.arm(this.store);
  }

  layOut() {
    const height = this.box.clientHeight;
    this.layout = layOut(this.signals, ORDER, height);
    for (const lane of this.layout.lanes) {
      lane.signals.forEach((signal, i) => (signal.colour = signal.palette[i % signal.palette.length]));
    }
    byId("scope-empty").hidden = this.signals.length > 0;
    this.legend();
  }

  legend() {
    const box = byId("legend");
    box.style.height = `${this.layout.height}px`;
    box.replaceChildren(
      ...this.layout.lanes.map((lane) => {
        const rows = lane.signals.map((signal) => {
          signal.output = el("output");
          const remove = el("button", { className: "quiet", title: "Remove", textContent: "×", onclick: () => this.toggle(signal.name) });
          const alone = el("button", { className: "quiet", title: signal.alone ? "Back to the others" : "A lane of its own", textContent: signal.alone ? "⤒" : "⤓" });
          alone.onclick = () => {
            signal.alone = !signal.alone;
            this.layOut();
          };
          const swatch = el("i");
          swatch.style.background = lane.band ? "transparent" : signal.colour;
          const title = `${signal.field.about}${signal.unit ? ` [${signal.unit}]` : ""}`;
          return el("div", { className: "entry", title }, swatch, el("span", { textContent: `${signal.component.name}.${signal.field.label}` }), signal.output, el("span", { className: "tools" }, lane.band ? null : alone, remove));
        });
        const head = lane.band ? [] : [el("strong", { textContent: lane.unit ? `${lane.title} [${lane.unit}]` : lane.title })];
        const node = el("div", { className: lane.band ? "lane-legend band" : "lane-legend" }, ...head, ...rows);
        node.style.top = `${lane.top}px`;
        node.style.height = `${lane.height}px`;
        return node;
      }),
    );
  }

  // --- time ---

  // After a frame.
  update(cycle) {
    this.newest = cycle;
    if (this.paused || !this.trigger.step(this.store, this.spanCycles, this.newestOfTrigger())) return;
    const from = this.trigger.at - this.spanCycles * this.trigger.before;
    this.hold(from, from + this.spanCycles, this.trigger.at);
    if (this.trigger.state === "held") this.pause(true);
  }

  newestOfTrigger() {
    return this.store.series.get(this.trigger.signal?.[0])?.last ?? -1;
  }

  hold(from, to, edge = null) {
    this.held = { store: this.store.piece(from, to), from, to, edge, since: performance.now() };
  }

  pause(on) {
    if (on && !this.held) {
      const window = this.liveWindow();
      this.held = { store: this.store.piece(0, window.to + 1), ...window, edge: null };
    }
    this.paused = on;
    if (!on) {
      this.held = this.zoom = null;
      this.trigger.arm(this.store);
    }
    byId("pause").setAttribute("aria-pressed", String(on));
    byId("pause").textContent = on ? "Run" : "Pause";
  }

  liveWindow() {
    return { from: this.newest - this.spanCycles, to: this.newest };
  }

  shown() {
    const trigger = this.trigger;
    const stale = trigger.mode === "auto" && this.held && performance.now() - this.held.since > Math.max(1000, 2000 * this.span);
    if (!this.held || (!this.paused && (trigger.mode === "off" || stale))) return { store: this.store, ...this.liveWindow() };
    return { store: this.held.store, ...(this.zoom ?? this.held) };
  }

  // --- drawing ---

  draw() {
    if (!this.layout || this.box.clientWidth < 50) return;
    const began = performance.now();
    const shown = this.shown();
    this.current = shown;
    const marks = [];
    const trigger = this.trigger;
    if (trigger.mode !== "off" && trigger.signal) {
      const name = `${this.model.components[trigger.signal[0]].name}.${trigger.signal[1]}`;
      marks.push({ lane: name, level: trigger.level, colour: css("--accent") });
      if (this.held?.edge && shown.store === this.held.store) marks.push({ cycle: this.held.edge, colour: css("--accent"), dashed: true, text: "T" });
    }
    for (const [name, cycle] of [["A", this.a], ["B", this.b]]) {
      if (cycle !== null) marks.push({ cycle, text: name, colour: css("--ink") });
    }
    if (this.hover !== null && this.drawing.window) marks.push({ cycle: this.drawing.cycleAt(this.hover), colour: css("--soft"), dashed: true });
    this.drawing.draw(shown.store, this.layout, shown, this.box.clientWidth - byId("legend").clientWidth, this.period, marks, { top: this.box.scrollTop, height: this.box.clientHeight });
    if (began - this.said > 90) {
      this.said = began;
      this.values(shown);
    }
    this.measure(shown);
    this.status();
    ++this.redraws;
    this.took = 0.9 * (this.took ?? 0) + 0.1 * (performance.now() - began);
  }

  values(shown) {
    const at = this.hover !== null ? this.drawing.cycleAt(this.hover) : shown.to;
    for (const signal of this.signals) {
      const value = shown.store.value(signal.component.index, signal.field.name, at);
      const name = this.model.nameOf(signal.component, signal.field.name, value);
      const text = name ?? (signal.field.whole ? exact(value) : number(value));
      if (signal.output.textContent !== text) signal.output.textContent = text;
    }
  }

  measure(shown) {
    const panel = byId("measured");
    const key = `${this.a}|${this.b}|${shown.from}|${this.signals.length}`;
    if (panel.dataset.key === key) return;
    panel.dataset.key = key;
    panel.hidden = this.a === null;
    if (this.a === null) return;
    const { a, b } = this;
    const time = (cycle) => (cycle === null ? "–" : `${(cycle * this.period).toFixed(4)} s`);
    const head = el("tr", {}, ...["", `A  ${time(a)}`, `B  ${time(b)}`, b === null ? "B − A" : `B − A  ${duration((b - a) * this.period)}`, "per s", "least between", "largest between"].map((t) => el("th", { textContent: t })));
    const rows = this.signals.map((signal) => {
      const index = signal.component.index;
      const value = (cycle) => (cycle === null ? NaN : shown.store.between(index, signal.field.name, cycle, signal.field.whole, modulusOf(signal)));
      const said = (v) => this.model.nameOf(signal.component, signal.field.name, v) ?? exact(v);
      const [va, vb] = [value(a), value(b)];
      const series = shown.store.series.get(index);
      const column = series?.columns.get(signal.field.name);
      let [low, high] = [Infinity, -Infinity];
      if (column && b !== null) {
        const [from, to] = [series.find(Math.min(a, b)), series.find(Math.max(a, b) + 1e-6)];
        for (let i = from; i < to; ++i) {
          low = Math.min(low, column[i]);
          high = Math.max(high, column[i]);
        }
        [low, high] = [Math.min(low, va, vb), Math.max(high, va, vb)];
      }
      const band = Boolean(signal.field.names || signal.field.flag);
      const difference = band ? "" : exact(vb - va);
      const rate = band || b === null || a === b ? "" : exact((vb - va) / ((b - a) * this.period));
      const cells = [said(va), said(vb), difference, rate, band || low > high ? "" : exact(low), band || low > high ? "" : exact(high)];
      return el("tr", {}, el("td", { textContent: signal.name }), ...cells.map((t, i) => el("td", { textContent: t && t !== "–" && !band && signal.unit ? `${t} ${signal.unit}${i === 3 ? "/s" : ""}` : t })));
    });
    panel.replaceChildren(el("table", {}, el("thead", {}, head), el("tbody", {}, ...rows)));
  }

  status() {
    const { trigger } = this;
    let text = "";
    if (trigger.mode !== "off") {
      const time = this.held?.edge ? ` at ${(this.held.edge * this.period).toFixed(4)} s` : "";
      text = !trigger.signal ? "choose a signal" : this.held?.edge ? `triggered${time}` : trigger.state === "filling" ? "filling" : "armed";
    }
    const node = byId("trigger-state");
    if (node.textContent !== text) node.textContent = text;
  }

  // --- what the user does ---

  controls() {
    const spans = byId("span");
    spans.append(...SPANS.map((s) => el("option", { value: s, textContent: s < 1 ? `${s * 1000} ms` : `${s} s`, selected: s === this.span })));
    spans.onchange = () => this.setSpan(Number(spans.value));
    byId("pause").onclick = () => this.pause(!this.paused);
    byId("clear-cursors").onclick = () => this.clearCursors();
    byId("save-csv").onclick = () => this.save();
    const mode = byId("trigger-mode");
    mode.append(...MODES.map((m) => el("option", { value: m, textContent: m })));
    mode.onchange = () => this.setTrigger({ mode: mode.value });
    byId("trigger-signal").onchange = ({ target }) => this.setTrigger({ name: target.value });
    byId("trigger-edge").onchange = ({ target }) => this.setTrigger({ edge: target.value });
    byId("trigger-name").onchange = ({ target }) => this.setTrigger({ level: Number(target.value) });
    byId("trigger-level").onchange = ({ target }) => this.setTrigger({ level: Number(target.value) });
    byId("trigger-before").onchange = ({ target }) => this.setTrigger({ before: Number(target.value) / 100 });
    new ResizeObserver(() => this.layOut()).observe(this.box);
  }

  setSpan(span) {
    this.span = span;
    byId("span").value = String(span);
    this.zoom = null;
    if (this.paused && this.held) {
      this.held = { ...this.held, from: this.held.to - this.spanCycles };
    } else {
      this.held = null;
      this.trigger.arm(this.store);
    }
  }

  setTrigger({ name, ...more }) {
    Object.assign(this.trigger, more);
    if (name !== undefined) {
      const signal = this.signals.find((one) => one.name === name);
      this.trigger.signal = signal ? [signal.component.index, signal.field.name] : null;
      const lane = this.layout.lanes.find((one) => one.signals.includes(signal));
      const { names, flag } = signal?.field ?? {};
      this.trigger.ofState = Boolean(names);
      const states = Object.entries(names ?? {}).map(([value, text]) => el("option", { value, textContent: text }));
      byId("trigger-name").replaceChildren(...states);
      byId("trigger-name").hidden = !names;
      byId("trigger-level").parentElement.hidden = Boolean(names || flag);
      if (flag) this.trigger.level = 0.5;
      else if (names) this.trigger.level = more.level ?? Number(states[0].value);
      else if (lane?.scale && more.level === undefined) this.trigger.level = Number(((lane.scale[0] + lane.scale[1]) / 2).toPrecision(3));
      byId("trigger-signal").value = signal ? name : "";
    }
    if (this.trigger.mode !== "off" && !this.trigger.signal && this.signals.length) {
      this.setTrigger({ name: this.signals.find((one) => !one.field.names && !one.field.flag)?.name ?? this.signals[0].name });
    }
    byId("trigger-mode").value = this.trigger.mode;
    byId("trigger-edge").value = this.trigger.edge;
    byId("trigger-level").value = byId("trigger-name").value = String(this.trigger.level);
    byId("trigger-before").value = String(100 * this.trigger.before);
    byId("trigger-more").hidden = this.trigger.mode === "off";
    this.held = null;
    if (this.paused) this.pause(false);
    this.trigger.arm(this.store);
  }

  fillTriggerSignals() {
    const select = byId("trigger-signal");
    const now = select.value;
    select.replaceChildren(...this.signals.map((signal) => el("option", { value: signal.name, textContent: signal.name })));
    if (this.has(now)) select.value = now;
    else if (this.trigger.mode !== "off") this.setTrigger({ mode: this.trigger.mode, name: this.signals[0]?.name ?? "" });
  }

  clearCursors() {
    this.a = this.b = null;
  }

  // No further than there are samples, or than the window went when it was paused.
  setZoom(from, to) {
    if (!(to - from > 2)) return;
    if (!this.paused) this.pause(true);
    const { held } = this;
    const [first, last] = held.store.extent() ?? [held.from, held.to];
    const [least, most] = [Math.min(first, held.from), Math.max(last, held.to)];
    const length = Math.min(to - from, most - least);
    const begin = Math.min(Math.max(from, least), most - length);
    this.zoom = { from: begin, to: begin + length };
  }

  pointer() {
    const canvas = byId("lanes");
    const rubber = byId("rubber");
    let from = null;
    canvas.onpointerdown = (event) => {
      if (event.button !== 0 || event.offsetX < LEFT) return;
      from = event.offsetX;
      canvas.setPointerCapture(event.pointerId);
    };
    canvas.onpointermove = (event) => {
      this.hover = event.offsetX >= LEFT ? event.offsetX : null;
      if (from !== null && Math.abs(event.offsetX - from) > DRAG) {
        const [left, right] = [Math.max(LEFT, Math.min(from, event.offsetX)), Math.max(from, event.offsetX)];
        Object.assign(rubber.style, { left: `${left}px`, width: `${right - left}px`, height: `${this.layout.height}px` });
        rubber.hidden = false;
      }
    };
    canvas.onpointerup = (event) => {
      if (from === null) return;
      const [x0, x1] = [Math.max(LEFT, Math.min(from, event.offsetX)), Math.max(from, event.offsetX)];
      if (x1 - x0 > DRAG) this.setZoom(this.drawing.cycleAt(x0), this.drawing.cycleAt(x1));
      else this.setCursor(this.drawing.cycleAt(event.offsetX), event.shiftKey);
      from = null;
      rubber.hidden = true;
    };
    canvas.onpointerleave = () => (this.hover = null);
    canvas.ondblclick = () => {
      this.zoom = null;
      this.clearCursors();
    };
    canvas.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
  }

  setCursor(at, second) {
    if (!this.paused) this.pause(true);
    const cycle = Math.round(at);
    if (second || (this.a !== null && this.b === null)) this.b = cycle;
    else [this.a, this.b] = [cycle, null];
  }

  wheel(event) {
    if (event.ctrlKey || this.box.scrollHeight > this.box.clientHeight + 1 && event.offsetX < LEFT) return;
    event.preventDefault();
    const factor = event.deltaY > 0 ? 1.25 : 0.8;
    if (!this.paused) {
      const i = SPANS.findIndex((span) => span >= this.span);
      this.setSpan(SPANS[Math.min(SPANS.length - 1, Math.max(0, i + (factor > 1 ? 1 : -1)))]);
      return;
    }
    const middle = this.drawing.cycleAt(event.offsetX);
    const { from, to } = this.drawing.window;
    this.setZoom(middle - (middle - from) * factor, middle + (to - middle) * factor);
  }

  // What is shown, as a table: time, and a column a signal; rows of each component.
  save() {
    const shown = this.shown();
    const cycles = new Set();
    for (const series of shown.store.series.values()) {
      for (let i = series.find(shown.from); i < series.end && series.cycles[i] <= shown.to; ++i) cycles.add(series.cycles[i]);
    }
    const decimals = Math.max(0, Math.ceil(-Math.log10(this.period)) + 3);
    const lines = [["time_s", ...this.signals.map((s) => (s.unit ? `${s.name} [${s.unit}]` : s.name))].join(",")];
    for (const cycle of [...cycles].sort((a, b) => a - b)) {
      const values = this.signals.map((s) => shown.store.value(s.component.index, s.field.name, cycle));
      lines.push([(cycle * this.period).toFixed(decimals), ...values.map((v) => (Number.isNaN(v) ? "" : v))].join(","));
    }
    const link = el("a", { href: URL.createObjectURL(new Blob([`${lines.join("\n")}\n`], { type: "text/csv" })), download: "scope.csv" });
    link.click();
    URL.revokeObjectURL(link.href);
  }
}

