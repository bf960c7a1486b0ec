// SPDX-License-Identifier: Apache-2.0
#include "tools/picture/flap/report_block.hpp"

#include "tools/picture/report/html_report.hpp"

#include <fmt/format.h>

namespace tactus::picture {

namespace {

template <class... Each>
struct Visit : Each... {
    using Each::operator()...;
};
template <class... Each>
Visit(Each...) -> Visit<Each...>;

}  // namespace

std::string html_of(std::span<const ReportBlock> blocks, std::string_view mark) {
    std::string out;
    int number = 0;
    for (const ReportBlock& block : blocks)
        out += std::visit(
            Visit{[](const Heading& h) { return fmt::format("<h2>{}</h2>\n", html::escaped(h.text)); },
                  [](const Paragraph& p) {
                      return fmt::format("<p{}>{}</p>\n", p.is_warning ? " class=\"fail\"" : "", html::escaped(p.text));
                  },
                  [](const ReportTable& t) {
                      std::string table = "<table><tr>";
                      for (const std::string& cell : t.head) table += "<th>" + html::escaped(cell) + "</th>";
                      table += "</tr>\n";
                      for (const auto& row : t.rows) {
                          table += "<tr>";
                          for (const std::string& cell : row) table += "<td>" + html::escaped(cell) + "</td>";
                          table += "</tr>\n";
                      }
                      return table + "</table>\n";
                  },
                  [&](const Drawing& d) {
                      const std::string name =
                          fmt::format("{}{}", mark, std::string(static_cast<std::size_t>(++number), 'x'));
                      return fmt::format("<figure>{}<figcaption class=\"small\">{}</figcaption></figure>\n",
                                         html::drawing(d.figure, name), html::escaped(d.caption));
                  },
                  [](const LabelledPicture& p) { return html_of(p); }},
            block);
    return out;
}

}  // namespace tactus::picture
