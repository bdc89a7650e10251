// The machine from above and in three dimensions at any time of the recording: feeds the live page's model and drawings
// from columns.

import { Model } from "../../view/page/model.js";
import { Plan } from "../../view/page/plan.js";
import { Space } from "../../view/page/space.js";
import { Series } from "../../view/page/store.js";
import { byId } from "../../view/page/dom.js";
import { inflated, rowAt } from "./columns.js";

const CORE = "./three.core.min.js"; // as the other module of three.js imports it

export class Scene {
  constructor(data, columns, recorded, clock) {
    this.recorded = recorded; // by name: {time, field(name)}
    this.clock = clock;
    this.model = new Model();
    this.model.begin(data.machine);
    const { plan, scene } = data.machine;
    const moved = scene.nodes.flatMap((node) => [node.moved?.component, node.shown?.component]).filter(Boolean);
    const shown = [...[...plan.movers, ...plan.parts, ...plan.belts, ...plan.groups].map(({ name }) => name), ...moved];
    this.shown = [...new Set(shown)].map((name) => this.model.byName.get(name));
    this.model.live = new Float64Array(this.model.components.reduce((sum, one) => sum + this.model.kinds[one.kind].live.length, 0)).fill(NaN);
    this.links = Object.entries(data.links).map(([name, links]) => ({ name, ...links, values: columns.numbers(links, 0) }));
    this.objects = Object.entries(data.objects).map(([name, { time, first, rows }]) => (
      { name, times: columns.times(time), first: columns.numbers(first, 1), rows: columns.numbers(rows, 0) }));
    const trails = new Map();
    for (const { name } of plan.groups) {
      const table = recorded.get(name);
      if (!table) continue;
      const cycles = table.time.map((t) => Math.round(t / data.machine.period_s));
      const fields = ["x", "y", "z"].filter((field) => table.has(field));
      trails.set(this.model.byName.get(name).index, Series.of(cycles, new Map(fields.map((field) => [field, table.values(field)]))));
    }
    byId("scene-section").hidden = false;
    this.plan = new Plan(this.model, () => trails, { ctrlZooms: true, onchange: () => this.draw() });
    this.space = new Space(this.model, () => trails, threeInside, { ctrlZooms: true, onchange: () => this.draw() });
    this.show();
    this.plan.begin();
    this.space.begin();
    for (const button of byId("scene-tabs").children) {
      button.onclick = () => this.open(button.value);
      button.hidden = !(button.value === "plan" ? data.flat : scene.nodes.length);
    }
    this.open(data.flat ? "plan" : "space");
    clock.addEventListener("change", () => {
      this.show();
      this.draw();
    });
  }

  // Puts the model where it was: everything at its last sample at or before the time.
  show() {
    const { model, clock: { time } } = this;
    model.cycle = Math.round(time / model.period);
    for (const component of this.shown) {
      const table = this.recorded.get(component.name);
      const row = table ? rowAt(table.time, time) : -1;
      model.kinds[component.kind].live.forEach((field, k) => {
        model.live[component.start + k] = row >= 0 && table.has(field) ? table.values(field)[row] : NaN;
      });
      if (component.kind !== "mover" || row < 0) continue;
      const of = (field) => (table.has(field) ? table.values(field)[row] : 0);
      model.rows[component.index] = { state: table.nameOf("state", of("state")), waits: of("waits_for") || of("delay") ? "waits" : "" };
    }
    for (const { name, from, to, n, count, values } of this.links) {
      const frame = Math.round(((time - from) / (to - from)) * (n - 1));
      const numbers = frame >= 0 && frame < n ? values.subarray(frame * count, (frame + 1) * count) : [];
      const known = numbers.length && numbers.every(Number.isFinite);
      model.placeLinks(name, known ? Array.from({ length: count / 7 }, (_, i) => [...numbers.subarray(7 * i, 7 * i + 7)]) : []);
    }
    for (const { name, times, first, rows } of this.objects) {
      const at = rowAt(times, time);
      model.objects[name] = at < 0 ? [] : Array.from({ length: first[at + 1] - first[at] }, (_, i) => [...rows.subarray(7 * (first[at] + i), 7 * (first[at] + i) + 7)]);
    }
  }

  // From above, or in three dimensions.
  open(tab) {
    this.tab = tab;
    for (const name of ["plan", "space"]) {
      byId(`${name}-bar`).hidden = name !== tab;
      byId(`${name}-box`).hidden = name !== tab;
    }
    for (const button of byId("scene-tabs").children) button.setAttribute("aria-pressed", String(button.value === tab));
    this.draw();
  }

  draw() {
    if (this.waiting || !this.tab) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this[this.tab].draw();
    });
  }
}

// three.js as it is inside the page: its two modules, inflated when they are needed.
async function threeInside() {
  const texts = new TextDecoder().decode(await inflated(byId("three").textContent)).split("\0");
  const url = (text) => URL.createObjectURL(new Blob([text], { type: "text/javascript" }));
  const core = url(texts[0]);
  return import(url(texts[1].replaceAll(`"${CORE}"`, JSON.stringify(core))));
}
