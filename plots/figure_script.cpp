#include "plots/page.hpp"

namespace hysteron::plots {
namespace {

constexpr std::string_view figure_text = R"js(
const figures = JSON.parse(document.getElementById("figures").textContent);

function curveOf(grids, curve) {
  return { ...curve, x: grids[curve.x], y: numbers(curve.y), errors: curve.errors ? numbers(curve.errors) : null,
           text: curve.name };
}

// One key for the curves of a kind, whatever panel they are in.
function entriesOf(panels) {
  const entries = new Map();
  for (const curve of panels.flatMap(panel => panel.curves)) {
    const id = curve.kind + curve.name;
    if (!entries.has(id)) entries.set(id, { kind: curve.kind, text: curve.name, shown: true, id });
  }
  return entries;
}

function showFigure(host, given) {
  const grids = given.grids.map(timesOf);
  const panels = given.panels.map(panel => ({ ...panel, curves: panel.curves.map(curve => curveOf(grids, curve)) }));
  const named = given.names.map(([label, value]) => ({ label, value }));
  const entries = entriesOf(panels);
  const isShown = curve => entries.get(curve.kind + curve.name).shown;
  const alone = panels.every(panel => panel.curves.length < 2);
  const [low, high] = reach(grids, 0, Math.max(0, ...grids.map(grid => grid.length)), []);
  const edge = Math.max(...grids.map(grid => grid.length), 0) && !named.length ? 0.05 / 1.1 * (high - low) : 0;
  const whole = given.plane ? [low, high] : [low + edge, high - edge];
  const tall = given.plane ? 420 : panels.length === 1 ? 320 : panels.length < 4 ? 190 : 130;
  zoomFigure(host, {
    name: given.title || document.title, plane: given.plane, x: whole, xLabel: panels[0].xLabel, shades: given.shades,
    y: given.plane ? reach(panels[0].curves.map(curve => curve.y), 0, Infinity, []) : undefined,
    names: named.length ? named : undefined,
    entries: alone ? [] : [...entries.values()],
    panels: () => panels.map(panel => ({ ...panel, height: tall, curves: panel.curves.filter(isShown) })),
    read: (x, y) => {
      if (given.plane) return `${panels[0].xLabel} = ${figure(x)} · ${panels[0].yLabel} = ${figure(y)}`;
      if (named.length) return "";
      const said = panels.flatMap(panel => panel.curves.filter(isShown).map(curve => {
        const next = indexOf(curve.x, x), k = curve.stroke === "steps" ? next - (curve.x[next] > x ? 1 : 0) : next;
        const value = curve.y[Math.max(0, Math.min(curve.y.length - 1, k))];
        return `${panel.curves.length > 1 ? panel.title + ", " + curve.name : panel.title}: ${figure(value)}`;
      }));
      return [`${panels[0].xLabel.replace(/ \[.*/, "")} = ${figure(x)}`, ...said].join(" · ");
    },
  });
}

figures.forEach((given, i) => showFigure(document.getElementById("figure-" + i), given));
document.documentElement.dataset.figures = figures.length;
)js";

}  // namespace

std::string_view figure_script() {
  return figure_text;
}

}  // namespace hysteron::plots
