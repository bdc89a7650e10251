// Cams with the places of master and slave: of each cam module the one that runs and the one that is to run next, then
// those that no module runs.

import { Edit } from "./cam_edit.js";
import { byId, css, el, fitCanvas, number, ticks, tone } from "./dom.js";
import { put } from "./rows.js";

const SLOTS = ["ip08_cam_table1", "ip09_cam_table2", "ip10_cam_table3", "ip11_cam_table4"];
const CURVES = ["position", "velocity", "acceleration", "jerk"];
const POWERS = ["", "", "²", "³"];
const HEIGHTS = [0.43, 0.19, 0.19, 0.19];
const DASHES = [6, 4]; // of the next cam, and of one that is edited
const NEAR = 14; // pixels: what is taken by the pointer

export class Cams {
  // commands: where cams can be edited; null: nowhere.
  constructor(model, commands = null) {
    this.model = model;
    this.commands = commands;
    this.cards = [];
  }

  begin() {
    const { cams } = this.model.machine;
    this.cards = [...(this.model.numbers.flex_cam ?? []), ...cams].map((of) => this.card(of));
    byId("cams-box").replaceChildren(...this.cards.map((card) => card.node));
    byId("cams-empty").hidden = cams.length > 0;
  }

  card(of) {
    const canvas = el("canvas");
    const words = el("span", { className: "soft" });
    const place = el("output");
    const places = el("p", { className: "soft" });
    const title = el("b", { textContent: of.name });
    const picture = el("div", { className: "picture" }, canvas);
    const node = el("section", { className: "card cam" }, el("header", {}, title, words, place), places, picture);
    const card = { of, canvas, words, place, places, title, picture, node, module: "start" in of, edit: null };
    if (card.module && this.commands && this.model.machine.commands) this.editor(card);
    return card;
  }

  editor(card) {
    const button = (textContent, title, onclick) => el("button", { textContent, title, onclick });
    const begin = button("Edit", "", () => {
      const cam = this.cam(this.numbersOf(card.of).running);
      if (cam?.knots) this.show(card, new Edit(cam));
    });
    const give = button("Put into force", "From the end of the cam that runs", () => this.give(card));
    const cancel = button("Cancel", "", () => this.show(card, null));
    card.buttons = { begin, give, cancel };
    card.node.append(el("footer", {}, begin, give, cancel));
    this.show(card, null);
    const { canvas } = card;
    canvas.onpointerdown = (event) => {
      const { edit, view } = card;
      if (!edit || edit.waits || !view) return;
      const far = edit.knots.map(([x, y]) => Math.hypot(view.across(x) - event.offsetX, view.down(y) - event.offsetY));
      const nearest = far.indexOf(Math.min(...far));
      if (far[nearest] > NEAR) return;
      edit.dragged = nearest;
      edit.view = view; // the scale stays while it is dragged
      canvas.setPointerCapture(event.pointerId);
    };
    canvas.onpointermove = (event) => {
      const { edit } = card;
      if (edit && edit.dragged >= 0) edit.drag(edit.dragged, edit.view.x(event.offsetX), edit.view.y(event.offsetY));
    };
    canvas.onpointerup = canvas.onpointercancel = () => {
      if (card.edit) Object.assign(card.edit, { dragged: -1, view: null });
    };
  }

  // Whether the cam that runs can be edited, and why not.
  allow(card, cam) {
    const why = !cam ? "no cam runs whose curve the page knows" : cam.knots ? "" : "its slope has steps, or it has more than 60 joints";
    card.buttons.begin.disabled = why !== "";
    card.buttons.begin.title = why || "Drag the joints of the cam that runs";
    card.buttons.give.disabled = card.edit?.waits ?? false;
  }

  show(card, edit) {
    card.edit = edit;
    card.canvas.classList.toggle("edited", edit !== null);
    card.buttons.begin.hidden = edit !== null;
    card.buttons.give.hidden = card.buttons.cancel.hidden = edit === null;
  }

  // Sends the edited cam; once the engine has it, it goes into the slot that runs.
  give(card) {
    const { edit } = card;
    if (edit.waits) return;
    if (edit.commands().every(([verb, given]) => this.commands.give("machine", verb, given))) edit.sent(this.latest());
  }

  // The greatest number of a cam.
  latest() {
    return Math.max(this.model.machine.cams.length, ...this.model.madeCams.keys());
  }

  putIntoForce(card) {
    const { edit } = card;
    if (!edit.newer || ![...this.model.madeCams.values()].some((cam) => cam.name === edit.name && cam.number > edit.newer)) return;
    const slot = this.model.liveOf(card.of, "cam_table");
    if (this.commands.give(card.of.name, "set_cam", { slot, cam: edit.name })) this.show(card, null);
  }

  // The number of the cam in a slot: from 1 in the order of the machine file, beyond it made at run time; 0: none.
  numberIn(module, slot) {
    return slot >= 1 && slot <= SLOTS.length ? this.model.liveOf(module, SLOTS[slot - 1]) || 0 : 0;
  }

  // The numbers of the cam that runs and of the one that is to run next: of another slot, or put into the same one;
  // 0: none.
  numbersOf(module) {
    const [slot, next] = ["cam_table", "next_cam_table"].map((field) => this.model.liveOf(module, field));
    const running = this.model.liveOf(module, "cam_number") || 0;
    const asked = this.numberIn(module, next || slot);
    return { running, next: running && asked !== running ? asked : 0 };
  }

  // The cam of a number; null: there is none, or it was made before anyone listened.
  cam(number) {
    return this.model.machine.cams[number - 1] ?? this.model.madeCams.get(number) ?? null;
  }

  nameOf(number) {
    return this.cam(number)?.name ?? (number ? "a cam made at run time" : "no cam");
  }

  draw() {
    const { model } = this;
    // Before anything is drawn: what is hidden leaves its room to the others.
    const modules = this.cards.filter((card) => card.module).map((card) => this.numbersOf(card.of));
    const busy = new Set(modules.flatMap(({ running, next }) => [this.cam(running), this.cam(next)]));
    for (const card of this.cards) if (!card.module) card.node.hidden = busy.has(card.of);
    for (const card of this.cards) {
      if (card.module) {
        const numbers = this.numbersOf(card.of);
        const [cam, next] = [this.cam(numbers.running), this.cam(numbers.next)];
        const row = model.rows[card.of.index];
        const then = numbers.next ? `next: ${this.nameOf(numbers.next)}` : "";
        put(card.words, [this.nameOf(numbers.running), then, row?.state, row?.more, row?.waits].filter(Boolean).join("  ·  "));
        const live = (field) => model.liveOf(card.of, field);
        const [x, y] = [live("set_x_position"), live("set_y_position")];
        put(card.place, cam ? `x ${number(x)} ${cam.units[0]}   y ${number(y)} ${cam.units[1]}` : "");
        put(card.places, `master ${this.at(card.of, "mp01_set_master_position")}   slave ${this.at(card.of, "mp02_set_slave_position")}, measured ${this.at(card.of, "actual_slave_position")}`);
        const measured = y + (live("actual_slave_position") - live("mp02_set_slave_position")) / live("set_scaling_slave");
        if (card.buttons) this.allow(card, cam);
        if (card.edit) this.putIntoForce(card);
        this.curves(card, cam, x, y, card.edit?.cam ?? next, measured);
      } else {
        if (card.node.hidden) continue;
        put(card.words, card.of.cyclic ? "cyclic" : "");
        this.curves(card, card.of, NaN, NaN, null, NaN);
      }
    }
  }

  // A value with its unit.
  at(module, field) {
    return `${number(this.model.liveOf(module, field))} ${this.model.unit(module, field)}`;
  }

  // The set point is a full dot, what is measured a ring; the cam that is to run next is dashed.
  curves(card, cam, x, y, next, measured) {
    const [width, height] = [card.picture.clientWidth, card.picture.clientHeight];
    if (width < 50) return;
    const c = fitCanvas(card.canvas, width, height);
    c.clearRect(0, 0, width, height);
    if (!cam) return;
    c.font = `11px ${css("--font")}`;
    const [left, right, bottom] = [66, 8, 20];
    const both = next ? [cam, next] : [cam];
    const [from, to] = [Math.min(...both.map((one) => one.x[0])), Math.max(...both.map((one) => one.x.at(-1)))];
    const across = (v) => left + ((v - from) / (to - from)) * (width - left - right);
    let top = 6;
    CURVES.forEach((name, i) => {
      const space = (height - bottom - 6) * HEIGHTS[i] - 8;
      const [low, high] = i === 0 && card.edit?.view ? card.edit.view.range : this.scale(both, i);
      const above = top;
      const down = (v) => above + space * (1 - (v - low) / (high - low));
      this.frame(c, cam, i, name, { top, space, left, right, width, low, high, down });
      if (next) this.curve(c, next, i, across, down, css("--soft"), DASHES);
      this.curve(c, cam, i, across, down, tone(this.model.machine.palette[i]), []);
      if (i === 0 && card.edit) this.handles(card, c, across, down, { left, right, width, from, to, top, space, low, high });
      if (Number.isFinite(x)) this.dots(c, cam, i, across(x), x, y, measured, { low, high, down });
      top += space + 8;
    });
    if (Number.isFinite(x) && x >= from && x <= to) {
      c.strokeStyle = css("--bad");
      c.globalAlpha = 0.6;
      c.beginPath();
      c.moveTo(across(x), 6);
      c.lineTo(across(x), height - bottom);
      c.stroke();
      c.globalAlpha = 1;
    }
    c.fillStyle = css("--soft");
    c.textBaseline = "top";
    const { at, decimals } = ticks(from, to, width / 80);
    for (const value of at) {
      c.textAlign = value === at[0] ? "left" : "center";
      if (across(value) < width - 44) c.fillText(value.toFixed(decimals), across(value), height - 15);
    }
    c.textAlign = "right";
    c.fillText(`x, ${cam.units[0]}`, width - right, height - 15);
  }

  // The least and the greatest value that is shown, with room.
  scale(cams, i) {
    const all = cams.map((cam) => {
      cam.extents ??= cam.curves.map((curve, k) => {
        const known = curve.filter((v) => v !== null);
        return [Math.min(...known, k ? 0 : Infinity), Math.max(...known, k ? 0 : -Infinity)];
      });
      return cam.extents[i];
    });
    const [low, high] = [Math.min(...all.map(([least]) => least)), Math.max(...all.map(([, most]) => most))];
    const room = 0.08 * (high - low || 1);
    return [low - room, high + room];
  }

  // The joints that can be dragged, and how pixels and values belong together.
  handles(card, c, across, down, { left, right, width, from, to, top, space, low, high }) {
    card.view = {
      across, down, range: [low, high],
      x: (px) => from + ((px - left) / (width - left - right)) * (to - from),
      y: (py) => low + (1 - (py - top) / space) * (high - low),
    };
    c.lineWidth = 1.5;
    c.strokeStyle = css("--accent");
    c.fillStyle = css("--card");
    for (const [x, y] of card.edit.knots) {
      c.beginPath();
      c.rect(across(x) - 4.5, down(y) - 4.5, 9, 9);
      c.fill();
      c.stroke();
    }
  }

  frame(c, cam, i, name, { top, space, left, right, width, low, high, down: y }) {
    c.lineWidth = 1;
    c.strokeStyle = css("--line");
    c.strokeRect(left + 0.5, Math.round(top) + 0.5, width - left - right - 1, Math.round(space));
    c.textAlign = "right";
    c.textBaseline = "middle";
    const { at, decimals } = ticks(low, high, Math.max(3, space / 34));
    for (const value of at) {
      c.strokeStyle = css("--grid");
      c.beginPath();
      c.moveTo(left, Math.round(y(value)) + 0.5);
      c.lineTo(width - right, Math.round(y(value)) + 0.5);
      c.stroke();
      c.fillStyle = css("--soft");
      if (y(value) > top + 5 && y(value) < top + space - 4) c.fillText(value.toFixed(decimals).replace("-", "−"), left - 5, y(value));
    }
    c.textAlign = "left";
    c.fillText(`${name}, ${cam.units[1]}${i ? `/${cam.units[0]}${POWERS[i]}` : ""}`, left + 6, top + 9);
  }

  curve(c, cam, i, across, y, colour, dashes) {
    c.strokeStyle = colour;
    c.lineWidth = 1.6;
    c.setLineDash(dashes);
    c.beginPath();
    let down = false;
    cam.curves[i].forEach((v, k) => {
      if (v === null) down = false;
      else if (down) c.lineTo(across(cam.x[k]), y(v));
      else {
        c.moveTo(across(cam.x[k]), y(v));
        down = true;
      }
    });
    c.stroke();
    c.setLineDash([]);
  }

  dots(c, cam, i, px, x, y, measured, { low, high, down }) {
    // With strokes of earlier cycles Y counts on: then the curve itself says where it is.
    const counts = i === 0 && y >= low && y <= high;
    const on = counts ? y : this.valueAt(cam, i, x);
    if (!Number.isFinite(on)) return;
    if (i === 0 && Number.isFinite(measured)) {
      const ring = on + measured - y;
      if (ring >= low && ring <= high) {
        c.strokeStyle = css("--ink");
        c.lineWidth = 1.5;
        c.beginPath();
        c.arc(px, down(ring), 8, 0, 7);
        c.stroke();
      }
    }
    c.fillStyle = css("--bad");
    c.strokeStyle = css("--card");
    c.lineWidth = 1.5;
    c.beginPath();
    c.arc(px, down(on), i ? 3.5 : 5, 0, 7);
    c.fill();
    c.stroke();
  }

  valueAt(cam, i, x) {
    const curve = cam.curves[i];
    const k = cam.x.findIndex((v) => v >= x);
    if (k < 1) return k === 0 ? curve[0] : NaN;
    const share = (x - cam.x[k - 1]) / (cam.x[k] - cam.x[k - 1]);
    return curve[k - 1] + share * (curve[k] - curve[k - 1]);
  }
}

