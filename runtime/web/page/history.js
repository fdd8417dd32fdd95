"use strict";
// The last hours of a point from the history of the task: the band from the lowest to the highest value of each place,
// and its mean, drawn by dygraphs. Asked for once, and again on demand: the history is on the disk.

class HistoryView {
  // get: asks the server with the token, where one is needed.
  constructor(get) {
    this.get = get;
    this.graph = null;
    this.asked = 0;
    place("history-form").addEventListener("submit", event => {
      event.preventDefault();
      this.draw();
    });
    for (const id of ["history-point", "history-hours"]) place(id).addEventListener("change", () => this.draw());
    new ResizeObserver(() => this.graph && this.graph.resize()).observe(place("history"));
  }

  build(names) {
    place("history-section").hidden = names.length === 0;
    place("history-point").replaceChildren(...names.map(name => new Option(name, name)));
    if (names.length > 0) this.draw();
  }

  say(text) {
    place("history-note").textContent = text;
  }

  async draw() {
    const point = place("history-point").value, hours = place("history-hours").value;
    const asked = ++this.asked;
    this.say("reading …");
    let trend;
    try {
      const answer = await this.get(`/api/history?point=${encodeURIComponent(point)}&hours=${hours}`);
      trend = await answer.json();
    } catch {
      trend = { refusal: "The server does not answer." };
    }
    if (asked !== this.asked) return;  // another one was asked for meanwhile
    if (trend.refusal !== undefined) return this.say(trend.refusal);
    if (trend.places.length === 0) return this.say(`There is nothing of ${point} in these hours yet.`);
    this.show(point, trend);
  }

  show(point, trend) {
    const label = named(point, trend.unit).trim();
    const rows = [];
    for (const entry of trend.places) {
      if (entry === null) {
        rows.push([new Date(rows[rows.length - 1][0].getTime() + 1), [null, null, null]]);
      } else {
        rows.push([new Date(entry[0]), entry.slice(1)]);
      }
    }
    if (this.graph) this.graph.destroy();
    this.graph = new Dygraph(place("history"), rows, {
      labels: ["time", point],
      customBars: true,
      colors: ["#2f7ed8"],
      strokeWidth: 1.4,
      legend: "never",
      ylabel: label,
      includeZero: false,
      animatedZooms: false,
      gridLineColor: "rgba(128, 128, 128, .28)",
      axisLineColor: "rgba(128, 128, 128, .9)",
      axes: { y: { axisLabelWidth: 66 } },
      yRangePad: 12,
    });
    const thinned = trend.looked_at < trend.rows ? `, ${trend.looked_at} of them looked at: short peaks may be missing` : "";
    const back = trend.set_back > 0 ? ` The wall clock was set back by ${trend.set_back.toFixed(0)} s meanwhile; ` +
      "later rows are shown behind it." : "";
    this.say(`${trend.rows} rows${thinned}.${back}`);
    place("history").dataset.places = rows.length;
  }
}
