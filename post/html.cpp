#include "hosel/post/html.hpp"

namespace hosel::post {
namespace {

constexpr const char* kStyle =
    R"(:root{--ink:#1d2733;--soft:#5d6b7a;--rule:#e3e8ee;--blue:#1f5f99;--orange:#d9731a;--grey:#9aa5b1}
body{font:15px/1.55 system-ui,-apple-system,'Segoe UI','DejaVu Sans',sans-serif;max-width:64rem;
margin:0 auto;padding:2rem 1.25rem 4rem;color:var(--ink);background:#fff}
h1{font-size:1.55rem;line-height:1.25;margin:0 0 .3rem}
h2{font-size:1.12rem;margin:2.4rem 0 .5rem;padding-bottom:.25rem;border-bottom:1px solid var(--rule)}
.lead{color:var(--soft);margin:.2rem 0 1.2rem}small,.soft{color:var(--soft)}p{margin:.5rem 0}
.verdict{display:flex;gap:1rem;align-items:baseline;border-left:5px solid;padding:.8rem 1.1rem;
font-size:1.12rem;border-radius:0 6px 6px 0}
.verdict b{white-space:nowrap;font-size:.95rem;text-transform:uppercase;letter-spacing:.04em}
.good{background:#eaf6ee;border-color:#2e8b57}.good b{color:#21693f}.open{background:#fdf5e4;border-color:#c98a12}
.open b{color:#8a5d07}.bad{background:#fbecea;border-color:#c0392b}.bad b{color:#96281b}
table{border-collapse:collapse;margin:.6rem 0;font-variant-numeric:tabular-nums}
td,th{padding:.28rem .8rem .28rem 0;text-align:right;border-bottom:1px solid var(--rule);vertical-align:top}
th{font-weight:600;color:var(--soft);font-size:.87rem}td:first-child,th:first-child,.l{text-align:left!important}
tr.chosen td{background:#eef5fb;font-weight:600}.scroll{overflow-x:auto}
.figures{display:grid;grid-template-columns:repeat(auto-fill,minmax(26rem,1fr));gap:1rem}figure{margin:0}
figcaption{font-size:.85rem;color:var(--soft)}svg{width:100%;height:auto;display:block}
svg text{font-size:12px;fill:#3b4754}.grid{stroke:#e8ecf0}.band{fill:#f4efe1}.before{fill:var(--grey);opacity:.65}
.after{fill:var(--blue);opacity:.85}.holdout{fill:var(--orange);opacity:.9}.one{stroke:#a07c1c;stroke-dasharray:4 3}
.whisker{stroke:#1d2733;stroke-width:1.4}.line-before{fill:none;stroke:var(--grey);stroke-width:1.4}
.line-after{fill:none;stroke:var(--blue);stroke-width:1.4}.measured{fill:#222;opacity:.45}
.key i{display:inline-block;width:.75em;height:.75em;border-radius:50%;margin:0 .3em 0 .9em;vertical-align:baseline}
@media print{body{padding:0}h2{break-after:avoid}figure,table{break-inside:avoid}})";

}  // namespace

std::string escape_html(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '<') out += "&lt;";
    else if (c == '>') out += "&gt;";
    else if (c == '&') out += "&amp;";
    else out += c;
  }
  return out;
}

std::string html_page(const std::string& title, const std::string& body) {
  return "<!doctype html><html lang='en'><head><meta charset='utf-8'><meta name='viewport' "
         "content='width=device-width'><title>" +
         escape_html(title) + "</title><style>" + kStyle + "</style></head><body>" + body + "</body></html>\n";
}

}  // namespace hosel::post
