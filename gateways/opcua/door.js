// Who is at the door: connections without a session. They cost a place each, and no word from them is needed to hold it.
//
// A guest has some time to become a session. Where all places of guests are taken, one goes for each that comes: who has
// said nothing first, then who comes from the address with the most guests, then who has been there longest. So silent
// connections keep nobody out, and a crowd from one address keeps out none from another.
//
// What a connection sends ends that connection at most. The library throws out of the event of a socket where a chunk is
// longer than was agreed, and an exception there would end the process.

import { subscribe } from "node:diagnostics_channel";

export class Door {
  /** @type {Map<import("node:net").Socket, NodeJS.Timeout>} the oldest first */
  #guests = new Map();
  /** @type {Map<import("node:net").Socket, Set<object>>} the sessions of every open connection */
  #open = new Map();

  /**
   * @param {{guests: number, patience: number, tell?: (line: string) => void}} options so many at once; ms until a guest has
   *   to have a session; what is told of who is ended for what it sent
   */
  constructor({ guests, patience, tell = () => {} }) {
    this.most = guests;
    this.patience = patience;
    this.tell = tell;
  }

  /** Sockets that this process accepts at a port. @param {() => number} port */
  watch(port) {
    subscribe("net.server.socket", ({ socket }) => {
      if (socket.localPort === port()) this.admit(socket);
    });
  }

  get guests() {
    return this.#guests.size;
  }

  /** @param {import("node:net").Socket} socket */
  admit(socket) {
    this.#endAlone(socket);
    while (this.#guests.size >= this.most) this.#pushOut();
    this.#open.set(socket, new Set());
    this.#welcome(socket);
    socket.once("close", () => {
      this.#forget(socket);
      this.#open.delete(socket);
    });
  }

  /**
   * A session is active on a connection.
   * @param {object} session
   * @param {{remoteAddress?: string, remotePort?: number} | undefined} channel none: its connection is closed already
   */
  seat(session, channel) {
    this.leave(session);
    if (!channel) return;
    for (const [socket, sessions] of this.#open) {
      if (socket.remotePort === channel.remotePort && socket.remoteAddress === channel.remoteAddress) {
        sessions.add(session);
        this.#forget(socket);
      }
    }
  }

  /** A session has ended, or goes on elsewhere: without another one its connection is a guest's. @param {object} session */
  leave(session) {
    for (const [socket, sessions] of this.#open) {
      if (sessions.delete(session) && sessions.size === 0) this.#welcome(socket);
    }
  }

  /** An exception while an event of the socket is handled ends the socket, and nothing else. */
  #endAlone(socket) {
    const emit = socket.emit.bind(socket);
    socket.emit = (event, ...what) => {
      try {
        return emit(event, ...what);
      } catch (problem) {
        this.tell(`${socket.remoteAddress}: its connection is ended for what it sent (${problem.message}).`);
        socket.destroy();
        return true;
      }
    };
  }

  #welcome(socket) {
    this.#guests.set(socket, setTimeout(() => socket.destroy(), this.patience).unref());
  }

  #forget(socket) {
    clearTimeout(this.#guests.get(socket));
    this.#guests.delete(socket);
  }

  #pushOut() {
    const all = [...this.#guests.keys()];
    const from = new Map();
    for (const { remoteAddress } of all) from.set(remoteAddress, (from.get(remoteAddress) ?? 0) + 1);
    const most = Math.max(...from.values());
    const socket = all.find(({ bytesRead }) => bytesRead === 0) ?? all.find(({ remoteAddress }) => from.get(remoteAddress) === most);
    this.#forget(socket); // now: its "close" comes later
    socket.destroy();
  }
}
