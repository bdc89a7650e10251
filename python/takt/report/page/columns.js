// The columns of a page, as takt/report/columns.py packs them.

const TYPES = { i8: Int8Array, f32: Float32Array, f64: Float64Array };

export async function inflated(text) {
  const packed = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

export class Columns {
  constructor(bytes) {
    this.bytes = bytes;
    this.known = new Map();
  }

  // A column of n numbers; NaN where nothing is known.
  numbers(place, n) {
    if ("constant" in place) return new Float64Array(n).fill(place.constant ?? NaN);
    const kind = Object.keys(TYPES).find((one) => one in place);
    const [at, count] = place[kind];
    const key = `${kind} ${at} ${count}`;
    if (!this.known.has(key)) {
      const width = TYPES[kind].BYTES_PER_ELEMENT;
      const together = new Uint8Array(count * width);
      for (let k = 0; k < width; ++k) {
        const apart = this.bytes.subarray(at + k * count, at + (k + 1) * count);
        for (let i = 0, to = k; i < count; ++i, to += width) together[to] = apart[i];
      }
      this.known.set(key, new TYPES[kind](together.buffer));
    }
    return this.known.get(key);
  }

  // As uPlot wants them: null where a curve has a gap.
  curve(place, n) {
    const values = this.numbers(place, n);
    return values.some(Number.isNaN) ? Array.from(values, (v) => (Number.isFinite(v) ? v : null)) : values;
  }

  times(base) {
    if (!("from" in base)) return this.numbers(base, base.n);
    const step = (base.to - base.from) / (base.n - 1);
    return Float64Array.from({ length: base.n }, (_, i) => base.from + i * step);
  }
}

const EPSILON = 1e-9; // s: a time is that of a sample in spite of rounding

// The last row at or before a time; -1: none.
export function rowAt(times, time) {
  let [from, to] = [0, times.length];
  while (from < to) {
    const middle = (from + to) >> 1;
    if (times[middle] <= time + EPSILON) from = middle + 1;
    else to = middle;
  }
  return from - 1;
}
