// The parts of the gateway that need no library: units, times, enumerations, users.
"use strict";

const assert = require("node:assert/strict");
const { EventEmitter, once } = require("node:events");
const { mkdtempSync, readFileSync, rmSync, writeFileSync } = require("node:fs");
const { tmpdir } = require("node:os");
const path = require("node:path");
const test = require("node:test");
const { pathToFileURL } = require("node:url");

const part = (name) => import(pathToFileURL(path.join(__dirname, "..", "..", "gateways", "opcua", name)).href);

test("a unit has the code of Recommendation 20, however it is written", async () => {
  const { engineeringUnits, unitIdOf } = await part("units.js");
  // The identifiers are those that OPC 10000-8 and UNECE_to_OPCUA.csv of the OPC Foundation list.
  const listed = { V: 5655636, mm: 5066068, um: 13384, "µm": 13384, "μm": 13384, degC: 4408652, "°C": 4408652, "Ω": 5195853,
    s: 5457219, "%": 20529, rpm: 5394509, "N·m": 20053, "N*m": 20053, "l/min": 19506, "L/min": 19506, "m/s^2": 5067595,
    "mm/s": 4403510, ml: 5065812, l: 5002322, lm: -1, kg: 4933453 };
  for (const [unit, id] of Object.entries(listed)) {
    assert.equal(engineeringUnits(unit).unitId, id, unit);
    assert.equal(engineeringUnits(unit).displayName.text, unit, "the text stays the diagram's");
  }
  assert.deepEqual(engineeringUnits("um/V"), { namespaceUri: "urn:hysteron:units", unitId: -1, displayName: { text: "um/V" },
    description: { text: "um/V" } });
  assert.equal(unitIdOf("VLT"), 0x564c54);
});

test("every unit that the library knows by the same code has the same symbol or is another one", async (t) => {
  const gateway = path.join(__dirname, "..", "..", "gateways", "opcua");
  let library;
  try {
    library = require(path.join(gateway, "node_modules", "node-opcua"));
  } catch {
    return t.skip("node-opcua is not installed: scripts/install-dependencies opcua");
  }
  library.setWarningLogger(() => {});
  const { engineeringUnits } = await part("units.js");
  let compared = 0;
  for (const { displayName, unitId } of Object.values(library.standardUnits)) {
    const ours = displayName.text && engineeringUnits(displayName.text.replace("²", "^2").replace("³", "^3").replace("r/min", "rpm"));
    if (ours && ours.unitId !== -1) {
      assert.equal(ours.unitId, unitId, displayName.text);
      compared += 1;
    }
  }
  assert.ok(compared > 25, `${compared}`);
});

let lastPort = 0;

/** A socket of an own port arrives at the door. */
function arrives(door, { from = "10.0.0.1", bytesRead = 0 } = {}) {
  const socket = Object.assign(new EventEmitter(), { remoteAddress: from, remotePort: (lastPort += 1), bytesRead, isOpen: true });
  socket.destroy = () => {
    socket.isOpen = false;
    setImmediate(() => socket.emit("close")); // as node does: later
  };
  door.admit(socket);
  return socket;
}

test("who says nothing keeps no other connection out", async () => {
  const { Door } = await part("door.js");
  const door = new Door({ guests: 3, patience: 60_000 });
  const spoke = arrives(door, { bytesRead: 8 });
  const seated = arrives(door, { bytesRead: 8 });
  const session = {};
  door.seat(session, seated);
  assert.equal(door.guests, 1, "who has a session is no guest");
  const silent = [arrives(door), arrives(door)];
  const next = arrives(door, { bytesRead: 8 });
  assert.deepEqual([spoke, seated, ...silent, next].map(({ isOpen }) => isOpen), [true, true, false, true, true], "the silent one that is there longest goes");
  arrives(door, { bytesRead: 8 });
  assert.equal(silent[1].isOpen, false);
  const other = arrives(door, { from: "10.0.0.2", bytesRead: 8 });
  assert.equal(spoke.isOpen, false, "all have spoken: the oldest goes");
  for (let k = 0; k < 20; k += 1) arrives(door, { bytesRead: 8 });
  assert.ok(other.isOpen, "a crowd from one address pushes out its own");
  assert.ok(seated.isOpen);
  assert.equal(door.guests, 3);
  door.leave(session);
  assert.equal(door.guests, 4, "without its session a connection is a guest's again");
  arrives(door, { bytesRead: 8 });
  seated.emit("close");
});

test("what a connection sends ends that connection alone", async () => {
  const { Door } = await part("door.js");
  const told = [];
  const door = new Door({ guests: 3, patience: 60_000, tell: (line) => told.push(line) });
  const [one, other] = [1, 2].map(() => arrives(door, { bytesRead: 8 }));
  let heard = "";
  one.on("data", () => { throw new Error("a chunk is too long"); });
  other.on("data", (words) => { heard = words; });
  one.emit("data", "MSGF");
  other.emit("data", "HELF");
  await once(one, "close");
  assert.deepEqual([one.isOpen, other.isOpen, heard, door.guests], [false, true, "HELF", 1]);
  assert.match(told.join(), /10\.0\.0\.1.*a chunk is too long/);
});

test("a guest has its time, and no more", async (t) => {
  const { Door } = await part("door.js");
  t.mock.timers.enable({ apis: ["setTimeout"] });
  const door = new Door({ guests: 3, patience: 10_000 });
  const [seated, guest] = [1, 2].map(() => arrives(door));
  door.seat({}, seated);
  t.mock.timers.tick(10_001);
  await once(guest, "close");
  assert.deepEqual([seated.isOpen, guest.isOpen], [true, false]);
  assert.equal(door.guests, 0);
});

test("a snapshot's time follows from the periods of the task", async () => {
  const { SourceTime } = await part("source_time.js");
  let steady = 1000;
  let wall = 1_700_000_000_000;
  const time = new SourceTime(0.01, () => steady, () => wall);
  const pass = (ms) => { steady += ms; wall += ms; };
  // seen 8 ms after it was taken, then without delay: the second look corrects the first
  assert.equal(time.of(100).getTime(), wall);
  pass(12);
  assert.equal(time.of(102).getTime(), wall);
  pass(5);
  assert.equal(time.of(102).getTime(), wall - 5, "the same snapshot keeps its time");
  pass(1000);
  wall += 50_000; // somebody sets the clock
  assert.equal(Math.round(wall - time.of(202).getTime()), 5, "5 ms old, and not 50 s");
  // the task's machine has a clock that is 100 ppm slower: the times do not run away from each other
  for (let i = 1; i <= 10_000; i += 1) {
    pass(1000);
    const age = wall - time.of(202 + i * 99.99).getTime();
    assert.ok(age >= 0 && age < 10, `${age}`);
  }
});

test("a forced input is a local override, but where the task says worse", async () => {
  const { statusOf } = await part("quality.js");
  const task = { isLinked: true, isStalled: false, state: "running", fault: "none" };
  const point = { kind: "input", low: -1, high: 1, isForced: true };
  assert.equal(statusOf(task, point, 0.5), "GoodLocalOverride");
  assert.equal(statusOf(task, { ...point, isForced: false }, 0.5), "Good");
  assert.equal(statusOf({ ...task, state: "faulted", fault: "lost link" }, point, 0.5), "UncertainLastUsableValue");
  assert.equal(statusOf({ ...task, isLinked: false }, point, 0.5), "BadNoCommunication");
});

test("an enumeration is what a meaning lists from 0 on", async () => {
  const { enumeration } = await part("quality.js");
  assert.deepEqual(enumeration("0 starting, 1 running, 2 faulted"), ["starting", "running", "faulted"]);
  assert.equal(enumeration("cycles that were run"), null);
  assert.equal(enumeration("0 none"), null);
  assert.equal(enumeration("1 a, 2 b"), null);
  assert.equal(enumeration(""), null);
});

test("a password lets in its user alone, and a damaged file nobody", async (t) => {
  const { addUser, InputError, Users } = await part("users.js");
  const folder = mkdtempSync(path.join(tmpdir(), "users-"));
  t.after(() => rmSync(folder, { recursive: true }));
  const file = path.join(folder, "users.json");
  await addUser(file, "anna", "password-of-anna", "write");
  await addUser(file, "ben", "password-of-anna", "read");
  const said = [];
  const users = new Users(file, (line) => said.push(line), 0);
  assert.equal(await users.isPassword("anna", "password-of-anna"), true);
  assert.equal(await users.isPassword("anna", "password-of-ann"), false);
  assert.equal(await users.isPassword("constructor", "password-of-anna"), false);
  assert.deepEqual([users.rightOf("anna"), users.rightOf("ben"), users.rightOf("toString")], ["write", "read", ""]);
  const kept = JSON.parse(readFileSync(file, "utf8"));
  assert.notEqual(kept.anna.password.split(":")[5], kept.ben.password.split(":")[5], "salted");
  // as many tries at once as there is room for, and no more
  const tries = await Promise.all(Array.from({ length: 8 }, () => users.isPassword("anna", "password-of-anna")));
  assert.equal(tries.filter(Boolean).length, 4);

  for (const damage of ["{", "[]", '{"anna": {"may": "rule", "password": "x"}}', '{"anna": {"may": "read", "password": "scrypt:1:1:1:AA==:AA=="}}']) {
    writeFileSync(file, damage);
    assert.equal(users.rightOf("anna"), "", damage);
    assert.equal(await users.isPassword("anna", "password-of-anna"), false);
    assert.throws(() => new Users(file, () => {}), InputError, damage);
    await assert.rejects(addUser(file, "carl", "password-of-carl", "read"), InputError);
    assert.equal(readFileSync(file, "utf8"), damage, "a file that cannot be read is not overwritten");
  }
  assert.match(said.at(-1), /nobody is let in until this is mended/);
});
