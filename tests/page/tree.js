// Opens the page of a tree in headless Chromium and uses it as a reader would.
//
//   node tree.js CHROMIUM EXPECTED.json
//
// EXPECTED: {page, series, address, options, width, height, exact: P.ppm, ids: I.ppm, segments: {id: {field: value}}}: the
// page of a tree and one of a tree whose field p changes; a view as the address tells it and as options of render, and
// what corcast drew of it, colors on #fbfaf7 and the ids of segments; values of all segments. Prints one line for each
// expectation that fails; exit status 1 if any does.
"use strict";
const fs = require("fs");
const { runIn } = require("./browser.js");

const [chromium, expectedFile] = process.argv.slice(2);
const expected = JSON.parse(fs.readFileSync(expectedFile, "utf8"));
const PAPER = [0xfb, 0xfa, 0xf7];
const LIGHT_OF_NOBODY = "haze=off&soft=off&shade=off&panels=off"; // as corcast's pictures are
let browser;
const evaluate = (expression) => browser.evaluate(expression);
const check = (ok, what) => browser.check(ok, what);
// The address is written after 150 ms, and a picture drawn when the browser asks for the next one.
const settled = () => evaluate("new Promise((r) => setTimeout(() => requestAnimationFrame(() => requestAnimationFrame(r)), 200))");
const text = (id) => evaluate(`document.getElementById("${id}").textContent`);

function readPpm(file) {
  const bytes = fs.readFileSync(file), words = [];
  let at = 0;
  while (words.length < 4) {
    const match = /\s*(?:#[^\n]*\n\s*)*(\S+)\s/.exec(bytes.subarray(at, at + 200).toString("latin1"));
    words.push(match[1]);
    at += match.index + match[0].length;
  }
  return { width: Number(words[1]), height: Number(words[2]), data: bytes.subarray(at), step: 3 };
}

// What the page shows, as pixels.
async function picture() {
  const shot = await browser.send("Page.captureScreenshot", { format: "png" });
  const data = await evaluate(`(async () => {
    const bytes = Uint8Array.from(atob("${shot.data}"), (c) => c.charCodeAt(0));
    const bitmap = await createImageBitmap(new Blob([bytes]));
    const canvas = new OffscreenCanvas(bitmap.width, bitmap.height), context = canvas.getContext("2d");
    context.drawImage(bitmap, 0, 0);
    const pixels = context.getImageData(0, 0, bitmap.width, bitmap.height).data;
    let text = "";
    for (let i = 0; i < pixels.length; i += 32768) text += String.fromCharCode(...pixels.subarray(i, i + 32768));
    return btoa(text);
  })()`);
  return { width: expected.width, height: expected.height, data: Buffer.from(data, "base64"), step: 4 };
}

const at = (picture, x, y) => {
  const i = picture.step * (y * picture.width + x);
  return [picture.data[i], picture.data[i + 1], picture.data[i + 2]];
};
const levels = (a, b) => Math.max(...a.map((v, c) => Math.abs(v - b[c])));
const idAt = (ids, x, y) => at(ids, x, y).reduce((sum, v) => sum * 256 + v, 0);

function difference(a, b) {
  return a.data.reduce((sum, v, i) => sum + Math.abs(v - b.data[i]), 0) / a.data.length;
}

// The id that all pixels around one have, or 0.
function lonelyId(ids, x, y, reach) {
  const id = idAt(ids, x, y);
  for (let dy = -reach; dy <= reach; dy++)
    for (let dx = -reach; dx <= reach; dx++) if (idAt(ids, x + dx, y + dy) !== id) return 0;
  return id;
}

// No pixel of the page shows a vessel where corcast has none within a pixel, nor paper within what corcast fills; and
// inside vessels the colors are corcast's.
async function checkPicture() {
  await browser.open(expected.page, expected.address + "&" + LIGHT_OF_NOBODY);
  const shown = await picture(), exact = readPpm(expected.exact), ids = readPpm(expected.ids);
  let beyond = 0, lacking = 0, inside = 0, off = 0, vessels = 0;
  for (let y = 1; y < expected.height - 1; y++)
    for (let x = 1; x < expected.width - 1; x++) {
      const around = [];
      for (let dy = -1; dy <= 1; dy++) for (let dx = -1; dx <= 1; dx++) around.push(levels(at(exact, x + dx, y + dy), PAPER));
      const isVessel = levels(at(shown, x, y), PAPER) > 40;
      vessels += isVessel;
      beyond += isVessel && Math.max(...around) <= 8;
      lacking += !isVessel && Math.min(...around) > 60;
      if (lonelyId(ids, x, y, 1) === 0) continue;
      inside++;
      off += levels(at(shown, x, y), at(exact, x, y));
    }
  check(vessels > 20000 && inside > 3000, `expected a picture of vessels, got ${vessels} pixels, ${inside} inside`);
  check(beyond === 0, `expected no vessel a pixel beyond corcast's, got ${beyond} pixels`);
  check(lacking === 0, `expected all vessels of corcast's picture, lacking ${lacking} pixels`);
  check(off / inside < 4, `expected corcast's colors within 4 levels, got ${off / inside}`);
  await browser.key("?");
  const look = await evaluate("JSON.parse(document.getElementById('properties').textContent).look.name");
  check(await text("figure") === `corcast render tree.swc ${expected.options} --size ${expected.width}x${expected.height} --look ${look} -o figure.png`,
    "expected the command that draws the view, got " + await text("figure"));
  await evaluate("document.getElementById('help').close()");
  await checkPicking(ids);
}

async function values() {
  return Object.fromEntries(await evaluate("[...document.querySelectorAll('#values tr')].map((r) =>" +
    " [r.dataset.field, [r.cells[1].textContent, r.cells[2].textContent]])"));
}

function checkValues(id, shown) {
  for (const [name, value] of Object.entries(expected.segments[id])) {
    const got = shown[name] && Number(shown[name][0]);
    check(Math.abs(got - value) <= 6e-5 * Math.abs(value), `expected ${name} ${value} of segment ${id}, got ${shown[name]}`);
  }
}

// The pointer meets the segments that corcast's id plane has there; a click holds one.
async function checkPicking(ids) {
  const places = new Map();
  for (let y = 3; y < expected.height - 3; y += 2)
    for (let x = 3; x < expected.width - 3; x += 2) {
      const id = lonelyId(ids, x, y, 2);
      if (id > 0 && expected.segments[id] && !places.has(id)) places.set(id, [x, y]);
    }
  check(places.size >= 8, `expected segments to point at, got ${places.size}`);
  for (const [id, [x, y]] of [...places].slice(0, 12)) {
    await browser.mouse("mouseMoved", x, y);
    const shown = await evaluate("document.getElementById('segment').value");
    check(shown === String(id), `expected segment ${id} at ${x}, ${y}, got ${shown}`);
    checkValues(id, await values());
  }
  const [id, [x, y]] = [...places][0];
  for (const type of ["mousePressed", "mouseReleased"]) await browser.mouse(type, x, y);
  await browser.mouse("mouseMoved", 1, 1);
  await settled();
  check((await evaluate("location.hash")).includes("segment=" + id), "expected a click to hold the segment");
  await browser.key("Escape");
}

// Each field has a picture of its own, a legend and colors; the address brings it back.
async function checkFields() {
  const addresses = new Map(), hashes = new Set();
  await browser.open(expected.page, "haze=off&soft=off&shade=off");
  for (const field of ["", "flow", "pressure"]) {
    await evaluate("document.activeElement.blur()");
    await evaluate(`(() => { const s = document.getElementById("field"); s.value = "${field}"; s.dispatchEvent(new Event("change")); })()`);
    await settled();
    const shown = await picture();
    hashes.add(shown.data.toString("base64"));
    addresses.set(await evaluate("location.hash"), shown);
    check(await evaluate("document.getElementById('scale').hidden") === (field === ""), "expected a legend of " + field);
  }
  check(hashes.size === 3, "expected each field to look different");
  const label = await evaluate("document.getElementById('legend').getAttribute('aria-label')");
  check(/^pressure from 60(\.0\d*)? to \d+(\.\d+)? mmHg$/.test(label), "expected the range, got " + label);
  for (const [address, shown] of [...addresses].slice(0, 2)) {
    await evaluate(`location.hash = ${JSON.stringify(address)}`);
    await settled();
    const off = difference(await picture(), shown);
    check(off < 0.1, `expected the same picture of ${address}, off by ${off} levels in the mean`);
    check(await evaluate("location.hash") === address, `expected ${address} to stay, got ${await evaluate("location.hash")}`);
  }
}

// A skewed field has a scale that the page gives a reason for; another can be selected; nonsense in the address has no effect.
async function checkScales() {
  await browser.open(expected.page, "field=flow&scale=constructor&map=nowhere&segment=4711&soft=off&shade=off");
  const kind = () => evaluate("document.getElementById('kind').value");
  check(await kind() === "log", "expected flow on a logarithmic scale, got " + await kind());
  check(/^logarithmic, because 80.% of the values fill \d+.% of a linear scale\.$/.test(await text("reason")), "expected a reason, got " + await text("reason"));
  check(await evaluate("document.getElementById('readout').hidden"), "expected no segment 4711");
  await evaluate("(() => { const s = document.getElementById('kind'); s.value = 'percentiles'; s.dispatchEvent(new Event('change')); })()");
  await settled();
  check((await evaluate("location.hash")).includes("scale=percentiles"), "expected the scale in the address");
  await evaluate("(() => { const s = document.getElementById('field'); s.value = 'pressure'; s.dispatchEvent(new Event('change')); })()");
  check(await kind() === "linear" && await text("reason") === "", "expected pressure on a linear scale, got " + await kind());
}

async function checkKeys() {
  await browser.open(expected.page, "soft=off&shade=off&segment=40");
  check(await evaluate("(document.getElementById('stage').focus(), document.activeElement.id)") === "stage", "expected the picture to take the focus");
  checkValues(40, await values());
  await browser.key("ArrowRight");
  await browser.key("ArrowUp");
  await browser.key("o");
  await settled();
  const address = await evaluate("location.hash");
  check(address.includes("turn=5,5&") && address.includes("projection=orthographic"), "expected keys to turn, got " + address);
  check(!(await evaluate("document.getElementById('bar').hidden")), "expected a scale bar where lengths are true");
  const held = () => evaluate("document.getElementById('segment').value");
  await browser.key("u");
  check(await held() === "39", "expected u to go to the parent, got " + await held());
  await browser.key("d");
  check(await evaluate("document.getElementById('kin').textContent.startsWith('↑ 39')"), "expected d to go down, got " + await held());
  await evaluate("(() => { const s = document.getElementById('segment'); s.value = '77'; s.dispatchEvent(new Event('change')); })()");
  checkValues(77, await values());
}

// Turned by hand; where motion is unwelcome it ends with the hand.
async function checkHands() {
  await browser.send("Emulation.setEmulatedMedia", { features: [{ name: "prefers-reduced-motion", value: "reduce" }] });
  await browser.mouse("mousePressed", 500, 150);
  await browser.mouse("mouseMoved", 560, 150, { buttons: 1, button: "left" });
  await browser.mouse("mouseReleased", 560, 150);
  await settled();
  const turned = await evaluate("location.hash");
  check(!turned.includes("turn=5,5&"), "expected a drag to turn the tree, got " + turned);
  await settled();
  check(await evaluate("location.hash") === turned, "expected the tree to rest");
  await browser.send("Emulation.setEmulatedMedia", { features: [] });
}

// The picture with its legend, as PNG of all pixels.
async function checkSaving() {
  await evaluate("window.saved = new Promise((resolve) => { const made = URL.createObjectURL;" +
    " URL.createObjectURL = (blob) => { resolve(blob); return made.call(URL, blob); }; }); 0");
  await browser.key("s");
  const size = await evaluate("saved.then(async (blob) => { const b = await createImageBitmap(blob);" +
    " return [blob.type, b.width, b.height, document.getElementById('stage').width, document.getElementById('stage').height]; })");
  check(size[0] === "image/png" && size[1] === size[3] && size[2] === size[4], "expected a PNG of the canvas, got " + size);
}

async function checkTime() {
  await browser.open(expected.series, "field=p&soft=off&shade=off");
  const pictures = new Set(), clocks = [];
  for (const moment of [0, 1, 2]) {
    await evaluate(`(() => { const s = document.getElementById("moment"); s.value = ${moment}; s.dispatchEvent(new Event("input")); })()`);
    await settled();
    clocks.push(await text("clock"));
    pictures.add((await picture()).data.toString("base64"));
  }
  check(pictures.size === 3, "expected each moment to look different");
  check(clocks.join() === "time 0.1,time 0.25,time 0.7", "expected the times, got " + clocks);
  check((await evaluate("location.hash")).includes("moment=3"), "expected the moment in the address");
}

// Walls that little of the sky reaches are darker, and none is lighter.
async function checkShade() {
  const shown = [];
  await browser.open(expected.page, "soft=off&shade=off");
  for (const shade of ["off", "on"]) {
    await evaluate(`location.hash = "#haze=off&panels=off&soft=off&shade=${shade}"`);
    await settled();
    for (let patience = 40; shade === "on" && patience > 0 && difference(await picture(), shown[0]) === 0; patience--) await settled();
    shown.push(await picture());
  }
  const darker = shown[0].data.filter((v, i) => v > shown[1].data[i] + 12).length;
  const lighter = shown[0].data.filter((v, i) => v + 2 < shown[1].data[i]).length;
  check(darker > 300 && lighter === 0, `expected shade, got ${darker} values darker and ${lighter} lighter`);
}

// The segment of the address, and the one that the user goes to, are ringed in the middle of the window.
async function checkRing() {
  const middle = [expected.width / 2, expected.height / 2], options = "soft=off&shade=off&panels=off";
  for (const address of ["segment=77&", "segment=120&projection=orthographic&"]) {
    await browser.open(expected.page, address + options);
    await checkRingAt(middle);
    check(at(await picture(), ...middle)[2] > 150, "expected the blue of a selected segment in the middle of " + address);
  }
  await browser.key("u");
  await evaluate("new Promise((r) => setTimeout(r, 600))"); // the camera glides
  await settled();
  await checkRingAt(middle);
  check((await evaluate("location.hash")).includes("segment=119"), "expected the parent to be selected");
  await browser.key("Escape");
  await settled();
  check(await evaluate("document.getElementById('ring').hidden"), "expected no ring without a selected segment");
}

async function checkRingAt(middle) {
  const ring = await evaluate("(() => { const b = document.getElementById('ring').getBoundingClientRect();" +
    " return [b.left + b.width / 2, b.top + b.height / 2, b.width]; })()");
  check(levels(ring.slice(0, 2), middle) <= 1 && ring[2] >= 36, `expected a ring at ${middle}, got ${ring}`);
}

const luminance = (color) => color.map((v) => v / 255).map((v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4))
  .reduce((sum, v, c) => sum + v * [0.2126, 0.7152, 0.0722][c], 0);

// On the dark background, the pixels inside vessels have a contrast that can be seen, in the colors of each map.
async function checkContrast() {
  const ids = readPpm(expected.ids), inside = [];
  for (let y = 2; y < expected.height - 2; y++)
    for (let x = 2; x < expected.width - 2; x++) if (lonelyId(ids, x, y, 1) > 0) inside.push([x, y]);
  await browser.send("Emulation.setEmulatedMedia", { features: [{ name: "prefers-color-scheme", value: "dark" }] });
  await browser.open(expected.page, "field=wss&shade=off&panels=off&" + expected.address);
  // A computer with much to do shows the page late.
  for (let patience = 40; patience > 0 && luminance(at(await picture(), 2, 2)) > 0.5; patience--) await settled();
  const names = await evaluate("[...document.getElementById('map').options].filter((o) => !o.disabled).map((o) => o.value)");
  for (const name of names) {
    await evaluate(`location.hash = ${JSON.stringify("#field=wss&shade=off&panels=off&map=" + name + "&" + expected.address)}`);
    await settled();
    const shown = await picture(), paper = luminance(at(shown, 2, 2));
    const contrasts = inside.map(([x, y]) => (luminance(at(shown, x, y)) + 0.05) / (paper + 0.05)).sort((a, b) => a - b);
    const [lowest, low] = [contrasts[0], contrasts[Math.floor(contrasts.length / 20)]];
    check(lowest > 2 && low > 2.8, `expected contrast on dark with ${name}, got ${lowest}, and below ${low} on 5 %`);
  }
  check(names.length >= 8, "expected maps, got " + names);
  await browser.send("Emulation.setEmulatedMedia", { features: [] });
}

async function checkSchemes() {
  const colors = new Set();
  for (const value of ["light", "dark"]) {
    await Promise.all([ // the page draws itself again before it receives the change of the scheme
      browser.send("Emulation.setEmulatedMedia", { features: [{ name: "prefers-color-scheme", value }] }),
      evaluate("dispatchEvent(new Event('hashchange'))")]);
    await settled();
    colors.add(String(at(await picture(), 2, Math.round(expected.height / 2))));
  }
  check(colors.has(String(PAPER)) && colors.size === 2, "expected light and dark paper, got " + [...colors].join(" and "));
}

// On a screen of 1280 x 720 with the largest legend.
async function checkPanels() {
  await browser.send("Emulation.setDeviceMetricsOverride", { width: 1280, height: 720, deviceScaleFactor: 1, mobile: false });
  await browser.open(expected.page, "field=flow&segment=40&soft=off&shade=off");
  check((await cards(1280, 720)).join() === "side,tools,readout", "expected the controls and the values of a segment, got " + await cards(1280, 720));
}

async function checkPhone() {
  await browser.send("Emulation.setDeviceMetricsOverride", { width: 390, height: 844, deviceScaleFactor: 1, mobile: true });
  await browser.open(expected.page, "field=flow&segment=40&soft=off&shade=off");
  check(await evaluate("document.documentElement.scrollWidth") <= 390, "expected the page to fit a phone");
  check((await cards()).join() === "tools,readout", "expected the values of a segment in place of the controls, got " + await cards());
  await browser.key("Escape");
  check((await cards()).join() === "side,tools", "expected the controls back, got " + await cards());
  await browser.send("Emulation.setTouchEmulationEnabled", { enabled: true });
  await settled();
  check((await evaluate("location.hash")).includes("turn=0,0&"), "expected to look from the front");
  const touch = (type, points) => browser.send("Input.dispatchTouchEvent", { type, touchPoints: points });
  await touch("touchStart", [{ x: 150, y: 300 }]);
  for (const x of [180, 210]) await touch("touchMove", [{ x, y: 300 }]);
  await touch("touchEnd", []);
  for (let i = 0; i < 20 && (await evaluate("location.hash")).includes("turn=0,0&"); i++) await settled();
  check(!(await evaluate("location.hash")).includes("turn=0,0&"), "expected a finger to turn the tree");
}

// The panels that can be seen, each of which fits the window, and none of which covers another.
async function cards(width = 390, height = 844) {
  const boxes = await evaluate("[...document.querySelectorAll('.card')].filter((c) => c.checkVisibility({ visibilityProperty: true }))" +
    ".map((c) => { const b = c.getBoundingClientRect(); return [c.id, b.left, b.top, b.right, b.bottom]; })");
  for (const [id, left, top, right, bottom] of boxes)
    check(left >= 0 && right <= width && top >= 0 && bottom <= height, `expected ${id} to fit the window`);
  for (const a of boxes)
    for (const b of boxes) check(a === b || a[4] <= b[2] || b[4] <= a[2] || a[3] <= b[1] || b[3] <= a[1], `expected ${a[0]} not to cover ${b[0]}`);
  return boxes.map(([id]) => id);
}

// The reason is said where there is nothing to draw with.
async function checkWithoutGraphics() {
  await browser.send("Page.addScriptToEvaluateOnNewDocument", { source: "HTMLCanvasElement.prototype.getContext = () => null" });
  await browser.open(expected.series);
  check(await evaluate("document.getElementById('failed').checkVisibility()"), "expected it to be said that there is no WebGL");
}

runIn(chromium, ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"], async function (opened) {
  browser = opened;
  await browser.send("Emulation.setDeviceMetricsOverride",
    { width: expected.width, height: expected.height, deviceScaleFactor: 1, mobile: false });
  for (const part of [checkPicture, checkFields, checkScales, checkKeys, checkHands, checkSaving, checkTime, checkShade, checkRing, checkContrast, checkSchemes, checkPanels, checkPhone]) await part();
  browser.checkSilence();
  await checkWithoutGraphics();
});
