#pragma once
namespace tapstudy::runner {
// After that of reports (analysis/report/html_style.hpp), of which this changes some colours for
// those who read on a dark screen.
inline constexpr const char* reproduction_style = R"css(
:root{color-scheme:light dark}
.verdict{display:inline-block;min-width:4.5rem;text-align:center;border-radius:.3rem;padding:0 .5rem;color:#fff;font-weight:600}
.true{background:#1b6e3c}.false{background:#a32a2a}.depends{background:#7a5600}
.claim{border-top:1px solid #cdd6df;margin-top:1.5rem;padding-top:.5rem}.claim h3{margin:.3rem 0;border:0}
.claim h4{font-size:1rem;margin:1rem 0 .3rem}code{font:.85rem ui-monospace,monospace;overflow-wrap:anywhere}
.scroll{margin:.3rem 0 1rem}.data th,.data td,.data thead th{white-space:normal;text-align:left;vertical-align:top}
.data .missed{color:#a32a2a}.overview th[scope=row]{min-width:11rem}
.small{grid-template-columns:repeat(auto-fill,minmax(min(100%,17rem),1fr))}
.force .line{stroke:#1b2733;stroke-width:1.2}.force .alone{stroke:#08519c;stroke-width:1.2}
.map{width:100%;height:auto}.map text{font-size:11px;fill:currentColor}
details{margin:.5rem 0}.animation img{max-width:100%;image-rendering:pixelated}summary{cursor:pointer;color:#08519c}
a{color:#08519c}
@media (max-width:600px){body{margin:1rem auto}}
@media (prefers-color-scheme:dark){
body{background:#12181f;color:#dbe3ea}.simulated{background:#3a3010;border-color:#d39e00}
.note,.provenance,caption,figcaption{color:#9fb0bf}a,summary,.contents a{color:#8cc0f5}
.claim,section>h3{border-color:#3a4753}.data .missed{color:#f29a9a}
.chart .frame{stroke:#7b8b9a}.chart .line{stroke:#b9c7d4}.chart .chance{stroke:#e08a87}
.chart circle{fill:#8cc0f5;stroke:#8cc0f5}.chart circle.open{fill:#12181f}.force .line{stroke:#dbe3ea}.force .alone{stroke:#8cc0f5}
}
)css";
}  // namespace tapstudy::runner
