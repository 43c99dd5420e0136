// Maps values to colors as corcast's own scales do. A value has a position in 0..1 on its range, linear or logarithmic.
// The color is interpolated in sRGB between the colors of a map. A map of separate colors gives each integer a color,
// and repeats its colors cyclically.

const NO_DATA = [128, 128, 128];

export class Scale {
  constructor(field, map, log, range) {
    this.field = field;
    this.map = map;
    this.log = log;
    this.range = range;
    this.counts = map.separate && field.whole;
  }

  // Returns the position of a value: 0 and 1 at the ends of the range, NaN for a value that cannot be shown.
  position(value) {
    const [low, high] = this.range;
    if (!Number.isFinite(value) || (this.log && value <= 0)) return NaN;
    if (high === low) return 0.5;
    return this.log ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low);
  }

  // Writes the color of a value, three sRGB bytes, into `out` from index `at` on.
  put(value, out, at) {
    const { bytes } = this.map, n = bytes.length / 3;
    const position = this.counts ? value : this.position(value);
    if (Number.isNaN(position)) {
      for (let c = 0; c < 3; c++) out[at + c] = NO_DATA[c];
      return;
    }
    const exact = this.counts ? (((position - 1) % n) + n) % n : Math.min(1, Math.max(0, position)) * (n - 1);
    const from = this.map.separate ? Math.round(exact) : Math.min(n - 2, Math.floor(exact));
    const part = this.map.separate ? 0 : exact - from;
    for (let c = 0; c < 3; c++) {
      const a = bytes[3 * from + c], b = part ? bytes[3 * from + 3 + c] : a;
      out[at + c] = Math.round(a + (b - a) * part);
    }
  }

  color(value) {
    const out = [0, 0, 0];
    this.put(value, out, 0);
    return `rgb(${out.join(" ")})`;
  }

  // Returns the value at a position.
  at(position) {
    const [low, high] = this.range;
    return this.log ? low * Math.pow(high / low, position) : low + (high - low) * position;
  }

  // Returns a few round values in the range.
  ticks() {
    const [low, high] = this.range;
    if (high === low) return [low];
    return this.log ? logTicks(low, high) : linearTicks(low, high, this.field.whole);
  }
}

function linearTicks(low, high, whole) {
  const rough = (high - low) / 4, power = Math.pow(10, Math.floor(Math.log10(rough)));
  let step = [1, 2, 5, 10].map((k) => k * power).find((s) => s >= rough * 0.999);
  if (whole) step = high - low <= 12 ? 1 : Math.ceil(step);
  const ticks = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) ticks.push(k * step);
  return ticks;
}

function logTicks(low, high) {
  const ticks = [];
  for (let power = Math.floor(Math.log10(low)); power <= Math.log10(high); power++)
    for (const k of high / low > 40 ? [1] : high / low > 8 ? [1, 3] : [1, 1.5, 2, 3, 5, 7]) {
      const tick = k * Math.pow(10, power);
      if (tick >= low * 0.999 && tick <= high * 1.001) ticks.push(tick);
    }
  return ticks.length > 1 ? thinned(ticks) : [low, high];
}

function thinned(ticks) {
  const every = Math.ceil(ticks.length / 6);
  return ticks.filter((tick, k) => k % every === 0);
}

// Returns a number as text with `digits` significant digits, and an exponent only for very large or small numbers.
export function number(value, digits = 4) {
  if (!Number.isFinite(value)) return "–";
  if (value !== 0 && (Math.abs(value) >= 1e6 || Math.abs(value) < 1e-4)) return value.toExponential(digits - 2);
  return String(Number(value.toPrecision(Number.isInteger(value) ? 9 : digits)));
}
