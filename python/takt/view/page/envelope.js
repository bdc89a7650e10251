// Smallest and largest values of a signal in stretches of equal length, so that a picture costs as much as it is wide.
// The stretches lie at multiples of their length: a picture that moves on does not flicker, and what was seen once is
// not looked at again.

const LENGTH = 8192; // stretches; a picture has about two a pixel at most

export class Envelope {
  constructor(size) {
    this.size = size; // cycles
    this.low = new Float64Array(LENGTH);
    this.high = new Float64Array(LENGTH);
    this.first = null; // number of the first stretch
    this.end = 0; // stretches
    this.row = 0; // of the series, from the first one ever: the next to be looked at
  }

  update(series, column) {
    const { cycles, moved } = series;
    const { low, high, size } = this;
    for (let i = Math.max(0, this.row - moved); i < series.end; ++i) {
      const stretch = Math.floor(cycles[i] / size);
      if (this.first === null || stretch >= this.first + LENGTH) this.makeRoom(stretch);
      const at = stretch - this.first;
      while (this.end <= at) {
        low[this.end] = Infinity;
        high[this.end++] = -Infinity;
      }
      const value = column[i];
      if (value < low[at]) low[at] = value;
      if (value > high[at]) high[at] = value;
    }
    this.row = moved + series.end;
  }

  makeRoom(stretch) {
    const first = this.first === null ? stretch : stretch - (LENGTH >> 1);
    const shift = this.first === null ? LENGTH : first - this.first;
    const kept = Math.max(0, this.end - shift);
    this.low.copyWithin(0, shift, shift + kept);
    this.high.copyWithin(0, shift, shift + kept);
    this.end = kept;
    this.first = first;
  }

  // Indices of the stretches that reach into a window.
  part(from, to) {
    if (this.first === null) return [0, 0];
    const begin = Math.min(Math.max(0, Math.floor(from / this.size) - this.first), this.end);
    return [begin, Math.min(Math.max(begin, Math.ceil(to / this.size) - this.first), this.end)];
  }

  range(begin, end) {
    let [least, most] = [Infinity, -Infinity];
    for (let i = begin; i < end; ++i) {
      if (this.low[i] < least) least = this.low[i];
      if (this.high[i] > most) most = this.high[i];
    }
    return [least, most];
  }
}
