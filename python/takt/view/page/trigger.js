// When the picture begins: at an edge of a signal.

export const MODES = ["off", "auto", "normal", "single"];

export class Trigger {
  constructor() {
    this.mode = "off";
    this.signal = null; // [component, field]
    this.edge = "rising"; // falling, either
    this.level = 0;
    this.ofState = false; // the signal is a state: rising is getting to the one of this number, falling is leaving it
    this.before = 0.2; // share of the picture that lies before the edge
    this.arm();
  }

  // What comes from now on counts, with the next frame, too.
  arm(store = null) {
    const series = store?.series.get(this.signal?.[0]);
    this.state = "armed"; // then filling, then held
    this.at = null; // cycle of the edge, with a fraction
    this.seen = series ? series.moved + series.end : null; // rows that were looked at, counted from the first one ever
  }

  // Looks at what has come. True: a picture is complete, from `at` on.
  step(store, span, newest) {
    if (this.mode === "off" || !this.signal) return false;
    const series = store.series.get(this.signal[0]);
    const column = series?.columns.get(this.signal[1]);
    if (!column) return false;
    if (this.state === "held") return false;
    if (this.state === "armed") {
      this.at = this.search(series, column);
      if (this.at === null) return false;
      this.state = "filling";
    }
    if (newest < this.at + span * (1 - this.before)) return false;
    this.seen = series.moved + series.find(this.at + span * (1 - this.before));
    this.state = this.mode === "single" ? "held" : "armed";
    return true;
  }

  search(series, column) {
    const first = this.seen === null ? series.end : Math.max(1, this.seen - series.moved);
    this.seen = series.moved + series.end;
    for (let i = Math.max(1, first); i < series.end; ++i) {
      const [a, b] = [this.over(column[i - 1]), this.over(column[i])];
      const from = a === 0 && b !== 0 ? this.cameFrom(column, i - 1) : a; // it rested at the level
      const rises = (a < 0 && b >= 0) || (a === 0 && b > 0 && from >= 0);
      const falls = (a > 0 && b <= 0) || (a === 0 && b < 0 && from <= 0);
      if ((rises && this.edge !== "falling") || (falls && this.edge !== "rising")) {
        this.seen = series.moved + i + 1;
        return series.cycles[i - 1] + (series.cycles[i] - series.cycles[i - 1]) * (a === 0 ? 0 : this.ofState ? 1 : a / (a - b));
      }
    }
    return null;
  }

  // How far above the level a value is.
  over(value) {
    return this.ofState ? (value === this.level ? 1 : -1) : value - this.level;
  }

  // How it got to the level that it is at: from above, > 0, or below; 0: it was there from the beginning.
  cameFrom(column, i) {
    while (i >= 0 && this.over(column[i]) === 0) --i;
    return i < 0 ? 0 : this.over(column[i]) || 0; // nothing is known of what was before the signal was chosen
  }
}
