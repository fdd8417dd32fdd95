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
let parameters = [];  // {point, at, now, staged, input}
let inputs = [];      // {point, at, now, forced, input, end}
let live = [];        // {element, key, of: "values" or "inner", at, type, unit}
let statusRows = [];  // {cell, at}
let readToken = "";
let session = "";     // of the stream that is open; what is forced ends with it
let isFollowing = false;  // the description of another version is asked for
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
  place("diagram-section").hidden = description.diagram === "";
  if (description.diagram === "") return;
  const picture = new DOMParser().parseFromString(description.diagram, "image/svg+xml").documentElement;
  place("diagram").replaceChildren(document.importNode(picture, true));
  for (const element of place("diagram").querySelectorAll(".value")) {
    const { point, inner } = element.dataset;
    const of = inner === undefined ? "values" : "inner";
    const at = inner === undefined ? index.get(point) : Number(inner);
    const signal = of === "values" ? description.points[at] : description.inner[at];
    if (signal === undefined) continue;
    const key = of + ":" + signal.name;
    live.push({ element, key, of, at, type: signal.type, unit: signal.unit === "1" ? "" : " " + signal.unit });
    const toggle = () => {
      trends.toggle(key);
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
  for (const { element, key } of live) {
    element.classList.toggle("plotted", trends.chosen.has(key));
    element.setAttribute("aria-pressed", trends.chosen.has(key));
  }
}

function buildTrends() {
  const own = description.points.map((point, at) => ({ ...point, key: "values:" + point.name, of: "values", at }))
    .filter(point => point.kind === "input" || point.kind === "output")
    .sort((a, b) => (a.type === "boolean") - (b.type === "boolean") || (a.kind === "input") - (b.kind === "input"));
  const inner = description.inner.map((signal, at) => ({ ...signal, key: "inner:" + signal.name, of: "inner", at }));
  if (trends === null) {
    trends = new Trends(place("trends"), [...own, ...inner]);
    trends.choose(own.slice(0, 8).map(signal => signal.key));
  } else {
    trends.change([...own, ...inner]);
  }
  markPlotted();
  if (xyView === null) xyView = new XyView();
  xyView.build(trends);
}

// A row for each point of a kind, with a place for a new value; what was typed before stays.
function buildTable(table, kind, before, cells) {
  const body = place(table).tBodies[0];
  const typed = new Map(before.map(({ point, input }) => [point.name, input.value]));
  const rows = [];
  body.textContent = "";
  description.points.forEach((point, at) => {
    if (point.kind !== kind) return;
    const row = add(body, "tr", {});
    add(row, "th", { textContent: point.name, scope: "row" });
    const now = add(row, "td", { className: "number value" });
    now.dataset.value = point.name;
    const own = cells(row, point);
    const input = add(add(row, "td", {}), "input", { type: "text", inputMode: "decimal", spellcheck: false });
    input.setAttribute("aria-label", "New value of " + point.name);
    input.dataset.name = point.name;
    input.value = typed.get(point.name) || "";
    add(row, "td", { textContent: point.unit === "1" ? "" : point.unit });
    add(row, "td", { textContent: limits(point) });
    add(row, "td", { textContent: point.meaning });
    rows.push({ point, at, now, input, ...own });
  });
  return rows;
}

const may = right => description.rights.includes(right);

function buildParameters() {
  parameters = buildTable("parameters", "parameter", parameters, (row, point) => {
    const staged = add(row, "td", { className: "number staged" });
    staged.dataset.staged = point.name;
    return { staged };
  });
  for (const { input } of parameters) input.disabled = !may("parameters");
  place("parameters-section").hidden = parameters.length === 0;
  place("reset").disabled = !may("reset");
  place("stage").disabled = !may("parameters");
}

function buildInputs() {
  inputs = buildTable("inputs", "input", inputs, (row, point) => {
    const forced = add(row, "td", { className: "forced" });
    const end = add(forced, "button", { type: "button", textContent: "End", hidden: true });
    end.setAttribute("aria-label", "End the force of " + point.name);
    end.addEventListener("click", () => force({ [point.name]: null }, `${point.name} is not forced any more.`));
    return { forced, end };
  });
  place("inputs-section").hidden = inputs.length === 0 || !may("force");
  place("force").disabled = !may("force");
}

// What whoever has the token may do, in a word for each right.
function buildAccess() {
  const words = { parameters: "parameters are changed", reset: "the task is reset", force: "inputs are forced" };
  place("token-section").hidden = !description.writable || description.token_to_read;
  place("access").textContent = !description.writable ? "Read-only: started without --web-token-file."
    : description.rights.length === 0 ? "Read-only: the run file gives the page no rights."
    : "With the token, " + description.rights.map(right => words[right]).join(", ") + ".";
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
  buildAccess();
  buildInputs();
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

function valueText(point, value) {
  return point.type === "boolean" ? shown(value, "boolean") : String(value);
}

// What is forced is said wherever its value stands.
function showForced(values, forced) {
  const isForced = new Set(forced);
  const texts = forced.map(at => `${description.points[at].name} = ${valueText(description.points[at], values[at])}`);
  const badge = place("forced");
  badge.hidden = forced.length === 0;
  badge.textContent = "Forced: " + texts.slice(0, 3).join(", ") + (texts.length > 3 ? ` and ${texts.length - 3} more` : "");
  for (const { point, at, now, forced: cell, end } of inputs) {
    now.textContent = valueText(point, values[at]);
    cell.parentElement.classList.toggle("is-forced", isForced.has(at));
    end.hidden = !isForced.has(at);
  }
  for (const { element, of, at } of live) element.classList.toggle("forced", of === "values" && isForced.has(at));
  trends.forced = new Set(forced.map(at => "values:" + description.points[at].name));
  place("release").disabled = forced.length === 0 || !may("force");
}

function showParameters(values, staged) {
  const waiting = new Map(staged);
  for (const parameter of parameters) {
    parameter.now.textContent = valueText(parameter.point, values[parameter.at]);
    const value = waiting.get(parameter.at);
    parameter.staged.textContent = value === undefined ? "" : String(value);
  }
  const count = waiting.size;
  place("waiting").textContent = count === 0 ? "" : `${count} staged, not yet in effect`;
  place("commit").disabled = place("discard").disabled = !may("parameters") || count === 0;
}

// An online change came: other points, and another picture.
async function followVersion() {
  if (isFollowing) return;
  isFollowing = true;
  try {
    const answer = await get("/api/description", readToken);
    if (answer.ok) {
      description = await answer.json();
      build();
      say(`The diagram was changed while it runs: this is version ${description.version}.`, "good");
    }
  } catch {
    // The stream ends as well, and begins anew.
  } finally {
    isFollowing = false;
  }
}

function show(frame) {
  heard = performance.now();
  if (frame.version !== description.version) return followVersion();
  for (const { element, of, at, type, unit } of live) element.textContent = shown(frame[of][at], type) + unit;
  showState(frame.values);
  showStatus(frame.values);
  showForced(frame.values, frame.forced);
  showParameters(frame.values, frame.staged);
  trends.add(frame.values[index.get("task.elapsed")] * description.period,
             trends.signals.map(({ of, at }) => frame[of][at]));
  document.body.classList.remove("stale");
  document.body.dataset.frames = ++frames;
}

function showStale() {
  if (performance.now() - heard < silence) return;
  document.body.classList.add("stale");
  badge(heard === 0 ? "Connecting" : "No connection: what is shown is old", heard === 0 ? "" : "bad");
}

// --- changing parameters, forcing inputs ---

// The values that were typed into the rows of a table, by name.
function typed(rows) {
  const values = {};
  for (const { point, input } of rows) {
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

// A refusal begins with the name that it is about.
function markRefused(rows, refusal) {
  for (const { point, input } of rows) {
    input.classList.toggle("refused", input.value !== "" && refusal.startsWith(point.name + " "));
  }
}

async function force(values, done) {
  const refusal = await post("/api/force", JSON.stringify({ session, inputs: values }));
  if (refusal !== "") {
    markRefused(inputs, refusal);
    return say(`Refused: ${refusal} Nothing was changed.`, "bad");
  }
  for (const { point, input } of inputs) if (point.name in values) input.value = "";
  say(done, "good");
}

async function forceTyped(event) {
  event.preventDefault();
  try {
    const values = typed(inputs);
    if (Object.keys(values).length === 0) return say("Type a new value beside an input first.", "bad");
    await force(values, `Forced: ${Object.keys(values).join(", ")}. It is so until this page is closed, or it is ended.`);
  } catch (problem) {
    say(problem.message + " Nothing was forced.", "bad");
  }
}

async function stage(event) {
  event.preventDefault();
  let values;
  try {
    values = typed(parameters);
  } catch (problem) {
    return say(problem.message + " Nothing was staged.", "bad");
  }
  const count = Object.keys(values).length;
  if (count === 0) return say("Type a new value beside a parameter first.", "bad");
  const refusal = await post("/api/stage", JSON.stringify(values));
  if (refusal !== "") {
    markRefused(parameters, refusal);
    return say(`Refused: ${refusal} Nothing was staged.`, "bad");
  }
  for (const { input } of parameters) input.value = "";
  say(`Staged: ${count === 1 ? "one value waits" : count + " values wait"} for a commit. The task goes on as before.`, "good");
}

async function give(target, done, kept) {
  const refusal = await post(target, "");
  say(refusal === "" ? done : `Refused: ${refusal} ${kept}`, refusal === "" ? "good" : "bad");
}

place("token-form").addEventListener("submit", event => event.preventDefault());
place("inputs-form").addEventListener("submit", forceTyped);
place("release").addEventListener("click", () =>
  give("/api/release", "No input is forced any more.", "What is forced stays so."));
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
  session = [...crypto.getRandomValues(new Uint8Array(16))].map(byte => byte.toString(16).padStart(2, "0")).join("");
  const socket = new WebSocket(scheme + location.host + "/api/stream?session=" + session);
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
