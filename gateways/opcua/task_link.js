// The link to a running task: its live page's answers, asked for again and again. A task that is not there is asked
// for with pauses that grow. Nothing here knows OPC UA.
//
// A new connection may lead to another task than the one before: what there is to be seen is then asked for anew. So a
// task that was started again is noticed however fast it came back.

import { createHash } from "node:crypto";
import { EventEmitter } from "node:events";
import http from "node:http";

const TIMEOUT = 5_000; // ms for an answer
const LONGEST_ANSWER = 64 * 1024 * 1024; // bytes; a picture of a large diagram is in the description
const FIRST_PAUSE = 250; // ms
const LONGEST_PAUSE = 10_000; // ms

/** What a task answered, where that was no 200. */
export class Refused extends Error {
  /** @param {number} status @param {string} words the task's own */
  constructor(status, words) {
    super(words);
    this.status = status;
  }
}

/** What a task answered, where that cannot be used. */
export class Unfit extends Error {}

/**
 * Events: "described" (description, layout), "values" (values), "lost" (why).
 * The layout is a hash of what a point is called, is of, and may be: equal for tasks that look the same.
 */
export class TaskLink extends EventEmitter {
  #base;
  #token;
  #interval;
  #agent = new http.Agent({ keepAlive: true, maxSockets: 1 });
  #stop = new AbortController();
  #isKnown = false;
  #version = 0; // of the diagram that was described; an online change begins another
  #looking = Promise.resolve();

  /** @param {{task: URL, token: string, interval: number}} options the interval in ms */
  constructor({ task, token, interval }) {
    super();
    this.#base = task;
    this.#token = token;
    this.#interval = interval;
  }

  async run() {
    let pause = FIRST_PAUSE;
    while (!this.#stop.signal.aborted) {
      try {
        await this.#look();
        pause = FIRST_PAUSE;
        await this.#sleep(this.#interval);
      } catch (problem) {
        if (this.#stop.signal.aborted) break;
        if (!(problem instanceof Unfit || problem instanceof Refused || problem.isOfLink)) throw problem; // a fault of ours
        this.#isKnown = false;
        this.emit("lost", reasonOf(problem));
        await this.#sleep(pause);
        pause = Math.min(2 * pause, LONGEST_PAUSE);
      }
    }
  }

  stop() {
    this.#stop.abort();
    this.#agent.destroy();
  }

  /** @param {Record<string, number | boolean>} values of parameters by name. Throws Refused. */
  async stage(values) {
    await this.#order("/api/stage", JSON.stringify(values));
  }

  async commit() {
    await this.#order("/api/commit");
  }

  async discard() {
    await this.#order("/api/discard");
  }

  /** What follows from an order is seen before its answer is given. @param {string} path @param {string} [body] */
  async #order(path, body) {
    await this.#ask("POST", path, body);
    await this.#look().catch(() => {}); // the order was taken; that the task is lost now, the next look tells
  }

  /** One look after the other. */
  #look() {
    const look = this.#looking.then(() => this.#lookNow());
    this.#looking = look.catch(() => {});
    return look;
  }

  /** Of a task that is known, its values; the description before them where the connection or the version is another. */
  async #lookNow() {
    for (let isSecondTry = false; ; isSecondTry = true) {
      try {
        if (await this.#lookOnce()) return;
      } catch (problem) {
        // A connection that waited may be closed by the other side as a request is on its way.
        if (!problem.wasWaiting || isSecondTry) throw problem;
      }
      this.#isKnown = false;
    }
  }

  /** Whether the values are of the task that was described. */
  async #lookOnce() {
    if (!this.#isKnown) {
      const { body } = await this.#ask("GET", "/api/description");
      const description = parsed(body);
      this.#isKnown = true;
      this.#version = description.version;
      this.emit("described", description, layoutOf(description));
    }
    const { body, isSameConnection } = await this.#ask("GET", "/api/values");
    const values = isSameConnection ? parsed(body) : null;
    if (values === null || values.version !== this.#version) return false;
    this.emit("values", values);
    return true;
  }

  /** @param {number} ms */
  #sleep(ms) {
    const { signal } = this.#stop;
    return new Promise((done) => {
      const wake = () => {
        clearTimeout(timer);
        signal.removeEventListener("abort", wake);
        done(undefined);
      };
      const timer = setTimeout(wake, ms);
      signal.addEventListener("abort", wake);
      if (signal.aborted) wake();
    });
  }

  /**
   * @param {string} method @param {string} path @param {string} [body]
   * @returns {Promise<{body: string, isSameConnection: boolean}>}
   */
  #ask(method, path, body) {
    return new Promise((resolve, reject) => {
      const request = http.request(new URL(path, this.#base), {
        method,
        // Orders go by a connection of their own: one that waited may end as the order is sent, and none is sent twice.
        agent: method === "GET" ? this.#agent : false,
        headers: this.#token ? { Authorization: `Bearer ${this.#token}` } : {},
        signal: AbortSignal.any([this.#stop.signal, AbortSignal.timeout(TIMEOUT)]),
      });
      request.on("error", (problem) => {
        const wasWaiting = request.reusedSocket && problem.code === "ECONNRESET";
        reject(Object.assign(problem, { isOfLink: true, wasWaiting }));
      });
      request.on("response", (answer) => {
        const parts = [];
        let bytes = 0;
        answer.on("data", (part) => {
          parts.push(part);
          bytes += part.length;
          if (bytes > LONGEST_ANSWER) request.destroy(new Error(`the answer to ${path} is too long`));
        });
        answer.on("error", (problem) => reject(Object.assign(problem, { isOfLink: true })));
        answer.on("end", () => {
          const text = Buffer.concat(parts).toString("utf8");
          if (answer.statusCode === 200) {
            resolve({ body: text, isSameConnection: request.reusedSocket });
          } else {
            reject(new Refused(answer.statusCode ?? 0, refusalIn(text)));
          }
        });
      });
      request.end(body);
    });
  }
}

/** @param {string} text */
function refusalIn(text) {
  try {
    return String(JSON.parse(text).refusal);
  } catch {
    return "The answer is none of a live page.";
  }
}

/** @param {string} text */
function parsed(text) {
  try {
    return JSON.parse(text);
  } catch {
    throw new Unfit("its answer is no JSON; is it a live page?");
  }
}

/** @param {any} problem */
function reasonOf(problem) {
  if (problem instanceof Refused) return `it answers ${problem.status}: ${problem.message}`;
  if (problem.name === "TimeoutError") return `it gave no answer for ${TIMEOUT / 1000} s`;
  return problem.code ?? problem.message;
}

/** @param {any} description */
function layoutOf({ name, period, points, inner, writable }) {
  return createHash("sha256").update(JSON.stringify([name, period, points, inner, writable])).digest("hex");
}
