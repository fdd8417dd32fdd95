// A Modbus server as clients in JavaScript see it, jsmodbus or modbus-serial, through the JSON map of its registers.
//
//   node interop.js points CLIENT PORT MAP.json      reads every point and prints its name and value; then adds 1 to each
//                                                    that may be written
//   node interop.js functions CLIENT PORT MAP.json   every function that the client has, against the diagram ECHO of
//                                                    test_js_clients.py; prints a line a function
"use strict";
const assert = require("node:assert");
const fs = require("node:fs");
const net = require("node:net");
const util = require("node:util");

const [mode, library, port, file] = process.argv.slice(2);
const map = JSON.parse(fs.readFileSync(file, "utf8"));
const points = new Map(map.points.map(point => [point.name, point]));

// --- the two libraries behind the same words: bits as arrays of booleans, registers as buffers ---

async function openJsmodbus() {
  const { client } = require("jsmodbus");
  const socket = new net.Socket();
  const it = new client.TCP(socket, 1, 20000);
  await new Promise((done, failed) => socket.once("error", failed).connect({ host: "127.0.0.1", port }, done));
  const body = async answer => (await answer).response.body;
  return {
    readBits: async (fc, at, count) =>
      [...(await body(fc === 1 ? it.readCoils(at, count) : it.readDiscreteInputs(at, count))).valuesAsArray]
        .slice(0, count).map(bit => bit === true || bit === 1),
    readWords: async (fc, at, count) =>
      Buffer.from((await body(fc === 3 ? it.readHoldingRegisters(at, count) : it.readInputRegisters(at, count))).valuesAsBuffer),
    writeCoil: (at, value) => it.writeSingleCoil(at, value),
    writeWord: (at, value) => it.writeSingleRegister(at, value),
    writeCoils: (at, values) => it.writeMultipleCoils(at, values),
    writeWords: (at, bytes) => it.writeMultipleRegisters(at, bytes),
    identify: async () => (await body(it.readDeviceIdentification(1, 0))).objects.map(({ value }) => String(value)),
    refusal: problem => problem.response.body.code,
    close: () => socket.destroy(),
  };
}

async function openModbusSerial() {
  const ModbusRTU = require("modbus-serial");
  const it = new ModbusRTU();
  await it.connectTCP("127.0.0.1", { port: Number(port) });
  it.setID(1);
  it.setTimeout(20000);
  const words = bytes => Array.from({ length: bytes.length / 2 }, (_, i) => bytes.readUInt16BE(2 * i));
  return {
    readBits: async (fc, at, count) =>
      (await (fc === 1 ? it.readCoils(at, count) : it.readDiscreteInputs(at, count))).data.slice(0, count),
    readWords: async (fc, at, count) =>
      (await (fc === 3 ? it.readHoldingRegisters(at, count) : it.readInputRegisters(at, count))).buffer,
    writeCoil: (at, value) => it.writeCoil(at, value),
    writeWord: (at, value) => it.writeRegister(at, value),
    writeCoils: (at, values) => it.writeCoils(at, values),
    writeWords: (at, bytes) => it.writeRegisters(at, words(bytes)),
    mask: (at, and, or) => it.maskWriteRegister(at, and, or),
    exchange: async (from, count, at, bytes) =>
      Buffer.from((await it.readWriteRegisters(from, count, at, bytes.length / 2, words(bytes))).data.flatMap(
        word => [word >> 8, word & 255])),
    identify: async () => Object.values((await it.readDeviceIdentification(1, 0)).data),
    refusal: problem => problem.modbusCode,
    close: () => it.close(() => {}),
  };
}

// --- values as registers ---

const codes = {
  int16: ["readInt16BE", "writeInt16BE", 2], uint16: ["readUInt16BE", "writeUInt16BE", 2],
  int32: ["readInt32BE", "writeInt32BE", 4], uint32: ["readUInt32BE", "writeUInt32BE", 4],
  int64: ["readBigInt64BE", "writeBigInt64BE", 8], uint64: ["readBigUInt64BE", "writeBigUInt64BE", 8],
  real32: ["readFloatBE", "writeFloatBE", 4], real64: ["readDoubleBE", "writeDoubleBE", 8],
};

// From the order of the map to that of the network, and back.
function ordered(bytes) {
  if (bytes.length === 2) return bytes;
  const order = map.word_order;
  const words = [];
  for (let i = 0; i < bytes.length; i += 2) words.push(bytes.subarray(i, i + 2));
  if (order === "CDAB" || order === "DCBA") words.reverse();
  const result = Buffer.concat(words);
  return order === "BADC" || order === "DCBA" ? result.swap16() : result;
}

function packed(type, value) {
  const [, write, size] = codes[type];
  const bytes = Buffer.alloc(size);
  bytes[write](size === 8 && type !== "real64" ? BigInt(value) : value);
  return ordered(bytes);
}

function unpacked(type, bytes) {
  return ordered(Buffer.from(bytes))[codes[type][0]]();
}

// --- every point ---

async function readAndChange(client) {
  for (const { name, area, address, registers, type, writable } of map.points) {
    if (type === "boolean") {
      const [value] = await client.readBits(area === "coil" ? 1 : 2, address, 1);
      console.log(name, value ? 1 : 0);
      if (writable) await client.writeCoil(address, !value);
      continue;
    }
    const value = unpacked(type, await client.readWords(area === "holding" ? 3 : 4, address, registers));
    console.log(name, String(value));
    if (writable) {
      const next = typeof value === "bigint" ? value + 1n : value + 1;
      await client.writeWords(address, packed(type, next));
    }
  }
}

// --- every function ---

const addressOf = name => points.get(name).address;

// What is read is the newest cycle: a value that was just written is there from the next one on.
async function eventually(read, wanted) {
  for (const end = Date.now() + 10000; ;) {
    const value = await read();
    if (util.isDeepStrictEqual(value, wanted)) return;
    assert.ok(Date.now() < end, `${value} instead of ${wanted}`);
  }
}

// Numbers of all sizes, the same in every run.
function* reals(count) {
  let state = 12345;
  for (let i = 0; i < count; ++i) {
    state = (Math.imul(state, 1103515245) + 12345) >>> 0;
    yield (state / 2 ** 32 - 0.5) * 10 ** (i % 40 - 20);
  }
}

const functions = {
  async "function 01, 05"(client) {
    for (const value of [true, false, true]) {
      await client.writeCoil(addressOf("B"), value);
      await eventually(() => client.readBits(1, addressOf("B"), 1), [value]);
    }
  },
  async "function 02"(client) {
    for (const value of [true, false]) {
      await client.writeCoil(addressOf("C"), value);
      await eventually(() => client.readBits(2, addressOf("C_BACK"), 1), [value]);
    }
  },
  async "function 15"(client) {
    const at = Math.min(addressOf("B"), addressOf("C"));
    for (const values of [[true, false], [false, true], [true, true]]) {
      await client.writeCoils(at, values);
      await eventually(() => client.readBits(1, at, 2), values);
    }
  },
  async "function 03, 06"(client) {
    for (const value of [0, 1, 0x1234, 0xffff]) {
      await client.writeWord(addressOf("W"), value);
      await eventually(async () => (await client.readWords(3, addressOf("W"), 1)).readUInt16BE(), value);
    }
  },
  async "function 16, 04"(client) {
    for (const value of reals(40)) {
      const whole = Math.trunc((value % 1000) * 1e6) + 0;  // no whole number is -0
      await client.writeWords(addressOf("X"), packed("real64", value));
      await client.writeWords(addressOf("N"), packed("int32", whole));
      await eventually(async () => unpacked("real64", await client.readWords(3, addressOf("X"), 4)), value);
      await eventually(async () => unpacked("int32", await client.readWords(3, addressOf("N"), 2)), whole);
      await eventually(async () => unpacked("real64", await client.readWords(4, addressOf("X_BACK"), 4)), value);
      await eventually(async () => unpacked("int32", await client.readWords(4, addressOf("N_BACK"), 2)), whole);
    }
  },
  async "function 22"(client) {
    if (!client.mask) return "not offered";
    const word = async () => (await client.readWords(3, addressOf("W"), 1)).readUInt16BE();
    await client.writeWord(addressOf("W"), 0x12ff);
    await eventually(word, 0x12ff);  // a mask changes the word of the newest cycle
    await client.mask(addressOf("W"), 0x00f2, 0x0025);
    await eventually(word, (0x12ff & 0x00f2) | (0x0025 & ~0x00f2));
  },
  async "function 23"(client) {
    if (!client.exchange) return "not offered";
    for (const value of reals(20)) {
      await eventually(async () => unpacked("real64",
        await client.exchange(addressOf("X"), 4, addressOf("X"), packed("real64", value))), value);
    }
  },
  async "function 43/14"(client) {
    assert.deepStrictEqual((await client.identify()).slice(0, 2), ["Hysteron", "hysteron-runtime"]);
  },
  async "exceptions 02 and 03"(client) {
    const failing = [[2, () => client.readWords(3, 30000, 1)], [3, () => client.writeWords(addressOf("N"), packed("int32", 2e9))],
                     [2, () => client.writeWords(addressOf("X"), Buffer.alloc(2))], [2, () => client.readBits(1, 30000, 1)]];
    for (const [code, ask] of failing) {
      await assert.rejects(async () => ask(), problem => client.refusal(problem) === code);
    }
  },
};

async function main() {
  const client = await (library === "jsmodbus" ? openJsmodbus() : openModbusSerial());
  if (mode === "points") {
    await readAndChange(client);
  } else {
    for (const [name, run] of Object.entries(functions)) console.log(`${name}: ${(await run(client)) || "ok"}`);
  }
  client.close();
}

main().catch(problem => {
  console.error(problem);
  process.exit(1);
});
