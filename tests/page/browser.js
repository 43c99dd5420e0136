// Headless Chromium over its debugging pipe, and Firefox over Marionette, with nothing installed but node: what the tests
// of pages have in common.
"use strict";
const { spawn } = require("child_process");
const fs = require("fs");
const net = require("net");
const os = require("os");
const path = require("path");

class Checks {
  check(ok, what) {
    if (ok) return;
    this.failures++;
    console.log(what);
  }

  // Nothing that a page of ours may do: a line of the console, or a request.
  checkSilence() {
    this.check(this.complaints.length === 0, "expected no console error, got " + this.complaints.join("; "));
    this.check(this.requests.length === 0, "expected no network access, got " + this.requests.join(", "));
  }
}

class Chromium extends Checks {
  constructor(chromium, args) {
    super();
    this.profile = fs.mkdtempSync(path.join(os.tmpdir(), "page-"));
    this.process = spawn(chromium, ["--headless=new", "--no-sandbox", "--remote-debugging-pipe",
      "--user-data-dir=" + this.profile, ...args, "about:blank"], { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] });
    [this.writer, this.reader] = [this.process.stdio[3], this.process.stdio[4]];
    this.sequence = 0;
    this.rest = "";
    this.waiting = new Map();
    this.complaints = [];
    this.requests = [];
    this.failures = 0;
    this.reader.setEncoding("utf8");
    this.reader.on("data", (chunk) => {
      const messages = (this.rest + chunk).split("\0");
      this.rest = messages.pop();
      messages.forEach((text) => this.receive(JSON.parse(text)));
    });
  }

  receive(message) {
    if (message.id) {
      const { resolve, reject } = this.waiting.get(message.id);
      this.waiting.delete(message.id);
      return message.error ? reject(new Error(message.error.message)) : resolve(message.result);
    }
    const p = message.params;
    if (message.method === "Runtime.exceptionThrown")
      this.complaints.push(p.exceptionDetails.exception ? p.exceptionDetails.exception.description : p.exceptionDetails.text);
    if (message.method === "Log.entryAdded" && p.entry.level === "error") this.complaints.push(p.entry.text);
    if (message.method === "Runtime.consoleAPICalled" && p.type === "error") this.complaints.push(JSON.stringify(p.args));
    if (message.method === "Network.requestWillBeSent" && !/^(file|data|blob):/.test(p.request.url)) this.requests.push(p.request.url);
  }

  send(method, params) {
    const id = ++this.sequence;
    const message = { id, method, params: params || {} };
    if (this.session) message.sessionId = this.session;
    this.writer.write(JSON.stringify(message) + "\0");
    return new Promise((resolve, reject) => { this.waiting.set(id, { resolve, reject }); });
  }

  async evaluate(expression) {
    const answer = await this.send("Runtime.evaluate", { expression, returnByValue: true, awaitPromise: true });
    if (answer.exceptionDetails) throw new Error(expression + ": " + answer.exceptionDetails.exception.description);
    return answer.result.value;
  }

  async start() {
    const target = await this.send("Target.createTarget", { url: "about:blank" });
    this.session = (await this.send("Target.attachToTarget", { targetId: target.targetId, flatten: true })).sessionId;
    for (const domain of ["Runtime", "Log", "Network", "Page"]) await this.send(domain + ".enable");
  }

  // Opens a page, and waits until it has settled; `address` is what follows its "#".
  async open(page, address) {
    await this.send("Page.navigate", { url: /^about:/.test(page) ? page : "file://" + path.resolve(page) + (address ? "#" + address : "") });
    await this.evaluate("new Promise(function (r) { if (document.readyState === 'complete') setTimeout(r, 300);" +
      " else window.addEventListener('load', function () { setTimeout(r, 300); }); })");
  }

  async key(name, modifiers) {
    const text = name.length === 1 ? name : undefined;
    await this.send("Input.dispatchKeyEvent", { type: "keyDown", key: name, text, modifiers });
    await this.send("Input.dispatchKeyEvent", { type: "keyUp", key: name, modifiers });
  }

  async mouse(type, x, y, more) {
    const button = type === "mouseMoved" ? "none" : "left";
    await this.send("Input.dispatchMouseEvent", { type, x, y, button, clickCount: 1, ...more });
  }
}

// Firefox has no software OpenGL without a display, so it is not headless: it runs below xvfb-run.
class Firefox extends Checks {
  constructor(firefox) {
    super();
    this.profile = fs.mkdtempSync(path.join(os.tmpdir(), "page-"));
    fs.writeFileSync(path.join(this.profile, "user.js"), 'user_pref("marionette.port", 0);\nuser_pref("webgl.force-enabled", true);\n');
    this.process = spawn(firefox, ["--no-remote", "--marionette", "--profile", this.profile],
      { stdio: "ignore", env: { ...process.env, HOME: this.profile } });
    this.sequence = 0;
    this.rest = Buffer.alloc(0);
    this.waiting = new Map();
    this.failures = 0;
  }

  // A message is its length in bytes, a colon, and JSON: [0, id, name, parameters], answered by [1, id, error, result].
  receive(chunk) {
    this.rest = Buffer.concat([this.rest, chunk]);
    for (let colon; (colon = this.rest.indexOf(":")) > 0;) {
      const end = colon + 1 + Number(this.rest.subarray(0, colon));
      if (this.rest.length < end) return;
      const message = JSON.parse(this.rest.subarray(colon + 1, end));
      this.rest = this.rest.subarray(end);
      const { resolve, reject } = this.waiting.get(message[1] || 0);
      if (message[2]) reject(new Error(message[2].message));
      else resolve(message[3]);
    }
  }

  answer(id) {
    return new Promise((resolve, reject) => { this.waiting.set(id, { resolve, reject }); });
  }

  send(name, params) {
    const message = JSON.stringify([0, ++this.sequence, name, params || {}]);
    this.socket.write(Buffer.byteLength(message) + ":" + message);
    return this.answer(this.sequence);
  }

  async evaluate(expression) {
    const script = "const [done] = arguments; Promise.resolve(eval(" + JSON.stringify(expression) + "))" +
      ".then((value) => done({ value }), (error) => done({ error: String(error) }));";
    const { value, error } = (await this.send("WebDriver:ExecuteAsyncScript", { script, args: [] })).value;
    if (error) throw new Error(expression + ": " + error);
    return value;
  }

  async start() {
    const port = path.join(this.profile, "MarionetteActivePort");
    while (!fs.existsSync(port) || !fs.readFileSync(port).length) await new Promise((r) => setTimeout(r, 100));
    this.socket = net.connect(Number(fs.readFileSync(port, "utf8")), "127.0.0.1").on("data", (chunk) => this.receive(chunk));
    await this.answer(0);
    await this.send("WebDriver:NewSession");
  }

  async open(page, address) {
    await this.send("WebDriver:Navigate", { url: "file://" + path.resolve(page) + (address ? "#" + address : "") });
  }
}

// Runs `body` in Chromium, or in Firefox if `args` is null, and ends the program: exit status
// 1 if any expectation failed.
function runIn(program, args, body) {
  const browser = args ? new Chromium(program, args) : new Firefox(program);
  const patience = setTimeout(function () {
    console.log("expected the browser to answer within fifteen minutes");
    browser.process.kill("SIGKILL");
    process.exit(1);
  }, 900000);
  browser.start().then(() => body(browser)).catch(function (error) {
    browser.failures++;
    console.log(error.message);
  }).finally(function () {
    clearTimeout(patience);
    // Its children may write for a moment longer, and rmSync does not look again for what they write.
    browser.process.on("exit", function removeProfile(code, signal, tries = 50) {
      try {
        fs.rmSync(browser.profile, { recursive: true, force: true });
      } catch (error) {
        if (tries > 0) return setTimeout(removeProfile, 100, code, signal, tries - 1);
      }
      process.exit(browser.failures ? 1 : 0);
    });
    browser.process.kill("SIGKILL");
  });
}

module.exports = { runIn };
