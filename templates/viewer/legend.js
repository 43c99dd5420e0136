// The color scale with its unit, and the scale bar, drawn on the page and into screenshots by the same hand.
import { number } from "./colors.js";

const BAR = 12, GAP = 5;

function style(context, ink) {
  context.font = "12px system-ui, -apple-system, 'Segoe UI', 'DejaVu Sans', sans-serif";
  context.textBaseline = "top";
  context.fillStyle = ink;
  context.strokeStyle = ink;
}

function fieldName(scale) {
  const { name, unit } = scale.field;
  return name + (unit ? ` (${unit})` : "") + (scale.log ? ", logarithmic" : "");
}

// A patch for each whole number, as far as the colors of the map are different ones.
function drawPatches(context, scale, width, top) {
  const [low, high] = scale.range, n = Math.min(high - low + 1, scale.map.bytes.length / 3);
  for (let k = 0; k < n; k++) {
    context.fillStyle = scale.color(low + k);
    context.fillRect((k * width) / n, top, width / n - 1, BAR);
  }
  return Array.from({ length: n }, (_, k) => ({ at: ((k + 0.5) * width) / n, value: low + k }));
}

function drawRamp(context, scale, width, top) {
  for (let x = 0; x < width; x++) {
    context.fillStyle = scale.color(scale.at((x + 0.5) / width));
    context.fillRect(x, top, 1.5, BAR);
  }
  return scale.ticks().map((value) => ({ at: scale.place(value) * width, value }));
}

// Labels that have room, each within the width.
function drawLabels(context, ticks, width, top) {
  let free = -Infinity;
  for (const { at, value } of ticks) {
    const label = number(value, 3), wide = context.measureText(label).width;
    const left = Math.min(width - wide, Math.max(0, at - wide / 2));
    if (left < free) continue;
    context.fillText(label, left, top + BAR + GAP + 2);
    context.fillRect(Math.min(width - 1, Math.max(0, at - 0.5)), top + BAR, 1, 4);
    free = left + wide + 8;
  }
}

export const LEGEND_HEIGHT = 34, TITLE_HEIGHT = 18;

// At the context's origin; with `titled` the field is said in a line above.
export function drawLegend(context, scale, width, ink, titled) {
  style(context, ink);
  if (titled) context.fillText(fieldName(scale), 0, 0);
  const top = titled ? TITLE_HEIGHT : 0, draw = scale.counts ? drawPatches : drawRamp;
  const ticks = draw(context, scale, width, top);
  context.fillStyle = ink;
  drawLabels(context, ticks, width, top);
}

// A bar of a round length, at most `most` pixels, its right end at the context's origin.
export function drawScaleBar(context, mmPerPixel, most, ink) {
  const power = Math.pow(10, Math.floor(Math.log10(most * mmPerPixel)));
  const length = [5, 2, 1].map((k) => k * power).find((mm) => mm <= most * mmPerPixel);
  const wide = length / mmPerPixel;
  style(context, ink);
  context.fillRect(-wide, 18, wide, 2);
  context.textAlign = "right";
  context.fillText(`${number(length)} mm`, 0, 0);
  context.textAlign = "left";
}

// A canvas of so many pixels of the page, cleared, with its context scaled to the screen's.
export function sized(canvas, width, height) {
  const ratio = Math.min(window.devicePixelRatio || 1, 3);
  canvas.width = Math.round(width * ratio);
  canvas.height = Math.round(height * ratio);
  canvas.style.width = width + "px";
  canvas.style.height = height + "px";
  const context = canvas.getContext("2d");
  context.scale(ratio, ratio);
  return context;
}
