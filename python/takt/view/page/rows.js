// A long list of rows of which only those in sight are elements.

import { el } from "./dom.js";

export class Rows {
  // make(): an element; fill(element, item): shows an item in it.
  constructor(box, height, make, fill) {
    Object.assign(this, { box, height, make, fill, items: [] });
    this.space = el("div", { className: "rows-space" });
    box.append(this.space);
    this.pool = [];
    box.addEventListener("scroll", () => this.draw());
    new ResizeObserver(() => this.draw()).observe(box);
  }

  show(items) {
    this.items = items;
    this.space.style.height = `${items.length * this.height}px`;
    this.draw();
  }

  draw() {
    const first = Math.max(0, Math.floor(this.box.scrollTop / this.height) - 2);
    const count = Math.min(this.items.length - first, Math.ceil(this.box.clientHeight / this.height) + 4);
    while (this.pool.length < count) {
      const node = this.make();
      node.classList.add("row");
      this.space.append(node);
      this.pool.push(node);
    }
    this.pool.forEach((node, i) => {
      node.hidden = i >= count;
      if (node.hidden) return;
      node.style.transform = `translateY(${(first + i) * this.height}px)`;
      this.fill(node, this.items[first + i]);
    });
  }
}

// Sets a text only where it is another one.
export function put(node, text) {
  if (node.textContent !== text) node.textContent = text;
}
