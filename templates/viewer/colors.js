// Maps values to colors as corcast's own scales do. A value has a position in 0..1 on its range, linear or logarithmic.
// The color is interpolated in sRGB between the colors of a map. A map of separate colors gives each integer a color,
// and repeats its colors cyclically.

const NO_DATA = [128, 128, 128];
const MIDDLE = 0.8; // a field is skewed if this part of its values, in the middle of their order, ...
const CROWDED = 0.25; // ... has less than this part of the colors of a linear scale
const TAIL = 0.02; // the part of the values that a scale of percentiles cuts off at either end

// The kinds of scales, in the order in which they are tried for a field.
export const KINDS = { linear: "linear", log: "logarithmic", percentiles: "2nd to 98th percentile" };

// Returns the value below which a part of the ascending values lies, as colorscale_percentiles does.
function quantile(sorted, part) {
  const place = part * (sorted.length - 1), from = Math.floor(place);
  return sorted[from] + (place - from) * (sorted[Math.min(from + 1, sorted.length - 1)] - sorted[from]);
}

// Returns the ends of a field's scale of this kind. A logarithmic scale begins at the smallest value above 0.
export function rangeOf({ sorted }, kind) {
  if (kind === "percentiles") return [quantile(sorted, TAIL), quantile(sorted, 1 - TAIL)];
  return [kind === "log" ? sorted.find((value) => value > 0) : sorted[0], sorted[sorted.length - 1]];
}

// Returns true if a field can have a scale of this kind.
export function hasKind({ sorted, whole }, kind) {
  return kind === "linear" || (kind === "log" ? sorted[sorted.length - 1] > 0 : !whole);
}

export class Scale {
  constructor(field, map, kind, range) {
    this.field = field;
    this.map = map;
    this.kind = kind;
    this.log = kind === "log";
    this.range = range;
    this.counts = map.separate && field.whole;
  }

  // Returns the part of the colors that the middle of the field's values has.
  get spread() {
    const { sorted } = this.field, ends = [(1 - MIDDLE) / 2, (1 + MIDDLE) / 2];
    const [from, to] = ends.map((part) => Math.min(1, Math.max(0, this.position(quantile(sorted, part)))));
    return to - from;
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

// ---- colors on a dark background ----------------------------------------------------------------

const CONTRAST = 3; // of each color with the background; WCAG 2.1, 1.4.11: graphical objects
const decoded = (v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
const encoded = (v) => (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055);
const linear = (bytes, at) => [0, 1, 2].map((c) => decoded(bytes[at + c] / 255));
const times = (rows, v) => rows.map((row) => row[0] * v[0] + row[1] * v[1] + row[2] * v[2]);

// Oklab, a space of lightness and two opponent colors (B. Ottosson, 2020): linear RGB to cone responses, these to
// Oklab, and back.
const TO_CONES = [[0.4122214708, 0.5363325363, 0.0514459929], [0.2119034982, 0.6806995451, 0.1073969566],
  [0.0883024619, 0.2817188376, 0.6299787005]];
const TO_LAB = [[0.2104542553, 0.793617785, -0.0040720468], [1.9779984951, -2.428592205, 0.4505937099],
  [0.0259040371, 0.7827717662, -0.808675766]];
const FROM_LAB = [[1, 0.3963377774, 0.2158037573], [1, -0.1055613458, -0.0638541728], [1, -0.0894841775, -1.291485548]];
const FROM_CONES = [[4.0767416621, -3.3077115913, 0.2309699292], [-1.2684380046, 2.6097574011, -0.3413193965],
  [-0.0041960863, -0.7034186147, 1.707614701]];

// Returns the luminance of a color in linear RGB, from 0 to 1.
export function luminance(rgb) { return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]; }

// Returns the contrast between two luminances, as WCAG 2 defines it.
export function contrast(a, b) { return (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05); }

// Returns the color with its lightness L of Oklab replaced by least + (1 - least) L, as three sRGB bytes.
function lift(rgb, least) {
  const [light, a, b] = times(TO_LAB, times(TO_CONES, rgb).map(Math.cbrt));
  const made = times(FROM_CONES, times(FROM_LAB, [least + (1 - least) * light, a, b]).map((v) => v ** 3));
  return made.map((v) => Math.round(255 * encoded(Math.min(1, Math.max(0, v)))));
}

// Returns a map's colors, each with a contrast of at least CONTRAST with a dark background of luminance `ground`. All
// are lifted by the same rule and by no more than that needs, so that their order of lightness and their hues remain.
export function lifted(bytes, ground) {
  const colors = Array.from({ length: bytes.length / 3 }, (_, k) => linear(bytes, 3 * k));
  const isVisible = (made) => colors.every((_, k) => contrast(luminance(linear(made, 3 * k)), ground) >= CONTRAST);
  let made = bytes;
  for (let least = 0.01; !isVisible(made) && least < 1; least += 0.01)
    made = Uint8Array.from(colors.flatMap((rgb) => lift(rgb, least)));
  return made;
}

// ---- kinds of scales ----------------------------------------------------------------------------

function spreadOf(field, map, kind) { return new Scale(field, map, kind, rangeOf(field, kind)).spread; }

// Returns true if most values of a field share few of the colors of a linear scale.
function isSkewed(field, map) {
  const { sorted, whole } = field;
  return !whole && sorted[0] < sorted[sorted.length - 1] && spreadOf(field, map, "linear") < CROWDED;
}

// Returns the kind of scale for a field: if the field is skewed, the first kind that is not crowded, or if all are
// crowded the least crowded. Values of 0, which a logarithmic scale cannot show, rule it out.
export function chooseKind(field, map) {
  if (!isSkewed(field, map)) return "linear";
  const spread = (kind) => spreadOf(field, map, kind);
  const kinds = Object.keys(KINDS).filter((kind) => kind !== "log" || field.sorted[0] > 0);
  return kinds.find((kind) => spread(kind) >= CROWDED) ||
    kinds.reduce((best, kind) => (spread(kind) > spread(best) ? kind : best));
}

const percent = (part) => `${number(100 * part, part < 0.1 ? 1 : 2)}\u00a0%`;

// Returns the sentence that says why a field has its scale, or "" if the field is not skewed.
export function reason({ field, map, kind }) {
  if (!isSkewed(field, map)) return "";
  const most = `${percent(MIDDLE)} of the values fill ${percent(spreadOf(field, map, "linear"))} of`;
  return kind === "linear" ? `Skewed: ${most} this scale.` : `${KINDS[kind]}, because ${most} a linear scale.`;
}

// Returns a number as text with `digits` significant digits, and an exponent only for very large or small numbers.
export function number(value, digits = 4) {
  if (!Number.isFinite(value)) return "–";
  if (value !== 0 && (Math.abs(value) >= 1e6 || Math.abs(value) < 1e-4)) return value.toExponential(digits - 2);
  return String(Number(value.toPrecision(Number.isInteger(value) ? 9 : digits)));
}
