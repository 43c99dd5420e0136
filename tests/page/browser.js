// Headless Chromium over its debugging pipe, with nothing installed but node: what the tests of pages have in common.
"use strict";
const { spawn } = require("child_process");
const fs = require("fs");
const os = require("os");
const path = require("path");

class Browser {
  constructor(chromium, args) {
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

// Runs `body`, with three minutes' patience, and ends the program: exit status 1 if any expectation failed.
function runIn(chromium, args, body) {
  const browser = new Browser(chromium, args);
  const patience = setTimeout(function () {
    console.log("expected the browser to answer within three minutes");
    browser.process.kill("SIGKILL");
    process.exit(1);
  }, 180000);
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
