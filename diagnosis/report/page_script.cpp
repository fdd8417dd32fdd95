#include "diagnosis/report/parts.hpp"

namespace hysteron::diagnosis::report {
namespace {

constexpr std::string_view script = R"js(
const data = JSON.parse(document.getElementById("data").textContent);

// Residuals above, signals below, over the same stretch of time.
function traceFigure(host, trace) {
  const times = timesOf(trace.time);
  const measured = numbers(trace.measured);
  const residuals = [["nominal", "nominal", "nominal"], ["calibrated", "before", "before: calibrated"],
                     ["improved", "after", "after: improved"]]
    .filter(([name]) => trace[name])
    .map(([name, kind, text]) => ({ kind, text, x: times, y: numbers(trace[name]), shown: name !== "nominal" }));
  if (residuals.length === 1) residuals[0].shown = true;
  for (const residual of residuals) residual.model = residual.y.map((value, k) => measured[k] + value);
  const floor = trace.floor > 0 && residuals.length > 0;
  const label = named(trace.signal, trace.unit);
  zoomFigure(host, {
    name: "Residual, measured and model over time",
    entries: [...residuals, { kind: "measured", text: "measured" },
              ...(floor ? [{ kind: "band", text: "noise floor, ± 2 σ" }] : [])],
    x: times.length > 1 ? [times[0], times[times.length - 1]] : [0, 1],
    xLabel: "t [s]",
    panels: () => {
      const shown = residuals.filter(residual => residual.shown);
      // The best model alone: more of them would lie on top of each other.
      const best = shown[shown.length - 1];
      return [
        { title: "Residual, model − measured", yLabel: label, height: 210, curves: shown,
          wanted: floor ? [-2 * trace.floor, 0, 2 * trace.floor] : [0],
          band: floor ? [-2 * trace.floor, 2 * trace.floor] : null },
        { title: best ? "Measured and model (" + best.text.replace(/^.*: /, "") + ")" : "Measured", yLabel: label,
          height: 184, curves: [{ kind: "measured", x: times, y: measured },
                                ...(best ? [{ kind: best.kind, x: times, y: best.model }] : [])] }];
    },
    read: t => {
      const k = Math.min(times.length - 1, indexOf(times, t));
      const said = residuals.filter(residual => residual.shown)
        .map(residual => `${residual.text} ${figure(residual.y[k])}`);
      return k < 0 ? "" : [`t = ${figure(times[k])} s`, `measured ${figure(measured[k])}`, ...said].join(" · ");
    },
  });
}

// An output over the input that drives its hysteresis: measured, before, after.
function loopFigure(host, trace) {
  const inputs = numbers(trace.over.values), measured = numbers(trace.measured);
  const model = (name, kind, text, shown) => trace[name] === undefined ? [] :
    [{ kind, text, shown, x: inputs, y: numbers(trace[name]).map((value, k) => measured[k] + value) }];
  const curves = [{ kind: "measured", text: "measured", shown: true, x: inputs, y: measured },
                  ...model("calibrated", "before", "before: calibrated", trace.improved === undefined),
                  ...model("improved", "after", "after: improved", true)];
  const xLabel = named(trace.over.name, trace.over.unit), yLabel = named(trace.signal, trace.unit);
  zoomFigure(host, {
    name: `${trace.signal} over ${trace.over.name}`, plane: true, entries: curves, xLabel,
    x: reach([inputs], 0, inputs.length, []),
    y: reach(curves.map(curve => curve.y), 0, Infinity, []),
    panels: () => [{ title: "", yLabel, height: 380, curves: curves.filter(curve => curve.shown) }],
    read: (x, y) => `${xLabel} = ${figure(x)} · ${yLabel} = ${figure(y)}`,
  });
}

// The force of a friction over its velocity.
function frictionFigure(host, friction) {
  const curve = { kind: "after", text: "in the improved diagram", x: numbers(friction.velocity), y: numbers(friction.force) };
  const xLabel = named("velocity", friction.velocityUnit), yLabel = named("force of " + friction.block, friction.forceUnit);
  zoomFigure(host, {
    name: `Force of ${friction.block} over velocity`, plane: true, entries: [curve], xLabel,
    x: reach([curve.x], 0, curve.x.length, []), y: reach([curve.y], 0, curve.y.length, [0]),
    panels: () => [{ title: "", yLabel, height: 300, curves: [curve] }],
    read: (x, y) => `${xLabel} = ${figure(x)} · ${yLabel} = ${figure(y)}`,
  });
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
// What a reader opens is drawn then, and not before.
function drawOnceOpen(host, drawIt) {
  const frame = host.closest("details");
  let drawn = false;
  const show = () => {
    if (frame.open && !drawn) {
      drawn = true;
      drawIt();
    }
  };
  frame.addEventListener("toggle", show);
  show();
  figures += drawn ? 1 : 0;
}
data.traces.forEach((trace, i) => {
  const overTime = document.getElementById("trace-" + i), loop = document.getElementById("loop-" + i);
  drawOnceOpen(overTime, () => traceFigure(overTime, trace));
  if (loop) drawOnceOpen(loop, () => loopFigure(loop, trace));
});
data.frictions.forEach((friction, i) => {
  const host = document.getElementById("friction-" + i);
  drawOnceOpen(host, () => frictionFigure(host, friction));
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
