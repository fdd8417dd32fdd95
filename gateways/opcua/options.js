// The command line: what may be said, and what is said of a mistake in it.

import { readFileSync } from "node:fs";
import { isIP } from "node:net";
import { homedir } from "node:os";
import { join } from "node:path";
import { parseArgs } from "node:util";

import { checkOwnerAlone, InputError } from "./users.js";

export const USAGE = `usage:
  hysteron-opcua --task http://127.0.0.1:8080 (--users FILE | --anonymous) [options]
  hysteron-opcua add-user NAME --users FILE [--may-write]      the password comes from standard input

  --task URL           the live page of a task that runs: hysteron serve --web ADDRESS:PORT
  --listen ADDR:PORT   where clients connect (127.0.0.1:4840); beyond the loopback nothing goes in the clear
  --users FILE         who may connect, as add-user writes it
  --anonymous          whoever connects may read
  --token-file FILE    the token of the live page: to write, and to read one beyond the loopback
  --writable           users that may write change parameters: staged, then committed
  --interval TIME      from look to look at the task, 50ms to 60s (250ms): also the shortest sampling interval
  --sessions N         clients at once, 1 to 200 (16)
  --state FOLDER       the certificate, its key, and the clients that are trusted
`;

const OPTIONS = /** @type {const} */ ({
  task: { type: "string" }, listen: { type: "string", default: "127.0.0.1:4840" }, users: { type: "string" },
  anonymous: { type: "boolean", default: false }, "token-file": { type: "string" }, writable: { type: "boolean", default: false },
  interval: { type: "string", default: "250ms" }, sessions: { type: "string", default: "16" }, state: { type: "string" },
  "may-write": { type: "boolean", default: false }, help: { type: "boolean", short: "h", default: false },
});

/** @param {string} text @returns {{address: string, port: number}} */
function endpoint(text) {
  const found = /^(?:\[(.+)\]|([^:]+)):(\d{1,5})$/.exec(text);
  const address = found?.[1] ?? found?.[2] ?? "";
  const port = Number(found?.[3]);
  if (!found || (isIP(address) === 0 && address !== "localhost") || port > 65535) {
    throw new InputError(`--listen ${text}: an address and a port are wanted, as 127.0.0.1:4840 or [::1]:4840.`);
  }
  return { address, port };
}

/** @param {string} text @returns {URL} */
function taskUrl(text) {
  let url;
  try {
    url = new URL(text);
  } catch {
    throw new InputError(`--task ${text}: the address of a live page is wanted, as http://127.0.0.1:8080.`);
  }
  if (url.protocol !== "http:" || url.pathname !== "/" || url.search || url.username) {
    throw new InputError(`--task ${text}: http, an address and a port are wanted, and nothing more. A live page has no TLS; take a tunnel.`);
  }
  return url;
}

/** @param {string} text @returns {number} ms */
function interval(text) {
  const found = /^(\d+(?:\.\d+)?)(ms|s)$/.exec(text);
  const ms = Number(found?.[1]) * (found?.[2] === "s" ? 1000 : 1);
  if (!(ms >= 50 && ms <= 60_000)) {
    throw new InputError(`--interval ${text}: a time from 50ms to 60s is wanted.`);
  }
  return ms;
}

/** @param {string} text @returns {number} */
function sessions(text) {
  const number = Number(text);
  if (!/^\d+$/.test(text) || number < 1 || number > 200) {
    throw new InputError(`--sessions ${text}: a whole number from 1 to 200 is wanted.`);
  }
  return number;
}

/** @param {string} file */
function tokenIn(file) {
  checkOwnerAlone(file);
  const token = readFileSync(file, "utf8").trimEnd();
  if (!/^[\x21-\x7e]{16,256}$/.test(token)) {
    throw new InputError(`${file} is no token: one line of 16 to 256 printable characters without blanks.`);
  }
  return token;
}

function usualState() {
  return process.env.STATE_DIRECTORY
    ?? join(process.env.XDG_STATE_HOME ?? join(homedir(), ".local", "state"), "hysteron-opcua");
}

/** Throws InputError. @param {string[]} args */
export function parseOptions(args) {
  let values, positionals;
  try {
    ({ values, positionals } = parseArgs({ args, options: OPTIONS, allowPositionals: true }));
  } catch (problem) {
    throw new InputError(`${problem.message}\n${USAGE}`);
  }
  if (values.help) return { command: "help" };
  if (positionals[0] === "add-user") {
    if (positionals.length !== 2 || !values.users) {
      throw new InputError(`add-user needs a name and --users FILE.\n${USAGE}`);
    }
    return { command: "add-user", name: positionals[1], users: values.users, may: values["may-write"] ? "write" : "read" };
  }
  if (positionals.length > 0 || values["may-write"]) {
    throw new InputError(`${positionals[0] ?? "--may-write"} is not understood here.\n${USAGE}`);
  }
  if (!values.task) {
    throw new InputError(`--task is missing: the address of the live page of a task that runs.\n${USAGE}`);
  }
  if (!values.users && !values.anonymous) {
    throw new InputError("Nobody could connect. Name users by --users FILE, or let everybody read by --anonymous.");
  }
  if (values.writable && !values["token-file"]) {
    throw new InputError("--writable needs --token-file FILE: the token with which hysteron serve was started.");
  }
  if (values.writable && !values.users) {
    throw new InputError("--writable needs --users FILE: who is anonymous may only read.");
  }
  return {
    command: "serve",
    task: taskUrl(values.task),
    ...endpoint(values.listen),
    users: values.users,
    isAnonymous: values.anonymous,
    token: values["token-file"] ? tokenIn(values["token-file"]) : "",
    isWritable: values.writable,
    interval: interval(values.interval),
    sessions: sessions(values.sessions),
    state: values.state ?? usualState(),
  };
}
