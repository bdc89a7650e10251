// The last values of the signals that are looked at: contiguous, so that a window of time is a pair of indices.

const LENGTH = 1 << 16; // of the arrays
const KEPT = 3 * (LENGTH / 4); // so many rows are there at least, once they have come

export class Series {
  constructor(fields) {
    this.cycles = new Float64Array(LENGTH);
    this.columns = new Map(fields.map((field) => [field, new Float64Array(LENGTH)]));
    this.end = 0;
    this.moved = 0; // rows that have left at the front: row + moved counts on for ever
  }

  // Of columns that are all there.
  static of(cycles, columns) {
    const series = Object.create(Series.prototype);
    return Object.assign(series, { cycles, columns, end: cycles.length, moved: 0 });
  }

  get last() {
    return this.end ? this.cycles[this.end - 1] : -1;
  }

  append(cycles, columns) {
    for (let at = 0; at < cycles.length; at += LENGTH - KEPT) {
      const count = Math.min(cycles.length - at, LENGTH - KEPT);
      if (this.end + count > LENGTH) this.makeRoom();
      this.cycles.set(cycles.subarray(at, at + count), this.end);
      for (const [field, column] of this.columns) {
        const values = columns.get(field);
        if (values) column.set(values.subarray(at, at + count), this.end);
        else column.fill(NaN, this.end, this.end + count);
      }
      this.end += count;
    }
  }

  makeRoom() {
    const from = this.end - KEPT;
    for (const column of [this.cycles, ...this.columns.values()]) column.copyWithin(0, from, this.end);
    this.moved += from;
    this.end = KEPT;
  }

  // The first row at or behind a cycle.
  find(cycle, from = 0, to = this.end) {
    while (from < to) {
      const middle = (from + to) >> 1;
      if (this.cycles[middle] < cycle) from = middle + 1;
      else to = middle;
    }
    return from;
  }

  // The value that holds at a cycle: that of the newest row at or before it.
  at(field, cycle) {
    const row = this.find(cycle + 1e-6) - 1;
    return row < 0 ? NaN : (this.columns.get(field)?.[row] ?? NaN);
  }

  // Those rows alone, to keep.
  piece(fromCycle, toCycle) {
    const [from, to] = [Math.max(0, this.find(fromCycle) - 1), Math.min(this.end, this.find(toCycle) + 1)];
    const copy = Series.of(this.cycles.slice(from, to), new Map([...this.columns].map(([field, column]) => [field, column.slice(from, to)])));
    copy.moved = this.moved + from;
    return copy;
  }
}

export class Store {
  constructor() {
    this.series = new Map(); // by component
  }

  // [[component, field]]: what is kept from now on.
  choose(signals) {
    const wanted = new Map();
    for (const [component, field] of signals) {
      if (!wanted.has(component)) wanted.set(component, new Set());
      wanted.get(component).add(field);
    }
    for (const component of [...this.series.keys()]) if (!wanted.has(component)) this.series.delete(component);
    for (const [component, fields] of wanted) {
      const series = this.series.get(component);
      if (!series) {
        this.series.set(component, new Series([...fields]));
        continue;
      }
      for (const field of [...series.columns.keys()]) if (!fields.has(field)) series.columns.delete(field);
      for (const field of fields) {
        if (!series.columns.has(field)) series.columns.set(field, new Float64Array(LENGTH).fill(NaN));
      }
    }
  }

  clear() {
    this.series.clear();
  }

  // From a frame: [[component, rows, fields, skipped]] and the numbers from `at` on.
  take(signals, numbers, at) {
    for (const [component, rows, fields] of signals) {
      const cycles = numbers.subarray(at, at + rows);
      at += rows;
      const columns = new Map();
      for (const field of fields) {
        columns.set(field, numbers.subarray(at, at + rows));
        at += rows;
      }
      this.series.get(component)?.append(cycles, columns);
    }
  }

  // What there is of a stretch of time, to keep.
  piece(fromCycle, toCycle) {
    const copy = new Store();
    for (const [component, series] of this.series) copy.series.set(component, series.piece(fromCycle, toCycle));
    return copy;
  }

  // The first and the last cycle that is there of anything; none of nothing.
  extent() {
    const all = [...this.series.values()].filter((series) => series.end);
    return all.length ? [Math.min(...all.map((series) => series.cycles[0])), Math.max(...all.map((series) => series.last))] : null;
  }

  // The value on the line between two samples; of whole numbers, and where it goes round, of the sample before.
  between(component, field, cycle, whole, modulus) {
    const series = this.series.get(component);
    const column = series?.columns.get(field);
    if (!column) return NaN;
    const row = series.find(cycle + 1e-6) - 1;
    const [a, b] = [column[row], column[row + 1]];
    if (row < 0 || whole || row + 1 >= series.end || !(Math.abs(b - a) < modulus / 2)) return series.at(field, cycle) ?? NaN;
    return a + ((b - a) * (cycle - series.cycles[row])) / (series.cycles[row + 1] - series.cycles[row]);
  }

  value(component, field, cycle) {
    return this.series.get(component)?.at(field, cycle) ?? NaN;
  }
}
