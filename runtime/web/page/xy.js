"use strict";
// One signal over another: the path of the last seconds, and where it is now.

const margin = { left: 62, right: 14, top: 10, bottom: 40 };

// Round numbers within a range: 1, 2 or 5 times a power of ten apart.
function ticks(low, high, most) {
  const rough = (high - low) / most;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map(factor => factor * power).find(size => size >= rough);
  const list = [];
  for (let k = Math.ceil(low / step); k * step <= high; ++k) list.push(Number((k * step).toPrecision(12)));
  return list;
}

class XyView {
  constructor() {
    this.canvas = place("xy");
    this.trends = null;
    for (const id of ["xy-up", "xy-across"]) place(id).addEventListener("change", () => this.draw());
    setInterval(() => this.draw(), redraws);
    new ResizeObserver(() => this.draw()).observe(this.canvas);
  }

  // Every signal of the trends that is a number, by its name once: an output is a signal of the diagram, too. First an output over an input, where there are both.
  build(trends) {
    this.trends = trends;
    const known = new Set();
    const signals = trends.signals.map((signal, at) => ({ ...signal, at })).filter(signal =>
      signal.type !== "boolean" && known.size < known.add(signal.name.toUpperCase()).size);
    const choose = (id, preferred) => {
      const before = place(id).selectedOptions[0]?.textContent;
      place(id).replaceChildren(...signals.map(signal => new Option(named(signal.name, signal.unit), signal.at)));
      const again = [...place(id).options].findIndex(option => option.textContent === before);
      place(id).selectedIndex = again >= 0 ? again : Math.max(0, signals.indexOf(preferred));
    };
    const outputs = signals.filter(signal => signal.kind === "output");
    choose("xy-up", outputs[outputs.length > 1 ? 1 : 0]);
    choose("xy-across", outputs.length > 1 ? outputs[0] : signals.find(signal => signal.kind === "input"));
    place("xy-section").hidden = signals.length < 2;
  }

  range(values) {
    const low = Math.min(...values), high = Math.max(...values);
    const pad = high > low ? 0.05 * (high - low) : Math.max(1e-12, 0.05 * Math.abs(high));
    return [low - pad, high + pad];
  }

  draw() {
    if (this.trends === null || place("xy-section").hidden) return;
    const across = Number(place("xy-across").value), up = Number(place("xy-up").value);
    const newest = this.trends.rows[this.trends.rows.length - 1];
    const points = this.trends.rows.filter(row => row[0] >= newest[0] - span)
      .map(row => [row[1 + across], row[1 + up]]).filter(([x, y]) => Number.isFinite(x) && Number.isFinite(y));
    const ratio = window.devicePixelRatio || 1;
    const width = this.canvas.clientWidth, height = this.canvas.clientHeight;
    this.canvas.width = width * ratio;
    this.canvas.height = height * ratio;
    this.canvas.dataset.points = points.length;
    if (points.length === 0 || width === 0) return;
    const pen = this.canvas.getContext("2d");
    pen.scale(ratio, ratio);
    const style = getComputedStyle(document.body);
    const [left, right] = this.range(points.map(([x]) => x)), [low, high] = this.range(points.map(([, y]) => y));
    const x = value => margin.left + (value - left) / (right - left) * (width - margin.left - margin.right);
    const y = value => height - margin.bottom - (value - low) / (high - low) * (height - margin.top - margin.bottom);
    pen.font = "12.5px " + style.fontFamily;
    pen.fillStyle = style.color;
    pen.strokeStyle = "rgba(128, 128, 128, .28)";
    pen.textAlign = "center";
    for (const value of ticks(left, right, Math.max(2, width / 110))) {
      pen.strokeRect(x(value), margin.top, 0, height - margin.top - margin.bottom);
      pen.fillText(String(value), x(value), height - margin.bottom + 16);
    }
    pen.fillText(place("xy-across").selectedOptions[0].textContent, (margin.left + width) / 2, height - 6);
    pen.textAlign = "right";
    for (const value of ticks(low, high, 6)) {
      pen.strokeRect(margin.left, y(value), width - margin.left - margin.right, 0);
      pen.fillText(String(value), margin.left - 6, y(value) + 4);
    }
    pen.save();
    pen.translate(13, (height - margin.bottom) / 2);
    pen.rotate(-Math.PI / 2);
    pen.textAlign = "center";
    pen.fillText(place("xy-up").selectedOptions[0].textContent, 0, 0);
    pen.restore();
    pen.strokeStyle = pen.fillStyle = colours[0];
    pen.lineWidth = 1.6;
    pen.beginPath();
    points.forEach(([px, py], k) => k === 0 ? pen.moveTo(x(px), y(py)) : pen.lineTo(x(px), y(py)));
    pen.stroke();
    const [px, py] = points[points.length - 1];
    pen.beginPath();
    pen.arc(x(px), y(py), 4.5, 0, 2 * Math.PI);
    pen.fill();
  }
}
