// What the pointer does in the scope, in the plan and in three dimensions, by keys.

import { byId } from "./dom.js";

const CLOSER = 0.8; // of a window, by one key
const PART = 0.1; // of a window or a view, by one key

// `tab()`: the name of the view that is seen.
export function listen(tab, scope, plan, space) {
  const cursors = new Cursors(scope);
  addEventListener("keydown", (event) => {
    if (/INPUT|SELECT|TEXTAREA/.test(event.target.tagName) || event.ctrlKey || event.altKey || event.metaKey) return;
    const taken = { scope: () => cursors.key(event), plan: () => look(plan, event.key), "3d": () => space.key(event) }[tab()]?.();
    if (taken) event.preventDefault();
  });
  giveUpFocus();
}

// Whoever clicks goes on with the keys of the view: only what was reached by keys keeps them to itself.
function giveUpFocus() {
  let opened = null; // the select that was by the pointer
  addEventListener("pointerdown", ({ target }) => (opened = target.closest("select")));
  addEventListener("change", ({ target }) => {
    if (target !== opened) return;
    opened = null;
    target.blur();
  });
  addEventListener("click", ({ target, detail }) => {
    if (detail) target.closest("button, [role=button], [type=checkbox]")?.blur(); // keys click, too, without a count
  });
}

class Cursors {
  constructor(scope) {
    this.scope = scope;
    this.picked = null; // by its key; else it is the one that was set last
    byId("lanes").addEventListener("pointerup", () => (this.picked = null));
  }

  get last() {
    const { a, b } = this.scope;
    if (this.picked && this.scope[this.picked] !== null) return this.picked;
    return b !== null ? "b" : a !== null ? "a" : null;
  }

  key({ key, shiftKey }) {
    const { scope } = this;
    if (!scope.drawing.window) return false;
    const way = { ArrowLeft: -1, ArrowRight: 1 }[key];
    const factor = { "+": CLOSER, "=": CLOSER, "-": 1 / CLOSER }[key];
    if (key === "a" || key === "b") this.pick(key);
    else if (way && this.last) this.move(way, shiftKey);
    else if (factor) this.zoom(factor);
    else return false;
    return true;
  }

  // In the middle of the samples that are shown, where it did not stand yet. There is no B without A.
  pick(name) {
    const { scope } = this;
    if (!scope.paused) scope.pause(true);
    const { from, to } = scope.shown();
    const [first, last] = this.samples();
    this.picked = name === "b" && scope.a === null ? "a" : name;
    scope[this.picked] ??= Math.round((Math.max(from, first) + Math.min(to, last)) / 2);
    this.follow(0);
  }

  samples() {
    const { store, from, to } = this.scope.shown();
    return store.extent() ?? [from, to];
  }

  // By a cycle, or a part of the window, from the first sample to the last.
  move(way, far) {
    const { scope, last } = this;
    const { from, to } = scope.shown();
    const step = way * (far ? Math.max(1, Math.round(PART * (to - from))) : 1);
    const [least, most] = this.samples();
    scope[last] = Math.min(Math.max(scope[last] + step, least), most);
    this.follow(step);
  }

  // The window goes along with the cursor; where that was out of sight it comes to its middle.
  follow(step) {
    const { scope, last } = this;
    const { from, to } = scope.shown();
    const at = scope[last];
    const beyond = Math.max(from - at, at - to);
    if (beyond <= 0) return;
    const by = beyond > Math.abs(step) ? at - (from + to) / 2 : step;
    scope.setZoom(from + by, to + by);
  }

  // About the cursor in sight, of a paused picture; else the window becomes shorter or longer.
  zoom(factor) {
    const { scope, last } = this;
    if (!scope.paused) {
      const spans = byId("span");
      spans.selectedIndex = Math.max(0, Math.min(spans.length - 1, spans.selectedIndex + (factor < 1 ? -1 : 1)));
      spans.dispatchEvent(new Event("change"));
      return;
    }
    const { from, to } = scope.shown();
    const seen = last && scope[last] >= from && scope[last] <= to;
    const middle = seen ? scope[last] : (from + to) / 2;
    scope.setZoom(middle - (middle - from) * factor, middle + (to - middle) * factor);
  }
}

function look(plan, key) {
  const { camera } = plan;
  if (!camera) return false;
  const [h, v] = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowDown: [0, -1], ArrowUp: [0, 1] }[key] ?? [0, 0];
  const factor = { "+": 1 / CLOSER, "=": 1 / CLOSER, "-": CLOSER }[key];
  if (key === "0") plan.fitAgain();
  else if (factor) camera.scale *= factor;
  else if (h || v) {
    camera.x += (h * PART * plan.width) / camera.scale;
    camera.y += (v * PART * plan.height) / camera.scale;
  } else return false;
  plan.onchange();
  return true;
}
