// Keeps a picture of a page, once it has settled.
//
//   node shoot.js CHROMIUM PAGE.html P.png WxH ADDRESS
"use strict";
const fs = require("fs");
const { runIn } = require("./browser.js");

const [chromium, page, output, size, address] = process.argv.slice(2);
const [width, height] = size.split("x").map(Number);

runIn(chromium, ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"], async function (browser) {
  await browser.send("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: 1, mobile: false });
  await browser.open(page, address);
  await browser.evaluate("new Promise((r) => setTimeout(r, 15000))"); // shade, found by software
  fs.writeFileSync(output, Buffer.from((await browser.send("Page.captureScreenshot", { format: "png" })).data, "base64"));
});
