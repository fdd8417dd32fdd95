#include "diagnosis/report/parts.hpp"

namespace hysteron::diagnosis::report {
namespace {

// On the wires, width says the same as colour.
constexpr std::string_view sheet = R"css(
.head.two { display: grid; grid-template-columns: minmax(0, 1fr) minmax(0, 1fr); gap: 0 2.2rem; align-items: start; }
@media (max-width: 800px) { .head.two { display: block; } }

.verdict .label { display: inline-block; margin: 0 0 .5rem; padding: .1rem .7rem; border-radius: 1rem; font-weight: 600;
  color: var(--paper); background: var(--after); }
.verdict .label.refused { background: var(--bad-line); }
.confidence svg { width: 9rem; height: .9rem; margin: 0 0 0 .6rem; vertical-align: -2px; }
.cards { display: grid; grid-template-columns: repeat(auto-fit, minmax(330px, 1fr)); gap: 1rem; }
article.effect { background: var(--card); border: 1px solid var(--line); border-top: 4px solid var(--after);
  border-radius: .4rem; padding: .5rem 1rem .8rem; overflow-x: auto; }
article.effect table { font-size: .9em; }
article.effect h3 { margin: .2rem 0; }
article.effect .at { font-weight: 400; color: var(--soft); }

tr.own td { font-weight: 600; }
.tag { background: var(--after); color: var(--paper); font-size: .75rem; padding: 0 .45rem; border-radius: .6rem; }
svg.share-bar { width: 110px; height: 11px; margin-right: .5rem; vertical-align: -1px; }
@media (max-width: 700px) { svg.share-bar { width: 44px; } }
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

.maps .mosaic { display: grid; grid-template-columns: repeat(auto-fill, minmax(265px, 1fr)); gap: .8rem 1.2rem; }
@media print {
  .traces, .maps { break-inside: auto; }
  svg.diagram { min-width: 0 !important; }
}
)css";

}  // namespace

std::string_view style() {
  return sheet;
}

}  // namespace hysteron::diagnosis::report
