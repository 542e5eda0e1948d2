#include "post/html.hpp"

#include <vtkBase64Utilities.h>

#include "post/file.hpp"

namespace hosel::post {
namespace {

constexpr const char* kStyle =
    R"(:root{color-scheme:light dark;--page:#fff;--ink:#1d2733;--soft:#5d6b7a;--rule:#e3e8ee;--band:#f4efe1;--gold:#a07c1c;
--blue:#0072b2;--orange:#d55e00;--green:#008a64;--pink:#b5578f;--sky:#3c9fd8;--grey:#9aa5b1;--chosen:#eef5fb;
--good:#eaf6ee;--good-ink:#21693f;--open:#fdf5e4;--open-ink:#8a5d07;--bad:#fbecea;--bad-ink:#96281b}
@media screen and (prefers-color-scheme:dark){:root{--page:#14191f;--ink:#e4e9ee;--soft:#9aa7b4;--rule:#2b343e;--band:#2e2a1c;
--gold:#d3ad4a;--blue:#56b4e9;--orange:#f08a3c;--green:#3cc39b;--pink:#dd8fbd;--sky:#8ccbf0;--grey:#77828d;
--chosen:#1b2a38;--good:#14291d;--good-ink:#7fd0a0;--open:#2c2412;--open-ink:#e5bd62;--bad:#311b18;--bad-ink:#f0988b}
img.curves,svg.curves{filter:invert(.92) hue-rotate(180deg)}
img.map{box-sizing:border-box;padding:.6rem;background:#fff;border:1px solid var(--rule);border-radius:8px}}
body{font:15px/1.55 system-ui,-apple-system,'Segoe UI','DejaVu Sans',sans-serif;max-width:64rem;
margin:0 auto;padding:2rem 1.25rem 4rem;color:var(--ink);background:var(--page)}
h1{font-size:1.55rem;line-height:1.25;margin:0 0 .3rem}h1:first-letter{text-transform:uppercase}
h2{font-size:1.12rem;margin:2.4rem 0 .5rem;padding-bottom:.25rem;border-bottom:1px solid var(--rule)}
.lead{color:var(--soft);margin:.2rem 0 1.2rem}small,.soft{color:var(--soft)}p{margin:.5rem 0}
.verdict{display:flex;flex-wrap:wrap;gap:.2rem 1rem;align-items:baseline;border-left:5px solid;padding:.8rem 1.1rem;
font-size:1.12rem;border-radius:0 6px 6px 0}.verdict span{flex:1 1 16rem}
.verdict b{font-size:.95rem;text-transform:uppercase;letter-spacing:.04em}
.good{background:var(--good);border-color:#2e8b57}.good b{color:var(--good-ink)}
.open{background:var(--open);border-color:#c98a12}.open b{color:var(--open-ink)}
.bad{background:var(--bad);border-color:#c0392b}.bad b{color:var(--bad-ink)}
.answers{display:grid;grid-template-columns:repeat(auto-fill,minmax(9.5rem,1fr));gap:.7rem;margin:1rem 0}
.answers div{border:1px solid var(--rule);border-radius:6px;padding:.55rem .8rem}.answers span{display:block;
color:var(--soft);font-size:.87rem}.answers b{font-size:1.2rem;font-weight:600;font-variant-numeric:tabular-nums}
table{border-collapse:collapse;margin:.6rem 0;font-variant-numeric:tabular-nums}
td,th{padding:.28rem .8rem .28rem 0;text-align:right;border-bottom:1px solid var(--rule);vertical-align:top}
th{font-weight:600;color:var(--soft);font-size:.87rem}td:first-child,th:first-child,.l{text-align:left!important}
td.long{min-width:11rem}
tr.chosen td{background:var(--chosen);font-weight:600}.scroll{overflow-x:auto}
.inputs{columns:21rem 2;column-gap:2.5rem}.inputs table{break-inside:avoid;width:100%}.inputs td:last-child{
overflow-wrap:anywhere;max-width:14rem}
pre{overflow-x:auto;font:13px/1.45 ui-monospace,'DejaVu Sans Mono',monospace;margin:.5rem 0}
pre.command{border-left:3px solid var(--rule);padding-left:.8rem;white-space:pre-wrap;overflow-wrap:anywhere}
.figures{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(26rem,100%),1fr));gap:1rem}figure{margin:.4rem 0}
.wide{max-width:44rem}.figures figure.alone{grid-column:1/-1;max-width:44rem}figcaption{font-size:.85rem;color:var(--soft)}
:not(svg)>svg,img{width:100%;height:auto;display:block}img{border-radius:4px}svg text{font-size:12px;fill:var(--ink)}
.grid{stroke:var(--rule)}.band{fill:var(--band)}.before{fill:var(--grey);opacity:.65}
.after{fill:var(--blue);opacity:.85}.remainder{fill:var(--green);opacity:.8}
.holdout{fill:var(--orange);opacity:.9}.one{stroke:var(--gold);stroke-dasharray:4 3}
.whisker{stroke:var(--ink);stroke-width:1.4}.line-before{fill:none;stroke:var(--grey);stroke-width:1.4}
.line-after{fill:none;stroke:var(--blue);stroke-width:1.4}.measured{fill:var(--ink);opacity:.45}
.line-1,.line-2,.line-3,.line-4,.line-5{fill:none;stroke-width:1.8}.line-1{stroke:var(--blue)}
.line-2{stroke:var(--orange)}.line-3{stroke:var(--green)}.line-4{stroke:var(--pink)}.line-5{stroke:var(--sky)}
svg text.line-1,svg text.line-2,svg text.line-3,svg text.line-4,svg text.line-5{stroke:none}
svg text.line-1{fill:var(--blue)}svg text.line-2{fill:var(--orange)}svg text.line-3{fill:var(--green)}
svg text.line-4{fill:var(--pink)}svg text.line-5{fill:var(--sky)}.mark{fill:none;stroke:var(--ink);stroke-width:1.2}
.face{fill:none;stroke:var(--ink);stroke-width:2.2}.rest{fill:none;stroke:var(--soft);stroke-dasharray:4 3}
.layer{fill:none;stroke:var(--page);stroke-width:.8}
@media screen and (max-width:34rem){.figures figure{margin:.4rem -1.2rem}.wide svg text{font-size:16px}
td,th{padding:.25rem .5rem .25rem 0;font-size:.86rem}}
.moving [data-part=view]{height:min(30rem,75vw);border:1px solid var(--rule);border-radius:6px;overflow:hidden;cursor:grab}
.moving p{display:flex;flex-wrap:wrap;gap:.4rem .7rem;align-items:center}.moving input[type=range]{flex:1 1 10rem}
.moving output{font-variant-numeric:tabular-nums;min-width:11rem}.moving b{font-weight:600}
.sliders [data-part=parameters]{display:grid;gap:.3rem 2rem;grid-template-columns:repeat(auto-fill,minmax(min(24rem,100%),1fr))}
.sliders label{display:grid;grid-template-columns:minmax(0,9rem) minmax(4rem,1fr) 7rem;gap:.6rem;align-items:center}
.sliders input{min-width:0;width:100%}.sliders output{font-variant-numeric:tabular-nums}.sliders .spark{width:9rem}
.sliders td{vertical-align:middle}
.moving [data-part=legend]{flex-wrap:nowrap}.moving i{flex:1 1 6rem;max-width:16rem;height:.8rem;border-radius:2px}
svg.curves text{font-size:13px;fill:#000}.told{position:relative}.told svg{position:absolute;inset:0;height:100%}
.key i{display:inline-block;width:.75em;height:.75em;border-radius:50%;margin:0 .3em 0 .9em;vertical-align:baseline}
@media print{:root{color-scheme:light}body{padding:0;font-size:11px;max-width:none}h2{break-after:avoid}
.figures{grid-template-columns:1fr 1fr}figure,table,.answers,.verdict,tr{break-inside:avoid}
.scroll,pre{overflow:visible;white-space:pre-wrap}pre{font-size:8px}.answers div{padding:.2rem .5rem}})";

}  // namespace

std::string escape_html(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '<') out += "&lt;";
    else if (c == '>') out += "&gt;";
    else if (c == '&') out += "&amp;";
    else if (c == '"') out += "&quot;";
    else if (c == '\'') out += "&#39;";
    else out += c;
  }
  return out;
}

std::string data_uri(const std::filesystem::path& picture) {
  const std::string bytes = read_file(picture);
  std::string text(4 * (bytes.size() / 3 + 1), '\0');
  text.resize(vtkBase64Utilities::Encode(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(),
                                         reinterpret_cast<unsigned char*>(text.data())));
  return (picture.extension() == ".svg" ? "data:image/svg+xml;base64," : "data:image/png;base64,") + text;
}

std::string html_page(const std::string& title, const std::string& body, const std::vector<PageScript>& scripts) {
  std::string allowed, run;
  for (const PageScript& s : scripts) {
    allowed += (allowed.empty() ? "'sha256-" : " 'sha256-") + s.checksum + "'";
    run += "<script>" + s.text + "</script>";
  }
  if (allowed.empty()) allowed = "'none'";
  return "<!doctype html><html lang='en'><head><meta charset='utf-8'><meta http-equiv='Content-Security-Policy' "
         "content=\"default-src 'none';img-src data:;style-src 'unsafe-inline';script-src " +
         allowed + "\"><meta name='viewport' content='width=device-width'><title>" + escape_html(title) +
         "</title><style>" + kStyle + "</style></head><body>" + body + run + "</body></html>\n";
}

}  // namespace hosel::post
