#!/usr/bin/env node
// hysteron-opcua: a task that `hysteron serve` runs, as an OPC UA server. A process of its own, which reads the task's
// live page; docs/how-to/opc-ua.md says how it is set up.

import { readFileSync } from "node:fs";
import { setPriority } from "node:os";
import { text } from "node:stream/consumers";

import { parseOptions, USAGE } from "./options.js";
import { TaskLink } from "./task_link.js";
import { addUser, InputError, Users } from "./users.js";

const NICENESS = 10; // whatever runs the machine goes before it, as before the live page

const { version } = JSON.parse(readFileSync(new URL("package.json", import.meta.url), "utf8"));

/** @param {string} line */
function tell(line) {
  process.stderr.write(`${line}\n`);
}

async function serve(options) {
  setPriority(NICENESS);
  const users = options.users ? new Users(options.users, tell) : null;
  // The library is loaded last: a mistake on the command line is told at once.
  const [{ makeServer }, { TaskSpace }] = await Promise.all([import("./server.js"), import("./address_space.js")]);
  const server = await makeServer({ ...options, users, version, tell });
  const link = new TaskLink(options);
  const space = new TaskSpace(server.engine.addressSpace, options, link, tell);
  follow(link, space, options.task);
  await server.start().catch((problem) => {
    throw new InputError(`--listen: ${options.address}:${options.port} cannot be used (${problem.code ?? problem.message}).`);
  });
  tell(`Listening on ${server.getEndpointUrl()}${options.isWritable ? "" : ", read-only"}.`);

  let isEnding = false;
  const end = async () => {
    if (isEnding) return;
    isEnding = true;
    link.stop();
    await server.shutdown(1_000);
    process.exit(0);
  };
  process.on("SIGTERM", end);
  process.on("SIGINT", end);
  await link.run();
}

/** A line for each change, none for each try. */
function follow(link, space, task) {
  let told = "";
  const once = (line) => {
    if (line !== told) tell(line);
    told = line;
  };
  link.on("described", (description, layout) => space.describe(description, layout));
  link.on("values", (values) => {
    space.update(values);
    once(`Linked to ${space.name} at ${task.host}: ${space.size} points, layout ${space.layout.slice(0, 16)}.`);
  });
  link.on("lost", (why) => {
    space.lost();
    once(`No link to the task at ${task.host}: ${why}. Trying again, at last every 10 s.`);
  });
}

async function main() {
  const options = parseOptions(process.argv.slice(2));
  if (options.command === "help") {
    process.stdout.write(USAGE);
  } else if (options.command === "add-user") {
    const password = (await text(process.stdin)).replace(/\r?\n$/, "");
    await addUser(options.users, options.name, password, options.may);
    tell(`${options.name} may ${options.may}, by ${options.users}.`);
  } else {
    await serve(options);
  }
}

main().catch((problem) => {
  tell(`hysteron-opcua: ${problem instanceof InputError ? problem.message : problem.stack}`);
  process.exit(problem instanceof InputError ? 2 : 1);
});
