#include "plots/page.hpp"

namespace hysteron::plots {
namespace {

// Orange, blue and grey of Okabe and Ito, which differ for the colour-blind as well.
constexpr std::string_view sheet = R"css(
:root {
  color-scheme: light dark;
  --paper: #ffffff; --card: #f6f7f9; --ink: #1b1f24; --soft: #5b6470; --line: #d5dae0; --grid: #e6e9ed;
  --nominal: #8a929c; --before: #d55e00; --after: #0072b2; --measured: #1b1f24; --floor: #00795a;
  --mark: #8cc8ee; --warn: #fff4d6; --warn-line: #c98a00; --bad: #fde8e4; --bad-line: #b3261e;
  --c0: #0072b2; --c1: #d55e00; --c2: #009e73; --c3: #cc79a7; --c4: #b07a00; --c5: #2f9bd8; --c6: #8c6d31; --c7: #1b1f24;
  --shade: #eef3f8; --s0: #b9c0c8; --s1: #d9b26a; --s2: #e0923a; --s3: #d0641c; --s4: #a83a16; --s5: #711f10;
  --under: var(--paper); --edge: #9aa3ae;
}
@media (prefers-color-scheme: dark) {
  :root {
    --paper: #14171b; --card: #1d2126; --ink: #e8eaed; --soft: #a3acb7; --line: #3a4149; --grid: #2a3037;
    --nominal: #8f98a3; --before: #ff9a4a; --after: #56b4e9; --measured: #e8eaed; --floor: #4fd1a5;
    --mark: #1f5f8b; --warn: #3a2f10; --warn-line: #e0a52a; --bad: #45201c; --bad-line: #ff8a7a;
    --c0: #56b4e9; --c1: #ff9a4a; --c2: #4fd1a5; --c3: #e9a6cc; --c4: #f0c04a; --c5: #9bd3f5; --c6: #cdb27e; --c7: #e8eaed;
    --edge: #6b7480; --shade: #1c232b; --s0: #59616a; --s1: #6e5a3a; --s2: #a06c2c; --s3: #d08434; --s4: #f2a850; --s5: #ffdf9e;
  }
}
@media print {
  :root {
    color-scheme: light;
    --paper: #ffffff; --card: #ffffff; --ink: #000000; --soft: #444444; --line: #bbbbbb; --grid: #e3e3e3;
    --nominal: #8a929c; --before: #d55e00; --after: #0072b2; --measured: #000000; --floor: #00795a;
    --mark: #8cc8ee; --warn: #fff4d6; --warn-line: #c98a00; --bad: #fde8e4; --bad-line: #b3261e;
    --c0: #0072b2; --c1: #d55e00; --c2: #009e73; --c3: #cc79a7; --c4: #b07a00; --c5: #2f9bd8; --c6: #8c6d31; --c7: #000000;
    --shade: #eef3f8; --s0: #b9c0c8; --s1: #d9b26a; --s2: #e0923a; --s3: #d0641c; --s4: #a83a16; --s5: #711f10;
  }
  body { font-size: 10pt; print-color-adjust: exact; -webkit-print-color-adjust: exact; }
  section, article, .map, tr { break-inside: avoid; }
  h2 { break-after: avoid; }
  table, article table, .scroll { overflow: visible; background-image: none; }
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
.summary { font-size: 1.3rem; line-height: 1.35; font-weight: 600; margin: 0 0 .6rem; }
.note, .hint { color: var(--soft); font-size: .87rem; }
footer { color: var(--soft); font-size: .87rem; border-top: 1px solid var(--line); padding-top: .6rem; }
.box { border-left: 5px solid; padding: .6rem 1rem; margin: .8rem 0; border-radius: 0 .3rem .3rem 0; }
.box h2 { font-size: 1rem; margin: 0 0 .2rem; }
.box ul { margin: 0; padding-left: 1.2rem; }
.box.warnings { background: var(--warn); border-color: var(--warn-line); }
.box.refusals, #fault { background: var(--bad); border-color: var(--bad-line); }
table { border-collapse: collapse; margin: .4rem 0; font-variant-numeric: tabular-nums; }
article table { width: 100%; }
article th, article td { padding-right: .5rem; }
article { --under: var(--card); }
@media (max-width: 700px) {
  td.number, th.number { white-space: normal; }
  /* What is wider than the page scrolls; where more lies beyond an edge, that edge has a shade. */
  table, article table, .scroll {
    display: block; overflow-x: auto; background-repeat: no-repeat;
    background-image: linear-gradient(to right, var(--under) 40%, transparent),
      linear-gradient(to left, var(--under) 40%, transparent), linear-gradient(to right, var(--edge), transparent),
      linear-gradient(to left, var(--edge), transparent);
    background-position: 0 0, 100% 0, 0 0, 100% 0; background-size: 2.6rem 100%, 2.6rem 100%, .9rem 100%, .9rem 100%;
    background-attachment: local, local, scroll, scroll;
  }
}
pre.command span { display: inline-block; max-width: 100%; }
@media (max-width: 700px), print { pre { white-space: pre-wrap; overflow-wrap: anywhere; } }
th, td { padding: .22rem .9rem .22rem 0; text-align: left; border-bottom: 1px solid var(--line); vertical-align: top; }
th { font-weight: 500; font-size: .87rem; color: var(--soft); }
.number { text-align: right; white-space: nowrap; }
td.bar { white-space: nowrap; }
details { margin: .5rem 0; }
summary { cursor: pointer; font-weight: 500; }
pre { background: var(--card); border: 1px solid var(--line); padding: .8rem; overflow-x: auto; font-size: .82rem; }

svg text { fill: var(--ink); font: 12px system-ui, "DejaVu Sans", sans-serif; }
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
.curve.c0 { stroke: var(--c0); } .dot.c0 { fill: var(--c0); } .keys i.c0 { border-color: var(--c0); }
.curve.c1 { stroke: var(--c1); } .dot.c1 { fill: var(--c1); } .keys i.c1 { border-color: var(--c1); }
.curve.c2 { stroke: var(--c2); } .dot.c2 { fill: var(--c2); } .keys i.c2 { border-color: var(--c2); }
.curve.c3 { stroke: var(--c3); } .dot.c3 { fill: var(--c3); } .keys i.c3 { border-color: var(--c3); }
.curve.c4 { stroke: var(--c4); } .dot.c4 { fill: var(--c4); } .keys i.c4 { border-color: var(--c4); }
.curve.c5 { stroke: var(--c5); } .dot.c5 { fill: var(--c5); } .keys i.c5 { border-color: var(--c5); }
.curve.c6 { stroke: var(--c6); } .dot.c6 { fill: var(--c6); } .keys i.c6 { border-color: var(--c6); }
.curve.c7 { stroke: var(--c7); } .dot.c7 { fill: var(--c7); } .keys i.c7 { border-color: var(--c7); }
rect.shade { fill: var(--shade); stroke: var(--line); } .plot text.shade { fill: var(--soft); }
.plot svg { overflow: visible; }
.zoomed:focus-visible { outline: 2px solid var(--line); outline-offset: 2px; }
.plot { margin: 0 0 .4rem; }
@media (max-width: 500px) { main { padding: .8rem .7rem 2rem; } h1, h2 { overflow-wrap: anywhere; } }
)css";

}  // namespace

std::string_view style() {
  return sheet;
}

}  // namespace hysteron::plots
