"use strict";
// The newest values of all signals, and their curves: one plot for each unit, drawn by dygraphs.

const span = 60;        // seconds that are shown
const redraws = 200;    // milliseconds between two drawings
const mostRows = 1300;  // a little more than the span at 20 values a second

// dygraphs' own legend writes styles into the page, which the page's policy forbids, even where it is not shown.
Dygraph.PLUGINS = Dygraph.PLUGINS.filter(plugin => plugin !== Dygraph.Plugins.Legend);

const truths = "TRUE is 1";
const truthTicks = [{ v: 0, label: "FALSE" }, { v: 1, label: "TRUE" }];

// Of Okabe and Ito.
const colours = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"];

function named(name, unit) {
  return unit === "" || unit === "1" ? name : `${name} [${unit}]`;
}

// A value as it is shown while it moves: as many digits at any time.
function shown(value, type) {
  if (value === null || value === undefined) return "NaN";
  if (type === "boolean") return value !== 0 ? "TRUE" : "FALSE";
  if (type === "integer") return String(value);
  if (value === 0) return "0.0000";
  const size = Math.abs(value);
  return size >= 1e-3 && size < 1e5 ? value.toFixed(Math.max(0, 4 - Math.max(0, Math.floor(Math.log10(size)))))
                                    : value.toExponential(3);
}

class Trends {
  // signals: {key, name, unit, type}; a row is a time and a value for each of them.
  constructor(host, signals) {
    this.host = host;
    this.signals = signals;
    this.rows = [];
    this.chosen = new Set();
    this.forced = new Set();  // keys
    this.plots = [];
    this.window = null;  // what was zoomed to; null: the newest values
    this.pointed = null;
    setInterval(() => this.draw(), redraws);
    new ResizeObserver(() => this.plots.forEach(({ graph }) => graph.resize())).observe(host);
  }

  add(time, values) {
    const last = this.rows[this.rows.length - 1];
    if (last && time < last[0]) this.rows = [];  // the task began anew
    if (last && time === last[0]) return;
    this.rows.push([time, ...values]);
    if (this.rows.length > mostRows) this.rows.splice(0, this.rows.length - mostRows);
    this.write();
  }

  // Other signals, as after an online change: those that stay keep their curves.
  change(signals) {
    const places = signals.map(({ key }) => this.signals.findIndex(signal => signal.key === key));
    this.rows = this.rows.map(row => [row[0], ...places.map(place => place < 0 ? null : row[1 + place])]);
    this.signals = signals;
    const known = new Set(signals.map(({ key }) => key));
    this.chosen = new Set([...this.chosen].filter(key => known.has(key)));
    this.layOut();
  }

  choose(keys) {
    this.chosen = new Set(keys);
    this.layOut();
  }

  toggle(key) {
    if (!this.chosen.delete(key)) this.chosen.add(key);
    this.layOut();
  }

  layOut() {
    for (const plot of this.plots) plot.graph.destroy();
    this.host.textContent = "";
    this.plots = [];
    const groups = new Map();
    this.signals.forEach((signal, index) => {
      if (!this.chosen.has(signal.key)) return;
      const group = signal.type === "boolean" ? truths : signal.unit;
      groups.set(group, [...(groups.get(group) || []), index]);
    });
    let colour = 0;
    for (const [group, members] of groups) {
      const isLast = this.plots.length === groups.size - 1;
      this.plots.push(this.plot(group, members.map(index => [index, colour++]), isLast));
    }
    if (this.plots.length === 0) this.host.textContent = "No signal is chosen.";
    this.draw();
  }

  plot(group, members, isLast) {
    const keys = this.host.appendChild(document.createElement("div"));
    keys.className = "keys";
    const values = members.map(([index, colour]) => {
      const key = keys.appendChild(document.createElement("span"));
      const line = key.appendChild(document.createElement("i"));
      line.style.borderColor = colours[colour % colours.length];
      key.append(named(this.signals[index].name, this.signals[index].unit) + " = ");
      return key.appendChild(document.createElement("b"));
    });
    const area = this.host.appendChild(document.createElement("div"));
    area.className = "plot";
    const isTruth = group === truths;
    area.classList.toggle("truths", isTruth);
    const names = members.map(([index]) => this.signals[index].name);
    const graph = new Dygraph(area, this.columns(members), {
      labels: ["t", ...members.map(([index]) => this.signals[index].key)],
      colors: members.map(([, colour]) => colours[colour % colours.length]),
      strokeWidth: 1.8,
      legend: "never",
      xlabel: isLast ? "time since the task's start [s]" : "",
      ylabel: isTruth ? names.join(", ") : named(names.length === 1 ? names[0] : "", group).trim() || names.join(", "),
      stepPlot: isTruth,
      valueRange: isTruth ? [-0.1, 1.1] : null,
      includeZero: false,
      animatedZooms: false,
      gridLineColor: "rgba(128, 128, 128, .28)",
      axisLineColor: "rgba(128, 128, 128, .9)",
      axes: { y: isTruth ? { axisLabelWidth: 66, ticker: () => truthTicks } : { axisLabelWidth: 66 } },
      yRangePad: 12,
      zoomCallback: (low, high) => { this.window = [low, high]; },
      highlightCallback: (event, x, points, row) => { this.pointed = x; },
      unhighlightCallback: () => { this.pointed = null; },
    });
    area.addEventListener("dblclick", () => { this.window = null; });
    return { graph, members, values };
  }

  columns(members) {
    const rows = this.rows.map(row => [row[0], ...members.map(([index]) => row[1 + index])]);
    return rows.length > 0 ? rows : [[0, ...members.map(() => null)]];
  }

  // The newest values, or those under the pointer, beside their names.
  write() {
    const newest = this.rows[this.rows.length - 1];
    const at = this.pointed === null ? newest : this.rows.find(row => row[0] >= this.pointed) || newest;
    for (const { members, values } of this.plots) {
      members.forEach(([index], k) => {
        values[k].textContent = shown(at[1 + index], this.signals[index].type) +
          (this.forced.has(this.signals[index].key) ? " (forced)" : "");
      });
    }
  }

  draw() {
    const newest = this.rows[this.rows.length - 1];
    if (!newest) return;
    const view = this.window || [Math.max(this.rows[0][0], newest[0] - span), Math.max(newest[0], this.rows[0][0] + 1)];
    for (const { graph, members } of this.plots) graph.updateOptions({ file: this.columns(members), dateWindow: view });
  }
}
