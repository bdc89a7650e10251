// The page: what the server says goes to the views, what the user chooses goes to the server.

import { Cams } from "./cams.js";
import { Chooser } from "./chooser.js";
import { Commands } from "./commands.js";
import { Connection } from "./connection.js";
import { byId, forgetColours, number } from "./dom.js";
import { Health } from "./health.js";
import { listen } from "./keys.js";
import { Details, MachineList } from "./list.js";
import { Model } from "./model.js";
import { Plan } from "./plan.js";
import { put } from "./rows.js";
import { Scope } from "./scope.js";
import { Space } from "./space.js";

const TABS = ["machine", "scope", "plan", "3d", "cams", "engine"];
const FIRST_SIGNALS = 6;
const COMPLAINT_MS = 5000; // that one is to be read

const model = new Model();
const connection = new Connection();
const scope = new Scope(model);
const chooser = new Chooser(model, scope);
const list = new MachineList(model);
const commands = new Commands(model, connection);
const cams = new Cams(model, commands);
const details = new Details(model, scope, commands);
const plan = new Plan(model, () => scope.store.series);
const space = new Space(model, () => scope.store.series, () => import("./three/three.module.min.js"), { onchange: () => tab === "3d" && redraw() });
const health = new Health(model, scope, connection);
const views = { machine: list, scope, plan, "3d": space, cams, engine: health };
let tab = "machine";
let epoch = null;
let run = null;
let asked = "";
let dirty = false;
let listed = 0;
let waitingFor = "";
let complained = "";
let complainedUntil = 0;

// --- what is chosen, in the address ---

function fromAddress() {
  const said = new URLSearchParams(location.hash.slice(1));
  return { tab: TABS.includes(said.get("tab")) ? said.get("tab") : "machine", signals: said.get("signals")?.split(",").filter(Boolean) ?? null };
}

function toAddress() {
  if (epoch === null) return; // what it says is not taken up yet
  const signals = scope.signals.map((signal) => signal.name).join(",");
  history.replaceState(null, "", `#${new URLSearchParams({ tab, ...(signals ? { signals } : {}) })}`);
}

// Set point and measured place of what comes first.
function usualSignals() {
  const names = [];
  for (const component of model.components) {
    const fields = model.kinds[component.kind].byName;
    const usual = model.machine.usual.filter((field) => fields.has(field));
    if (component.kind === "axis") names.push(...["set_position", "set_velocity"].map((field) => `${component.name}.${field}`));
    else if (!model.numbers.axis) names.push(...usual.slice(0, 2).map((field) => `${component.name}.${field}`));
    if (names.length >= FIRST_SIGNALS) break;
  }
  return names.slice(0, FIRST_SIGNALS);
}

function ask() {
  if (epoch === null) return;
  const signals = scope.signals.map((signal) => [signal.component.index, signal.field.name]);
  const trails = { plan, "3d": space }[tab];
  if (trails) signals.push(...trails.signals().filter(([i, f]) => !signals.some(([j, g]) => i === j && f === g)));
  const wanted = tab === "scope" ? chooser.details() : details.component ? [details.component.index] : [];
  const request = { epoch, signals, details: wanted };
  const text = JSON.stringify(request);
  if (text === asked) return;
  asked = text;
  scope.store.choose(signals);
  const after = [...scope.store.series].filter(([, series]) => series.end).map(([index, series]) => [index, series.last]);
  connection.send({ ...request, after });
}

// --- what the server says ---

connection.addEventListener("machine", ({ detail }) => {
  const again = detail.run === run; // the server was away, not the engine: what is there goes on
  epoch = detail.epoch;
  asked = "";
  if (!again) {
    const names = run === null ? fromAddress().signals : scope.signals.map((signal) => signal.name);
    run = detail.run;
    scope.forget();
    model.begin(detail);
    for (const view of [list, chooser, plan, space, cams, health]) view.begin();
    details.show(null);
    choose(names ?? usualSignals());
    if (names?.length && !scope.signals.length) scope.choose(usualSignals());
    document.title = `${detail.name} – Takt`;
    put(byId("machine-name"), detail.name);
    byId("version").textContent = `takt ${detail.version}`;
  }
  commands.begin(epoch);
  document.body.classList.add("ready");
  ask();
});

connection.addEventListener("frame", ({ detail }) => {
  if (epoch === null) return;
  const at = model.take(detail);
  scope.store.take(detail.header.signals, detail.numbers, at);
  scope.update(Math.max(0, ...[...scope.store.series.values()].map((series) => series.last)) || model.cycle);
  health.take();
  for (const { target, verb, sentence } of detail.header.answers ?? []) complain(`${target}.${verb}: ${sentence}`);
  say();
  ask();
  redraw();
});

function redraw() {
  if (dirty) return;
  dirty = true;
  requestAnimationFrame(draw);
}

function draw() {
  dirty = false;
  if (!model.machine) return;
  views[tab].draw();
  const now = performance.now();
  if (tab === "scope" && now - listed > 90) {
    listed = now;
    chooser.rows.draw();
  }
  details.draw();
  header();
}

function header() {
  put(byId("time"), `${number(model.now, 2)} s`);
  const bad = model.rows.filter((row) => model.isBad(row));
  const waits = model.rows.filter((row) => row?.waits && !model.isBad(row)).length;
  const faults = byId("faults");
  faults.hidden = !bad.length;
  put(faults, bad.length === 1 ? `${model.components[bad[0].i].name} in error` : `${bad.length} in error`);
  put(byId("waiting-count"), waits ? `${waits} waiting` : "");
}

// What is not there is said; all else is shown.
function choose(names) {
  scope.choose(names);
  const missing = names.map((name) => model.whyNo(name)).filter(Boolean);
  if (missing.length) complain(missing.join("; "));
}

function complain(text) {
  [complained, complainedUntil] = [text, performance.now() + COMPLAINT_MS];
  say();
}

// What is wrong, in one line under the head.
function say() {
  const { gone, trouble } = model.health;
  const complaint = performance.now() < complainedUntil ? complained : "";
  const text = complaint || (!connection.connected ? "the server of this page is gone – trying again" : epoch === null ? waitingFor : gone ? "the engine is gone: nothing has been heard for 3 s" : trouble || "");
  const banner = byId("banner");
  banner.hidden = !text;
  put(banner, text);
  const state = !connection.connected ? "lost" : gone || epoch === null ? "gone" : "running";
  document.body.dataset.state = state;
  put(byId("state"), { lost: "disconnected", gone: epoch === null ? "waiting for an engine" : "engine gone", running: "live" }[state]);
}

connection.addEventListener("lost", () => {
  asked = "";
  say();
});
connection.addEventListener("connected", () => say());
connection.addEventListener("waiting", ({ detail }) => {
  waitingFor = detail;
  epoch = null; // what is shown is how it was
  asked = "";
  commands.end();
  say();
});
connection.addEventListener("complaint", ({ detail }) => complain(detail));

// --- what the user does ---

function show(name) {
  tab = name;
  for (const one of TABS) {
    byId(`view-${one}`).hidden = one !== name;
    byId(`tab-${one}`).setAttribute("aria-selected", String(one === name));
  }
  details.box.hidden = !details.component || name === "scope";
  if (name === "scope") scope.layOut?.();
  toAddress();
  ask();
  if (model.machine) draw();
}

for (const name of TABS) byId(`tab-${name}`).onclick = () => show(name);
list.addEventListener("open", ({ detail }) => {
  details.show(detail === details.component ? null : detail);
  ask();
});
scope.addEventListener("chosen", () => {
  if (epoch !== null) ask();
  toAddress();
});
byId("faults").onclick = () => {
  byId("list-filter").value = "error";
  show("machine");
  list.rebuild();
};

const themes = ["", "light", "dark"];
function theme(name) {
  document.documentElement.dataset.theme = name;
  localStorage.setItem("theme", name);
  byId("theme").textContent = { "": "auto", light: "light", dark: "dark" }[name];
  forgetColours();
}
byId("theme").onclick = () => theme(themes[(themes.indexOf(document.documentElement.dataset.theme ?? "") + 1) % 3]);
theme(localStorage.getItem("theme") ?? "");
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", forgetColours);

addEventListener("keydown", (event) => {
  if (/INPUT|SELECT|TEXTAREA/.test(event.target.tagName)) return;
  const presses = event.target.closest("button, [role=button]"); // Space is for that then
  if (event.key === " " && !presses && tab === "scope") {
    event.preventDefault();
    scope.pause(!scope.paused);
  } else if (event.key === "Escape") {
    scope.zoom = null;
    scope.clearCursors();
    details.show(null);
  } else if (/^[1-6]$/.test(event.key)) show(TABS[event.key - 1]);
});
addEventListener("hashchange", () => {
  const said = fromAddress();
  if (said.tab !== tab) show(said.tab);
  if (said.signals && model.machine && said.signals.join() !== scope.signals.map((s) => s.name).join()) choose(said.signals);
});

listen(() => tab, scope, plan, space);
show(fromAddress().tab);
window.takt = { model, scope, connection, plan, space, cams, health }; // to look at from the console, and for tests
