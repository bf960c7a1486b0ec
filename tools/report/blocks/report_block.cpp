// SPDX-License-Identifier: Apache-2.0
#include "tools/report/blocks/report_block.hpp"

#include "dsp/core/overload.hpp"
#include "tools/report/blocks/picture_figure.hpp"
#include "tools/report/figures/html_report.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::report {

namespace {

constexpr const char* fail = " class=\"fail\"";

std::string html_of(const ReportList& list) {
    std::string out = fmt::format("<ul{}>\n", list.is_warning ? fail : "");
    for (const std::string& item : list.items) out += "<li>" + html::escaped(item) + "</li>\n";
    return out + "</ul>\n";
}

bool is_number(const std::string& cell) {
    return cell.find_first_of("0123456789") != std::string::npos &&
           cell.find_first_not_of("0123456789.-") == std::string::npos;
}

std::string mark_of(const ReportTable& table, std::size_t row) {
    if (row >= table.marks.size()) return "";
    const Vec3 c = 255.0 * table.marks[row];
    return fmt::format("<span style=\"background:rgb({:.0f},{:.0f},{:.0f})\">&emsp;</span> ", c.x, c.y, c.z);
}

std::string html_of(const ReportTable& table) {
    std::string out = "<table><tr>";
    for (const std::string& cell : table.head) out += "<th>" + html::escaped(cell) + "</th>";
    out += "</tr>\n";
    for (std::size_t n = 0; n < table.rows.size(); ++n) {
        out += fmt::format("<tr{}>", n < table.warnings.size() && table.warnings[n] ? fail : "");
        for (std::size_t c = 0; c < table.rows[n].size(); ++c) {
            const std::string& cell = table.rows[n][c];
            out += fmt::format("<td{}>{}{}</td>", is_number(cell) ? " class=\"n\"" : "",
                               c == 0 ? mark_of(table, n) : "", html::escaped(cell));
        }
        out += "</tr>\n";
    }
    return out + "</table>\n";
}

std::string captioned(const display::Figure& figure, const std::string& caption, const std::string& prefix) {
    return fmt::format("<figure>{}<figcaption class=\"small\">{}</figcaption></figure>\n",
                       html::drawing(figure, prefix), html::escaped(caption));
}

std::string html_of(const render::LabelledPicture& picture, const std::string& prefix) {
    if (picture.image.rgb.empty()) return "<p>All fragments are hidden.</p>\n";
    return captioned(figure_of(picture), picture.caption, prefix);
}

}  // namespace

std::string html_of(std::span<const ReportBlock> blocks, std::string_view mark) {
    std::string out;
    int number = 0;
    const auto prefix = [&] { return fmt::format("{}{}-", mark, ++number); };
    for (const ReportBlock& block : blocks)
        out += std::visit(
            Overload{[](const Heading& h) {
                      return fmt::format("<h{0}{1}>{2}</h{0}>\n", std::clamp(h.depth, 1, 3) + 1,
                                         h.is_warning ? fail : "", html::escaped(h.text));
                  },
                  [](const Paragraph& p) { return fmt::format("<p>{}</p>\n", html::escaped(p.text)); },
                  [](const ReportList& l) { return html_of(l); }, [](const ReportTable& t) { return html_of(t); },
                  [&](const Drawing& d) { return captioned(d.figure, d.caption, prefix()); },
                  [&](const PictureGrid& g) {
                      std::string two = "<div class=\"two\">\n";
                      for (const render::LabelledPicture& picture : g.pictures) two += html_of(picture, prefix());
                      return two + "</div>\n";
                  }},
            block);
    return out;
}

}  // namespace tactus::report
