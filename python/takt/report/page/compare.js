// The page of two runs: tables of what differs, and curves over one another with their difference below.

import { byId, css, el, forgetColours } from "../../view/page/dom.js";
import { Clock, showPlayer } from "./clock.js";
import { Columns, inflated } from "./columns.js";
import { bands, breaks, digits, Plots, redrawAll } from "./plots.js";

const [TALL, LOW, DELTA, BAND] = [140, 100, 64, 28]; // px: lanes of positions, others, differences, a state
const SHOWN = 40; // rows of the table of differences at first

const data = JSON.parse(byId("data").textContent);
const columns = new Columns(await inflated(byId("columns").textContent));
const runs = data.runs.map((run) => {
  const times = run.bases.map((base) => columns.times(base));
  return new Map(run.components.map((component) => [component.name, { component, time: times[component.base], fields: new Map(component.fields.map((f) => [f.name, f])) }]));
});
const colours = [data.palette[0], data.palette[1]];
const step = Math.min(1, ...runs.flatMap((run) => [...run.values()].map(({ time }) => time).filter((t) => t.length > 1).map((t) => (t.at(-1) - t[0]) / (t.length - 1))));
const clock = new Clock(data.span, step);
const plots = new Plots(clock, data.span);
const blocks = new Map();

// --- tables ---

const cell = (text, properties = {}) => el("td", { textContent: text ?? "—", ...properties });
const head = (...titles) => el("thead", {}, el("tr", {}, ...titles.map((textContent) => el("th", { textContent }))));

function named(index) {
  const mark = el("i", { className: "run" });
  mark.style.background = colours[index];
  return el("th", {}, mark, data.names[index]);
}

const pairHead = () => el("thead", {}, el("tr", {}, el("th"), named(0), named(1)));

function showHead() {
  document.querySelector("h1").replaceChildren(...data.names.flatMap((name, i) => {
    const part = el("span", { textContent: name });
    part.style.color = colours[i];
    return i ? [el("span", { className: "soft", textContent: " and " }), part] : [part];
  }));
  const differing = data.signals.filter((signal) => signal.differs).length;
  const pill = byId("pill");
  const apart = differing || data.incomparable.length || data.only.some((there) => there.length);
  pill.className = `pill ${apart ? "" : "good"}`;
  pill.textContent = differing ? `${differing} of ${data.signals.length} signals differ` : apart ? "not all could be compared" : "no difference";
  byId("sentence").textContent = data.notes.join(" ");
  byId("troubles").append(...data.trouble.map((textContent) => el("p", { className: "notice", textContent })));
}

function showVerdicts() {
  byId("verdicts-section").hidden = !data.verdicts.length;
  const told = (verdict) => {
    if (!verdict.length) return cell("—", { className: "soft" });
    const [passed, sentence] = verdict;
    return el("td", {}, el("b", { className: passed ? "good" : "bad", textContent: passed ? "passed" : "failed" }), ` ${sentence}`);
  };
  byId("verdicts").append(pairHead(), el("tbody", {}, ...data.verdicts.map(([title, a, b]) => el("tr", { className: a[0] === b[0] ? "" : "apart" }, cell(title), told(a), told(b)))));
}

function showDifferences() {
  const differing = data.signals.filter((signal) => signal.differs);
  byId("differences-section").hidden = !data.signals.length;
  const rows = differing.map((signal) => {
    const go = el("button", { type: "button", className: "quiet", textContent: `${signal.component}.${signal.field}` });
    go.onclick = () => goTo(signal);
    return el("tr", {}, el("td", {}, go), cell(signal.largest), cell(signal.largest ? signal.at : null), cell(signal.rms), cell(signal.first), cell(signal.share));
  });
  const body = el("tbody", {}, ...rows.slice(0, SHOWN));
  if (rows.length) byId("differences").append(head("signal", "largest difference", "at", "rms", "differs first", "of the time"), body);
  if (rows.length > SHOWN) {
    const more = el("button", { type: "button", textContent: `${rows.length - SHOWN} more` });
    more.onclick = () => { body.append(...rows.slice(SHOWN)); more.remove(); };
    byId("differences-section").append(more);
  }
  const same = data.signals.filter((signal) => !signal.differs).map((signal) => `${signal.component}.${signal.field}`);
  byId("same").textContent = same.length ? `No difference: ${same.join(", ")}.` : "";
}

function showRest() {
  const rows = [
    ...data.only.flatMap((there, i) => (there.length ? [el("tr", {}, cell(`only in ${data.names[i]}`), cell(there.join(", ")))] : [])),
    ...data.incomparable.map((sentence) => el("tr", {}, cell("not comparable"), cell(sentence))),
  ];
  byId("only-section").hidden = !rows.length;
  byId("only").append(el("tbody", {}, ...rows));
  byId("facts-table").append(pairHead(), el("tbody", {}, ...data.facts.map(([name, a, b]) => el("tr", { className: a === b ? "" : "apart" }, cell(name), cell(a), cell(b)))));
  byId("machine-section").hidden = !data.machine.length;
  byId("machine").append(...data.machine.map((line) => el("div", { textContent: line || " ", className: line[0] === "-" ? "minus" : line[0] === "+" ? "plus" : "" })));
}

// --- curves ---

class Block {
  constructor(name) {
    this.name = name;
    this.signals = data.signals.filter((signal) => signal.component === name);
    this.node = el("article", { className: "component card" });
    this.node.dataset.name = name;
    this.lanes = new Map();
  }

  get shown() {
    return byId("all").ariaPressed === "true" ? this.signals : this.signals.filter((signal) => signal.differs);
  }

  // Makes what is to be seen of it now.
  make() {
    const first = !this.node.childElementCount;
    const same = this.signals.filter((signal) => !signal.differs).length;
    if (first) this.node.append(el("h3", {}, this.name, same ? el("small", { textContent: `${same} of ${this.signals.length} signals are the same` }) : null));
    for (const signal of this.shown) if (!this.lanes.has(signal)) this.lanes.set(signal, this.addLanes(signal));
    for (const [signal, lane] of this.lanes) lane.hidden = !this.shown.includes(signal);
    plots.refresh();
  }

  addLanes(signal) {
    const group = el("div", { className: "pair" });
    this.node.append(group);
    const curves = runs.map((run) => {
      const { component, time, fields } = run.get(this.name);
      const field = fields.get(signal.field);
      return { time, field, holes: component.holes, modulus: signal.quantity === "position" ? component.modulus : null };
    });
    if (signal.states) this.addBands(group, signal, curves);
    else this.addCurves(group, signal, curves);
    return group;
  }

  legend(signal, outputs, more = null) {
    const entries = data.names.map((name, i) => {
      const mark = el("i");
      mark.style.borderColor = colours[i];
      return el("div", { className: "entry" }, mark, el("span", { textContent: name }), outputs[i]);
    });
    return el("div", { className: "legend" }, el("strong", { textContent: signal.unit ? `${signal.label} [${signal.unit}]` : signal.label }), ...entries, more);
  }

  addCurves(group, signal, curves) {
    const row = el("div", { className: "lane" });
    group.append(row);
    const values = curves.map(({ field, time }) => columns.curve(field, time.length));
    const [a, b] = curves.map(({ time }) => time);
    const same = a === b || (a.length === b.length && a.every((t, i) => t === b[i]));
    const [time, ...joined] = same ? [a, ...values] : uPlot.join(values.map((v, i) => [curves[i].time, v]));
    const outputs = data.names.map(() => el("output"));
    plots.add(row, {
      height: signal.quantity === "position" ? TALL : LOW,
      time,
      columns: joined,
      last: !signal.differs,
      series: curves.map(({ holes, modulus }, i) => ({
        stroke: colours[i], width: i ? 1.3 : 1.9, dash: i ? [6, 4] : undefined, points: { show: false }, gaps: breaks(holes, joined[i], modulus), spanGaps: false,
      })),
      show: (at) => outputs.forEach((out, i) => { out.textContent = at < 0 ? "" : digits(joined[i][at]); }),
    });
    row.append(this.legend(signal, outputs));
    if (signal.differs) this.addDifference(group, signal);
  }

  addDifference(group, signal) {
    const row = el("div", { className: "lane" });
    group.append(row);
    const time = columns.times(signal.time);
    const delta = columns.curve(signal.delta, time.length);
    const out = el("output");
    plots.add(row, {
      height: DELTA,
      time,
      columns: [delta],
      series: [{ stroke: () => css("--bad"), width: 1.3, points: { show: false } }],
      show: (at) => { out.textContent = at < 0 ? "" : digits(delta[at]); },
    });
    const mark = el("i");
    mark.style.borderColor = "var(--bad)";
    row.append(el("div", { className: "legend" }, el("div", { className: "entry" }, mark, el("span", { textContent: "difference" }), out)));
  }

  addBands(group, signal, curves) {
    const row = el("div", { className: "lane" });
    group.append(row);
    const rows = curves.map(({ time, field, holes }) => ({ times: time, values: columns.numbers(field, time.length), names: field.names ?? {}, holes }));
    const time = [...new Set(rows.flatMap(({ times }) => [...times]))].sort((a, b) => a - b);
    const outputs = data.names.map(() => el("output"));
    const at = (times, t) => { let [from, to] = [0, times.length]; while (from < to) { const middle = (from + to) >> 1; if (times[middle] <= t + 1e-9) from = middle + 1; else to = middle; } return from - 1; };
    plots.add(row, {
      height: BAND * 2,
      time,
      columns: [new Uint8Array(time.length)],
      series: [{ paths: () => null, points: { show: false } }],
      yAxis: false,
      yRange: [0, 1],
      hooks: { draw: [bands(rows)] },
      show: (index) => outputs.forEach((out, i) => {
        const { times, values, names } = rows[i];
        const own = index < 0 ? -1 : at(times, time[index]);
        out.textContent = own < 0 ? "" : names[values[own]]?.[0] ?? String(values[own]);
      }),
    });
    row.append(this.legend(signal, outputs));
  }
}

function showCurves() {
  const observer = new IntersectionObserver((entries) => {
    for (const entry of entries) if (entry.isIntersecting) blocks.get(entry.target.dataset.name).make();
  }, { rootMargin: "600px" });
  for (const name of data.components) {
    const block = new Block(name);
    blocks.set(name, block);
    const chip = el("button", { type: "button", ariaPressed: "true", textContent: name });
    chip.onclick = () => {
      block.hidden = !block.hidden;
      chip.ariaPressed = String(!block.hidden);
      refresh();
    };
    byId("chips").append(chip);
    byId("curves").append(block.node);
    observer.observe(block.node);
  }
  const refresh = () => {
    for (const block of blocks.values()) {
      block.node.hidden = Boolean(block.hidden) || !block.shown.length;
      block.node.style.minHeight = `${60 + 150 * block.shown.length}px`;
      if (block.node.childElementCount) block.make();
    }
  };
  byId("all").onclick = () => {
    byId("all").ariaPressed = String(byId("all").ariaPressed !== "true");
    refresh();
  };
  byId("reset").onclick = () => plots.zoom(...data.span);
  refresh();
}

function goTo(signal) {
  const block = blocks.get(signal.component);
  block.make();
  if (signal.moment !== null) clock.set(signal.moment);
  const behavior = matchMedia("(prefers-reduced-motion: reduce)").matches ? "auto" : "smooth";
  block.lanes.get(signal)?.scrollIntoView({ behavior, block: "center" });
}

showHead();
showVerdicts();
showDifferences();
showRest();
showCurves();
showPlayer(clock);
const first = data.signals.find((signal) => signal.differs && signal.moment !== null);
clock.set(first ? first.moment : data.span[0]);
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
  forgetColours();
  redrawAll();
});
window.takt = { data, clock, plots, blocks, runs, columns }; // for the console, and for tests
document.body.classList.add("ready");
