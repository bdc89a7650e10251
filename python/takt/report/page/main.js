// The page of a report: what it is given goes to its parts, which share one time.

import { byId, el, forgetColours } from "../../view/page/dom.js";
import { RecordedCams } from "./cams.js";
import { Clock, showPlayer } from "./clock.js";
import { Columns, inflated } from "./columns.js";
import { Curves } from "./curves.js";
import { redrawAll } from "./plots.js";
import { Scene } from "./scene.js";
import { Verdicts } from "./verdicts.js";

const data = JSON.parse(byId("data").textContent);
const columns = new Columns(await inflated(byId("columns").textContent));

// --- what was recorded, by component ---

class Table {
  constructor(component) {
    this.fields = new Map(component.fields.map((field) => [field.name, field]));
    this.time = times[component.base];
  }

  has(name) {
    return this.fields.has(name);
  }

  values(name) {
    return columns.numbers(this.fields.get(name), this.time.length);
  }

  curve(name) {
    return columns.curve(this.fields.get(name), this.time.length);
  }

  nameOf(name, value) {
    return this.fields.get(name)?.names?.[value]?.[0];
  }
}

const times = data.bases.map((base) => columns.times(base));
const recorded = new Map(data.components.map((component) => [component.name, new Table(component)]));

// --- head, figures, tables ---

const show = (value) => (value === null ? "—" : Array.isArray(value) ? value.join(", ") : String(value));
const isGroup = (value) => value !== null && typeof value === "object" && !Array.isArray(value);

function showHead() {
  document.querySelector("h1").textContent = data.title;
  const failed = data.verdicts.filter((v) => !v.passed).length + Boolean(data.complaint);
  const all = data.verdicts.length + Boolean(data.complaint);
  const pill = byId("pill");
  pill.className = `pill ${failed ? "bad" : all ? "good" : ""}`;
  pill.textContent = !all ? "no verdicts" : failed ? `${failed} of ${all} failed` : `all ${all} passed`;
  const trouble = [data.trouble, empty ? "Nothing was recorded: there is no sample in it." : all ? "" : "Nothing was judged: there are no verdicts in it. takt report --scenario FILE judges it."].filter(Boolean);
  byId("trouble").hidden = !trouble.length;
  byId("trouble").textContent = trouble.join(" ");
}

function showFigures() {
  const facts = data.made ? { made: data.made } : {};
  if (data.span[0] !== null) facts.length = `${(data.span[1] - data.span[0]).toFixed(3)} s`;
  for (const [name, value] of Object.entries({ ...data.meta, ...facts })) {
    if (!isGroup(value)) byId("facts").append(el("div", {}, el("dt", { textContent: name }), el("dd", { textContent: show(value) })));
  }
  for (const [name, group] of Object.entries(data.meta).filter(([, value]) => isGroup(value))) {
    const cards = Object.entries(group).map(([what, value]) =>
      el("div", { className: "figure" }, el("b", { textContent: isGroup(value) ? JSON.stringify(value) : show(value) }), el("span", { textContent: what })));
    byId("figures").append(el("div", { className: "group" }, el("h2", { textContent: name }), el("div", { className: "cards" }, ...cards)));
  }
  byId("summary-section").hidden = !data.summary.rows.length;
  document.querySelector("#summary thead").append(el("tr", {}, ...data.summary.head.map((t) => el("th", { textContent: t }))));
  document.querySelector("#summary tbody").append(...data.summary.rows.map((row) => el("tr", {}, ...row.map((t) => el("td", { textContent: t })))));
}

// --- all of it ---

const empty = data.span[0] === null;
showHead();
showFigures();
const span = empty ? [0, 0] : data.span;
const step = Math.min(1, ...times.filter((t) => t.length > 1).map((t) => (t.at(-1) - t[0]) / (t.length - 1)));
const clock = new Clock(span, step);
const verdicts = new Verdicts(data, columns, clock, goTo);
const scene = data.scene && !empty ? new Scene(data.scene, columns, recorded, clock) : null;
const cams = data.cams && !empty ? new RecordedCams(data.cams, recorded, clock) : null;
const curves = new Curves(data, recorded, clock);
byId("curves-section").hidden = !data.components.length;
if (!empty) showPlayer(clock);
byId("thinned").hidden = !data.thinned;
byId("thinned").textContent = data.thinned;
const failure = [data.assertion, ...data.verdicts].find((verdict) => verdict && !verdict.passed && verdict.place);
clock.set(failure ? failure.place[0] : span[0]);

function goTo(verdict) {
  const block = curves.choose(verdict);
  if (verdict.place) clock.set(verdict.place[0]);
  const behavior = matchMedia("(prefers-reduced-motion: reduce)").matches ? "auto" : "smooth";
  (scene ? byId("scene-section") : block)?.scrollIntoView({ behavior, block: "start" });
}

matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
  forgetColours();
  redrawAll();
  scene?.draw();
  cams?.draw();
});
window.takt = { data, clock, curves, verdicts, recorded, cams, model: scene?.model, plan: scene?.plan, space: scene?.space, scene }; // for the console, and for tests
document.body.classList.add("ready");
