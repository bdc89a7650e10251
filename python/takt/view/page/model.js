// What the page knows of the machine: what it is made of, and how it is now.

export class Model {
  constructor() {
    this.machine = null;
    this.reset();
  }

  reset() {
    this.rows = [];
    this.live = new Float64Array(0);
    this.details = new Map();
    this.events = [];
    this.engine = null;
    this.cycle = 0;
    this.objects = {};
    this.poses = {}; // of the links of groups: place and quaternion
    this.links = {}; // where each begins and ends
    this.shapes = new Map(); // of tracks, by name
    this.routes = new Map(); // over the free surface, by the mover's name
    this.madeCams = new Map(); // at run time, by number
    this.health = {};
  }

  begin(machine) {
    this.reset();
    this.machine = machine;
    this.kinds = machine.kinds;
    this.components = machine.components;
    this.byName = new Map();
    this.numbers = {}; // components by kind, as the engine counts them: the first is number 1
    let start = 0;
    this.components.forEach((component, index) => {
      component.index = index;
      component.start = start;
      start += this.kinds[component.kind].live.length;
      this.byName.set(component.name, component);
      (this.numbers[component.kind] ??= []).push(component);
    });
    for (const track of machine.plan.tracks) this.shapes.set(track.name, track);
    for (const kind of Object.values(this.kinds)) {
      kind.byName = new Map(kind.fields.map((field, place) => [field.name, { ...field, place }]));
      kind.livePlace = new Map(kind.live.map((field, place) => [field, place]));
    }
  }

  get period() {
    return this.machine?.period_s ?? 0.001;
  }

  get now() {
    return this.cycle * this.period;
  }

  // Takes a frame. Where the numbers of signals begin.
  take({ header, numbers }) {
    this.cycle = header.cycle;
    this.live = numbers.subarray(0, header.live);
    let at = header.live;
    this.details.clear();
    for (const index of header.details) {
      const count = this.kinds[this.components[index].kind].fields.length;
      this.details.set(index, numbers.subarray(at, at + count));
      at += count;
    }
    for (const row of header.rows ?? []) this.rows[row.i] = row;
    if (header.events) this.events = [...this.events, ...header.events].slice(-500);
    if (header.engine) this.engine = header.engine;
    for (const shape of header.shapes ?? []) this.shapes.set(shape.name, shape);
    for (const route of header.routes ?? []) this.routes.set(route.name, route);
    for (const cam of header.cams ?? []) this.madeCams.set(cam.number, cam);
    this.objects = header.objects;
    for (const [name, poses] of Object.entries(header.links)) this.placeLinks(name, poses);
    this.health = header.health;
    return at;
  }

  placeLinks(group, poses) {
    const spans = this.machine.scene.spans[group];
    this.poses[group] = poses;
    this.links[group] = poses.map(([x, y, z, ...turn], i) => {
      const [dx, dy, dz] = turned(turn, spans.slice(3 * i, 3 * i + 3));
      return [x, y, z, x + dx, y + dy, z + dz];
    });
  }

  liveOf(component, field) {
    const place = this.kinds[component.kind].livePlace.get(field);
    return place === undefined ? NaN : this.live[component.start + place];
  }

  field(component, name) {
    return this.kinds[component.kind].byName.get(name);
  }

  unit(component, name) {
    const unit = this.field(component, name)?.unit ?? "";
    return unit === "1" ? "" : (component.units[unit] ?? unit);
  }

  // Why no signal is named so; empty where one is.
  whyNo(signal) {
    const [, name, field] = /^(?:(.*)\.)?(.*)$/.exec(signal);
    const component = this.byName.get(name ?? signal);
    if (!component) return `there is no component ${name ?? signal}`;
    return this.field(component, field) ? "" : `${name} publishes no ${field}`;
  }

  // The value of an enumeration or a switch by name; null for numbers.
  nameOf(component, name, value) {
    const field = this.field(component, name);
    if (!field) return null;
    if (field.names) return field.names[String(value)] ?? null;
    return field.flag && (value === 0 || value === 1) ? (value ? "yes" : "no") : null;
  }

  isBad(row) {
    return Boolean(row && (row.error || /error/i.test(row.state)));
  }
}

// A vector turned by a unit quaternion.
function turned([x, y, z, w], [a, b, c]) {
  const [u, v, t] = [2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)];
  return [a + w * u + y * t - z * v, b + w * v + z * u - x * t, c + w * t + x * v - y * u];
}
