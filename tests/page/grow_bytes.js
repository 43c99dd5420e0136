// Grows trees with the program of the page that grows trees, with and without vectors, in its worker but without a browser.
//
//   node grow_bytes.js FOLDER EXPECTED.json
//
// FOLDER: what `make page` has made: worker.js, made/simd.wasm and made/plain.wasm. EXPECTED: as of grow.js, and
// `stl` {address, sha256}: a tree and its surface with --lod 0.5. Prints one line
// for each file that is not the program's; exit status 1 if there is any.
"use strict";
const crypto = require("crypto");
const fs = require("fs");
const path = require("path");
const vm = require("vm");

const [folder, expectedFile] = process.argv.slice(2);
const { trees, stl } = JSON.parse(fs.readFileSync(expectedFile, "utf8"));

for (const kind of ["simd", "plain"]) {
  const answers = [], self = {};
  const context = vm.createContext({ self, postMessage: (message) => answers.push(message), WebAssembly, TextDecoder, TextEncoder, performance });
  vm.runInContext(fs.readFileSync(path.join(folder, "worker.js"), "utf8"), context);
  self.onmessage({ data: { module: new WebAssembly.Module(fs.readFileSync(path.join(folder, "made", kind + ".wasm"))) } });
  for (const { address, sha256, wants = "swc" } of [...trees, { ...stl, wants: "stl" }]) {
    self.onmessage({ data: { number: 1, wants, options: address.replaceAll("&", "\n"), lod: 0.5 } });
    const { answer, error } = answers.filter(({ number }) => number).pop();
    if (answer && crypto.createHash("sha256").update(answer.bytes).digest("hex") === sha256) continue;
    console.log(`expected the program's ${wants} bytes of ${address} from ${kind}.wasm, got ${error || "others"}`);
    process.exitCode = 1;
  }
}
