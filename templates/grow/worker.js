// Runs the program, compiled to WebAssembly [src/web/web.h], beside the page: one message per tree or file. Each tree is
// grown by an instance of its own, so that its memory is freed and a program that stopped leaves nothing behind.

const BAD_FILE = 8; // WASI's errno for a file that is not open: a page has no files
let module = null, program = null, grown = null;

// The functions of WASI that the C library calls. There are no files, clocks count from the start of the page, and what
// the program writes to its error stream is the message of a broken invariant.
function wasi(memory, lines) {
  const view = () => new DataView(memory().buffer);
  return {
    clock_time_get(clock, precision, at) {
      view().setBigUint64(at, BigInt(Math.round(performance.now() * 1e6)), true);
      return 0;
    },
    fd_write(file, pieces, n, at) {
      let written = 0;
      for (let k = 0; k < n; k++) {
        const [from, size] = [0, 4].map((byte) => view().getUint32(pieces + 8 * k + byte, true));
        lines.push(new TextDecoder().decode(new Uint8Array(memory().buffer, from, size)));
        written += size;
      }
      view().setUint32(at, written, true);
      return 0;
    },
    proc_exit(status) { throw new Error(`the program ended with status ${status}`); },
  };
}

class Program {
  constructor() {
    this.lines = [];
    const known = wasi(() => this.exports.memory, this.lines), imports = {};
    for (const { module: from, name } of WebAssembly.Module.imports(module))
      (imports[from] ||= {})[name] = known[name] || (() => BAD_FILE);
    imports.page.progress = (what, fraction) => {
      const bytes = new Uint8Array(this.exports.memory.buffer, what), end = bytes.indexOf(0);
      postMessage({ step: new TextDecoder().decode(bytes.subarray(0, end)), fraction });
    };
    this.exports = new WebAssembly.Instance(module, imports).exports;
    this.exports._initialize();
  }

  get bytes() {
    const { memory, web_bytes, web_size } = this.exports;
    return new Uint8Array(memory.buffer, web_bytes(), web_size()).slice();
  }

  get text() { return new TextDecoder().decode(this.bytes); }

  // Calls a function of the program. `input`: the text that it reads. Throws the sentence of an error.
  call(name, input = "") {
    const bytes = new TextEncoder().encode(input), at = this.exports.web_input(bytes.length);
    new Uint8Array(this.exports.memory.buffer, at, bytes.length).set(bytes);
    let status;
    try {
      status = this.exports[name]();
    } catch (error) {
      program = null;
      throw new Error(`The program stopped: ${[...this.lines, error.message].join(" ")}`);
    }
    if (status !== 0) throw new Error(this.text);
    return this;
  }
}

const rows = (text) => text.split("\n").filter((line) => line).map((line) => line.split("\t"));

function nodes({ buffer }, origin) {
  const n = buffer.byteLength / 24, position = new Float32Array(buffer, 0, 3 * n);
  position.forEach((v, k) => { position[k] = v - origin[k % 3]; });
  return { position, radius: new Float32Array(buffer, 12 * n, n), parent: new Uint32Array(buffer, 16 * n, n),
    id: new Uint32Array(buffer, 20 * n, n) };
}

// A field of integers from 0 on is a count.
function field({ buffer }) {
  const bytes = new Uint8Array(buffer), end = bytes.indexOf(0);
  const [name, title, unit] = new TextDecoder().decode(bytes.subarray(0, end)).split("\t");
  const values = new Float32Array(buffer, 4 * Math.ceil((end + 1) / 4));
  return { name, title, unit, values, times: [], whole: values.every((v) => Number.isNaN(v) || (v >= 0 && Number.isInteger(v))) };
}

function fields() {
  const made = [];
  for (let k = 0, n = program.exports.web_fields(); k < n; k++) {
    const { bytes } = program.call("web_field", String(k));
    if (bytes.length) made.push(field(bytes));
  }
  return made;
}

function grow(options) {
  if (program && grown === options) return;
  grown = null;
  program = new Program();
  const [command, ...messages] = program.call("web_grow", options).text.trimEnd().split("\n");
  Object.assign(program, { command, messages });
  grown = options;
}

const ANSWERS = {
  tree({ options, origin }) {
    const begin = performance.now();
    grow(options);
    const seconds = (performance.now() - begin) / 1000, { command, messages } = program;
    return { command, messages, seconds, ...nodes(program.call("web_nodes").bytes, origin), fields: fields(),
      summary: Object.fromEntries(rows(program.call("web_summary").text)) };
  },
  swc({ options }) {
    grow(options);
    return { bytes: program.call("web_swc").bytes };
  },
  stl({ options, lod }) {
    grow(options);
    return { bytes: program.call("web_stl", `lod=${lod}\n`).bytes };
  },
};

self.onmessage = ({ data }) => {
  if (data.module) {
    module = data.module;
    return;
  }
  try {
    postMessage({ number: data.number, answer: ANSWERS[data.wants](data) });
  } catch (error) {
    postMessage({ number: data.number, error: error.message });
  }
};
