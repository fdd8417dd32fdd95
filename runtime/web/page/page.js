"use strict";
// The live page: what the task does, in words, numbers, curves and in its diagram; and its parameters, staged and
// committed. It speaks to the server that it came from, and to no other.

const place = id => document.getElementById(id);
const silence = 2000;  // milliseconds without values, after which those that are shown are called stale

let description = null;  // what there is to be seen
let index = new Map();   // of points, by name
let trends = null;
let historyView = null;
let xyView = null;
let parameters = [];  // {point, now, staged, input}
let live = [];        // {element, of: "values" or "inner", at, type, unit}
let statusRows = [];  // {cell, at}
let readToken = "";
let heard = 0, frames = 0;

function add(parent, name, properties) {
  return parent.appendChild(Object.assign(document.createElement(name), properties));
}

function say(text, kind) {
  const notice = place("notice");
  notice.hidden = text === "";
  notice.className = "notice " + kind;
  notice.textContent = text;
}

function badge(text, kind) {
  place("state").textContent = text;
  place("state").className = "badge " + kind;
}

window.addEventListener("error", event => say("The page has a fault: " + event.message, "bad"));

// --- what is asked of the server ---

async function get(target, token) {
  return fetch(target, { headers: token ? { Authorization: "Bearer " + token } : {} });
}

// Empty where it was taken, the reason where not.
async function post(target, body) {
  const token = place("token").value || readToken;
  if (token === "") return "Type the token first; the server was started with a file that holds it.";
  try {
    const answer = await fetch(target, { method: "POST", headers: { Authorization: "Bearer " + token }, body });
    return answer.ok ? "" : (await answer.json()).refusal;
  } catch {
    return "The server does not answer.";
  }
}

// --- building the page ---

// "0 none, 1 hang, …" as a list of names.
function names(meaning) {
  return meaning.split(", ").map(entry => entry.replace(/^\d+ /, ""));
}

function limits({ low, high, type }) {
  if (type === "boolean") return "FALSE, TRUE";
  if (low === null && high === null) return "";
  return low === null ? `≤ ${high}` : high === null ? `≥ ${low}` : `${low} … ${high}`;
}

function buildDiagram() {
  if (description.diagram === "") return;
  const picture = new DOMParser().parseFromString(description.diagram, "image/svg+xml").documentElement;
  place("diagram").replaceChildren(document.importNode(picture, true));
  place("diagram-section").hidden = false;
  for (const element of place("diagram").querySelectorAll(".value")) {
    const { point, inner } = element.dataset;
    const of = inner === undefined ? "values" : "inner";
    const at = inner === undefined ? index.get(point) : Number(inner);
    const signal = of === "values" ? description.points[at] : description.inner[at];
    if (signal === undefined) continue;
    live.push({ element, of, at, type: signal.type, unit: signal.unit === "1" ? "" : " " + signal.unit });
    const toggle = () => {
      trends.toggle(of + at);
      markPlotted();
    };
    element.setAttribute("tabindex", "0");
    element.setAttribute("role", "button");
    element.setAttribute("aria-label", `${signal.name}: in the trends or not`);
    element.addEventListener("click", toggle);
    element.addEventListener("keydown", event => {
      if (event.key !== "Enter" && event.key !== " ") return;
      event.preventDefault();
      toggle();
    });
  }
}

function markPlotted() {
  for (const { element, of, at } of live) {
    element.classList.toggle("plotted", trends.chosen.has(of + at));
    element.setAttribute("aria-pressed", trends.chosen.has(of + at));
  }
}

function buildTrends() {
  const own = description.points.map((point, at) => ({ ...point, key: "values" + at }))
    .filter(point => point.kind === "input" || point.kind === "output")
    .sort((a, b) => (a.type === "boolean") - (b.type === "boolean") || (a.kind === "input") - (b.kind === "input"));
  const inner = description.inner.map((signal, at) => ({ ...signal, key: "inner" + at }));
  trends = new Trends(place("trends"), [...own, ...inner]);
  trends.choose(own.slice(0, 8).map(signal => signal.key));
  markPlotted();
  if (xyView === null) xyView = new XyView();
  xyView.build(trends);
}

function buildParameters() {
  const body = place("parameters").tBodies[0];
  body.textContent = "";
  parameters = [];
  description.points.forEach((point, at) => {
    if (point.kind !== "parameter") return;
    const row = add(body, "tr", {});
    add(row, "th", { textContent: point.name, scope: "row" });
    const now = add(row, "td", { className: "number value" });
    now.dataset.value = point.name;
    const staged = add(row, "td", { className: "number staged" });
    staged.dataset.staged = point.name;
    const input = add(add(row, "td", {}), "input", { type: "text", inputMode: "decimal", spellcheck: false });
    input.setAttribute("aria-label", "New value of " + point.name);
    input.dataset.name = point.name;
    input.disabled = !description.writable;
    add(row, "td", { textContent: point.unit === "1" ? "" : point.unit });
    add(row, "td", { textContent: limits(point) });
    add(row, "td", { textContent: point.meaning });
    parameters.push({ point, at, now, staged, input });
  });
  place("parameters-section").hidden = parameters.length === 0;
  place("reset").disabled = !description.writable;
  place("token-label").hidden = !description.writable || description.token_to_read;
  place("stage").disabled = !description.writable;
  place("access").textContent = description.writable ? "Parameters can be changed by whoever has the token."
                                                     : "Read-only: started without --web-token-file.";
}

function buildCycles() {
  const body = place("cycles").tBodies[0];
  body.textContent = "";
  statusRows = [];
  description.points.forEach((point, at) => {
    if (point.kind !== "status") return;
    const row = add(body, "tr", {});
    const isState = ["task.state", "task.fault", "task.last_fault", "task.history_fault", "task.mqtt_connected",
                     "task.mqtt_fault", "task.tls_fault", "task.online_change"].includes(point.name);
    add(row, "th", { textContent: isState ? point.name.slice(5).replace("_", " ") : point.meaning, scope: "row", title: point.name });
    const cell = add(row, "td", { className: "number" });
    cell.dataset.value = point.name;
    statusRows.push({ cell, at, point, names: isState ? names(point.meaning) : null });
  });
}

function build() {
  document.title = description.name + " – Hysteron";
  place("title").textContent = description.name;
  index = new Map(description.points.map((point, at) => [point.name, at]));
  live = [];
  buildDiagram();
  buildTrends();
  buildParameters();
  buildCycles();
  if (historyView === null) historyView = new HistoryView(target => get(target, readToken));
  historyView.build(description.history);
}

// --- showing values ---

function showState(values) {
  const of = name => values[index.get(name)];
  const word = name => names(description.points[index.get(name)].meaning)[of(name)] || "unknown";
  const state = word("task.state"), fault = word("task.fault");
  if (fault !== "none" && state !== "stopped") badge("Outputs are safe: " + fault, "bad");
  else badge(state === "running" ? "Running" : state[0].toUpperCase() + state.slice(1), state === "running" ? "good" : "bad");
  const late = ["task.late_wake", "task.late_cpu", "task.late_preempted", "task.late_steal"];
  const lateCycles = late.reduce((sum, name) => sum + of(name), 0);
  place("summary").textContent = `cycle ${of("task.cycles")}, one every ${Number((description.period * 1000).toPrecision(6))} ms · ` +
    `${of("task.skipped")} skipped · ${lateCycles} late`;
}

function showStatus(values) {
  for (const { cell, at, point, names } of statusRows) {
    const value = values[at];
    cell.textContent = names ? names[value] : point.unit === "ns" ? `${(value / 1000).toFixed(1)} µs` : String(value);
  }
}

function showParameters(values, staged) {
  const waiting = new Map(staged);
  for (const parameter of parameters) {
    parameter.now.textContent = parameter.point.type === "boolean" ? shown(values[parameter.at], "boolean")
                                                                   : String(values[parameter.at]);
    const value = waiting.get(parameter.at);
    parameter.staged.textContent = value === undefined ? "" : String(value);
  }
  const count = waiting.size;
  place("waiting").textContent = count === 0 ? "" : `${count} staged, not yet in effect`;
  place("commit").disabled = place("discard").disabled = !description.writable || count === 0;
}

function show(frame) {
  heard = performance.now();
  for (const { element, of, at, type, unit } of live) element.textContent = shown(frame[of][at], type) + unit;
  showState(frame.values);
  showStatus(frame.values);
  showParameters(frame.values, frame.staged);
  trends.add(frame.values[index.get("task.elapsed")] * description.period, trends.signals.map(({ key }) =>
    key.startsWith("inner") ? frame.inner[Number(key.slice(5))] : frame.values[Number(key.slice(6))]));
  document.body.classList.remove("stale");
  document.body.dataset.frames = ++frames;
}

function showStale() {
  if (performance.now() - heard < silence) return;
  document.body.classList.add("stale");
  badge(heard === 0 ? "Connecting" : "No connection: what is shown is old", heard === 0 ? "" : "bad");
}

// --- changing parameters ---

function typed() {
  const values = {};
  for (const { point, input } of parameters) {
    const text = input.value.trim();
    input.classList.remove("refused");
    if (text === "") continue;
    if (/^[+-]?[1-9]\d{0,2},\d{3}$/.test(text)) {  // a decimal comma, or one between thousands
      input.classList.add("refused");
      throw new Error(`${point.name}: “${text}” can be read in two ways. ` +
        `Write ${text.replace(",", ".")} or ${text.replace(",", "")}.`);
    }
    const truth = { TRUE: 1, FALSE: 0 }[text.toUpperCase()];
    const value = truth === undefined ? Number(text.replace(",", ".")) : truth;
    if (!Number.isFinite(value)) {
      input.classList.add("refused");
      throw new Error(`${point.name}: “${text}” is no number.`);
    }
    values[point.name] = value;
  }
  return values;
}

async function stage(event) {
  event.preventDefault();
  let values;
  try {
    values = typed();
  } catch (problem) {
    return say(problem.message + " Nothing was staged.", "bad");
  }
  const count = Object.keys(values).length;
  if (count === 0) return say("Type a new value beside a parameter first.", "bad");
  const refusal = await post("/api/stage", JSON.stringify(values));
  if (refusal !== "") {
    for (const { point, input } of parameters) {
      input.classList.toggle("refused", input.value !== "" && refusal.startsWith(point.name + " "));
    }
    return say(`Refused: ${refusal} Nothing was staged.`, "bad");
  }
  for (const { input } of parameters) input.value = "";
  say(`Staged: ${count === 1 ? "one value waits" : count + " values wait"} for a commit. The task goes on as before.`, "good");
}

async function give(target, done, kept) {
  const refusal = await post(target, "");
  say(refusal === "" ? done : `Refused: ${refusal} ${kept}`, refusal === "" ? "good" : "bad");
}

place("parameters-form").addEventListener("submit", stage);
place("commit").addEventListener("click", () =>
  give("/api/commit", "Committed: the set counts from the next step on.", "Nothing was changed; what is staged stays staged."));
place("discard").addEventListener("click", () =>
  give("/api/discard", "Discarded: nothing is staged any longer.", "What is staged stays staged."));

// Asks twice: the states of a running control are lost.
place("reset").addEventListener("click", () => {
  const button = place("reset");
  const show = isAsked => {
    button.dataset.sure = isAsked ? "yes" : "";
    button.textContent = isAsked ? "Reset: every state begins anew?" : "Reset the task";
  };
  const isSure = button.dataset.sure === "yes";
  show(!isSure);
  if (isSure) give("/api/reset", "Reset: every state begins anew.", "The task goes on as before.");
  else setTimeout(() => show(false), 5000);
});

async function save() {
  try {
    const answer = await get("/api/parameters.toml", readToken);
    const text = await answer.text();
    if (!answer.ok) return say(JSON.parse(text).refusal, "bad");
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([text], { type: "application/toml" }));
    link.download = description.name.toLowerCase() + ".toml";
    link.click();
    URL.revokeObjectURL(link.href);
    say(`Saved: ${link.download} has the parameters that count now; what is staged is not in it.`, "good");
  } catch {
    say("The server does not answer.", "bad");
  }
}
place("save").addEventListener("click", save);

// --- the connection ---

function listen() {
  const scheme = location.protocol === "https:" ? "wss://" : "ws://";
  const socket = new WebSocket(scheme + location.host + "/api/stream");
  socket.addEventListener("open", () => {
    if (description.token_to_read) socket.send(readToken);
  });
  socket.addEventListener("message", event => show(JSON.parse(event.data)));
  socket.addEventListener("close", () => setTimeout(connect, 1000));
}

async function connect() {
  try {
    const answer = await get("/api/description", readToken);
    if (answer.status === 401) {
      place("login").hidden = false;
      badge("The token is asked for", "");
      if (readToken !== "") say((await answer.json()).refusal, "bad");
      return;
    }
    const text = await answer.text();
    if (!answer.ok) throw new Error(JSON.parse(text).refusal);
    const next = JSON.parse(text);
    if (JSON.stringify(next) !== JSON.stringify(description)) {
      description = next;
      build();
    }
    place("login").hidden = true;
    listen();
  } catch (problem) {
    if (!(problem instanceof TypeError)) say(problem.message, "bad");  // a TypeError: nobody answers
    setTimeout(connect, 1000);
  }
}

place("login-form").addEventListener("submit", event => {
  event.preventDefault();
  readToken = place("login-token").value;
  say("", "");
  connect();
});

setInterval(showStale, 500);
connect();
