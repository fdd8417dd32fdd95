// When a snapshot was taken, on this machine's clock. A task counts periods by its own clock and asks no wall clock, so
// the time follows from its count: start + elapsed · period. What is seen may be old, and is never newer: of all starts
// that follow from a snapshot, the earliest is the true one. Two machines' clocks drift apart, so the start may move on.

const DRIFT = 2e-4; // of two machines' clocks; ten times what a quartz does

export class SourceTime {
  #period;
  #steady;
  #wall;
  #start = Infinity;
  #looked = 0;

  /**
   * @param {number} period of the task, in seconds
   * @param {() => number} steady milliseconds of a clock that nobody sets
   * @param {() => number} wall milliseconds since 1970
   */
  constructor(period, steady = () => performance.now(), wall = () => Date.now()) {
    this.#period = period * 1000;
    this.#steady = steady;
    this.#wall = wall;
  }

  /** @param {number} elapsed periods, as task.elapsed @returns {Date} */
  of(elapsed) {
    const now = this.#steady();
    this.#start = Math.min(this.#start + DRIFT * (now - this.#looked), now - elapsed * this.#period);
    this.#looked = now;
    return new Date(this.#wall() - (now - this.#start - elapsed * this.#period));
  }
}
