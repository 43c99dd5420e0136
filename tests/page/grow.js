// Opens the page that grows trees in headless Chromium or in Firefox, and uses it as a reader would.
//
//   node grow.js chromium|firefox-esr EXPECTED.json
//
// EXPECTED: {page, trees: [{address, command, sha256}]}: the page; addresses of trees, with the command
// line that makes each and the SHA-256 of the SWC file that the program writes. Prints one line for each expectation
// that fails; exit status 1 if any does.
"use strict";
const crypto = require("crypto");
const fs = require("fs");
const { runIn } = require("./browser.js");

const [program, expectedFile] = process.argv.slice(2);
const expected = JSON.parse(fs.readFileSync(expectedFile, "utf8"));
const CALM = "soft=off&shade=off";
let browser;
const evaluate = (expression) => browser.evaluate(expression);
const check = (ok, what) => browser.check(ok, what);
const text = (id) => evaluate(`document.getElementById("${id}").textContent`);
const visible = (id) => evaluate(`document.getElementById("${id}").checkVisibility()`);
const pause = (ms) => evaluate(`new Promise((r) => setTimeout(r, ${ms}))`);

// Waits until an expression is true; complains after ten seconds.
async function until(expression, what) {
  for (let patience = 200; patience > 0; patience--) {
    if (await evaluate(expression)) return;
    await pause(50);
  }
  check(false, `expected ${what}; the page says: ${await text("said")}`);
}

const grown = (n) => until(`document.querySelector("#measures [data-key=terminals] td:nth-child(2)")?.textContent === "${n}"` +
  ` && document.getElementById("busy").hidden`, `${n} terminals`);

// Follows an address within the page.
const go = (address) => evaluate(`location.hash = ${JSON.stringify("#" + address)}`);

// Presses a button that saves a file. Returns the file's name, type and bytes.
async function saved(button) {
  const file = await evaluate(`new Promise((resolve) => {
    const made = URL.createObjectURL, click = HTMLAnchorElement.prototype.click;
    let blob;
    URL.createObjectURL = (b) => made.call(URL, blob = b);
    HTMLAnchorElement.prototype.click = async function () {
      URL.createObjectURL = made;
      HTMLAnchorElement.prototype.click = click;
      const bytes = new Uint8Array(await blob.arrayBuffer());
      let chars = "";
      for (let i = 0; i < bytes.length; i += 4096) chars += String.fromCharCode(...bytes.subarray(i, i + 4096));
      resolve([this.download, blob.type, btoa(chars)]);
    };
    document.getElementById("${button}").click();
  })`);
  return { name: file[0], type: file[1], bytes: Buffer.from(file[2], "base64") };
}

const sha256 = (bytes) => crypto.createHash("sha256").update(bytes).digest("hex");

async function checkTree({ address, command, sha256: hash }) {
  await go(`${address}&${CALM}`);
  await until(`document.getElementById("command").textContent === ${JSON.stringify(command)}`, command);
  const file = await saved("swc");
  check(file.name === "tree.swc" && sha256(file.bytes) === hash, `expected the bytes of ${command}, got ${file.bytes.length} others`);
}

// Without vectors, the page runs its other module.
async function checkWithoutVectors() {
  const script = await browser.send("Page.addScriptToEvaluateOnNewDocument", { source: "WebAssembly.validate = () => false" });
  await browser.open("about:blank");
  await browser.open(expected.page, `terminals=9&${CALM}`);
  await checkTree(expected.trees[0]);
  await browser.send("Page.removeScriptToEvaluateOnNewDocument", script);
}

// An edited address is told in a sentence, and the page goes on.
async function checkAddresses() {
  const tell = (address, sentence) => until(`${sentence}.test(document.getElementById("said").textContent)`,
    `a sentence like ${sentence} of ${address}`);
  await tell("gamma=11", /--gamma: '11'.*shows its first tree/);
  await grown("1,000");
  for (const [address, sentence] of [
    ["terminals=90&from=a.swc&turn=a,b", /knows no 'from'.*Turn is 'a,b' in the address; it must be two numbers/],
    ["terminals=90&stage=91", /Stage is '91' in the address; it must be an integer from 1 to 90/],
    ["terminals=90&segment=x&soft=maybe", /Segment is 'x'.*Soft is 'maybe' in the address; it must be on or off/],
  ]) {
    await go(`${address}&${CALM}`);
    await tell(address, sentence);
    await grown("90");
  }
  for (const [address, sentence] of [
    ["terminals=1e9", /Terminals is 1e9; this page grows at most 100,000/],
    ["terminals=80&domain=mask:brain.nii", /brain\.nii: cannot be read: a page in a browser reads no files/],
    ["terminals=80&seed=%E0%A4%A", /--seed: '.*' is not/],
    ["terminals=80&domain=cube:20", /cube.*stays as it was/],
  ]) {
    await go(`${address}&${CALM}`);
    await tell(address, sentence);
    await until("location.hash.includes('terminals=90')", `the tree before ${address}`);
  }
}

async function checkStages() {
  await go(`terminals=12&domain=ball:30&seed=3&stage=4&field=flow&${CALM}`);
  await grown("4");
  check(await text("stage-of") === "4 of 12 terminals", "expected the stage, got " + await text("stage-of"));
  check(await evaluate("document.getElementById('field').value") === "flow", "expected the field of the address");
  check((await text("command")).includes("--terminals 12 "), "expected the command of the whole tree");
  await evaluate("(() => { const s = document.getElementById('grown-to'); s.value = 1; s.dispatchEvent(new Event('input')); })()");
  await grown("12");
  await until("!location.hash.includes('stage=') && location.hash.includes('field=flow')", "an address of the whole tree");
  await evaluate("document.getElementById('play').click()");
  await until("document.getElementById('play').textContent === 'Pause'", "the stages to play");
  await until("document.getElementById('play').textContent === 'Play'", "the stages to end");
  await grown("12");
}

async function checkFiles() {
  const png = await saved("save"), stl = await saved("stl");
  check(png.name === "tree.png" && png.type === "image/png", `expected a PNG, got ${png.name}, ${png.type}`);
  const triangles = stl.bytes.readUInt32LE(80);
  check(stl.name === "tree.stl" && triangles > 5000 && stl.bytes.length === 84 + 50 * triangles,
    `expected a binary STL file, got ${stl.bytes.length} bytes of ${triangles} triangles`);
}

// On a phone the picture comes first, and the controls below it. A finger turns the tree, two enlarge it.
async function checkPhone() {
  await browser.send("Emulation.setTouchEmulationEnabled", { enabled: true });
  await browser.send("Emulation.setDeviceMetricsOverride", { width: 390, height: 844, deviceScaleFactor: 0.5, mobile: true });
  const [wide, picture, controls, canvas] = await evaluate("[document.documentElement.scrollWidth," +
    " document.getElementById('stage').getBoundingClientRect().bottom, document.getElementById('side').getBoundingClientRect().top," +
    " document.getElementById('stage').clientWidth]");
  check(wide <= 390 && canvas === 390, `expected the page to fit a phone, got ${wide} and ${canvas} pixels`);
  check(picture <= controls && picture > 400, `expected the picture above the controls, got ${picture} and ${controls}`);
  const touch = (type, ...points) => browser.send("Input.dispatchTouchEvent",
    { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
  const drag = async (...ways) => {
    await touch("touchStart", ...ways.map((way) => way(0)));
    for (const part of [0.25, 0.5, 0.75, 1]) await touch("touchMove", ...ways.map((way) => way(part)));
    await touch("touchEnd");
  };
  const address = (name) => `new URLSearchParams(location.hash.slice(1)).get("${name}")`;
  const [turn, height] = await evaluate(`[${address("turn")}, ${address("height")}]`);
  await drag((part) => [150 + 80 * part, 200]);
  await until(`${address("turn")} !== "${turn}"`, "a finger to turn the tree");
  await drag((part) => [150 - 60 * part, 200], (part) => [240 + 60 * part, 200]);
  await until(`${address("height")} < ${0.7 * height}`, "two fingers to enlarge the tree");
  await browser.send("Emulation.setTouchEmulationEnabled", { enabled: false });
}

async function checkWithoutWebAssembly() {
  await browser.send("Page.addScriptToEvaluateOnNewDocument", { source: "delete globalThis.WebAssembly" });
  await browser.open("about:blank");
  await browser.open(expected.page, CALM);
  check(await visible("failed") && /WebAssembly/.test(await text("failed")), "expected a sentence about WebAssembly");
}

async function useFirefox(opened) {
  browser = opened;
  await browser.send("WebDriver:SetWindowRect", { width: 760, height: 400 });
  await browser.open(expected.page, `terminals=90&gamma=11&${CALM}`);
  for (const part of [checkAddresses, () => checkTree(expected.trees[0]), checkStages, checkFiles]) await part();
}

async function useChromium(opened) {
  browser = opened;
  await browser.send("Emulation.setDeviceMetricsOverride", { width: 760, height: 240, deviceScaleFactor: 0.5, mobile: false });
  await browser.open(expected.page, `terminals=90&gamma=11&${CALM}`);
  for (const part of [checkAddresses, () => checkTree(expected.trees[0]), checkStages, checkFiles, checkPhone, checkWithoutVectors]) await part();
  browser.checkSilence();
  await checkWithoutWebAssembly();
}

if (/firefox/.test(program)) runIn(program, null, useFirefox);
else runIn(program, ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"], useChromium);
