// The page that grows trees. Its state is a set of options of `corcast grow`, which the address and the command line
// show, and the view of the viewer. A worker grows; while it works, only the last request waits.
import simd from "made/simd.wasm";
import plain from "made/plain.wasm";
import worker from "made/worker.txt";
import colors from "made/maps.json";
import cast from "../looks/cast.ini";
import { number } from "../viewer/colors.js";
import { Tree } from "../viewer/tree.js";
import { begin, copy, download, own, showAll, showTree } from "../viewer/viewer.js";

const find = (id) => document.getElementById(id);
const MOST_TERMINALS = 100000;
const MESH_SEGMENTS = 500; // a tree of this many segments or fewer is saved as STL with all triangles
const BUSY = 250; // ms after which a growth counts as long: the page shows its progress, and a new request ends it
const START = { terminals: "1000", domain: "ball:30", seed: "1" }; // the tree of an address without options
// The options with a control, and the values that corcast uses without them.
const USUAL = { terminals: "1000", domain: "disc:50", gamma: "3", lambda: "2", seed: "1", refine: "none" };
// Options that an address may have without a control. The page has none that names a file.
const OTHERS = ["inlet", "inlet-shares", "p-perf", "p-term", "q-perf", "viscosity", "viscosity-law", "hematocrit",
  "plasma-viscosity", "terminal-flow", "min-radius", "clearance", "pair", "candidates", "relax", "toss", "partial", "refine-moves"];
const SIZES = { disc: "50", ball: "30", rect: "80,60", box: "60,50,40", ellipsoid: "40,30,20", shell: "40,40,40,8" };

let options = [], known = [], stage = null; // pairs [name, value]; those of the tree shown; terminals shown, or null: all
let full = null; // the answer that has the whole tree

// ---- the program --------------------------------------------------------------------------------

const WITH_VECTORS = [0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11];

function decoded(base64) {
  const chars = atob(base64), bytes = new Uint8Array(chars.length);
  for (let i = 0; i < chars.length; i++) bytes[i] = chars.charCodeAt(i);
  return bytes;
}

// A worker with the program. One request runs, and one waits, which a later one of its kind replaces.
class Grower {
  constructor(module) {
    this.module = module;
    this.source = URL.createObjectURL(new Blob([worker], { type: "text/javascript" }));
    this.number = 0;
    this.restart();
  }

  restart() {
    if (this.worker) this.worker.terminate();
    this.worker = new Worker(this.source);
    this.worker.postMessage({ module: this.module });
    this.worker.onmessage = ({ data }) => this.hear(data);
    this.running = null;
  }

  hear({ number, step, fraction, answer, error }) {
    if (number === undefined) return showProgress(step, fraction, this.running.begin);
    const { resolve, reject } = this.running;
    this.running = null;
    if (error === undefined) resolve(answer);
    else reject(new Error(error));
    this.next();
  }

  next() {
    showBusy(false);
    if (this.running || !this.waiting) return;
    this.running = { ...this.waiting, begin: performance.now() };
    this.waiting = null;
    this.worker.postMessage({ ...this.running.request, number: ++this.number });
    const { number } = this;
    setTimeout(() => { if (this.running && this.number === number) showBusy(true); }, BUSY);
  }

  // Asks for a tree or a file. Returns a promise of the answer; it is rejected with the sentence of an error, and with
  // null if a later request has replaced it.
  ask(request) {
    return new Promise((resolve, reject) => {
      if (this.waiting) this.waiting.reject(null);
      this.waiting = { request, resolve, reject };
      if (this.running && performance.now() - this.running.begin > BUSY) this.stop();
      this.next();
    });
  }

  stop() {
    if (!this.running) return;
    this.running.reject(null);
    this.restart();
    this.next();
  }
}

let grower = null;

// ---- options ------------------------------------------------------------------------------------

const value = (name) => { const found = options.find(([key]) => key === name); return found ? found[1] : USUAL[name]; };
const lines = (list) => list.map(([name, text]) => `${name}=${text}\n`).join("");
const differing = (list) => list.filter(([name, text]) => USUAL[name] !== text);

function set(name, text) {
  options = [...options.filter(([key]) => key !== name), [name, text]];
  stage = null;
  grow();
}

// Returns the options of a stage of growth: the same tree with fewer terminals, not refined.
function staged() {
  const finished = new Set(["terminals", "refine", "refine-moves"]);
  return stage === null ? differing(options)
    : [...differing(options).filter(([name]) => !finished.has(name)), ["terminals", String(stage)]];
}

// Returns the point that the domain is moved to, which is the origin of the page's numbers.
function origin() {
  const [, text] = value("domain").split("@"), point = (text || "").split(",").map(Number);
  return [0, 1, 2].map((c) => (Number.isFinite(point[c]) ? point[c] : 0));
}

function check(list) {
  const terminals = list.find(([name]) => name === "terminals");
  if (terminals && Number(terminals[1]) > MOST_TERMINALS)
    throw new Error(`terminals is ${terminals[1]}; this page grows at most ${MOST_TERMINALS.toLocaleString("en")}. The program grows more.`);
}

// Grows the tree of the options, or its stage, and shows it. Returns a promise of "grown", "failed", after a sentence, or
// "replaced", if a later call came before the tree.
async function grow() {
  showControls();
  try {
    check(options);
    const answer = await grower.ask({ wants: "tree", options: lines(staged()), origin: origin() });
    const moved = !full || value("domain") !== known;
    known = value("domain");
    if (stage === null) full = answer;
    showTree(treeOf(answer));
    if (moved) showAll();
    showAnswer(answer);
    return "grown";
  } catch (error) {
    if (error) complain(error.message);
    return error ? "failed" : "replaced";
  }
}

// ---- what is shown ------------------------------------------------------------------------------

const maps = colors.map(({ name, separate, colors: hex }) => ({ name, separate,
  bytes: Uint8Array.from(hex.match(/../g), (digits) => parseInt(digits, 16)) }));

// Reads a look, an INI file [src/stage/look.c]. Returns what the viewer takes.
function readLook(text) {
  const sections = {};
  let section = {};
  for (const line of text.split("\n")) {
    const head = /^\[(.*)\]/.exec(line), row = /^(\w+) = (.*)$/.exec(line);
    if (head) section = sections[head[1]] = {};
    if (row) section[row[1]] = row[2].split(" ").map(Number);
  }
  const { vessel, finish } = sections, one = (name, usual) => (finish[name] ? finish[name][0] : usual);
  return {
    name: "cast", isChosen: false, color: vessel.color, ambient: one("ambient", 0.1), diffuse: one("diffuse", 0.6),
    brilliance: one("brilliance", 1), phong: one("phong", 0), phongSize: one("phong_size", 40),
    specular: one("specular", 0), roughness: one("roughness", 0.05),
    lights: Object.entries(sections).filter(([name]) => name.startsWith("light "))
      .map(([, { direction, color }]) => ({ point: false, direction, color })),
  };
}

const look = readLook(cast);

function treeOf({ command, ...answer }) {
  const properties = { name: "tree.swc", generator: find("version").content, command, origin: origin(), look, start: null };
  return new Tree({ ...answer, properties, maps });
}

const MEASURES = [
  ["terminals", "terminals", ""], ["total_length_mm", "total length", "mm"], ["volume_mm3", "volume", "mm³"],
  ["root_radius_mm", "root radius", "mm"], ["min_radius_mm", "thinnest radius", "mm"], ["max_strahler", "Strahler order", ""],
  ["target", "target", ""], ["terminal_pressure_mean_mmhg", "terminal pressure", "mmHg"],
];

const measure = (v) => (Number.isInteger(v) ? v.toLocaleString("en") : number(v));

function showMeasures(summary) {
  find("measures").replaceChildren(...MEASURES.filter(([key]) => key in summary).map(([key, title, unit]) => {
    const row = document.createElement("tr");
    for (const text of [title, measure(Number(summary[key])), unit]) row.insertCell().textContent = text;
    row.dataset.key = key;
    return row;
  }));
}

function showAnswer({ summary, messages, seconds }) {
  showMeasures(summary);
  const warnings = messages.filter((line) => line.startsWith("warning: ")).map((line) => sentence(line.slice(9)));
  const grew = `${Number(summary.terminals).toLocaleString("en")} terminals in ${number(seconds, 2)}\u00a0s.`;
  say([grew, ...warnings].join(" "), warnings.length > 0);
}

// Makes a sentence of an error, whose first word may be a word, or the name of an option or a file.
const sentence = (text) => text.replace(/^[a-z]+ /, (word) => word[0].toUpperCase() + word.slice(1)) + (/[.!]$/.test(text) ? "" : ".");

function say(text, isBad) {
  find("said").textContent = text;
  find("said").classList.toggle("bad", isBad);
}

function complain(text) { say(sentence(text), true); }

function showBusy(busy) {
  find("busy").hidden = !busy;
  if (!busy) find("progress").value = 0;
}

function showProgress(step, fraction, begin) {
  if (step) find("step").textContent = step;
  if (performance.now() - begin > BUSY) find("progress").value = fraction;
}

const shape = () => value("domain").split(":")[0];
const command = () => full && find("command").textContent;

// A slider of counts from 1 to `most` has equal ratios at equal distances.
const toSlider = (count, most) => (most > 1 ? Math.log(count) / Math.log(most) : 1);
const fromSlider = (place, most) => Math.round(Math.pow(most, place));

function showControls() {
  const put = (id, text) => { if (document.activeElement !== find(id)) find(id).value = text; };
  put("terminals", value("terminals"));
  put("many", toSlider(Number(value("terminals")) || 1, MOST_TERMINALS));
  put("shape", shape());
  put("size", value("domain").slice(shape().length + 1));
  put("gamma", value("gamma"));
  put("exponent", value("gamma"));
  put("lambda", value("lambda"));
  put("weight", value("lambda"));
  put("seed", value("seed"));
  put("refine", value("refine"));
  const all = Number(value("terminals")) || 1;
  put("grown-to", stage === null ? 1 : toSlider(stage, all));
  find("stage-of").hidden = stage === null;
  find("stage-of").textContent = `${(stage ?? all).toLocaleString("en")} of ${all.toLocaleString("en")} terminals`;
  const words = differing(options).map(([name, text]) => (text === "on" ? ` --${name}` : ` --${name} ${quoted(text)}`)).join("");
  find("command").textContent = `corcast grow${words} -o tree.swc`;
}

const quoted = (text) => (/^[\w.,:@+-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`);

// ---- the address --------------------------------------------------------------------------------

const VIEW = { turn: 2, "look-at": 3, height: 1, projection: ["perspective", "orthographic"], field: null, map: null, scale: null,
  moment: 1, grown: 1, soft: ["on", "off"], shade: ["on", "off"], haze: ["on", "off"], panels: ["on", "off"], segment: 1 };

// Returns a sentence on a part of the address about the view that cannot be used; null if it can.
function complaint(key, text) {
  const form = VIEW[key];
  if (Array.isArray(form) && !form.includes(text)) return `${key} is '${text}' in the address; it must be ${form.join(" or ")}`;
  const numbers = text.split(",");
  if (typeof form === "number" && (numbers.length !== form || !numbers.every((part) => part.trim() && Number.isFinite(Number(part)))))
    return `${key} is '${text}' in the address; it must be ${["", "a number", "two numbers", "three numbers"][form]}`;
  return null;
}

// Divides an address into options, a stage and complaints.
function readParts(get) {
  const found = { options: [], stage: null, complaints: [] };
  for (const [key, text] of get) {
    if (key in USUAL || OTHERS.includes(key)) {
      if (key !== "inlet") found.options = found.options.filter(([name]) => name !== key);
      found.options.push([key, text]);
    } else if (key === "stage") {
      found.stage = Number(text);
    } else if (key in VIEW) {
      found.complaints.push(complaint(key, text));
    } else {
      found.complaints.push(`this page knows no '${key}', which is in the address`);
    }
  }
  const all = Number((found.options.find(([name]) => name === "terminals") || ["", USUAL.terminals])[1]);
  if (found.stage !== null && !(Number.isInteger(found.stage) && found.stage >= 1 && found.stage <= all)) {
    found.complaints.push(`stage is '${get.get("stage")}' in the address; it must be an integer from 1 to ${all}`);
    found.stage = null;
  }
  found.complaints = found.complaints.filter((text) => text);
  return found;
}

let first = true;

// Grows the tree of an address. If that fails, keeps the tree before; the first time, shows the tree of START.
async function readAddress(get) {
  const found = readParts(get), before = first ? { options: Object.entries(START), stage: null } : { options, stage };
  const said = [];
  if (!found.options.length) found.options = Object.entries(START);
  if (first || lines(found.options) !== lines(options) || found.stage !== stage) {
    ({ options, stage } = found);
    let end = await grow();
    if (end === "failed") {
      said.push(find("said").textContent, first ? "The page shows its first tree instead." : "The tree stays as it was.");
      ({ options, stage } = before);
      end = await grow();
    }
    if (end === "replaced") return false;
  }
  first = false;
  said.push(...found.complaints.map(sentence));
  if (said.length) say(said.join(" "), true);
  return true;
}

function addressParts() {
  const parts = options.filter(([name, text]) => name in START || USUAL[name] !== text);
  return stage === null ? parts : [...parts, ["stage", stage]];
}

// ---- files --------------------------------------------------------------------------------------

const whole = () => lines(differing(options));

async function saveFile(wants, name, more = {}) {
  try {
    const { bytes } = await grower.ask({ wants, options: whole(), ...more });
    download(new Blob([bytes]), name);
  } catch (error) {
    if (error) complain(error.message);
  }
}

// The part of the triangles that a tree's STL file keeps, so that large trees give files that programs for printing open.
function detail() {
  const segments = 2 * Number(value("terminals"));
  return Number(Math.min(1, Math.max(0.05, MESH_SEGMENTS / segments)).toPrecision(2));
}

// ---- hands --------------------------------------------------------------------------------------

let playing = null;

// Shows the stages of growth, each as soon as the one before is drawn.
async function play() {
  if (playing) {
    playing = null;
    return;
  }
  const run = playing = {}, all = Number(value("terminals")), begin = performance.now();
  find("play").textContent = "Pause";
  for (let count = 1; count < all && playing === run; count = Math.max(count + 1, Math.round(count * 1.15))) {
    stage = count;
    if ((await grow()) !== "grown") break;
    await new Promise((resolve) => setTimeout(resolve, 60));
  }
  find("play").textContent = "Play";
  if (playing !== run) return;
  playing = null;
  stage = null;
  await grow();
}

function setStage(place) {
  const all = Number(value("terminals")), count = fromSlider(place, all);
  playing = null;
  stage = count >= all ? null : count;
  grow();
}

function listen() {
  const on = (id, type, action) => find(id).addEventListener(type, (event) => action(event.target.value, event));
  on("many", "input", (place) => set("terminals", String(rounded(fromSlider(place, MOST_TERMINALS)))));
  on("terminals", "change", (text) => set("terminals", text.trim()));
  on("shape", "change", (name) => set("domain", `${name}:${SIZES[name]}`));
  on("size", "change", (text) => set("domain", `${shape()}:${text.trim()}`));
  for (const [id, name] of [["gamma", "gamma"], ["lambda", "lambda"], ["seed", "seed"], ["refine", "refine"]])
    on(id, "change", (text) => set(name, text.trim()));
  on("exponent", "input", (text) => set("gamma", text));
  on("weight", "input", (text) => set("lambda", text));
  on("dice", "click", () => set("seed", String(1 + Math.floor(Math.random() * 9999))));
  on("grown-to", "input", setStage);
  on("play", "click", play);
  on("stop", "click", () => { playing = null; grower.stop(); say("Stopped.", false); });
  on("swc", "click", () => saveFile("swc", "tree.swc"));
  on("stl", "click", () => saveFile("stl", "tree.stl", { lod: detail() }));
  on("copy", "click", (text, event) => copy(find("command").textContent, event.target));
  on("link", "click", (text, event) => copy(location.href, event.target));
}

// Two significant digits, as a slider is not more precise.
const rounded = (count) => (count < 100 ? count : Number(count.toPrecision(2)));

// ---- the beginning ------------------------------------------------------------------------------

own.addressParts = addressParts;
own.readAddress = readAddress;
own.command = () => `${command()} && corcast render tree.swc`;
own.freeBox = function freeBox() {
  const canvas = find("stage").getBoundingClientRect(), side = find("side").getBoundingClientRect();
  const top = find("tools").getBoundingClientRect().bottom - canvas.top;
  const left = side.top < canvas.bottom && side.left <= canvas.left + side.width / 2 ? side.right : 0;
  return { left, top, width: canvas.width - left, height: canvas.height - top };
};

async function open() {
  if (typeof WebAssembly !== "object") throw new Error("the page needs WebAssembly");
  grower = new Grower(await WebAssembly.compile(decoded(WebAssembly.validate(Uint8Array.from(WITH_VECTORS)) ? simd : plain)));
  find("shape").append(...Object.keys(SIZES).map((name) => new Option(name, name)));
  listen();
  begin(treeOf(await grower.ask({ wants: "tree", options: "terminals=1\n", origin: [0, 0, 0] })));
}

open().catch(({ message }) => {
  find("failed").textContent = `This browser cannot grow trees: ${message}.`;
  find("failed").hidden = false;
});
