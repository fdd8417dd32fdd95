// Users and their passwords, in a file of their own: {"anna": {"may": "read", "password": "scrypt:16384:8:1:SALT:HASH"}}.
// It is read again when it changed, so that a user who was taken out is out.

import { randomBytes, scrypt, timingSafeEqual } from "node:crypto";
import { readFileSync, renameSync, statSync, writeFileSync } from "node:fs";
import { promisify } from "node:util";

const derive = promisify(scrypt);
const COST = { N: 16384, r: 8, p: 1 }; // 16 MiB and some 50 ms a try
const BYTES = 32;
const MOST_AT_ONCE = 4; // tries; each takes memory and a thread
const PENALTY = 500; // ms, after a wrong password
const LOOK_EVERY = 500; // ms: rights are asked for with each value that is read
export const SHORTEST_PASSWORD = 8;
const RIGHTS = ["read", "write"];

/** A fault of the user's, to be shown without a stack. */
export class InputError extends Error {}

/** Refuses a secret that others may read, as the token file of `hysteron serve` is refused. @param {string} file */
export function checkOwnerAlone(file) {
  let mode;
  try {
    mode = statSync(file).mode;
  } catch (problem) {
    throw new InputError(`${file} cannot be read (${problem.code}).`);
  }
  if (mode & 0o077) {
    throw new InputError(`${file} may be read by others. Run: chmod 600 ${file}`);
  }
}

/** @param {string} password @param {Buffer} salt */
async function hashed(password, salt, { N, r, p } = COST) {
  return derive(password, salt, BYTES, { N, r, p, maxmem: 256 * N * r });
}

/** @param {string} file @returns {Record<string, {may: string, password: string}>} */
function parsed(file) {
  checkOwnerAlone(file);
  let users;
  try {
    users = JSON.parse(readFileSync(file, "utf8"));
  } catch (problem) {
    throw new InputError(`${file} is no JSON: ${problem.message}. Make it by: hysteron-opcua add-user NAME --users ${file}`);
  }
  if (users === null || typeof users !== "object" || Array.isArray(users)) {
    throw new InputError(`${file} is no JSON object of users. Make it by: hysteron-opcua add-user NAME --users ${file}`);
  }
  for (const [name, user] of Object.entries(users)) {
    if (!RIGHTS.includes(user?.may) || !decoded(user?.password)) {
      throw new InputError(`${file}: the user ${name} has no "may" of ${RIGHTS.join(", ")}, or no "password" that add-user wrote.`);
    }
  }
  return users;
}

/** @param {unknown} text */
function decoded(text) {
  const [kind, N, r, p, salt, hash] = typeof text === "string" ? text.split(":") : [];
  const cost = { N: Number(N), r: Number(r), p: Number(p) };
  const known = kind === "scrypt" && cost.N === COST.N && cost.r === COST.r && cost.p === COST.p;
  const bytes = { salt: Buffer.from(salt ?? "", "base64"), hash: Buffer.from(hash ?? "", "base64") };
  return known && bytes.salt.length >= 16 && bytes.hash.length === BYTES ? { ...cost, ...bytes } : null;
}

/**
 * Adds a user or gives one another password and right; the file is there whole or as before.
 * @param {string} file @param {string} name @param {string} password @param {string} may
 */
export async function addUser(file, name, password, may) {
  if (!/^[^\s\p{C}]{1,64}$/u.test(name) || name === "anonymous" || name === "__proto__") {
    throw new InputError(`"${name}" is no name of a user: 1 to 64 printable characters without blanks, and not "anonymous".`);
  }
  if (password.length < SHORTEST_PASSWORD) {
    throw new InputError(`The password has ${password.length} characters; it must have ${SHORTEST_PASSWORD} at least.`);
  }
  let users = {};
  try {
    statSync(file);
    users = parsed(file);
  } catch (problem) {
    if (problem.code !== "ENOENT") throw problem;
  }
  const salt = randomBytes(16);
  const hash = await hashed(password, salt);
  users[name] = { may, password: ["scrypt", COST.N, COST.r, COST.p, salt.toString("base64"), hash.toString("base64")].join(":") };
  const beside = `${file}.${process.pid}`;
  writeFileSync(beside, JSON.stringify(users, null, 2) + "\n", { mode: 0o600, flag: "wx", flush: true });
  renameSync(beside, file);
}

export class Users {
  #file;
  #tell;
  #users;
  #version = "";
  #trying = 0;
  #lookEvery;
  #next = 0;

  /** Throws InputError where the file cannot be used. @param {string} file @param {(line: string) => void} tell */
  constructor(file, tell, lookEvery = LOOK_EVERY) {
    this.#file = file;
    this.#tell = tell;
    this.#lookEvery = lookEvery;
    this.#users = parsed(file);
    this.#version = this.#versionNow();
    if (Object.keys(this.#users).length === 0) {
      throw new InputError(`${file} has no users. Add one by: hysteron-opcua add-user NAME --users ${file}`);
    }
  }

  #versionNow() {
    const { mtimeMs, size, ino } = statSync(this.#file, { throwIfNoEntry: false }) ?? {};
    return `${mtimeMs} ${size} ${ino}`;
  }

  /** Who cannot be read lets nobody in: what the file said before may be what was to be taken back. */
  #current() {
    const now = performance.now();
    if (now < this.#next) return this.#users;
    this.#next = now + this.#lookEvery;
    const version = this.#versionNow();
    if (version !== this.#version) {
      this.#version = version;
      try {
        this.#users = parsed(this.#file);
        this.#tell(`Users: ${this.#file} was read again.`);
      } catch (problem) {
        this.#users = {};
        this.#tell(`Users: nobody is let in until this is mended: ${problem.message}`);
      }
    }
    return this.#users;
  }

  /** @param {string} name @returns {string} "read", "write", or "" for who is not known */
  rightOf(name) {
    const users = this.#current();
    return Object.hasOwn(users, name) ? users[name].may : "";
  }

  /** Takes as long for a name that is not known. @param {string} name @param {string} password @returns {Promise<boolean>} */
  async isPassword(name, password) {
    if (this.#trying >= MOST_AT_ONCE) return false;
    this.#trying += 1;
    try {
      const users = this.#current();
      const user = Object.hasOwn(users, name) ? decoded(users[name].password) : null;
      const wanted = user ?? { ...COST, salt: randomBytes(16), hash: Buffer.alloc(BYTES) };
      const given = await hashed(password, wanted.salt, wanted);
      const is = timingSafeEqual(given, wanted.hash) && user !== null;
      if (!is) {
        await new Promise((done) => setTimeout(done, PENALTY));
      }
      return is;
    } finally {
      this.#trying -= 1;
    }
  }
}
