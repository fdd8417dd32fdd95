#include "diagnosis/report/parts.hpp"

namespace hysteron::diagnosis::report {
namespace {

// Orange, blue and grey of Okabe and Ito, which differ for the colour-blind as well; on the wires, width says the same
// as colour.
constexpr std::string_view sheet = R"css(
:root {
  color-scheme: light dark;
  --paper: #ffffff; --card: #f6f7f9; --ink: #1b1f24; --soft: #5b6470; --line: #d5dae0; --grid: #e6e9ed;
  --nominal: #8a929c; --before: #d55e00; --after: #0072b2; --measured: #1b1f24; --floor: #00795a;
  --mark: #8cc8ee; --warn: #fff4d6; --warn-line: #c98a00; --bad: #fde8e4; --bad-line: #b3261e;
  --s0: #b9c0c8; --s1: #d9b26a; --s2: #e0923a; --s3: #d0641c; --s4: #a83a16; --s5: #711f10;
}
@media (prefers-color-scheme: dark) {
  :root {
    --paper: #14171b; --card: #1d2126; --ink: #e8eaed; --soft: #a3acb7; --line: #3a4149; --grid: #2a3037;
    --nominal: #8f98a3; --before: #ff9a4a; --after: #56b4e9; --measured: #e8eaed; --floor: #4fd1a5;
    --mark: #1f5f8b; --warn: #3a2f10; --warn-line: #e0a52a; --bad: #45201c; --bad-line: #ff8a7a;
    --s0: #59616a; --s1: #6e5a3a; --s2: #a06c2c; --s3: #d08434; --s4: #f2a850; --s5: #ffdf9e;
  }
}
@media print {
  :root {
    color-scheme: light;
    --paper: #ffffff; --card: #ffffff; --ink: #000000; --soft: #444444; --line: #bbbbbb; --grid: #e3e3e3;
    --nominal: #8a929c; --before: #d55e00; --after: #0072b2; --measured: #000000; --floor: #00795a;
    --mark: #8cc8ee; --warn: #fff4d6; --warn-line: #c98a00; --bad: #fde8e4; --bad-line: #b3261e;
    --s0: #b9c0c8; --s1: #d9b26a; --s2: #e0923a; --s3: #d0641c; --s4: #a83a16; --s5: #711f10;
  }
  body { font-size: 10pt; print-color-adjust: exact; -webkit-print-color-adjust: exact; }
  section, article, .map, tr { break-inside: avoid; }
  .traces, .maps { break-inside: auto; }
  h2 { break-after: avoid; }
  svg.diagram { min-width: 0 !important; }
  .scroll { overflow: visible; }
  .hint, button.whole { display: none; }
}
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink); font: 15px/1.45 system-ui, "DejaVu Sans", sans-serif; }
main { max-width: 1180px; margin: 0 auto; padding: 1.2rem 1.4rem 3rem; }
h1 { font-size: 1rem; font-weight: 500; color: var(--soft); margin: 0 0 .6rem; }
h2 { font-size: 1.15rem; margin: 0 0 .6rem; }
h3 { font-size: 1rem; margin: .8rem 0 .3rem; }
section { margin: 0 0 1.6rem; }
p { margin: .3rem 0 .6rem; }
.note, .hint { color: var(--soft); font-size: .87rem; }
footer { color: var(--soft); font-size: .87rem; border-top: 1px solid var(--line); padding-top: .6rem; }
.head.two { display: grid; grid-template-columns: minmax(0, 1fr) minmax(0, 1fr); gap: 0 2.2rem; align-items: start; }
@media (max-width: 800px) { .head.two { display: block; } }

.verdict .label { display: inline-block; margin: 0 0 .5rem; padding: .1rem .7rem; border-radius: 1rem; font-weight: 600;
  color: var(--paper); background: var(--after); }
.verdict .label.refused { background: var(--bad-line); }
.summary { font-size: 1.3rem; line-height: 1.35; font-weight: 600; margin: 0 0 .6rem; }
.confidence svg { width: 9rem; height: .9rem; margin: 0 0 0 .6rem; vertical-align: -2px; }
.box { border-left: 5px solid; padding: .6rem 1rem; margin: .8rem 0; border-radius: 0 .3rem .3rem 0; }
.box h2 { font-size: 1rem; margin: 0 0 .2rem; }
.box ul { margin: 0; padding-left: 1.2rem; }
.box.warnings { background: var(--warn); border-color: var(--warn-line); }
.box.refusals, #fault { background: var(--bad); border-color: var(--bad-line); }
.cards { display: grid; grid-template-columns: repeat(auto-fit, minmax(330px, 1fr)); gap: 1rem; }
article.effect { background: var(--card); border: 1px solid var(--line); border-top: 4px solid var(--after);
  border-radius: .4rem; padding: .5rem 1rem .8rem; }
article.effect h3 { margin: .2rem 0; }
article.effect .at { font-weight: 400; color: var(--soft); }

table { border-collapse: collapse; margin: .4rem 0; font-variant-numeric: tabular-nums; }
article table { width: 100%; }
article th, article td { padding-right: .5rem; }
@media (max-width: 700px) { table, article table { display: block; overflow-x: auto; } }
th, td { padding: .22rem .9rem .22rem 0; text-align: left; border-bottom: 1px solid var(--line); vertical-align: top; }
th { font-weight: 500; font-size: .87rem; color: var(--soft); }
.number { text-align: right; white-space: nowrap; }
td.bar { white-space: nowrap; }
tr.own td { font-weight: 600; }
.tag { background: var(--after); color: var(--paper); font-size: .75rem; padding: 0 .45rem; border-radius: .6rem; }
svg.share-bar { width: 110px; height: 11px; margin-right: .5rem; vertical-align: -1px; }
details { margin: .5rem 0; }
summary { cursor: pointer; font-weight: 500; }
pre { background: var(--card); border: 1px solid var(--line); padding: .8rem; overflow-x: auto; font-size: .82rem; }

svg text { fill: var(--ink); font: 12px system-ui, "DejaVu Sans", sans-serif; }
rect.nominal { fill: var(--nominal); } rect.before { fill: var(--before); } rect.after { fill: var(--after); }
rect.rest { fill: var(--grid); }
svg.missing { width: 100%; max-width: 720px; display: block; }
svg.missing .grid { stroke: var(--line); } svg.missing .dots { fill: var(--before); opacity: .45; }
svg.missing .law { fill: none; stroke: var(--after); stroke-width: 2.5; }
svg.gap { width: 100%; max-width: 560px; display: block; }
svg.gap text { font-size: 13px; }
svg.gap .row { text-anchor: end; } svg.gap .value { font-weight: 600; }
path.floor { stroke: var(--floor); stroke-width: 2; stroke-dasharray: 5 3; fill: none; }
svg text.floor { fill: var(--floor); }

.scroll { overflow-x: auto; }
svg.diagram { display: block; width: 100%; height: auto; margin: 0 auto; }
.wire { fill: none; stroke: var(--s0); stroke-width: 1.6; }
.wire.s1 { stroke: var(--s1); stroke-width: 2; } .wire.s2 { stroke: var(--s2); stroke-width: 2.8; }
.wire.s3 { stroke: var(--s3); stroke-width: 3.6; } .wire.s4 { stroke: var(--s4); stroke-width: 4.6; }
.wire.s5 { stroke: var(--s5); stroke-width: 5.6; }
.tip { fill: var(--s0); } .t1 { fill: var(--s1); } .t2 { fill: var(--s2); } .t3 { fill: var(--s3); }
.t4 { fill: var(--s4); } .t5 { fill: var(--s5); }
.marked { fill: none; stroke: var(--mark); stroke-width: 12; stroke-linecap: round; }
.diagram rect { fill: var(--card); stroke: var(--soft); }
.diagram .port rect { fill: var(--paper); }
.diagram .expression rect { fill: var(--paper); stroke: var(--line); }
.diagram .added rect { stroke: var(--after); stroke-width: 3; }
.diagram .name { text-anchor: middle; font-size: 13px; font-weight: 600; }
.diagram .expression .name { font-weight: 400; font-size: 11.5px; font-family: "DejaVu Sans Mono", monospace; }
.diagram .type { text-anchor: middle; font-size: 11px; font-weight: 400; fill: var(--soft); }
.diagram .pin { font-size: 10px; fill: var(--soft); } .diagram .pin.out { text-anchor: end; }
.diagram text.effect { text-anchor: middle; font-weight: 700; fill: var(--after); }
.diagram .on-wire rect { stroke-dasharray: 5 3; }
.diagram .on-wire .name { fill: var(--after); }
.diagram text.share { paint-order: stroke; stroke: var(--paper); stroke-width: 4; }
.diagram text.share { font-size: 12px; font-weight: 600; }
.legend span { white-space: nowrap; margin-left: .8rem; }
.legend { font-size: .87rem; color: var(--soft); }
svg.key { width: 26px; height: 12px; margin-right: .3rem; vertical-align: -2px; }

.plot svg, .map svg { display: block; width: 100%; touch-action: pan-y; }
.plot svg.zooms { cursor: crosshair; }
.axis { fill: none; stroke: var(--soft); } .grid { fill: none; stroke: var(--grid); }
.plot text, .map text { font-size: 11px; } .plot text.title, .map text.title { font-weight: 600; font-size: 12px; }
.curve { fill: none; stroke-width: 1.3; stroke-linejoin: round; }
.map .curve { stroke-width: 2; }
.curve.nominal { stroke: var(--nominal); } .curve.before { stroke: var(--before); } .curve.after { stroke: var(--after); }
.curve.measured { stroke: var(--measured); } .curve.mean { stroke: var(--soft); stroke-dasharray: 4 3; stroke-width: 1.3; }
.curve.zero { stroke: var(--soft); stroke-width: .8; }
.dot.before { fill: var(--before); } .dot.after { fill: var(--after); }
.band { fill: var(--floor); opacity: .16; } .select { fill: var(--after); opacity: .18; }
.cross { stroke: var(--soft); stroke-dasharray: 2 2; fill: none; }
.keys { display: flex; flex-wrap: wrap; gap: .3rem 1rem; align-items: center; font-size: .87rem; margin: .4rem 0 .2rem; }
.keys button { font: inherit; color: inherit; background: none; border: 1px solid transparent; padding: .05rem .4rem;
  cursor: pointer; border-radius: .3rem; }
.keys button:hover, .keys button:focus-visible, .keys button.whole { border-color: var(--line); }
.keys button[aria-pressed="false"] { opacity: .5; text-decoration: line-through; }
.keys i { display: inline-block; width: 1.4rem; height: 0; border-top: 3px solid; margin-right: .4rem; vertical-align: 4px; }
.keys i.nominal { border-color: var(--nominal); } .keys i.before { border-color: var(--before); }
.keys i.after { border-color: var(--after); } .keys i.measured { border-color: var(--measured); }
.keys i.mean { border-top: 2px dashed var(--soft); }
.keys i.band { border-top: 10px solid var(--floor); opacity: .3; vertical-align: 1px; }
.readout { font-size: .87rem; color: var(--soft); min-height: 1.4em; font-variant-numeric: tabular-nums; }
.maps .mosaic { display: grid; grid-template-columns: repeat(auto-fill, minmax(265px, 1fr)); gap: .8rem 1.2rem; }
)css";

}  // namespace

std::string_view style() {
  return sheet;
}

}  // namespace hysteron::diagnosis::report
