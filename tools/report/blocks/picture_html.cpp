// SPDX-License-Identifier: Apache-2.0
#include "tools/report/blocks/picture_html.hpp"

#include "devices/display/png.hpp"
#include "tools/report/figures/html_report.hpp"

#include <fmt/format.h>

namespace tactus::report {

namespace {

std::string svg_of(const render::PictureText& t) {
    std::string out;
    if (t.mark) {
        const Vec3 c = 255.0 * *t.mark;
        out = fmt::format(
            "<rect x=\"{:.0f}\" y=\"{:.0f}\" width=\"10\" height=\"10\" stroke=\"#333\" "
            "fill=\"rgb({:.0f},{:.0f},{:.0f})\"/>\n",
            t.x - 14.0, t.y - 10.0, c.x, c.y, c.z);
    }
    return out + fmt::format("<text x=\"{:.0f}\" y=\"{:.0f}\" text-anchor=\"{}\"{}>{}</text>\n", t.x, t.y,
                             t.anchor == 's'   ? "start"
                             : t.anchor == 'e' ? "end"
                                               : "middle",
                             t.size > 13.0 ? fmt::format(" font-size=\"{:.0f}\" font-weight=\"bold\"", t.size) : "",
                             html::escaped(t.text));
}

}  // namespace

std::string html_of(const render::LabelledPicture& picture) {
    if (picture.image.rgb.empty()) return "<p>All fragments are hidden.</p>\n";
    std::string texts;
    for (const render::PictureText& text : picture.texts) texts += svg_of(text);
    const std::string bar =
        fmt::format("<path d=\"M{0:.1f} {1} v8 h{2:.1f} v-8\" fill=\"none\" stroke=\"#000\" stroke-width=\"2\"/>\n",
                    picture.bar_x, picture.bar_y - 8.0, picture.bar_length);
    return fmt::format(
        "<figure><div style=\"position:relative;max-width:{0}px\"><img alt=\"{2}\" width=\"{0}\" "
        "style=\"display:block;width:100%\" src=\"data:image/png;base64,{3}\"><svg viewBox=\"0 0 {0} {1}\" "
        "style=\"position:absolute;left:0;top:0;width:100%\" font-family=\"sans-serif\" font-size=\"13\" "
        "paint-order=\"stroke\" stroke-linejoin=\"round\"><style>text{{stroke:#fff;stroke-width:3px;"
        "paint-order:stroke;fill:#000}}</style>\n{4}{5}</svg></div><figcaption class=\"small\">{2}</figcaption>"
        "</figure>\n",
        picture.image.width, picture.image.height, html::escaped(picture.caption),
        display::base64(display::png_bytes(picture.image)), texts, bar);
}

}  // namespace tactus::report
