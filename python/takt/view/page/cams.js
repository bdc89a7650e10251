// Cams with the point that is in force: of each cam module the one that runs, then those that no module runs.

import { byId, css, el, fitCanvas, number, ticks, tone } from "./dom.js";
import { put } from "./rows.js";

const SLOTS = ["ip08_cam_table1", "ip09_cam_table2", "ip10_cam_table3", "ip11_cam_table4"];
const CURVES = ["position", "velocity", "acceleration"];

export class Cams {
  constructor(model) {
    this.model = model;
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
    const title = el("b", { textContent: of.name });
    const picture = el("div", { className: "picture" }, canvas);
    const node = el("section", { className: "card cam" }, el("header", {}, title, words, place), picture);
    return { of, canvas, words, place, title, picture, node, module: "start" in of };
  }

  // The number of the cam that a module runs: from 1 in the order of the machine file, beyond it made at run time.
  numberOf(module) {
    const slot = this.model.liveOf(module, "cam_table");
    return slot >= 1 && slot <= SLOTS.length ? this.model.liveOf(module, SLOTS[slot - 1]) : NaN;
  }

  // The cam that a module runs, of the machine file.
  running(module) {
    return this.model.machine.cams[this.numberOf(module) - 1] ?? null;
  }

  draw() {
    const { model } = this;
    const busy = new Set();
    for (const card of this.cards) {
      if (card.module) {
        const cam = this.running(card.of);
        busy.add(cam);
        const row = model.rows[card.of.index];
        const made = this.numberOf(card.of) > model.machine.cams.length;
        put(card.words, [cam?.name ?? (made ? "a cam made at run time" : "no cam"), row?.state, row?.more, row?.waits].filter(Boolean).join("  ·  "));
        const [x, y] = ["set_x_position", "set_y_position"].map((field) => model.liveOf(card.of, field));
        put(card.place, cam ? `x ${number(x)} ${cam.units[0]}   y ${number(y)} ${cam.units[1]}` : "");
        this.curves(card, cam, x, y);
      } else {
        card.node.hidden = busy.has(card.of);
        if (card.node.hidden) continue;
        put(card.words, card.of.cyclic ? "cyclic" : "");
        this.curves(card, card.of, NaN, NaN);
      }
    }
  }

  curves(card, cam, x, y) {
    const [width, height] = [card.picture.clientWidth, card.picture.clientHeight];
    if (width < 50) return;
    const c = fitCanvas(card.canvas, width, height);
    c.clearRect(0, 0, width, height);
    if (!cam) return;
    c.font = `11px ${css("--font")}`;
    const [left, right, bottom] = [66, 8, 20];
    const [from, to] = [cam.x[0], cam.x.at(-1)];
    const across = (v) => left + ((v - from) / (to - from)) * (width - left - right);
    const heights = [0.56, 0.22, 0.22];
    let top = 6;
    CURVES.forEach((name, i) => {
      const space = (height - bottom - 6) * heights[i] - 8;
      this.curve(c, cam, i, name, { top, space, left, right, width, across });
      if (i === 0 && Number.isFinite(x)) this.dot(c, cam, x, y, { top, space, across });
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

  scale(cam, i) {
    cam.scales ??= cam.curves.map((curve) => {
      const known = curve.filter((v) => v !== null);
      const [low, high] = [Math.min(...known, i ? 0 : Infinity), Math.max(...known, i ? 0 : -Infinity)];
      const room = 0.08 * (high - low || 1);
      return [low - room, high + room];
    });
    return cam.scales[i];
  }

  curve(c, cam, i, name, { top, space, left, right, width, across }) {
    const [low, high] = this.scale(cam, i);
    const y = (v) => top + space * (1 - (v - low) / (high - low));
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
    c.fillText(`${name}, ${cam.units[1]}${i ? `/${cam.units[0]}${i > 1 ? "²" : ""}` : ""}`, left + 6, top + 9);
    c.strokeStyle = tone(this.model.machine.palette[i]);
    c.lineWidth = 1.6;
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
  }

  dot(c, cam, x, y, { top, space, across }) {
    const [low, high] = this.scale(cam, 0);
    // With strokes of earlier cycles Y counts on: then the curve itself says where it is.
    const on = y >= low && y <= high ? y : this.valueAt(cam, x);
    const py = top + space * (1 - (on - low) / (high - low));
    if (!Number.isFinite(py)) return;
    c.fillStyle = css("--bad");
    c.strokeStyle = css("--card");
    c.lineWidth = 1.5;
    c.beginPath();
    c.arc(across(x), py, 5, 0, 7);
    c.fill();
    c.stroke();
  }

  valueAt(cam, x) {
    const k = cam.x.findIndex((v) => v >= x);
    if (k < 1) return k === 0 ? cam.curves[0][0] : NaN;
    const share = (x - cam.x[k - 1]) / (cam.x[k] - cam.x[k - 1]);
    return cam.curves[0][k - 1] + share * (cam.curves[0][k] - cam.curves[0][k - 1]);
  }
}

