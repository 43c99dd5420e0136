// Opens a report page in headless Chromium, over its debugging pipe, and uses it as a reader would.
//
//   node page.js CHROMIUM PAGE.html EXPECTED.json
//
// EXPECTED: {cases, worst: {id, differing, x, y, a: [r, g, b], b: [r, g, b], segment, depth, classes}}. Prints one line
// for each expectation that fails; exit status 1 if any does.
"use strict";
const fs = require("fs");
const { runIn } = require("./browser.js");

const [chromium, page, expectedFile] = process.argv.slice(2);
const expected = JSON.parse(fs.readFileSync(expectedFile, "utf8"));
let browser;
const evaluate = (expression) => browser.evaluate(expression);
const check = (ok, what) => browser.check(ok, what);
const key = (name) => browser.key(name);
const mouse = (type, x, y) => browser.mouse(type, x, y);
const send = (method, params) => browser.send(method, params);

const hash = "(function () { var c = document.getElementById('stage'), d = c.getContext('2d')" +
  ".getImageData(0, 0, c.width, c.height).data, h = 0; for (var i = 0; i < d.length; i += 5) h = (h * 31 + d[i]) | 0;" +
  " return h; })()";
const readout = "Array.from(document.querySelectorAll('#readout div')).map(function (d) { return d.textContent; })";
const settled = "new Promise(function (r) { setTimeout(r, 160); })"; // the address is written after 100 ms
const rows = "Array.from(document.querySelectorAll('.cases tbody tr')).map(function (r) { return r.dataset.case; })";

async function checkOpening() {
  check((await evaluate(rows)).length === expected.cases, "expected " + expected.cases + " rows");
  check((await evaluate(rows))[0] === expected.worst.id, "expected the worst case first, got " + await evaluate(rows));
  check(await evaluate("document.querySelectorAll('.case:not([hidden])').length") === 1, "expected one case to be shown");
  check(await evaluate("!!document.querySelector('.case:not([hidden]) #stage')"), "expected the viewer in it");
  check(await evaluate("Array.from(document.images).every(function (i) { return i.complete; })"), "expected all pictures");
  check(await evaluate("document.getElementById('stage').getBoundingClientRect().top < window.innerHeight / 2"),
    "expected the pictures in the upper half of the window");
  check(await evaluate("location.hash") === "", "expected the address to stay as it is until something is changed");
  check(await evaluate("new Set(Array.from(document.querySelectorAll('.cases tbody th')).map(function (c) {" +
    " return c.textContent; })).size") === expected.cases, "expected cases to be told apart");
  check(await evaluate("Array.from(document.querySelectorAll('.case:not([hidden]) .measured')).every(function (d) {" +
    " return d.open === d.querySelector('.verdict').textContent.includes('differ'); })"), "expected what differs to be open, alone");
}

// The worst pixel is the first of the next ones, and the sentence leads to it.
async function checkWorst() {
  const w = expected.worst, place = w.x + ", " + w.y;
  check((await evaluate(readout))[0].startsWith("Worst pixel (column, row)" + place), "expected the worst pixel's values at first");
  await key("n");
  check((await evaluate(readout))[0].startsWith("Pixel (column, row)" + place), "expected n to begin with the worst, got " + await evaluate(readout));
  await key("0");
  await evaluate("document.querySelector('.case:not([hidden]) header a').click()");
  await evaluate(settled);
  check((await evaluate(readout))[0].startsWith("Pixel (column, row)" + place), "expected the sentence to lead to the worst pixel");
  check(await evaluate("document.activeElement.id") === "stage", "expected a link to bring the keys to the pictures");
  check(await evaluate("getComputedStyle(document.getElementById('stage')).outlineStyle") === "solid", "expected the focus to be seen");
  await key("0");
}

// Sorted and filtered cases are in the address, too.
async function checkFilter() {
  const shown = "Array.from(document.querySelectorAll('.cases tbody tr:not([hidden])')).map(function (r) { return r.dataset.case; })";
  await key("/");
  check(await evaluate("document.activeElement.id") === "filter", "expected / to lead to the filter");
  for (const letter of "differ") await key(letter);
  check((await evaluate(shown)).join() === expected.worst.id, "expected the cases that differ, got " + await evaluate(shown));
  await evaluate("document.querySelectorAll('.cases th[data-sort] button')[4].click()");
  await evaluate(settled);
  const address = await evaluate("location.hash");
  check(address.includes("filter=differ") && address.includes("sort=5d"), "expected sort and filter in the address, got " + address);
  await browser.open("about:blank");
  await browser.open(page, address.slice(1));
  check((await evaluate(shown)).join() === expected.worst.id, "expected the address to filter, got " + await evaluate(shown));
  check(await evaluate("document.querySelectorAll('.cases th')[5].getAttribute('aria-sort')") === "descending", "expected the address to sort");
  await evaluate("(function () { var f = document.getElementById('filter'); f.value = ''; f.dispatchEvent(new Event('input')); })()");
}

async function checkSorting() {
  const head = "document.querySelectorAll('.cases th[data-sort]')[3]";
  const values = "Array.from(document.querySelectorAll('.cases tbody tr')).map(function (r) {" +
    " return Number(r.cells[4].dataset.value); })";
  await evaluate(head + ".querySelector('button').click()");
  const down = await evaluate(values);
  check(await evaluate(head + ".getAttribute('aria-sort')") === "descending", "expected the column to be sorted");
  check(down.every(function (v, i) { return i === 0 || v <= down[i - 1]; }), "expected falling numbers, got " + down);
  await evaluate(head + ".querySelector('button').click()");
  const up = await evaluate(values);
  check(up.every(function (v, i) { return i === 0 || v >= up[i - 1]; }), "expected rising numbers, got " + up);
  await evaluate(head + ".querySelector('button').click()");
}

async function checkHistogram() {
  const bars = await evaluate("Array.from(document.querySelectorAll('.case:not([hidden]) .histogram text'))" +
    ".filter(function (t, i) { return i % 2 === 0; }).map(function (t) { return Number(t.textContent); })");
  const sum = bars.reduce(function (a, b) { return a + b; }, 0);
  check(sum === expected.worst.differing, "expected " + expected.worst.differing + " pixels in the histogram, got " + sum);
}

async function checkZoomAndValues() {
  const w = expected.worst;
  await evaluate("location.hash = '#case=" + w.id + "&mode=beside&zoom=48&x=" + w.x + "&y=" + w.y + "'");
  await evaluate(settled);
  await evaluate("document.getElementById('stage').scrollIntoView({ block: 'center' })");
  const box = await evaluate("(function () { var b = document.getElementById('stage').getBoundingClientRect();" +
    " return [b.left, b.top, b.width, b.height]; })()");
  // The pixel is in the middle of each pane; the panes of A and B read the same.
  for (const middle of [1 / 4, 3 / 4]) {
    await mouse("mouseMoved", box[0] + box[2] * middle, box[1] + box[3] / 2);
    const cells = await evaluate(readout);
    check(cells[0].includes(")" + w.x + ", " + w.y), "expected pixel " + w.x + ", " + w.y + ", got " + cells[0]);
    check(cells[1].includes(w.a.join(" ") + ", segment " + w.segment), "expected A to be " + w.a + ", got " + cells[1]);
    check(cells[2].includes(w.b.join(" ")), "expected B to be " + w.b + ", got " + cells[2]);
    const d = w.b.map(function (v, i) { return v - w.a[i]; }).join(" ");
    check(cells[3].includes("B − A" + d), "expected the difference " + d + ", got " + cells[3]);
    const depths = [1, 2].map(function (i) { return Number(/depth ([-0-9.]+) mm/.exec(cells[i])[1]); });
    depths.forEach(function (depth, i) {
      check(Math.abs(depth - w.depth) < 0.004, "expected a depth of " + w.depth + " mm, got " + depth + " of side " + i);
    });
    check(/normals 0\.0\d\d°/.test(cells[3]), "expected the angle between the normals, got " + cells[3]);
    const linear = /linear ([0-9.]+)/.exec(cells[1])[1];
    const v = w.a[0] / 255, expectedLinear = v < 0.04045 ? v / 12.92 : Math.pow((v + 0.055) / 1.055, 2.4);
    check(Math.abs(linear - expectedLinear) < 1e-4, "expected linear " + expectedLinear + ", got " + linear);
    check(/^Pixel[^a-z]*\(column, row\)[0-9, ]+(shading|edge|shadow)$/.test(cells[0]), "expected the pixel's class, got " + cells[0]);
  }
}

// Enlarged, the difference says by how much, in the pixels themselves.
async function checkWrittenDifferences() {
  const w = expected.worst;
  await evaluate("(function () { var write = CanvasRenderingContext2D.prototype.fillText; window.written = [];" +
    " CanvasRenderingContext2D.prototype.fillText = function (text) { written.push(text); write.apply(this, arguments); }; })()");
  for (const map of ["steps", "x8"]) {
    await evaluate("written = []; location.hash = '#case=" + w.id + "&mode=difference&map=" + map + "&zoom=96&x=" + w.x + "&y=" + w.y + "'");
    await evaluate(settled);
    const written = (await evaluate("written")).join(" "), d = w.b.map(function (v, i) { return v - w.a[i]; }).join(" ");
    check((" " + written + " ").includes(" " + d + " "), "expected " + d + " in a pixel, got " + written);
  }
}

// What is shown can be read off the address, and is shown again by it.
async function checkAddress() {
  await mouse("mouseMoved", 1, 1);
  await evaluate("location.hash = '#case=" + expected.worst.id + "'");
  await evaluate(settled);
  await key("2");
  await key("+");
  await key("+");
  await key("ArrowRight");
  await key("p");
  await evaluate(settled);
  const address = await evaluate("location.hash");
  for (const part of ["case=" + expected.worst.id, "mode=swipe", "plane=depth", "zoom=", "x=", "y="])
    check(address.includes(part), "expected " + part + " in the address, got " + address);
  const shown = await evaluate(hash);
  await key("1");
  await key("0");
  await evaluate(settled);
  check(await evaluate("location.hash") !== address, "expected the address to follow the keys");
  await evaluate("window.scrollTo(0, 0)");
  await evaluate("location.hash = '" + address + "'");
  await evaluate(settled);
  check(await evaluate(hash) === shown, "expected the address to show the same again");
  check(await evaluate("location.hash") === address, "expected the address to stay, got " + await evaluate("location.hash"));
  check(await evaluate("(function () { var b = document.getElementById('stage').getBoundingClientRect();" +
    " return b.top >= 0 && b.bottom <= window.innerHeight; })()"), "expected a link to lead to the pictures");
  await key("1");
}

// Every plane and map has a picture of its own; the classes are counted as the comparison counts them.
async function checkPlanes() {
  await evaluate("location.hash = '#case=" + expected.worst.id + "&mode=beside'");
  await evaluate(settled);
  const seen = [];
  for (const plane of ["color", "depth", "normal", "id"]) {
    await evaluate("location.hash = '#case=" + expected.worst.id + "&mode=beside&plane=" + plane + "'");
    await evaluate(settled);
    seen.push(await evaluate(hash));
  }
  for (const map of ["steps", "x1", "x8", "x64", "classes"]) {
    await evaluate("location.hash = '#case=" + expected.worst.id + "&mode=difference&map=" + map + "'");
    await evaluate(settled);
    seen.push(await evaluate(hash));
  }
  check(new Set(seen).size === seen.length, "expected every plane and map to look different");
  const legend = await evaluate("document.getElementById('legend').textContent");
  for (const [name, count] of Object.entries(expected.worst.classes))
    if (count) check(legend.includes(name.replace("_", " ") + " " + count), "expected " + name + " " + count + ", got " + legend);
  await key("1");
}

const touch = (type, ...points) => send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
const number = async (name) => Number(new URLSearchParams((await evaluate("location.hash")).slice(1)).get(name));

// A finger scrolls the page until the pictures are enlarged, and reads a pixel; two enlarge them.
async function checkTouch() {
  await evaluate("location.hash = '#case=" + expected.worst.id + "&mode=swipe'");
  await evaluate(settled);
  const action = "document.getElementById('stage').style.touchAction";
  check(await evaluate(action) === "pan-y", "expected a finger to scroll the page, got " + await evaluate(action));
  const [left, top, w, h] = await evaluate("(function () { var b = document.getElementById('stage').getBoundingClientRect();" +
    " return [b.left, b.top, b.width, b.height]; })()");
  const at = (x, y) => [left + x * w, top + y * h];
  await touch("touchStart", at(0.25, 0.5));
  await touch("touchEnd");
  await evaluate(settled);
  check(/pixel=(29|30),4[45]/.test(await evaluate("location.hash")), "expected a tap to hold its pixel, got " + await evaluate("location.hash"));
  await touch("touchStart", at(0.4, 0.2));
  await touch("touchStart", at(0.4, 0.2), at(0.6, 0.2));
  for (const far of [0.15, 0.2, 0.25, 0.3]) await touch("touchMove", at(0.5 - far, 0.2), at(0.5 + far, 0.2));
  await touch("touchEnd");
  await evaluate(settled);
  const zoom = await number("zoom") / (w / 120);
  check(Math.abs(zoom - 3) < 0.06, "expected fingers three times as far apart to enlarge threefold, got " + zoom);
  check(await evaluate(action) === "none", "expected a finger to move the enlarged pictures");
  const x = await number("x");
  await touch("touchStart", at(0.2, 0.5));
  await touch("touchMove", at(0.3, 0.5));
  await touch("touchEnd");
  await evaluate(settled);
  check(Math.abs(await number("x") - x + 0.1 * 120 / 3) < 0.3, "expected a finger to move by 4 pixels, got " + (await number("x") - x));
}

async function checkPhone() {
  await send("Emulation.setDeviceMetricsOverride", { width: 390, height: 844, deviceScaleFactor: 2, mobile: true });
  await send("Emulation.setTouchEmulationEnabled", { enabled: true });
  await browser.open("about:blank");
  await browser.open(page);
  check(await evaluate("document.documentElement.scrollWidth <= 390"), "expected the page to fit a phone");
  check(await evaluate("(function () { var b = document.getElementById('stage').getBoundingClientRect();" +
    " return b.width > 350 && b.bottom < window.innerHeight; })()"), "expected the pictures on the first screen of a phone");
  check(await evaluate("Array.from(document.querySelectorAll('.case:not([hidden]) .rules td:last-child')).every(function (d) {" +
    " var b = d.getBoundingClientRect(); return b.width === 0 || b.right <= 390; })"), "expected the limits to be seen on a phone");
  const blink = "document.querySelector('[data-mode=blink]').click()";
  await evaluate(blink);
  const first = await evaluate(hash);
  await evaluate(blink);
  check(await evaluate(hash) !== first, "expected the button to blink without keys");
  await checkTouch();
  await send("Emulation.setTouchEmulationEnabled", { enabled: false });
  await send("Emulation.clearDeviceMetricsOverride");
  await evaluate(settled);
}

async function checkSwipeAndBlink() {
  await evaluate("location.hash = '#case=" + expected.worst.id + "&mode=swipe&split=0.9'");
  await evaluate(settled);
  const right = await evaluate(hash);
  await evaluate("(function () { var s = document.getElementById('split'); s.value = 100; s.dispatchEvent(new Event('input')); })()");
  check(await evaluate(hash) !== right, "expected the swipe edge to move");
  await key("3");
  const first = await evaluate(hash);
  await key(" ");
  const second = await evaluate(hash);
  await key(" ");
  check(second !== first, "expected blinking to show the other picture");
  check(await evaluate(hash) === first, "expected blinking twice to come back");
  await key("4");
  check(await evaluate("document.querySelector('[data-mode=difference]').getAttribute('aria-pressed')") === "true",
    "expected key 4 to show the difference");
  await key("n");
  const cells = await evaluate(readout);
  check(/A-?\d+ -?\d+ -?\d+/.test(cells[3]) && !cells[3].includes("A0 0 0"), "expected n to go to a pixel that differs, got " + cells);
}

async function checkKeysAndCrops() {
  const before = await evaluate("document.querySelector('tr[aria-current]').dataset.case");
  await key("j");
  check(await evaluate("document.querySelector('tr[aria-current]').dataset.case") !== before, "expected j to go on");
  await key("k");
  check(await evaluate("document.querySelector('tr[aria-current]').dataset.case") === before, "expected k to go back");
  check(await evaluate("document.querySelectorAll('.case:not([hidden]) .crops figure').length") > 0, "expected crops");
  check(await evaluate("document.querySelector('.case:not([hidden]) .crops button').textContent") === "AB",
    "expected crops to say which is A and which is B");
  const shown = await evaluate(hash);
  await evaluate("document.querySelector('.case:not([hidden]) .crops button').click()");
  check(await evaluate(hash) !== shown, "expected a crop to show its place");
}

async function checkColors() {
  const colors = [];
  for (const value of ["light", "dark"]) {
    await send("Emulation.setEmulatedMedia", { features: [{ name: "prefers-color-scheme", value }] });
    colors.push(await evaluate("getComputedStyle(document.body).backgroundColor"));
  }
  check(colors[0] !== colors[1], "expected a dark page, too, got " + colors);
}

runIn(chromium, ["--disable-gpu", "--window-size=1200,900"], async function (opened) {
  browser = opened;
  await browser.open(page);
  await checkOpening();
  await checkWorst();
  await checkFilter();
  await checkSorting();
  await checkHistogram();
  await checkZoomAndValues();
  await checkWrittenDifferences();
  await checkSwipeAndBlink();
  await checkKeysAndCrops();
  await checkAddress();
  await checkPlanes();
  await checkPhone();
  await checkColors();
  browser.checkSilence();
});
