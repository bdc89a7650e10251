// The machine from above at any time of the recording: feeds the live page's model and drawing from columns.

import { Model } from "../../view/page/model.js";
import { Plan } from "../../view/page/plan.js";
import { Series } from "../../view/page/store.js";
import { byId } from "../../view/page/dom.js";
import { rowAt } from "./columns.js";

export class Scene {
  constructor(data, columns, recorded, clock) {
    this.recorded = recorded; // by name: {time, field(name)}
    this.clock = clock;
    this.model = new Model();
    this.model.begin(data.machine);
    const { plan } = data.machine;
    this.shown = [...plan.movers, ...plan.parts, ...plan.belts, ...plan.groups].map(({ name }) => this.model.byName.get(name));
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
    this.show();
    this.plan.begin();
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
      model.links[name] = known ? Array.from({ length: count / 6 }, (_, i) => [...numbers.subarray(6 * i, 6 * i + 6)]) : [];
    }
    for (const { name, times, first, rows } of this.objects) {
      const at = rowAt(times, time);
      model.objects[name] = at < 0 ? [] : Array.from({ length: first[at + 1] - first[at] }, (_, i) => [...rows.subarray(7 * (first[at] + i), 7 * (first[at] + i) + 7)]);
    }
  }

  draw() {
    if (this.waiting || !this.plan) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.plan.draw();
    });
  }
}
