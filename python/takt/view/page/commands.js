// Commands from the page, where the machine file allows it. What is jogged moves as long as the button is held: the page
// says so again and again, and whoever does not hear it lets go.

import { byId, el } from "./dom.js";

// Modules have inputs; an error is acknowledged when one of them rises.
const module = (halt) => [
  ["On", "control", { regulator_on: true }], ["Off", "control", { regulator_on: false }], ["Reset", "control", { reset_error: true }, { reset_error: false }],
  ["Halt", "control", { [halt]: true }], ["Go on", "control", { [halt]: false }],
];
const BUTTONS = {
  axis: [["On", "power", { enable: true }], ["Off", "power", { enable: false }], ["Reset", "reset", {}], ["Halt", "halt", {}]],
  group: [["On", "power", { enable: true }], ["Off", "power", { enable: false }], ["Enable", "enable", {}], ["Disable", "disable", {}], ["Reset", "reset", {}], ["Halt", "halt", {}]],
  flex_cam: module("halt"),
  pick_place: module("path_halt"),
  mover: [["Enable", "enable", {}], ["Disable", "disable", {}], ["Reset", "reset", {}], ["Halt", "halt", {}]],
  track: [["Enable", "enable", {}], ["Disable", "disable", {}], ["Reset", "reset", {}]],
  planar_group: [["Enable", "enable", {}], ["Disable", "disable", {}], ["Reset", "reset", {}]],
};
const LEAST_MS = 15;
const APART_MS = 100; // from one command of a button to the next, so that the engine sees both

const speedInput = (value, unit) => el("input", { type: "number", min: 0, step: "any", value, title: `Velocity, ${unit}` });

export class Commands {
  constructor(model, connection) {
    this.model = model;
    this.connection = connection;
    this.epoch = null;
    this.timer = null;
    byId("emergency-stop").onclick = () => this.give("machine", "emergency_stop", {});
    byId("stop-all").onclick = () => this.give("machine", "stop_all", {});
    for (const event of ["blur", "pagehide"]) addEventListener(event, () => this.letGo());
    document.addEventListener("visibilitychange", () => document.hidden && this.letGo());
    for (const event of ["pointerup", "pointercancel", "keyup"]) addEventListener(event, () => this.letGo());
    connection.addEventListener("lost", () => this.letGo());
  }

  begin(epoch) {
    this.letGo();
    this.epoch = epoch;
    byId("stops").hidden = !this.model.machine.commands;
  }

  // There is no engine that could be commanded.
  end() {
    this.letGo();
    this.epoch = null;
  }

  // False: nobody hears it, and the user is told.
  give(target, verb, given) {
    const nobody = !this.connection.connected ? "the server of this page is gone" : this.epoch === null ? "no engine is heard" : "";
    if (!nobody) return this.connection.send({ epoch: this.epoch, command: [target, verb, given] });
    this.connection.say("complaint", `${target}.${verb} was not given: ${nobody}`);
    return false;
  }

  // The buttons of a component.
  panel(component) {
    const buttons = this.model.machine.commands ? BUTTONS[component.kind] : null;
    if (!buttons) return [];
    const plain = buttons.map(([text, verb, ...all]) => el("button", { textContent: text, onclick: () => all.forEach((given, i) => setTimeout(() => this.give(component.name, verb, given), i * APART_MS)) }));
    const rows = [el("div", { className: "buttons" }, ...plain)];
    if (component.kind === "axis") rows.push(this.jogRow(component));
    if (component.kind === "group") rows.push(this.groupJogRow(component));
    return rows;
  }

  jogRow(component) {
    const unit = this.model.unit(component, "set_velocity");
    const velocity = speedInput(Number((component.velocity / 10).toPrecision(2)), unit);
    const button = (text, way) => this.jogButton(component, text, () => ({ [way]: true, velocity: Number(velocity.value) }));
    return el("div", { className: "buttons" }, button("◀ jog", "backward"), velocity, el("span", { className: "soft", textContent: unit }), button("jog ▶", "forward"));
  }

  // The tool along and about the axes of a coordinate system, or one axis of the group.
  groupJogRow(component) {
    const choice = (title, names) => el("select", { title }, ...names.map((name) => el("option", { value: name, textContent: name })));
    const system = choice("Coordinate system", component.tool ? ["mcs", "wcs", "tool", "acs"] : ["acs"]);
    const axis = el("select", { title: "Axis" });
    const axes = Array.from({ length: component.axes }, (_, i) => `a${i + 1}`);
    const choose = () => axis.replaceChildren(...choice("", system.value === "acs" ? axes : ["x", "y", "z", "a", "b", "c"]).children);
    system.onchange = choose;
    choose();
    const speed = speedInput(10, "mm/s, deg/s, or unit/s of an axis");
    const button = (text, sense) => this.jogButton(component, text, () => ({ [axis.value]: sense * Number(speed.value), coordinate_system: system.value }));
    return el("div", { className: "buttons" }, system, axis, button("◀ jog", -1), speed, button("jog ▶", 1));
  }

  // Gives a jog as long as it is held; `given` says which.
  jogButton(component, text, given) {
    const node = el("button", { className: "jog", textContent: text, title: "Moves while it is held; Space or Enter holds it, too" });
    node.onpointerdown = (event) => {
      if (event.button === 0) this.hold(component.name, given(), node);
    };
    node.onkeydown = (event) => {
      if (event.key !== " " && event.key !== "Enter") return;
      event.preventDefault();
      if (!event.repeat) this.hold(component.name, given(), node);
    };
    node.onblur = () => this.letGo();
    node.oncontextmenu = (event) => event.preventDefault();
    return node;
  }

  hold(target, given, node) {
    this.letGo();
    if (!this.give(target, "jog", given)) return;
    this.held = node;
    node.setAttribute("aria-pressed", "true");
    const every = Math.max(LEAST_MS, Math.min(100, 250 * this.model.machine.dead_man_s));
    this.timer = setInterval(() => this.connection.send({ epoch: this.epoch, hold: true }), every);
  }

  letGo() {
    if (this.timer === null) return;
    clearInterval(this.timer);
    this.timer = null;
    this.held.setAttribute("aria-pressed", "false");
    this.connection.send({ epoch: this.epoch, hold: false });
  }
}
