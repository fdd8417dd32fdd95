#include "diagnosis/report/parts.hpp"

namespace hysteron::diagnosis::report {
namespace {

constexpr std::string_view script = R"js(
const data = JSON.parse(document.getElementById("data").textContent);

function timesOf(time) {
  return time.values ? time.values.map(t => t === null ? NaN : t)
                     : Float64Array.from({ length: time.count }, (_, k) => time.start + k * time.step);
}

function numbers(values) {
  return Float64Array.from(values, value => value === null ? NaN : value);
}

// The first index whose time is not before t.
function indexOf(times, t) {
  let low = 0, high = times.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] < t) low = middle + 1;
    else high = middle;
  }
  return low;
}

// Residuals above, signals below, over the same stretch of time.
function traceFigure(host, trace) {
  const times = timesOf(trace.time);
  const measured = numbers(trace.measured);
  const residuals = [["nominal", "nominal", "nominal"], ["calibrated", "before", "before: calibrated"],
                     ["improved", "after", "after: improved"]]
    .filter(([name]) => trace[name])
    .map(([name, kind, text]) => ({ kind, text, values: numbers(trace[name]), shown: name !== "nominal" }));
  if (residuals.length === 1) residuals[0].shown = true;
  for (const residual of residuals) {
    residual.model = residual.values.map((value, k) => measured[k] + value);
    residual.toggle = () => redraw();
  }
  const floor = trace.floor > 0 && residuals.length > 0;
  const row = keys(host, [...residuals, { kind: "measured", text: "measured" },
                          ...(floor ? [{ kind: "band", text: "noise floor, ± 2 σ" }] : [])]);
  const whole = add(row, "button", { type: "button", className: "whole", textContent: "Whole record", hidden: true });
  add(row, "span", { className: "hint", textContent: "Drag to zoom, double click to see all." });
  const area = add(host, "div", {});
  const readout = add(host, "div", { className: "readout" });
  const full = times.length > 1 ? [times[0], times[times.length - 1]] : [0, 1];
  let view = full, drawnWidth = 0;

  function zoom(to) {
    view = to;
    whole.hidden = view === full;
    redraw();
  }
  whole.addEventListener("click", () => zoom(full));

  function redraw() {
    const width = drawnWidth = Math.max(420, area.clientWidth);
    area.textContent = "";
    const first = Math.max(0, indexOf(times, view[0]) - 1);
    const last = Math.min(times.length, indexOf(times, view[1]) + 2);
    const shown = residuals.filter(residual => residual.shown);
    const frames = [];
    const svg = draw(area, "svg", { class: "zooms", viewBox: `0 0 ${width} 500`, role: "img",
                                    "aria-label": "Residual, measured and model over time" });
    const clip = "clip-" + host.id;
    const definition = draw(draw(svg, "defs", {}), "clipPath", { id: clip });
    draw(definition, "rect", { x: 70, y: 0, width: width - 82, height: 500 });
    function panel(top, bottom, title, curves, wanted, labels) {
      const frame = { left: 70, right: width - 12, top, bottom };
      const range = reach(curves.map(curve => curve.values), first, last, wanted);
      const { x, y } = axes(svg, frame, { x: view, y: range, title, yLabel: named(trace.signal, trace.unit), ...labels });
      const inside = draw(svg, "g", { "clip-path": `url(#${clip})` });
      if (wanted.length === 3) {
        draw(inside, "rect", { class: "band", x: 70, width: width - 82, y: y(wanted[2]), height: y(wanted[0]) - y(wanted[2]) });
      }
      for (const curve of curves) {
        draw(inside, "path", { class: "curve " + curve.kind,
                               d: linePath(times, curve.values, first, last, x, y) });
      }
      frames.push(frame);
    }
    panel(26, 236, "Residual, model − measured", shown,
          floor ? [-2 * trace.floor, 0, 2 * trace.floor] : [0], { numbers: false });
    // The best model alone: more of them would lie on top of each other.
    const best = shown[shown.length - 1];
    panel(272, 456, best ? "Measured and model (" + best.text.replace(/^.*: /, "") + ")" : "Measured",
          [{ kind: "measured", values: measured }, ...(best ? [{ kind: best.kind, values: best.model }] : [])], [],
          { xLabel: "t [s]" });
    pointing(svg, width, frames);
  }

  function pointing(svg, width, frames) {
    const { left, right } = frames[0];
    const top = frames[0].top, bottom = frames[frames.length - 1].bottom;
    const cross = draw(svg, "path", { class: "cross" });
    const select = draw(svg, "rect", { class: "select", y: top, height: bottom - top, width: 0 });
    const timeAt = px => view[0] + (px - left) / (right - left) * (view[1] - view[0]);
    const pixel = event => {
      const box = svg.getBoundingClientRect();
      return Math.min(right, Math.max(left, (event.clientX - box.left) * width / box.width));
    };
    let start = null;
    svg.addEventListener("pointerdown", event => {
      if (event.button !== 0) return;
      start = pixel(event);
      if (event.isTrusted) svg.setPointerCapture(event.pointerId);
    });
    svg.addEventListener("pointermove", event => {
      const at = pixel(event);
      cross.setAttribute("d", `M${at} ${top}V${bottom}`);
      if (start !== null) {
        select.setAttribute("x", Math.min(start, at));
        select.setAttribute("width", Math.abs(at - start));
      }
      const k = Math.min(times.length - 1, indexOf(times, timeAt(at)));
      const said = residuals.filter(residual => residual.shown)
        .map(residual => `${residual.text} ${figure(residual.values[k])}`);
      readout.textContent = k < 0 ? "" : [`t = ${figure(times[k])} s`, `measured ${figure(measured[k])}`, ...said].join(" · ");
    });
    svg.addEventListener("pointerup", event => {
      if (start === null) return;
      const ends = [timeAt(start), timeAt(pixel(event))].sort((a, b) => a - b);
      const wide = Math.abs(pixel(event) - start) > 5;
      start = null;
      select.setAttribute("width", 0);
      if (wide && indexOf(times, ends[1]) - indexOf(times, ends[0]) > 1) zoom(ends);
    });
    svg.addEventListener("pointercancel", () => { start = null; select.setAttribute("width", 0); });
    svg.addEventListener("pointerleave", () => { cross.setAttribute("d", ""); readout.textContent = ""; });
    svg.addEventListener("dblclick", () => zoom(full));
  }

  redraw();
  new ResizeObserver(() => {
    if (area.clientWidth > 0 && Math.max(420, area.clientWidth) !== drawnWidth) redraw();
  }).observe(area);
}

// One small plot a map, those that explain most first.
function mapFigures(host, maps, unit) {
  keys(host, [{ kind: "before", text: "before: calibrated, RMS" }, { kind: "after", text: "after: improved, RMS" },
              { kind: "mean", text: "before: mean" }]);
  const grid = add(host, "div", { className: "mosaic" });
  for (const map of [...maps].sort((a, b) => b.share - a.share)) {
    const cell = add(grid, "div", { className: "map" });
    const svg = draw(cell, "svg", { viewBox: "0 0 300 234", role: "img", "aria-label": "Residual over " + map.over });
    const places = numbers(map.places);
    const curves = [["mean", map.mean], ["before", map.before], ["after", map.after]]
      .map(([kind, values]) => ({ kind, values: numbers(values) }));
    const finite = [...places].filter(Number.isFinite);
    const log = finite.length > 2 && Math.min(...finite) > 0 && Math.max(...finite) > 100 * Math.min(...finite);
    const x = log ? [Math.min(...finite), Math.max(...finite)] : reach([places], 0, places.length, []);
    const scale = axes(svg, { left: 62, right: 292, top: 42, bottom: 190 },
                       { x, y: reach(curves.map(curve => curve.values), 0, places.length, [0]), log,
                         xLabel: named(map.over, map.unit), yLabel: named("residual", unit) });
    const explained = 100 * map.share;
    draw(svg, "text", { class: "title", x: 4, y: 15 }, "over " + map.over);
    draw(svg, "text", { class: "explained", x: 4, y: 31 },
         `mean explains ${explained < 9.95 ? explained.toFixed(1) : explained.toFixed(0)} %`);
    for (const curve of curves) {
      let path = "", penDown = false;
      for (let k = 0; k < Math.min(places.length, curve.values.length); ++k) {
        const ok = Number.isFinite(places[k]) && Number.isFinite(curve.values[k]);
        if (ok) path += `${penDown ? "L" : "M"}${scale.x(places[k]).toFixed(1)} ${scale.y(curve.values[k]).toFixed(1)}`;
        if (ok && curve.kind !== "mean") {
          draw(svg, "circle", { class: "dot " + curve.kind, cx: scale.x(places[k]), cy: scale.y(curve.values[k]), r: 2.2 });
        }
        penDown = ok;
      }
      draw(svg, "path", { class: "curve " + curve.kind, d: path });
    }
  }
}

function commandFigure(host, next) {
  const times = timesOf(next.time), values = numbers(next.values);
  const redraw = () => {
    const width = Math.max(420, host.clientWidth);
    host.textContent = "";
    const svg = draw(host, "svg", { viewBox: `0 0 ${width} 250`, role: "img", "aria-label": "Command over time" });
    const { x, y } = axes(svg, { left: 70, right: width - 12, top: 14, bottom: 206 },
                          { x: times.length > 1 ? [times[0], times[times.length - 1]] : [0, 1],
                            y: reach([values], 0, values.length, []), xLabel: "t [s]",
                            yLabel: named(next.input, next.unit) });
    draw(svg, "path", { class: "curve after", d: linePath(times, values, 0, times.length, x, y) });
  };
  redraw();
  let width = host.clientWidth;
  new ResizeObserver(() => {
    if (host.clientWidth > 0 && host.clientWidth !== width) {
      width = host.clientWidth;
      redraw();
    }
  }).observe(host);
}

let figures = 0;
data.traces.forEach((trace, i) => {
  const host = document.getElementById("trace-" + i);
  const frame = host.closest("details");
  let drawn = false;
  const show = () => {
    if (frame.open && !drawn) {
      drawn = true;
      traceFigure(host, trace);
    }
  };
  frame.addEventListener("toggle", show);
  show();
  figures += drawn ? 1 : 0;
});
window.addEventListener("beforeprint", () => {
  document.querySelectorAll("details.trace").forEach((frame, i) => { if (i < 4) frame.open = true; });
});
const maps = document.getElementById("maps");
if (maps) {
  mapFigures(maps, data.maps, data.unit);
  figures += data.maps.length;
}
const next = document.getElementById("next");
if (next) {
  commandFigure(next, data.next);
  ++figures;
}
document.documentElement.dataset.figures = figures;
)js";

}  // namespace

std::string_view page_script() {
  return script;
}

}  // namespace hysteron::diagnosis::report
