// Draws the color scale with its unit, and the scale bar, on the page and into screenshots.
import { KINDS, number } from "./colors.js";

const BAR = 12, GAP = 5;

function style(context, ink) {
  context.font = "12px system-ui, -apple-system, 'Segoe UI', 'DejaVu Sans', sans-serif";
  context.textBaseline = "top";
  context.fillStyle = ink;
  context.strokeStyle = ink;
}

function scaleTitle(scale) {
  const { title, unit } = scale.field;
  return title + (unit ? ` (${unit})` : "") + (scale.kind === "linear" ? "" : ", " + KINDS[scale.kind]);
}

// Draws a patch of color for each integer of the range, at most one for each color of the map.
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
  return scale.ticks().map((value) => ({ at: scale.position(value) * width, value }));
}

// Draws the labels of ticks within the width. A label that would overlap the one before is left out.
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

// Draws the color scale at the context's origin. If `titled` is true, a line above names the field.
export function drawLegend(context, scale, width, ink, titled) {
  style(context, ink);
  if (titled) context.fillText(scaleTitle(scale), 0, 0);
  const top = titled ? TITLE_HEIGHT : 0, draw = scale.counts ? drawPatches : drawRamp;
  const ticks = draw(context, scale, width, top);
  context.fillStyle = ink;
  drawLabels(context, ticks, width, top);
}

// Draws a scale bar of a round length, at most `most` pixels, with its right end at the context's origin.
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

// Resizes a canvas to CSS pixels, clears it, and returns its context, which is scaled to the screen's pixels.
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
