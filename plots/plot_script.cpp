#include "plots/page.hpp"

namespace hysteron::plots {
namespace {

constexpr std::string_view plots = R"js("use strict";
// A page that cannot draw says so, rather than showing empty frames.
// That a frame's sizes settle in the next frame only is no fault.
window.addEventListener("error", event => {
  if (String(event.message).startsWith("ResizeObserver loop")) return;
  const note = document.getElementById("fault");
  note.hidden = false;
  note.className = "box fault";
  note.textContent = "The plots could not be drawn: " + event.message;
});

const pen = document.getElementById("pen");

function draw(parent, name, attributes, text) {
  const element = document.createElementNS(pen.namespaceURI, name);
  for (const key in attributes) element.setAttribute(key, attributes[key]);
  if (text !== undefined) element.textContent = text;
  parent.appendChild(element);
  return element;
}

function add(parent, name, properties) {
  const element = Object.assign(document.createElement(name), properties);
  parent.appendChild(element);
  return element;
}

function named(name, unit) {
  return unit === "" || unit === "1" ? name : name + " [" + unit + "]";
}

// Numbers at 1, 2 or 5 times a power of ten, about `most` of them, all with the same digits behind the point. Two at
// least: one alone shows no scale.
function ticks(low, high, most) {
  const rough = (high - low) / most;
  const power = Math.pow(10, Math.floor(Math.log10(rough)));
  const step = power * [1, 2, 5, 10].find(digit => digit * power >= 0.999 * rough);
  const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  const big = Math.max(Math.abs(low), Math.abs(high));
  if (most < 8 && Math.floor(high / step + 1e-9) - Math.ceil(low / step - 1e-9) < 1) return ticks(low, high, most + 1);
  const found = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) {
    const value = k * step;
    const plain = big < 1e6 && digits < 6;
    const needed = Math.min(15, Math.max(6, Math.ceil(Math.log10(big / step)) + 1));
    found.push({ value, label: plain ? value.toFixed(digits).replace(/^-(0(\.0*)?)$/, "$1")
                                     : String(Number(value.toPrecision(needed))) });
  }
  return found;
}

function decades(low, high) {
  const found = [];
  const from = Math.floor(Math.log10(low)), to = Math.ceil(Math.log10(high));
  for (let power = from; power <= to; ++power) {
    for (const digit of to - from > 2 ? [1] : [1, 2, 5]) {
      const value = digit * Math.pow(10, power);
      if (value >= low * 0.999 && value <= high * 1.001) {
        found.push({ value, label: String(Number(value.toPrecision(3))) });
      }
    }
  }
  return found;
}

function figure(value) {
  return Number.isFinite(value) ? String(Number(value.toPrecision(4))) : "–";
}

// The least and largest finite value of arrays between two indexes, with some room about them.
function reach(arrays, first, last, wanted) {
  let low = wanted.length ? Math.min(...wanted) : Infinity, high = wanted.length ? Math.max(...wanted) : -Infinity;
  for (const values of arrays) {
    for (let k = first; k < Math.min(last, values.length); ++k) {
      if (values[k] < low) low = values[k];
      if (values[k] > high) high = values[k];
    }
  }
  if (!(low <= high)) return [0, 1];
  const room = high > low ? 0.05 * (high - low) : 0.1 * Math.abs(low) || 1;
  return [low - room, high + room];
}

// A pair of axes in an SVG: x and y are functions from data to pixels.
function axes(svg, frame, options) {
  const { left, right, top, bottom } = frame;
  const log = options.log === true;
  const place = value => log ? Math.log(value) : value;
  const [xl, xh] = options.x.map(place), [yl, yh] = options.y;
  const x = value => left + (place(value) - xl) / (xh - xl) * (right - left);
  const y = value => bottom - (value - yl) / (yh - yl) * (bottom - top);
  const wide = Math.max(2, Math.min(10, Math.floor((right - left) / 52))), tall = Math.max(2, Math.floor((bottom - top) / 34));
  let last = -Infinity;
  for (const tick of options.names ?? (log ? decades(...options.x) : ticks(xl, xh, wide))) {
    draw(svg, "path", { class: "grid", d: `M${x(tick.value)} ${top}V${bottom}` });
    const half = 3.5 * tick.label.length;
    if (options.numbers !== false && x(tick.value) - half > last) {
      draw(svg, "text", { x: x(tick.value), y: bottom + 15, "text-anchor": "middle" }, tick.label);
      last = x(tick.value) + half + 4;
    }
  }
  for (const tick of ticks(yl, yh, tall)) {
    draw(svg, "path", { class: "grid", d: `M${left} ${y(tick.value)}H${right}` });
    draw(svg, "text", { x: left - 6, y: y(tick.value) + 4, "text-anchor": "end" }, tick.label);
  }
  draw(svg, "path", { class: "axis", d: `M${left} ${top}V${bottom}H${right}` });
  if (options.title) draw(svg, "text", { class: "title", x: left, y: top - 8 }, options.title);
  if (options.xLabel) {
    draw(svg, "text", { class: "label", x: (left + right) / 2, y: bottom + 31, "text-anchor": "middle" }, options.xLabel);
  }
  if (options.yLabel) {
    const middle = (top + bottom) / 2;
    draw(svg, "text", { class: "label", x: 12, y: middle, "text-anchor": "middle",
                        transform: `rotate(-90 12 ${middle})` }, options.yLabel);
  }
  return { x, y };
}

// The path of a line over the indexes first … last − 1. Of many samples in one pixel, the least and the largest are
// drawn in the order in which they come: the picture is that of all samples.
function linePath(times, values, first, last, x, y) {
  const parts = [];
  let penDown = false;
  const to = k => {
    parts.push((penDown ? "L" : "M") + x(times[k]).toFixed(1) + " " + y(values[k]).toFixed(1));
    penDown = true;
  };
  const end = Math.min(last, values.length);
  const pixels = Math.abs(x(times[Math.max(first, end - 1)]) - x(times[first]));
  if (end - first < 3 * pixels) {
    for (let k = first; k < end; ++k) {
      if (Number.isFinite(values[k])) to(k);
      else penDown = false;
    }
    return parts.join("");
  }
  for (let k = first; k < end;) {
    const pixel = Math.floor(x(times[k]));
    let low = -1, high = -1;
    for (; k < end && Math.floor(x(times[k])) === pixel; ++k) {
      if (!Number.isFinite(values[k])) continue;
      if (low < 0 || values[k] < values[low]) low = k;
      if (high < 0 || values[k] > values[high]) high = k;
    }
    if (low < 0) {
      penDown = false;
      continue;
    }
    to(Math.min(low, high));
    if (low !== high) to(Math.max(low, high));
  }
  return parts.join("");
}

// A row of keys; those with a `toggle` can be pressed.
function keys(parent, entries) {
  const row = add(parent, "div", { className: "keys" });
  for (const entry of entries) {
    const key = add(row, entry.toggle ? "button" : "span", {});
    if (entry.toggle) {
      key.type = "button";
      key.setAttribute("aria-pressed", String(entry.shown));
      key.addEventListener("click", () => {
        entry.shown = !entry.shown;
        key.setAttribute("aria-pressed", String(entry.shown));
        entry.toggle();
      });
    }
    add(key, "i", { className: entry.kind });
    key.append(entry.text);
  }
  return row;
}
)js";

}  // namespace

std::string_view plot_script() {
  return plots;
}

}  // namespace hysteron::plots
