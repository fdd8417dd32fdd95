#include "plots/page.hpp"

namespace hysteron::plots {
namespace {

constexpr std::string_view zoom_text = R"js(
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

// A curve in a plane: points that fall into the same half pixel are drawn once.
function loopPath(xs, ys, x, y) {
  const parts = [];
  let penDown = false, lastX = NaN, lastY = NaN;
  for (let k = 0; k < Math.min(xs.length, ys.length); ++k) {
    if (!Number.isFinite(xs[k]) || !Number.isFinite(ys[k])) {
      penDown = false;
      continue;
    }
    const px = Math.round(2 * x(xs[k])) / 2, py = Math.round(2 * y(ys[k])) / 2;
    if (penDown && px === lastX && py === lastY) continue;
    parts.push((penDown ? "L" : "M") + px + " " + py);
    [lastX, lastY, penDown] = [px, py, true];
  }
  return parts.join("");
}

// A signal of steps: each value holds until the next.
function stepPath(times, values, first, last, x, y) {
  let path = "", penDown = false, held = NaN;
  for (let k = first; k < Math.min(last, values.length); ++k) {
    if (!Number.isFinite(values[k])) {
      if (penDown) path += `H${x(times[k - 1]).toFixed(1)}`;  // it held until there
      penDown = false;
    } else if (!penDown) {
      path += `M${x(times[k]).toFixed(1)} ${y(values[k]).toFixed(1)}`;
      penDown = true;
    } else if (values[k] !== held || k + 1 >= last) {
      path += `H${x(times[k]).toFixed(1)}` + (values[k] === held ? "" : `V${y(values[k]).toFixed(1)}`);
    }
    held = values[k];
  }
  return path;
}

function drawDots(parent, curve, x, y) {
  for (let k = 0; k < curve.x.length; ++k) {
    if (!Number.isFinite(curve.x[k]) || !Number.isFinite(curve.y[k])) continue;
    const half = curve.errors ? curve.errors[k] : NaN;
    if (Number.isFinite(half)) {
      draw(parent, "path", { class: "curve " + curve.kind,
                             d: `M${x(curve.x[k])} ${y(curve.y[k] - half)}V${y(curve.y[k] + half)}` });
    }
    draw(parent, "circle", { class: "dot " + curve.kind, cx: x(curve.x[k]), cy: y(curve.y[k]), r: 3.5 });
  }
}

// Panels over one axis, which is zoomed: by a drag, by keys, and by a double click back to the whole.
// spec: name, entries of the keys (those with `shown` can be hidden), x: the whole reach, xLabel, panels(): what is to
// be drawn, each { title, yLabel, height, curves, wanted, band }; read(x): a line of text; shades, names of the axis;
// plane: one panel of curves in a plane, zoomed both ways, with y: its whole reach.
function zoomFigure(host, spec) {
  for (const entry of spec.entries) {
    if (entry.shown !== undefined) entry.toggle = () => redraw();
  }
  const row = keys(host, spec.entries);
  const whole = add(row, "button", { type: "button", className: "whole", textContent: "Whole record", hidden: true });
  add(row, "span", { className: "hint", textContent: "Drag to zoom, double click to see all. Keys: ← → + − Home." });
  const area = add(host, "div", { className: "zoomed", tabIndex: 0 });
  const readout = add(host, "div", { className: "readout" });
  const all = { x: spec.x, y: spec.y };
  let view = all, drawnWidth = 0;

  function zoom(to) {
    view = to;
    whole.hidden = view === all;
    redraw();
  }
  whole.addEventListener("click", () => zoom(all));
  const part = ([low, high], from, to) => [low + from * (high - low), low + to * (high - low)];
  // Never beyond the whole, and never so near that nothing is left to see.
  function zoomTo(x, y) {
    const long = all.x[1] - all.x[0], wide = Math.max(Math.min(x[1] - x[0], long), 1e-9 * long);
    const low = Math.min(Math.max(x[0], all.x[0]), all.x[1] - wide);
    zoom(wide >= long * 0.999999 && !y ? all : { x: [low, low + wide], y: y ?? all.y });
  }
  area.addEventListener("keydown", event => {
    const scaled = (from, to) => zoomTo(part(view.x, from, to), view.y && view.y !== all.y ? part(view.y, from, to) : undefined);
    const shifted = by => zoomTo(part(view.x, by, 1 + by), view.y !== all.y ? view.y : undefined);
    const act = { ArrowLeft: () => shifted(-0.25), ArrowRight: () => shifted(0.25), "+": () => scaled(0.25, 0.75),
                  "=": () => scaled(0.25, 0.75), "-": () => scaled(-0.5, 1.5), Home: () => zoom(all),
                  Escape: () => zoom(all) }[event.key];
    if (!act || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    act();
  });

  function redraw() {
    const width = drawnWidth = Math.max(420, area.clientWidth);
    const panels = spec.panels();
    area.textContent = "";
    const apart = spec.plane ? 0 : 36, bottom = spec.xLabel ? 44 : 30;
    const height = 26 + panels.reduce((sum, panel) => sum + panel.height, 0) + apart * (panels.length - 1) + bottom;
    const svg = draw(area, "svg", { class: "zooms", viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": spec.name });
    const clip = "clip-" + host.id;
    const definition = draw(draw(svg, "defs", {}), "clipPath", { id: clip });
    draw(definition, "rect", { x: 66, y: 0, width: width - 74, height });  // a dot on the edge is whole
    const frames = [];
    let top = 26;
    for (const panel of panels) {
      const frame = { left: 70, right: width - 12, top, bottom: top + panel.height };
      const spans = panel.curves.map(curve => spec.plane || curve.stroke === "dots" ? [0, curve.x.length] :
        [Math.max(0, indexOf(curve.x, view.x[0]) - 1), Math.min(curve.x.length, indexOf(curve.x, view.x[1]) + 2)]);
      const ends = panel.curves.map((curve, i) => reach([curve.y], ...spans[i], panel.wanted ?? []));
      const errors = panel.curves.flatMap(curve => curve.errors ?
        [...curve.y].flatMap((value, k) => [value - curve.errors[k], value + curve.errors[k]]).filter(Number.isFinite) : []);
      const range = view.y ?? (ends.length || panel.wanted ?
        [Math.min(...ends.map(end => end[0]), ...(ends.length ? [] : [reach([], 0, 0, panel.wanted)[0]]), ...errors),
         Math.max(...ends.map(end => end[1]), ...(ends.length ? [] : [reach([], 0, 0, panel.wanted)[1]]), ...errors)] : [0, 1]);
      const isLast = panel === panels[panels.length - 1];
      const options = { x: view.x, y: range, title: panel.title, yLabel: panel.yLabel, names: spec.names,
                        numbers: isLast, xLabel: isLast ? spec.xLabel : undefined };
      const shades = draw(svg, "g", { "clip-path": `url(#${clip})` });
      const { x, y } = axes(svg, frame, options);
      for (const shade of spec.shades ?? []) {
        draw(shades, "rect", { class: "shade", x: x(shade.begin), width: Math.max(0, x(shade.end) - x(shade.begin)),
                               y: frame.top, height: panel.height });
        draw(shades, "text", { class: "shade", x: Math.max(74, x(shade.begin) + 4), y: frame.top + 13 }, shade.name);
      }
      const inside = draw(svg, "g", { "clip-path": `url(#${clip})` });
      if (panel.band) {
        draw(inside, "rect", { class: "band", x: 70, width: width - 82, y: y(panel.band[1]),
                               height: y(panel.band[0]) - y(panel.band[1]) });
      }
      panel.curves.forEach((curve, i) => {
        if (curve.stroke === "dots") return drawDots(inside, curve, x, y);
        const d = spec.plane ? loopPath(curve.x, curve.y, x, y)
          : (curve.stroke === "steps" ? stepPath : linePath)(curve.x, curve.y, ...spans[i], x, y);
        draw(inside, "path", { class: "curve " + curve.kind, d });
      });
      frames.push({ ...frame, range });
      top = frame.bottom + apart;
    }
    if (frames.length) pointing(svg, width, height, frames);
  }

  function pointing(svg, width, height, frames) {
    const { left, right } = frames[0];
    const top = frames[0].top, bottom = frames[frames.length - 1].bottom;
    const cross = draw(svg, "path", { class: "cross" });
    const select = draw(svg, "rect", { class: "select", y: top, height: bottom - top, width: 0 });
    const xAt = px => view.x[0] + (px - left) / (right - left) * (view.x[1] - view.x[0]);
    const yAt = py => frames[0].range[1] - (py - top) / (bottom - top) * (frames[0].range[1] - frames[0].range[0]);
    const place = event => {
      const box = svg.getBoundingClientRect();
      return [Math.min(right, Math.max(left, (event.clientX - box.left) * width / box.width)),
              Math.min(bottom, Math.max(top, (event.clientY - box.top) * height / box.height))];
    };
    let start = null;
    const drop = () => {
      start = null;
      select.setAttribute("width", 0);
    };
    svg.addEventListener("pointerdown", event => {
      if (event.button !== 0) return;
      start = place(event);
      if (event.isTrusted) svg.setPointerCapture(event.pointerId);
    });
    svg.addEventListener("pointermove", event => {
      const [px, py] = place(event);
      cross.setAttribute("d", `M${px} ${top}V${bottom}` + (spec.plane ? `M${left} ${py}H${right}` : ""));
      if (start !== null) {
        select.setAttribute("x", Math.min(start[0], px));
        select.setAttribute("width", Math.abs(px - start[0]));
        if (spec.plane) {
          select.setAttribute("y", Math.min(start[1], py));
          select.setAttribute("height", Math.abs(py - start[1]));
        }
      }
      readout.textContent = spec.read(xAt(px), yAt(py));
    });
    svg.addEventListener("pointerup", event => {
      if (start === null) return;
      const end = place(event), sorted = values => values.sort((a, b) => a - b);
      const x = sorted([xAt(start[0]), xAt(end[0])]), y = sorted([yAt(start[1]), yAt(end[1])]);
      const wide = Math.abs(end[0] - start[0]) > 5 && (!spec.plane || Math.abs(end[1] - start[1]) > 5);
      drop();
      if (wide) zoom(spec.plane ? { x, y } : { x, y: all.y });
    });
    svg.addEventListener("pointercancel", drop);
    svg.addEventListener("pointerleave", () => { cross.setAttribute("d", ""); readout.textContent = ""; });
    svg.addEventListener("dblclick", () => zoom(all));
  }

  redraw();
  new ResizeObserver(() => {
    if (area.clientWidth > 0 && Math.max(420, area.clientWidth) !== drawnWidth) redraw();
  }).observe(area);
}
)js";

}  // namespace

std::string_view zoom_script() {
  return zoom_text;
}

}  // namespace hysteron::plots
