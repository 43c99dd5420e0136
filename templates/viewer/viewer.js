// What pages of trees have in common. The module holds the state of the view, which the address of the page stores, and
// changes the state when the user presses keys, uses the mouse or the touch screen, or changes the address. A picture is
// drawn only after a change.
//
// A page calls begin() with its tree. A page whose tree changes calls showTree() with each new tree.
import { Color, SRGBColorSpace, WebGLRenderer } from "three";
import { chooseKind, hasKind, KINDS, lifted, luminance, rangeOf, Scale } from "./colors.js";
import { drawLegend, drawScaleBar, LEGEND_HEIGHT, TITLE_HEIGHT } from "./legend.js";
import { ink, Panel } from "./panel.js";
import { Shade } from "./shade.js";
import { Vessels } from "./vessels.js";
import { View, VIEWS } from "./view.js";

const find = (id) => document.getElementById(id);
const SHADE = 0.75;
const EDGE = 0.35; // darkness at the outlines of vessels on a light background in soft light
const FORM = 0.5; // strength of light and dark on vessels whose color shows a value
const RING = 18; // CSS pixels: smallest radius of the ring around the selected segment
const HIT = 4; // CSS pixels: minimum width of a vessel for picking with the pointer

const SHADE_PAUSE = 400; // ms without a new tree, after which shade is computed
const SWITCHES = { soft: true, shade: true, haze: true, panels: true }; // on or off in an address without them

// What a page does itself. A page replaces functions of this object before begin().
export const own = {
  addressParts: () => [], // the page's own parts of the address, as pairs of key and value
  // Takes the page's own parts from a URLSearchParams. Returns false, or a promise of it, if another address has come.
  readAddress: () => true,
  command: (name) => `corcast render ${name}`, // the command that draws the tree; options are appended
  freeBox: panelsLeave, // returns the part of the canvas that nothing covers, CSS pixels
};

let tree = null, start = null, vessels = null, panel = null, shade = null, view = null;
const CHECKS = ["soft", "shade", "haze"];
const state = {
  field: null, map: null, kind: null, moment: 0, grown: 1,
  hovered: -1, pinned: -1, // indices of segments, or -1
};
let scale = null, wanted = false, playing = 0, written = 0, reading = 0, known = location.hash;
let ground = null; // luminance of a dark background, or null if the background is light
const retired = []; // what drew the tree before; it is kept until the next tree is drawn, which uses its shaders again
const colors = { paper: null, accent: null }; // of the shader

// Only takeScheme reads `dark.matches`: Chromium sends no change event if a script reads the new value before.
const dark = matchMedia("(prefers-color-scheme: dark)");
const canvas = find("stage");
const renderer = makeRenderer();
renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));

function makeRenderer() {
  try {
    return new WebGLRenderer({ canvas, antialias: true });
  } catch (error) {
    find("failed").hidden = false;
    throw error;
  }
}

// ---- pictures -----------------------------------------------------------------------------------

function draw() {
  view.step();
  vessels.draw(renderer, view.camera, canvas.height);
}

function wantPicture() {
  if (wanted) return;
  wanted = true;
  requestAnimationFrame(() => {
    wanted = false;
    draw();
    retired.splice(0).forEach((old) => old.dispose());
    panel.drawScaleBar(mmPerPixel());
    panel.showRing(ring());
  });
}

// Returns the circle around the selected segment in CSS pixels, {x, y, radius}, or null.
function ring() {
  const i = state.pinned;
  if (i < 0) return null;
  const [[x, y], ...ends] = [tree.middle(i), tree.point(i), tree.point(tree.parent[i])].map((at) => view.onScreen(at));
  const reach = Math.max(...ends.map((end) => Math.hypot(end[0] - x, end[1] - y)));
  return { x, y, radius: Math.min(Math.max(RING, reach + 10), 0.4 * canvas.clientHeight) };
}

function mmPerPixel() {
  return view.isOrthographic ? view.pose.height / canvas.clientHeight : 0;
}

// Returns the part of the window that the panels leave free. The tree is drawn in its middle.
function panelsLeave() {
  const { innerWidth: width, innerHeight: height } = window, side = find("side").getBoundingClientRect();
  if (side.width === 0) return { left: 0, top: 0, width, height };
  const top = find("tools").getBoundingClientRect().bottom;
  if (side.width >= width / 2) return { left: 0, top, width, height: side.top - top };
  return { left: side.right, top, width: width - side.right, height: height - top };
}

// Fits the view, and the panel of a segment, into what the other panels leave.
function fitView() {
  find("readout").style.setProperty("--side", `${find("side").getBoundingClientRect().bottom}px`);
  view.resize(canvas.clientWidth, canvas.clientHeight, own.freeBox());
}

function resize() {
  renderer.setSize(canvas.clientWidth, canvas.clientHeight, false);
  panel.drawLegend();
  fitView();
  wantPicture();
}

// Applies the page's colors, light or dark by the browser's setting.
function takeScheme() {
  const styles = getComputedStyle(document.documentElement);
  const color = (name) => new Color().setStyle(styles.getPropertyValue(name).trim(), SRGBColorSpace);
  renderer.setClearColor(color("--paper"));
  Object.assign(colors, { paper: color("--paper").convertLinearToSRGB(), accent: color("--accent") });
  ground = dark.matches ? luminance(color("--paper").toArray()) : null;
  show();
}

// Returns how strongly the farthest vessels fade. On a dark background they must fade less to stay visible.
function haze() { return ground === null ? 0.45 : 0.25; }

// ---- what is shown ------------------------------------------------------------------------------

const named = (list, name) => list.find((item) => item.name === name);

// Returns the colors that the page shows. On a dark background they are lighter than those of the map.
function visible(bytes) { return ground === null ? bytes : lifted(bytes, ground); }

// Returns the field's scale of the kind that was selected, else of the kind that shows the field best. The scale with
// which the page was made has its own range.
function makeScale() {
  const field = named(tree.fields, state.field);
  if (!field) return null;
  let map = named(tree.maps, state.map) || named(tree.maps, "viridis") || tree.maps[0];
  if (map.separate && !field.whole) map = tree.maps.find(({ separate }) => !separate);
  map = { ...map, bytes: visible(map.bytes) };
  const made = start && start.field === field.name && start.kind;
  const asked = [state.kind, made].find((kind) => Object.hasOwn(KINDS, kind) && hasKind(field, kind));
  const kind = map.separate && field.whole ? "linear" : asked || chooseKind(field, map);
  return new Scale(field, map, kind, made === kind ? [start.low, start.high] : rangeOf(field, kind));
}

function shownMoment() {
  return scale && scale.field.times.length > 1 ? Math.min(state.moment, scale.field.times.length - 1) : 0;
}

function show() {
  scale = makeScale();
  const moment = shownMoment(), shown = state.pinned >= 0 ? state.pinned : state.hovered;
  vessels.paint(scale, visible(vessels.plain), moment);
  for (const [name, color] of Object.entries(colors)) vessels.set(name, color);
  vessels.set("grown", state.grown);
  vessels.set("fade", state.haze ? haze() : 0);
  vessels.set("isSoft", state.soft);
  vessels.set("form", scale ? FORM : 1);
  vessels.set("rim", ground === null ? 0 : 0.12);
  vessels.set("edge", state.soft && ground === null ? EDGE : 0);
  vessels.set("shade", state.shade && shade.isDone ? SHADE : 0);
  document.body.classList.toggle("bare", !state.panels);
  find("project").setAttribute("aria-pressed", view.isOrthographic);
  for (const name of CHECKS) find(name).checked = state[name];
  if (state.shade && !shade.isDone) findShade();
  if (find("grown")) find("grown").value = state.grown;
  panel.showScale(scale, scale && scale.field);
  panel.showTime(scale && scale.field, moment);
  fitView(); // after the panels have changed
  showSegment(shown);
  wantAddress();
}

function showSegment(i) {
  vessels.set("picked", i < 0 ? -1 : tree.segments.indexOf(i));
  panel.showSegment(i, shownMoment(), i === state.pinned, pin);
  wantPicture();
}

let finding = false, calm = 0;

// Computes the ambient occlusion, a few directions per picture, so that the page stays responsive. Waits while the tree
// changes often.
function findShade() {
  if (finding) return;
  finding = true;
  requestAnimationFrame(function next() {
    for (let k = 0; k < 4 && performance.now() >= calm; k++) shade.step();
    if (!shade.isDone) return requestAnimationFrame(next);
    finding = false;
    show();
  });
}

function change(what) {
  Object.assign(state, what);
  show();
}

// Selects a field. `kind: null` selects the kind of scale by the field's values.
function setField(name) { change({ field: named(tree.fields, name) ? name : null, kind: null }); }

function pin(i) {
  Object.assign(state, { pinned: i, hovered: -1 });
  if (i >= 0) view.center(tree.middle(i));
  showSegment(i);
  wantAddress();
}

function nextField(step) {
  const names = [null, ...tree.fields.map(({ name }) => name)];
  setField(names[(names.indexOf(state.field) + step + names.length) % names.length]);
}

// ---- the address --------------------------------------------------------------------------------

const rounded = (v) => String(Number(v.toFixed(3)));
const fromOrigin = (point, sign) => point.map((v, c) => v + sign * tree.properties.origin[c]);

// Returns the view as options of `corcast render`. The address uses the same names.
function viewOptions() {
  const { turn, rise, target, height } = view.pose;
  return [["projection", view.isOrthographic ? "orthographic" : "perspective"],
    ["turn", `${rounded(turn)},${rounded(rise)}`], ["look-at", fromOrigin(target, 1).map(rounded).join(",")],
    ["height", rounded(height)]];
}

// Writes the state to the address, unless the user has just set another address, which is about to be read.
function writeAddress() {
  written = 0;
  if (location.hash !== known || reading > 0) return;
  const parts = [...own.addressParts(), ...viewOptions()];
  if (state.field) parts.push(["field", state.field], ["map", scale.map.name], ["scale", scale.kind]);
  else if (start) parts.push(["field", "none"]);
  if (shownMoment()) parts.push(["moment", shownMoment() + 1]);
  if (state.grown < 1) parts.push(["grown", state.grown]);
  for (const [name, usual] of Object.entries(SWITCHES))
    if (state[name] !== usual) parts.push([name, state[name] ? "on" : "off"]);
  if (state.pinned >= 0) parts.push(["segment", tree.id[state.pinned]]);
  const text = parts.map(([key, value]) => `${key}=${encodeURIComponent(value).replaceAll("%2C", ",").replaceAll("%3A", ":")}`).join("&");
  history.replaceState(null, "", "#" + text);
  known = location.hash;
}

// Writes the address soon. A movement that slows down changes the view for seconds, so the address does not wait until it
// ends. Browsers accept 200 changes of the address in 30 s; 160 ms make at most 188.
function wantAddress() {
  written = written || setTimeout(writeAddress, 160);
}

function numbers(text, count) {
  const list = (text || "").split(",").map(Number);
  return list.length === count && list.every(Number.isFinite) ? list : null;
}

function clamped(text, low, high, fallback) {
  const value = Number(text);
  return text !== null && Number.isFinite(value) ? Math.min(high, Math.max(low, value)) : fallback;
}

async function readAddress() {
  known = location.hash;
  const get = new URLSearchParams(location.hash.slice(1));
  reading++;
  const isLast = await own.readAddress(get);
  reading--;
  if (isLast) takeView(get);
}

// Sets the state of the view from the address.
function takeView(get) {
  const field = get.get("field") ?? (start && start.field);
  view.project(get.get("projection") === "orthographic");
  change({
    field: named(tree.fields, field) ? field : null,
    map: get.get("map") ?? (start && start.map),
    kind: get.get("scale"),
    moment: Math.round(clamped(get.get("moment"), 1, 1e6, 1)) - 1,
    grown: clamped(get.get("grown"), 0, 1, 1),
    ...Object.fromEntries(Object.entries(SWITCHES).map(([name, usual]) =>
      [name, get.has(name) ? get.get(name) !== "off" : usual])),
    pinned: tree.numberOf.get(Number(get.get("segment"))) ?? -1,
    hovered: -1,
  });
  readPose(get);
}

// Sets the view from the address. Without a view there, shows all of the tree, or the selected
// segment in the middle of its surroundings.
function readPose(get) {
  const target = numbers(get.get("look-at"), 3), height = Number(get.get("height"));
  view.frame(...(numbers(get.get("turn"), 2) || [0, 0]));
  if (target) view.change({ target: fromOrigin(target, -1) });
  else if (state.pinned >= 0) view.change({ target: tree.middle(state.pinned), height: view.pose.height / 2 });
  if (height > 0 && Number.isFinite(height)) view.change({ height });
}

// Returns the command that draws the same view as a figure, which does not depend on this computer's graphics card.
function renderCommand() {
  const { isOrthographic } = view, list = (point) => fromOrigin(point, 1).map(rounded).join(",");
  const words = isOrthographic ? viewOptions() : [["projection", "perspective"], ["location", list(view.eye)],
    ["look-at", list(view.pose.target)], ["angle", rounded(view.angleAcross)]];
  words.push(["size", `${canvas.clientWidth}x${canvas.clientHeight}`]);
  words.push(["look", tree.properties.look.name]);
  if (scale) words.push(["color-by", scale.field.name], ["colormap", scale.map.name]);
  if (scale) words.push(["range", scale.range.map((v) => Number(v.toPrecision(6))).join(",")]);
  if (shownMoment()) words.push(["moment", shownMoment() + 1]);
  const options = words.map(([key, value]) => `--${key} ${value}`).join(" ") + (scale && scale.log ? " --log" : "");
  return `${own.command(tree.properties.name)} ${options} -o figure.png`;
}

function showHelp() {
  find("figure").textContent = renderCommand();
  find("help").showModal();
}

// ---- hands and keys -----------------------------------------------------------------------------

function pickAt(x, y) {
  const { from, along, least, slack } = view.ray(x, y);
  return tree.pick(from, along, (slack * HIT) / 2, (least * HIT) / 2, state.grown);
}

function hover(event) {
  if (event.pointerType === "touch" || event.buttons || state.pinned >= 0) return;
  const i = pickAt(event.clientX, event.clientY);
  if (i === state.hovered) return;
  state.hovered = i;
  showSegment(i);
}

function leave() {
  if (state.hovered < 0) return;
  state.hovered = -1;
  showSegment(state.pinned);
}

let pressed = null;

function release(event) {
  if (!pressed || Math.hypot(event.clientX - pressed.x, event.clientY - pressed.y) > 5) return;
  pin(pickAt(event.clientX, event.clientY));
}

function drawRing(context, circle) {
  if (!circle) return;
  const styles = getComputedStyle(document.documentElement);
  context.beginPath();
  context.arc(circle.x, circle.y, circle.radius, 0, 2 * Math.PI);
  for (const [name, width] of [["--paper", 6], ["--accent", 2]]) {
    context.strokeStyle = styles.getPropertyValue(name);
    context.lineWidth = width;
    context.stroke();
  }
}

// Hands a file to the user.
export function download(blob, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

function save() {
  draw();
  const page = document.createElement("canvas"), ratio = canvas.width / canvas.clientWidth;
  page.width = canvas.width;
  page.height = canvas.height;
  const context = page.getContext("2d"), margin = 24;
  context.drawImage(canvas, 0, 0);
  context.scale(ratio, ratio);
  drawRing(context, ring());
  if (scale) {
    context.save();
    context.translate(margin, canvas.clientHeight - margin - LEGEND_HEIGHT - TITLE_HEIGHT);
    drawLegend(context, scale, 240, ink(), true);
    context.restore();
  }
  if (view.isOrthographic) {
    context.translate(canvas.clientWidth - margin, canvas.clientHeight - margin - 22);
    drawScaleBar(context, mmPerPixel(), 200, ink());
  }
  page.toBlob((png) => download(png, tree.properties.name.replace(/\.[^.]*$/, "") + ".png"));
}

// Copies a text, and says so on the button. Where a browser gives no clipboard, shows the text to be copied by hand.
export async function copy(text, button) {
  const label = button.textContent;
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    prompt(label, text);
    return;
  }
  button.textContent = "Copied";
  setTimeout(() => { button.textContent = label; }, 1200);
}

function play() {
  clearInterval(playing);
  playing = playing ? 0 : setInterval(() => {
    change({ moment: (shownMoment() + 1) % scale.field.times.length });
  }, 120);
  find("play").textContent = playing ? "Pause" : "Play";
}

function project() {
  view.project(!view.isOrthographic);
  show();
}

function kin(up) {
  if (state.pinned < 0) return pin(tree.segments[0]);
  const thickest = (a, b) => tree.radius[b] - tree.radius[a];
  const near = up ? [tree.parent[state.pinned]] : [...tree.daughters[state.pinned]].sort(thickest);
  const next = near.find((i) => tree.numberOf.has(tree.id[i]));
  if (next !== undefined) pin(next);
}

function turnBy(turn, rise) {
  const { pose } = view;
  view.change({ turn: pose.turn + turn, rise: pose.rise + rise });
}

function moveBy(right, up) {
  const { target, height } = view.pose, m = view.camera.matrixWorld.elements;
  view.change({ target: target.map((v, c) => v + height * (right * m[c] + up * m[4 + c])) });
}

function zoomBy(factor) { view.change({ height: view.pose.height / factor }); }

function fit() {
  const { turn, rise } = view.pose;
  view.frame(turn, rise);
}

const KEYS = {
  ArrowLeft: (shift) => (shift ? moveBy(0.05, 0) : turnBy(-5, 0)),
  ArrowRight: (shift) => (shift ? moveBy(-0.05, 0) : turnBy(5, 0)),
  ArrowUp: (shift) => (shift ? moveBy(0, -0.05) : turnBy(0, 5)),
  ArrowDown: (shift) => (shift ? moveBy(0, 0.05) : turnBy(0, -5)),
  "+": () => zoomBy(1.15), "=": () => zoomBy(1.15), "-": () => zoomBy(1 / 1.15), 0: fit,
  f: () => nextField(1), F: () => nextField(-1), o: project, s: save,
  d: () => kin(false), u: () => kin(true), h: () => change({ haze: !state.haze }), "?": showHelp,
  p: () => change({ panels: !state.panels }), Escape: () => pin(-1),
};

function key(event) {
  const { tagName } = event.target, action = KEYS[event.key];
  if (!action || event.ctrlKey || event.metaKey || event.altKey || find("help").open) return;
  if (/^(INPUT|SELECT)$/.test(tagName) && event.key !== "Escape") return;
  event.preventDefault();
  action(event.shiftKey);
}

function listen() {
  const on = (id, type, action) => find(id) && find(id).addEventListener(type, action);
  on("field", "change", (e) => setField(e.target.value));
  on("map", "change", (e) => change({ map: e.target.value }));
  on("kind", "change", (e) => change({ kind: e.target.value }));
  on("moment", "input", (e) => change({ moment: Number(e.target.value) }));
  on("grown", "input", (e) => change({ grown: Number(e.target.value) }));
  for (const name of CHECKS) on(name, "change", (e) => change({ [name]: e.target.checked }));
  on("play", "click", play);
  on("view", "change", (e) => { view.frame(...VIEWS[e.target.value]); e.target.value = ""; });
  on("project", "click", project);
  on("save", "click", save);
  on("render", "click", (e) => copy(renderCommand(), e.target));
  on("keys", "click", showHelp);
  on("release", "click", () => pin(-1));
  on("segment", "change", (e) => {
    const i = tree.numberOf.get(Number(e.target.value));
    e.target.setAttribute("aria-invalid", i === undefined);
    if (i !== undefined) pin(i);
  });
  canvas.addEventListener("pointermove", hover);
  canvas.addEventListener("pointerleave", leave);
  canvas.addEventListener("pointerdown", (e) => { pressed = e.isPrimary ? { x: e.clientX, y: e.clientY } : null; });
  canvas.addEventListener("pointerup", release);
  document.addEventListener("keydown", key);
  window.addEventListener("resize", resize);
  window.addEventListener("hashchange", readAddress);
  canvas.addEventListener("webglcontextrestored", wantPicture);
  dark.addEventListener("change", takeScheme);
}

// Replaces the tree of the page. The view stays; so does the selected segment, if the tree has one of its id. `origin`
// and `look` of all trees of a page are the same.
export function showTree(next) {
  const pinned = state.pinned >= 0 ? next.numberOf.get(tree.id[state.pinned]) ?? -1 : -1;
  if (vessels) retired.push(vessels, shade);
  tree = next;
  vessels = new Vessels(tree);
  shade = new Shade(renderer, vessels);
  vessels.set("open", shade.sum.texture);
  panel.setTree(tree);
  view.setTree(tree);
  Object.assign(state, { pinned, hovered: -1 });
  calm = performance.now() + SHADE_PAUSE;
  show();
}

// Shows the whole tree, from the direction of the view.
export function showAll() { fit(); }

// Shows the first tree, by the address, and listens to the user.
export function begin(first) {
  start = first.properties.start;
  SWITCHES.soft = !first.properties.look.isChosen; // soft light replaces the light of the default look alone
  Object.assign(state, SWITCHES);
  panel = new Panel();
  view = new View(canvas, first, () => { wantPicture(); wantAddress(); });
  find("view").append(...Object.keys(VIEWS).map((name) => new Option(name, name)));
  showTree(first);
  calm = 0;
  listen();
  resize();
  takeScheme();
  readAddress();
}
