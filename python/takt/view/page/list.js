// Every component with its state, what it does and why it waits; and what was commanded.

import { byId, commandWords, el, number } from "./dom.js";
import { Rows, put } from "./rows.js";

// What says where a component is and how fast, by kind.
const PLACE = { axis: ["actual_position"], flex_cam: ["set_x_position", "set_y_position"], group: ["x", "y", "z"], belt: ["position"], pose: ["pose_x", "pose_y", "pose_z"], pick_place: ["position_x", "position_y", "position_z"], mover: ["x", "y"], part: ["x", "y"], track: ["length"] };
const SPEED = { axis: "set_velocity", flex_cam: "set_x_velocity", group: "path_velocity", belt: "velocity", pick_place: "set_path_velocity" };

export class MachineList extends EventTarget {
  constructor(model) {
    super();
    this.model = model;
    this.kind = "";
    byId("list-filter").oninput = () => this.rebuild();
    this.rows = new Rows(byId("list"), 34, () => this.make(), (node, item) => this.fill(node, item));
  }

  begin() {
    const kinds = ["", ...Object.keys(this.model.kinds)];
    const buttons = kinds.map((kind) => {
      const count = kind ? this.model.numbers[kind].length : this.model.components.length;
      const button = el("button", { textContent: `${kind ? kind.replaceAll("_", " ") : "all"} ${count}` });
      button.setAttribute("aria-pressed", String(kind === ""));
      button.onclick = () => {
        this.kind = kind;
        for (const other of buttons) other.setAttribute("aria-pressed", String(other === button));
        this.rebuild();
      };
      return button;
    });
    this.kind = "";
    byId("kinds").replaceChildren(...(kinds.length > 2 ? buttons : []));
    this.rebuild();
    byId("events").replaceChildren();
  }

  rebuild() {
    const words = byId("list-filter").value.toLowerCase().split(/\s+/).filter(Boolean);
    const text = (component) => {
      const row = this.model.rows[component.index];
      return `${component.name} ${component.kind} ${row?.state ?? ""} ${row?.waits ?? ""} ${row?.more ?? ""} ${row?.error ? "error" : ""}`.toLowerCase();
    };
    const items = (this.model.components ?? []).filter((c) => (!this.kind || c.kind === this.kind) && words.every((word) => text(c).includes(word)));
    this.rows.show(items);
    byId("list-count").textContent = words.length || this.kind ? `${items.length} of ${this.model.components.length}` : "";
  }

  draw() {
    if (byId("list-filter").value) this.rebuild();
    else this.rows.draw();
    this.log();
  }

  make() {
    const gauge = el("div", { className: "gauge" }, el("i"));
    const node = el("div", { className: "machine-row" }, el("span", { className: "name" }), el("span", { className: "state" }), el("span", { className: "place" }, el("span"), gauge), el("span", { className: "speed" }), el("span", { className: "does" }), el("span", { className: "waits" }));
    node.tabIndex = 0;
    node.onclick = () => this.dispatchEvent(new CustomEvent("open", { detail: node.item }));
    node.onkeydown = (event) => event.key === "Enter" && node.onclick();
    return node;
  }

  fill(node, component) {
    node.item = component;
    const row = this.model.rows[component.index];
    const [name, state, place, speed, does, waits] = node.children;
    put(name, component.name);
    name.title = component.kind.replaceAll("_", " ");
    put(state, row?.state ?? (row ? component.kind.replaceAll("_", " ") : "not heard yet"));
    if (row && !row.state) put(state, component.kind.replaceAll("_", " "));
    const colour = this.model.machine.states[row?.state];
    state.style.setProperty("--state", colour ?? "var(--soft)");
    state.classList.toggle("plain", !colour);
    this.fillPlace(place, component);
    const speedField = SPEED[component.kind];
    put(speed, component.kind === "mover" ? `${number(Math.hypot(this.live(component, "velocity_x"), this.live(component, "velocity_y")), 1)} mm/s` : speedField ? `${number(this.live(component, speedField), 1)} ${this.model.unit(component, speedField)}` : "");
    put(does, [row && commandWords(row.command), row?.more].filter(Boolean).join("  ·  "));
    does.title = row?.command ?? "";
    node.classList.toggle("bad", Boolean(this.model.isBad(row)));
    const since = row?.since ? `${row.waits}, for ${number((this.model.cycle - row.since) * this.model.period, 1)} s` : row?.waits;
    const bad = row?.error ? `${String(row.error).padStart(4, "0")} ${row.error_text}` : "";
    put(waits, bad || since || (row?.refused ? `last refused: ${row.refused}` : ""));
    waits.classList.toggle("old", !bad && !since);
    waits.title = [bad, since, row?.refused].filter(Boolean).join("\n");
  }

  live(component, field) {
    return this.model.liveOf(component, field);
  }

  fillPlace(node, component) {
    const fields = PLACE[component.kind] ?? [];
    const [text, gauge] = node.children;
    const unit = fields.length ? this.model.unit(component, fields[0]) : "";
    put(text, fields.length ? `${fields.map((field) => number(this.live(component, field), fields.length > 1 ? 1 : 3)).join("  ")} ${unit}` : "");
    const range = component.range ?? (component.modulus ? [0, component.modulus] : null);
    gauge.hidden = !range;
    if (range) gauge.firstChild.style.left = `${Math.max(0, Math.min(1, (this.live(component, fields[0]) - range[0]) / (range[1] - range[0]))) * 100 || 0}%`;
  }

  // What was commanded and what became of it, the newest first.
  log() {
    const { events, period } = this.model;
    const newest = events.at(-1);
    if (newest === this.newest && events.length === this.logged) return;
    this.newest = newest;
    this.logged = events.length;
    const rows = events.slice(-200).reverse().map(([cycle, target, text, state, sentence, client]) => {
      const time = cycle < 0 ? "" : (cycle * period).toFixed(3);
      const node = el("div", { className: `event ${state}` }, ...[time, target, commandWords(text), sentence || state].map((t) => el("span", { textContent: t, title: t })));
      node.children[1].title = client;
      return node;
    });
    byId("events").replaceChildren(...rows);
    byId("no-events").hidden = rows.length > 0;
  }
}

// All that one component publishes.
export class Details {
  constructor(model, scope, commands) {
    this.model = model;
    this.scope = scope;
    this.commands = commands;
    this.box = byId("details");
    this.component = null;
    byId("details-close").onclick = () => this.show(null);
  }

  show(component) {
    this.component = component;
    this.box.hidden = !component;
    if (!component) return;
    byId("details-name").textContent = component.name;
    byId("details-kind").textContent = component.kind.replaceAll("_", " ");
    this.outputs = this.model.kinds[component.kind].fields.map((field) => {
      const output = el("output");
      const tick = el("input", { type: "checkbox", title: "In the scope", checked: this.scope.has(`${component.name}.${field.name}`) });
      tick.onchange = () => this.scope.toggle(`${component.name}.${field.name}`);
      return { field, output, node: el("label", { title: field.about }, tick, el("span", { textContent: field.label }), output) };
    });
    byId("details-commands").replaceChildren(...this.commands.panel(component));
    byId("details-fields").replaceChildren(...this.outputs.map((one) => one.node));
  }

  draw() {
    if (!this.component) return;
    const row = this.model.rows[this.component.index];
    const said = [row?.state, row?.command, row?.more, row?.waits, row?.error ? `${row.error} ${row.error_text}` : ""];
    put(byId("details-words"), said.filter(Boolean).join("; "));
    const values = this.model.details.get(this.component.index);
    if (!values) return;
    this.outputs.forEach(({ field, output }, place) => {
      const unit = this.model.unit(this.component, field.name);
      const name = this.model.nameOf(this.component, field.name, values[place]) ?? (field.whole ? String(values[place]) : number(values[place]));
      put(output, unit ? `${name} ${unit}` : name);
    });
  }
}
