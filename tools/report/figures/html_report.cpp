// SPDX-License-Identifier: Apache-2.0
#include "tools/report/figures/html_report.hpp"

#include "devices/display/png.hpp"

#include <fmt/format.h>

namespace tactus::report::html {

namespace {

constexpr const char* style =
    R"(body{font:15px/1.5 system-ui,sans-serif;color:#22262e;max-width:60rem;margin:2rem auto;padding:0 1rem}
h1{font-size:1.5rem}h2{font-size:1.15rem;margin-top:2.2rem}table{border-collapse:collapse;font-size:13px}
td,th{padding:.25rem .6rem;border-bottom:1px solid #e3e6ea;text-align:left;vertical-align:top}
td.n,th.n{text-align:right}
figure{margin:0}.two{display:grid;grid-template-columns:1fr 1fr;gap:1rem}
img,svg{max-width:100%;height:auto}.small{color:#6b7280;font-size:13px}.pass{color:#1b7a3d}.fail{color:#b81d24})";

}  // namespace

std::string escaped(std::string_view text) {
    std::string out;
    for (const char c : text) switch (c) {
            case '<': out += "&lt;"; break;
            case '>': out += "&gt;"; break;
            case '&': out += "&amp;"; break;
            case '"': out += "&quot;"; break;
            default: out += c;
        }
    return out;
}

std::string drawing(const display::Figure& figure, std::string_view mark) { return figure.svg(mark); }

std::string picture(const display::Image& image, std::string_view caption) {
    return fmt::format(
        "<figure><img alt=\"{0}\" width=\"{1}\" src=\"data:image/png;base64,{2}\"><figcaption "
        "class=\"small\">{0}</figcaption></figure>\n",
        escaped(caption), image.width, display::base64(display::png_bytes(image)));
}

std::string page(std::string_view title, const std::string& body) {
    return fmt::format(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{0}</title><style>{1}</style></head>\n"
        "<body><h1>{0}</h1>\n{2}</body></html>\n",
        escaped(title), style, body);
}

}  // namespace tactus::report::html
