#pragma once
namespace tapstudy::analysis {
inline constexpr const char* html_style = R"css(
body{font:16px/1.5 system-ui,sans-serif;color:#1b2733;max-width:60rem;margin:1rem auto;padding:0 1rem}
h1{font-size:1.6rem}h2{font-size:1.2rem;margin-top:1.5rem}h3{font-size:1rem;margin:1.5rem 0 .3rem}
.simulated{background:#fff3cd;border-left:.3rem solid #d39e00;padding:.5rem 1rem}
table{border-collapse:collapse}caption{text-align:left;color:#567;font-size:.85rem;padding-bottom:.4rem}
.matrix th{font-weight:500;padding:.4rem .7rem;text-align:right}.matrix thead th{text-align:center;max-width:9rem}
.matrix tbody th{min-width:9rem}.matrix td{width:7.6rem;height:3.2rem;text-align:center;border:2px solid #fff}
.matrix td b{display:block;font-size:1.2rem}.matrix td span{font-size:.8rem}
.matrix td.correct{outline:2px solid #1b2733;outline-offset:-3px}
.matrix .total{width:3rem;color:#567;text-align:center}
.accuracy th{font-weight:500;text-align:left;padding:.2rem 1rem .2rem 0}.accuracy td{padding:.2rem 1rem .2rem 0}
.accuracy td{white-space:nowrap}.dot{width:200px;height:16px;overflow:visible}.dot .axis{stroke:#cdd6df}.dot .chance{stroke:#b0413e;stroke-dasharray:3 2}
.dot .interval{stroke:#08519c;stroke-width:2}.dot circle{fill:#08519c}
.scroll{overflow-x:auto;position:relative;left:50%;transform:translateX(-50%);width:fit-content;min-width:100%;max-width:min(96vw,90rem)}
.data th,.data td{padding:.2rem 1rem .2rem 0;text-align:right;white-space:nowrap;font-weight:400}
.data thead th{font-weight:500;vertical-align:bottom;white-space:normal;min-width:4rem}
.data tr>:first-child,.data tr>.text{text-align:left}.data td.text{white-space:normal;max-width:22rem}
.charts{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(100%,18rem),1fr));gap:1rem;margin-top:1rem}
figure{margin:0}figcaption{font-size:.85rem;color:#567}.chart{width:100%;height:auto}.chart text{font-size:11px;fill:currentColor}
.chart path{fill:none}.chart .frame{stroke:#8796a5}.chart .line{stroke:#567;stroke-width:1.5}.chart .chance{stroke:#b0413e;stroke-dasharray:3 2}
.chart .interval{stroke:#08519c;stroke-width:3}.chart circle{fill:#08519c;stroke:#08519c;fill-opacity:.8}.chart circle.open{fill:#fff;fill-opacity:1}
.chart .band{fill:#c6dbef}.chart .mark{stroke:#b0413e}.charts .first{grid-column-start:1}details>summary{cursor:pointer;margin-top:1rem}
.contents{font-size:.85rem}.contents ul{padding:0;list-style:none}.contents li{display:inline}.contents a{color:#08519c;margin-right:.6rem}.anchor{scroll-margin-top:3rem}
.section>summary,section>h3{border-top:1px solid #cdd6df;padding-top:.6rem}.section>summary{margin-top:.6rem}summary h3{display:inline}.section>summary h3{font-size:1.1rem}
section>h3{font-size:1.1rem}section .data~h3,section>h3~h3{font-size:1rem;border:0;padding:0}
.note,.provenance{font-size:.85rem;color:#567}.provenance th{text-align:left;font-weight:500;padding-right:1rem;vertical-align:top}
.provenance td{overflow-wrap:anywhere}.notes{white-space:pre-line}
@media (max-width:600px){.accuracy td{white-space:normal;padding-right:.5rem}.accuracy th{padding-right:.5rem;overflow-wrap:anywhere}.accuracy th[scope=row]{min-width:5.5rem}.accuracy thead th{overflow-wrap:normal}
  .dot{width:72px}.data thead{display:none}.data,.data tbody,.data tr,.data tbody th,.data td{display:block}.data tbody th,.data td,.data td.text{white-space:normal;max-width:none;padding:.1rem 0;overflow-wrap:anywhere}
  .data tbody th{font-weight:500;text-align:left;margin-top:.5rem}.data td{display:flex;justify-content:space-between;gap:1rem}.data td::before{content:attr(data-heading);color:#567;text-align:left;overflow-wrap:break-word}
  .matrix td{width:auto;min-width:2.4rem;height:2.6rem}.matrix td b{font-size:1rem}.matrix td span{font-size:.7rem}.matrix tbody th{min-width:0}.matrix th{padding:.2rem .1rem;font-size:.65rem;overflow-wrap:anywhere}.matrix .total{width:auto}h1{font-size:1.3rem}}
@media screen and (prefers-color-scheme:dark){:root{color-scheme:dark}body{background:#14191f;color:#dde5ec}
  .simulated{background:#4a3a08;border-color:#d39e00}caption,figcaption,.matrix .total,.note,.provenance,.data td::before{color:#9fb0bf}
  .matrix td{border-color:#14191f}.matrix td.correct{outline-color:#dde5ec}.contents a{color:#8ab8e6}.section>summary,section>h3{border-color:#3a4754}
  .dot .axis{stroke:#3a4754}.dot .chance,.chart .chance,.chart .mark{stroke:#ef8a80}.dot .interval,.chart .interval{stroke:#6baed6}.dot circle{fill:#6baed6}
  .chart .line{stroke:#b9c9d6}.chart .band{fill:#274a68}.chart circle{fill:#6baed6;stroke:#6baed6}.chart circle.open{fill:#14191f}}
@media print{details::details-content{content-visibility:visible;height:auto}body{margin:0;max-width:none;font-size:11pt}.scroll{overflow:visible;left:0;transform:none;width:auto;max-width:none}
  .data{font-size:8.5pt}.data.wide{font-size:7.5pt}.data th,.data td,.accuracy td{white-space:normal;padding-right:.4rem}
  .data thead th{min-width:0;overflow-wrap:break-word}.charts{grid-template-columns:repeat(2,1fr)}figure,tr{break-inside:avoid}h2,h3,h2+p,caption,.question{break-after:avoid}table{break-inside:auto}caption{break-inside:avoid}
  .matrix td{width:auto}.matrix td,.simulated{print-color-adjust:exact;-webkit-print-color-adjust:exact}}
)css";
}  // namespace tapstudy::analysis
