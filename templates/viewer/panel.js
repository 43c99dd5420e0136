// The panels beside the picture: the selected field, the legend, and the values of a segment.
import { hasKind, KINDS, number, reason } from "./colors.js";
import { drawLegend, drawScaleBar, LEGEND_HEIGHT, sized } from "./legend.js";

const find = (id) => document.getElementById(id);

function option(value, label) {
  const made = document.createElement("option");
  made.value = value;
  made.textContent = label;
  return made;
}

function row(name, value, unit) {
  const made = document.createElement("tr");
  for (const [kind, text] of [["th", name], ["td", value], ["td", unit]]) {
    const cell = document.createElement(kind);
    cell.textContent = text;
    if (kind === "th") cell.scope = "row";
    made.append(cell);
  }
  return made;
}

function jump(number, label, go) {
  const made = document.createElement("button");
  made.type = "button";
  made.textContent = label;
  made.addEventListener("click", () => go(number));
  return made;
}

export function ink() {
  return getComputedStyle(document.body).color;
}

export class Panel {
  constructor() {
    find("kind").append(...Object.entries(KINDS).map(([kind, words]) => option(kind, words)));
  }

  setTree(tree) {
    this.tree = tree;
    const { properties, segments, low, high } = tree;
    find("name").textContent = properties.name;
    const sides = low.map((l, c) => number(high[c] - l, 3)).join(" × ");
    find("summary").textContent = `${segments.length.toLocaleString("en")} segments, ${sides}\u00a0mm`;
    const words = ({ title, unit }) => title + (unit ? ` (${unit})` : "");
    const fields = tree.fields.map((field) => option(field.name, words(field)));
    find("field").replaceChildren(option("", "one color"), ...fields);
    find("map").replaceChildren(...tree.maps.map(({ name }) => option(name, name)));
    find("made").textContent = `${properties.generator}: ${properties.command}`;
  }

  showScale(scale, field) {
    find("field").value = field ? field.name : "";
    find("scale").hidden = !scale;
    for (const choice of find("kind").options)
      choice.disabled = !field || !hasKind(field, choice.value) || (scale.counts && choice.value !== "linear");
    for (const choice of find("map").options)
      choice.disabled = !!field && !field.whole && this.tree.maps.find(({ name }) => name === choice.value).separate;
    if (!scale) return;
    find("map").value = scale.map.name;
    find("kind").value = scale.kind;
    find("reason").textContent = reason(scale);
    this.scale = scale;
    this.drawLegend();
  }

  drawLegend() {
    const canvas = find("legend"), width = Math.round(canvas.parentElement.clientWidth);
    if (!this.scale || width === 0) return;
    drawLegend(sized(canvas, width, LEGEND_HEIGHT), this.scale, width, ink(), false);
    const [low, high] = this.scale.range, { title, unit } = this.scale.field;
    canvas.setAttribute("aria-label", `${title} from ${number(low)} to ${number(high)} ${unit}`);
  }

  drawScaleBar(mmPerPixel) {
    const canvas = find("bar");
    canvas.hidden = !mmPerPixel;
    if (!mmPerPixel) return;
    const context = sized(canvas, 160, 22);
    context.translate(160, 0);
    drawScaleBar(context, mmPerPixel, 150, ink());
  }

  // Shows the ring around the selected segment, or hides it if `ring` is null.
  showRing(ring) {
    const element = find("ring");
    element.hidden = !ring;
    if (!ring) return;
    const { x, y, radius } = ring;
    Object.assign(element.style, { left: `${x - radius}px`, top: `${y - radius}px`,
      width: `${2 * radius}px`, height: `${2 * radius}px` });
  }

  // Shows the slider of times for a field that changes with time, and hides it for any other field. A page of grown trees
  // has none.
  showTime(field, moment) {
    const times = field ? field.times : [];
    if (!find("time")) return;
    find("time").hidden = times.length < 2;
    if (times.length < 2) return;
    find("moment").max = times.length - 1;
    find("moment").value = moment;
    find("clock").textContent = `time ${number(times[moment])}`;
  }

  // Shows all values of segment i, or hides the panel if i is -1. `pinned`: the panel stays when the pointer leaves.
  // `go` is called with the segment that the user jumps to.
  showSegment(i, moment, pinned, go) {
    const { tree } = this;
    find("readout").hidden = i < 0;
    if (i < 0) return;
    if (document.activeElement !== find("segment")) find("segment").value = tree.id[i];
    find("readout").classList.toggle("pinned", pinned);
    find("values").replaceChildren(...tree.fields.map(({ name, title, unit, values, times }) => {
      const at = times.length > 1 ? Math.min(moment, times.length - 1) * tree.n : 0;
      const line = row(title, number(values[at + i], 5), unit);
      line.dataset.field = name;
      return line;
    }));
    const up = tree.parent[i], isSegment = (node) => tree.numberOf.has(tree.id[node]);
    find("kin").replaceChildren(
      ...(isSegment(up) ? [jump(up, `↑ ${tree.id[up]}`, go)] : []),
      ...tree.daughters[i].filter(isSegment).map((node) => jump(node, `↓ ${tree.id[node]}`, go)));
  }
}
