// The list of all signals: filtered, opened component by component, ticked to be seen in the scope.

import { byId, el, exact, number } from "./dom.js";
import { Rows, put } from "./rows.js";

const MOST_FOUND = 400;

export class Chooser {
  constructor(model, scope) {
    this.model = model;
    this.scope = scope;
    this.open = new Set();
    this.filter = byId("filter");
    this.filter.oninput = () => this.rebuild();
    this.rows = new Rows(byId("signals"), 24, () => this.make(), (node, item) => this.fill(node, item));
    scope.addEventListener("chosen", () => this.rows.draw());
  }

  begin() {
    this.open.clear();
    if (this.model.components.length <= 3) for (const one of this.model.components) this.open.add(one.index);
    this.rebuild();
  }

  rebuild() {
    const words = this.filter.value.toLowerCase().split(/[\s.]+/).filter(Boolean);
    const items = [];
    for (const component of this.model.components ?? []) {
      const fields = this.model.kinds[component.kind].fields;
      const fits = (text) => words.every((word) => text.includes(word));
      const found = words.length ? fields.filter((field) => fits(`${component.name} ${field.name} ${component.kind}`.toLowerCase())) : [];
      if (words.length && !found.length) continue;
      items.push({ component });
      const shown = words.length ? found : this.open.has(component.index) ? fields : [];
      if (items.length < MOST_FOUND || !words.length) items.push(...shown.map((field) => ({ component, field })));
    }
    this.items = items;
    this.rows.show(items);
  }

  // Components whose values are to be seen.
  details() {
    const { box, height, items } = this.rows;
    const first = Math.floor(box.scrollTop / height);
    const seen = items.slice(first, first + Math.ceil(box.clientHeight / height) + 1);
    return [...new Set(seen.filter((item) => item.field).map((item) => item.component.index))].slice(0, 16);
  }

  make() {
    const node = el("div", {}, el("i"), el("span"), el("output"));
    node.tabIndex = 0;
    node.role = "button";
    node.onkeydown = (event) => {
      if (event.key !== "Enter" && event.key !== " ") return;
      event.preventDefault();
      node.click();
    };
    node.onclick = () => {
      const { component, field } = node.item;
      if (field) {
        this.scope.toggle(`${component.name}.${field.name}`);
      } else {
        this.open[this.open.has(component.index) ? "delete" : "add"](component.index);
        this.rebuild();
      }
    };
    return node;
  }

  fill(node, item) {
    const [mark, name, value] = node.children;
    node.item = item;
    const { component, field } = item;
    const isOpen = this.filter.value || this.open.has(component.index);
    node.classList.toggle("component", !field);
    node.classList.toggle("chosen", Boolean(field) && this.scope.has(`${component.name}.${field.name}`));
    node.title = field ? field.about : "";
    put(mark, field ? "" : isOpen ? "▾" : "▸");
    put(name, field ? field.label : component.name);
    if (!field) {
      put(value, component.kind.replaceAll("_", " "));
      return;
    }
    const now = this.model.details.get(component.index)?.[this.model.field(component, field.name).place];
    const unit = this.model.unit(component, field.name);
    const said = this.model.nameOf(component, field.name, now) ?? (field.whole ? exact(now) : number(now));
    put(value, unit ? `${said} ${unit}` : said);
  }
}
