// The cams at any time of the recording: feeds the live page's drawing of them from columns.

import { Cams } from "../../view/page/cams.js";
import { byId } from "../../view/page/dom.js";
import { rowAt } from "./columns.js";

export class RecordedCams {
  // data: {cams, made, modules, palette} (takt.report.scene); recorded: by name.
  constructor(data, recorded, clock) {
    this.recorded = recorded;
    this.clock = clock;
    this.machine = { cams: data.cams, palette: data.palette };
    this.madeCams = new Map(data.made.map((cam) => [cam.number, cam]));
    const modules = data.modules.map((module, index) => ({ ...module, index, start: index }));
    this.numbers = { flex_cam: modules };
    this.rows = [];
    byId("cams-section").hidden = false;
    this.cams = new Cams(this);
    this.cams.begin();
    const show = () => this.draw();
    clock.addEventListener("change", show);
    new ResizeObserver(show).observe(byId("cams-box"));
    this.draw();
  }

  row(module) {
    return rowAt(this.recorded.get(module.name).time, this.clock.time);
  }

  liveOf(module, field) {
    const table = this.recorded.get(module.name);
    const row = this.row(module);
    return row >= 0 && table.has(field) ? table.values(field)[row] : NaN;
  }

  unit(module, field) {
    return module.units[field] ?? "";
  }

  draw() {
    for (const module of this.numbers.flex_cam) {
      const state = this.recorded.get(module.name).nameOf("state", this.liveOf(module, "state"));
      this.rows[module.index] = { state };
    }
    this.cams.draw();
  }
}
