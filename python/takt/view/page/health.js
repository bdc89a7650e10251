// How the engine is: its cycle, the times it takes, what was late, lost or refused.

import { byId, css, duration, el, fitCanvas, number, whole } from "./dom.js";
import { put } from "./rows.js";

const PACES = ["real time", "paced by the clock", "as fast as it goes"];
const RECENT = 100; // states of the engine, 10 s at 10 Hz

export class Health {
  constructor(model, scope, connection) {
    Object.assign(this, { model, scope, connection });
    this.recent = [];
    this.rate = { at: performance.now(), frames: 0, redraws: 0, messages: 0 };
    this.cards = new Map();
  }

  begin() {
    this.recent = [];
    this.engine = null;
    this.cards.clear();
    const card = (key, title, about) => {
      const value = el("b", { textContent: "–" });
      const node = el("div", { className: "figure", title: about }, value, el("span", { textContent: title }));
      this.cards.set(key, { node, value });
      return node;
    };
    const group = (title, ...cards) => el("section", {}, el("h2", { textContent: title }), el("div", { className: "cards" }, ...cards));
    byId("figures").replaceChildren(
      group("Engine", card("machine", "machine", ""), card("period", "cycle", "Length of a cycle"), card("pace", "pace", "Who makes time go on"), card("time", "time", "Since the start of the engine"), card("applied", "commands", "Taken up by the cycle"), card("clients", "clients", "That gave a sign of life within 2 s")),
      group("Counts that should stay 0", ...this.model.machine.counts.map(([key, title, about]) => card(key, title, about))),
      group("This page", card("lost", "states lost on the way", "Gaps in the sequence of what is looked at, over LCM"), card("skipped", "rows skipped", "Overwritten before this page took them: it is too slow"), card("signals", "signals", "In the scope"), card("values", "messages/s", "Taken by the scope, of all that are looked at"), card("frames", "frames/s", "From the server"), card("redraws", "redraws/s", "Of the scope, while it is seen"), card("took", "a redraw takes", "Mean"), card("memory", "memory", "Of this page, as the browser says it")),
    );
  }

  take() {
    const { engine } = this.model;
    if (!engine || engine === this.engine) return;
    this.engine = engine;
    this.recent.push({ execution: engine.execution, latency: engine.latency });
    if (this.recent.length > RECENT) this.recent.shift();
  }

  put(key, text, bad = false) {
    const card = this.cards.get(key);
    if (!card) return;
    put(card.value, text);
    card.node.classList.toggle("bad", bad);
  }

  draw() {
    const { model, engine, scope } = this;
    const { health, machine } = model;
    this.put("machine", `${machine.name}`);
    this.put("period", duration(machine.period_s));
    this.put("time", `${number(model.now, 1)} s`);
    if (engine) {
      this.put("pace", PACES[engine.pace] ?? "");
      this.put("applied", whole(engine.commands_applied));
      this.put("clients", String(engine.clients));
      for (const [key] of machine.counts) this.put(key, whole(engine[key]), engine[key] > 0);
    }
    this.put("lost", whole(health.lost ?? 0), health.lost > 0);
    this.put("skipped", whole(health.skipped ?? 0), health.skipped > 0);
    this.put("signals", String(scope.signals.length));
    const now = performance.now();
    if (now - this.rate.at > 1000) {
      const seconds = (now - this.rate.at) / 1000;
      this.put("frames", ((this.connection.frames - this.rate.frames) / seconds).toFixed(1));
      this.put("redraws", ((scope.redraws - this.rate.redraws) / seconds).toFixed(1));
      this.put("values", whole(Math.max(0, (health.messages - this.rate.messages) / seconds)));
      this.rate = { at: now, frames: this.connection.frames, redraws: scope.redraws, messages: health.messages };
      if (scope.took) this.put("took", duration(scope.took / 1000));
      const memory = performance.memory?.usedJSHeapSize;
      if (memory) this.put("memory", `${(memory / 1e6).toFixed(0)} MB`);
    }
    for (const what of ["execution", "latency"]) this.histogram(what);
  }

  // Bars of powers of two: since the start pale, of the last seconds strong.
  histogram(what) {
    const box = byId(`histogram-${what}`);
    const all = this.engine?.[what];
    const [width, height] = [box.clientWidth, box.clientHeight];
    const note = byId(`histogram-${what}-note`);
    if (width < 50) return;
    const c = fitCanvas(box.querySelector("canvas"), width, height);
    c.clearRect(0, 0, width, height);
    if (!all?.count) {
      put(note, "is measured in real time only");
      return;
    }
    const first = this.recent[0][what];
    const recent = all.buckets.map((count, i) => count - first.buckets[i]);
    const used = all.buckets.map((count, i) => [count, i]).filter(([count]) => count).map(([, i]) => i);
    const [from, to] = [Math.max(0, Math.min(...used) - 1), Math.min(31, Math.max(...used) + 1)];
    const most = Math.max(...all.buckets);
    const latest = Math.max(1, ...recent);
    const bar = (width - 20) / (to - from + 1);
    const base = height - 34;
    // A logarithmic height: what is rare is what one looks for.
    const tall = (count, of) => (count ? ((Math.log10(count) + 0.4) / (Math.log10(Math.max(of, 2)) + 0.4)) * (base - 16) : 0);
    c.font = `11px ${css("--font")}`;
    c.textAlign = "center";
    for (let i = from; i <= to; ++i) {
      const x = 10 + (i - from) * bar;
      c.fillStyle = css("--pale");
      c.fillRect(x + 2, base - tall(all.buckets[i], most), bar - 4, tall(all.buckets[i], most));
      c.fillStyle = css("--accent");
      const strong = tall(recent[i], latest) * Math.min(1, tall(latest, most) / (base - 16) || 0);
      c.fillRect(x + 2 + bar / 5, base - strong, bar - 4 - (2 * bar) / 5, strong);
      c.fillStyle = css("--soft");
      if (i < to && (bar > 30 || (i - from) % 2 === 0)) c.fillText(duration(2 ** (i + 1) * 1e-9).replace(/(\d)\.\d+ /, "$1 "), x + bar, height - 18);
      if (all.buckets[i] && bar > 38) c.fillText(all.buckets[i] >= 1e6 ? `${(all.buckets[i] / 1e6).toFixed(1)} M` : whole(all.buckets[i]), x + bar / 2, base - tall(all.buckets[i], most) - 6);
    }
    c.strokeStyle = css("--line");
    c.beginPath();
    c.moveTo(10, base + 0.5);
    c.lineTo(width - 10, base + 0.5);
    c.stroke();
    put(note, `median ${duration(quantile(all, 0.5))}, 99 % below ${duration(quantile(all, 0.99))}, longest ${duration(all.max * 1e-9)}`);
  }
}

// s below which so many of the times lie; bucket i holds those in [2^i, 2^(i+1)) ns.
function quantile({ buckets, count, max }, share) {
  let wanted = share * count;
  for (let i = 0; i < buckets.length - 1; ++i) {
    if (buckets[i] >= wanted && buckets[i]) return Math.min(2 ** i * (1 + wanted / buckets[i]), max) * 1e-9;
    wanted -= buckets[i];
  }
  return max * 1e-9;
}
