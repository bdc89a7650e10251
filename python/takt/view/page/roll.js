// Curves that move on: a pixel that was drawn stays where it is, in a ring, and only the strip that is new is drawn.
// Lengths are in pixels of the screen; a pixel's number is that of its first cycle, in pixels since the first one ever.

export class Roll {
  constructor() {
    this.canvas = document.createElement("canvas");
    this.context = this.canvas.getContext("2d");
    this.lanes = new Map(); // by key: what is drawn of it
  }

  // From the pixel `first` on, of so many cycles each. `layout`: where lanes are; if it is another one, nothing is kept.
  begin(width, height, first, size, layout) {
    const key = `${width} ${height} ${size} ${layout}`;
    if (key !== this.key) {
      Object.assign(this.canvas, { width, height }); // which clears it
      this.lanes.clear();
    }
    Object.assign(this, { key, first, size });
  }

  // Has a lane drawn where that was not done or has changed since: anywhere if it is `made` of something else, else from
  // where its signals ended, `ends`. paint(c, x, from, to) draws it between two cycles; `over`: how far a line reaches.
  update(lane, top, height, made, ends, over, paint) {
    const { first, size, context: c } = this;
    const { width } = this.canvas;
    const end = first + width;
    const known = this.lanes.get(lane);
    const same = known && known.end <= end && made.length === known.made.length && made.every((one, i) => one === known.made[i]);
    const longer = (same ? ends : []).flatMap((cycle, i) => (cycle === known.ends[i] ? [] : [Math.floor(known.ends[i] / size) - over]));
    let at = Math.max(first, same ? Math.min(known.end, ...longer) : first);
    this.lanes.set(lane, { made, ends, end });
    while (at < end) {
      const column = this.column(at);
      const count = Math.min(end - at, width - column);
      const number = at;
      c.save();
      c.beginPath();
      c.rect(column, top, count, height);
      c.clip();
      c.clearRect(column, top, count, height);
      paint(c, (cycle) => cycle / size - number + column, (at - over) * size, (at + count + over) * size);
      c.restore();
      at += count;
    }
  }

  column(pixel) {
    const { width } = this.canvas;
    return ((pixel % width) + width) % width;
  }

  // Puts it all where it belongs in a picture.
  show(c, left) {
    const { width, height } = this.canvas;
    if (!height) return;
    const column = this.column(this.first);
    c.drawImage(this.canvas, column, 0, width - column, height, left, 0, width - column, height);
    if (column) c.drawImage(this.canvas, 0, 0, column, height, left + width - column, 0, column, height);
  }
}
