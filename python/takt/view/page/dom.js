// Elements, numbers and colours.

export function el(tag, properties = {}, ...children) {
  const node = Object.assign(document.createElement(tag), properties);
  node.append(...children.filter((child) => child !== null && child !== undefined));
  return node;
}

export const byId = (id) => document.getElementById(id);

// A number as it stands in tables that change all the time: as wide as before.
export function number(value, digits = 3) {
  if (value === undefined || value === null || Number.isNaN(value)) return "–";
  if (!Number.isFinite(value)) return value > 0 ? "∞" : "−∞";
  const size = Math.abs(value);
  if (size >= 1e9) return value.toExponential(4);
  const text = size >= 1e5 ? value.toFixed(0) : size >= 1e4 ? value.toFixed(Math.min(digits, 1)) : value.toFixed(digits);
  return Number(text) === 0 ? (0).toFixed(digits) : text.replace("-", "−");
}

// As exactly as six digits can say it.
export function exact(value) {
  if (value === undefined || value === null || Number.isNaN(value)) return "–";
  if (!Number.isFinite(value)) return value > 0 ? "∞" : "−∞";
  const size = Math.abs(value);
  const text = size >= 1e7 || (size && size < 1e-4) ? value.toExponential(4) : String(Number(value.toPrecision(7)));
  return text.replace("-", "−");
}

export const whole = (value) => Math.round(value).toLocaleString("en").replaceAll(",", " ");

export function duration(seconds) {
  const size = Math.abs(seconds);
  if (size >= 1) return `${Number(seconds.toPrecision(5))} s`.replace("-", "−");
  if (size >= 1e-3) return `${Number((seconds * 1e3).toPrecision(4))} ms`.replace("-", "−");
  return `${Number((seconds * 1e6).toPrecision(3))} µs`.replace("-", "−");
}

// "move_absolute {position: 100.0}" as it is read with ease.
export const commandWords = (text) => text.replace(/^(\w+) \{(.*)\}$/, "$1: $2").replace(/(\.\d{3})\d+/g, "$1").replace(/(\d)\.0+\b/g, "$1");

// --- colours ---

let cache = new Map();

// The same hue where it can be seen on a dark ground, too.
export function tone(hex) {
  if (css("--dark") !== "1") return hex;
  const lighter = [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16)).map((v) => Math.round(v + (255 - v) * 0.3));
  return `rgb(${lighter.join()})`;
}

export const forgetColours = () => { cache = new Map(); };

export function css(name) {
  if (!cache.has(name)) cache.set(name, getComputedStyle(document.documentElement).getPropertyValue(name).trim());
  return cache.get(name);
}

// A canvas as large as its element, in pixels of the screen; lengths are those of CSS.
export function fitCanvas(canvas, width, height) {
  const ratio = window.devicePixelRatio || 1;
  const [w, h] = [Math.round(width * ratio), Math.round(height * ratio)];
  if (canvas.width !== w || canvas.height !== h) {
    canvas.width = w;
    canvas.height = h;
    canvas.style.width = `${width}px`;
    canvas.style.height = `${height}px`;
  }
  const context = canvas.getContext("2d");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  return context;
}

// Round numbers between two, so many at most; and how many decimals they have.
export function ticks(from, to, most) {
  const rough = (to - from) / Math.max(1, most);
  if (!(rough > 0)) return { at: [], decimals: 0, step: 1 };
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].find((k) => k * power >= rough * 0.999) * power;
  const at = [];
  for (let k = Math.ceil(from / step - 1e-9); k * step <= to + 1e-9 * step; ++k) at.push(k * step);
  if (at.length < 2 && most < 12) return ticks(from, to, 2 * most); // one alone is no scale
  return { at, step, decimals: Math.max(0, -Math.floor(Math.log10(step) + 1e-9)) };
}
