// SPDX-License-Identifier: Apache-2.0
// Blocks of a report as PDF 1.4 (ISO 32000-1): the standard font Helvetica, pictures as the data of their PNG files.
#include "devices/display/png.hpp"
#include "tools/report/blocks/report_block.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

namespace tactus::report {

namespace {

constexpr double page_width = 595.0, page_height = 842.0, margin = 48.0;  // points; A4
constexpr double inside = page_width - 2.0 * margin;
constexpr double gutter = 12.0, mark_width = 10.0, caption_size = 8.0, min_size = 6.0;  // points
constexpr double bold = 1.08;  // width of bold text over that of plain text

/// WinAnsi, in which bytes from 160 to 255 are Latin-1; with ( ) and \ escaped.
std::string ansi(std::string_view text) {
    std::string out;
    for (std::size_t n = 0; n < text.size(); ++n) {
        const auto byte = static_cast<unsigned char>(text[n]);
        unsigned code = byte;
        std::size_t more = 0;
        if (byte >= 0xF0) code = byte & 7U, more = 3;
        else if (byte >= 0xE0) code = byte & 15U, more = 2;
        else if (byte >= 0xC0) code = byte & 31U, more = 1;
        for (; more > 0 && n + 1 < text.size(); --more)
            code = code << 6U | (static_cast<unsigned char>(text[++n]) & 63U);
        if (code == 0x2013) code = 0x96;
        else if (code == 0x2212) code = '-';
        else if (code == 0x2022) code = 0x95;
        else if (code > 255 || code < 32 || (code > 126 && code < 160)) code = '?';
        if (code == '(' || code == ')' || code == '\\') out += '\\';
        out += static_cast<char>(code);
    }
    return out;
}

/// Widths of Helvetica for the printable characters of ASCII, thousandths of the size (Adobe Core 14 AFM).
double width_of(std::string_view ansi_text, double size) {
    constexpr std::array<int, 95> widths{
        278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333,  278, 278, 556, 556, 556,
        556, 556, 556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556, 1015, 667, 667, 722, 722, 667,
        611, 778, 722, 278, 500, 667, 556, 833, 722, 778, 667, 778, 722, 667,  611, 722, 667, 944, 667,
        667, 611, 278, 278, 278, 469, 556, 333, 556, 556, 500, 556, 556, 278,  556, 556, 222, 222, 500,
        222, 833, 556, 556, 556, 556, 333, 500, 278, 556, 500, 722, 500, 500,  500, 334, 260, 334, 584};
    double sum = 0.0;
    for (const char c : ansi_text) {
        const auto byte = static_cast<unsigned char>(c);
        sum += byte >= 32 && byte < 127 ? widths[byte - 32U] : 556;
    }
    return sum * size / 1000.0;
}

class Pdf {
public:
    explicit Pdf(const std::string& title) {
        begin_page();
        lines(title, 17.0, true);
    }

    void add(const Heading& h) {
        room(60.0);
        y_ -= 12.0;
        lines(h.text, 13.0, true, h.is_warning);
    }
    void add(const Paragraph& p) { lines(p.text, 9.5, false, p.is_warning); }

    void add(const ReportList& l) {
        for (const std::string& item : l.items) lines("\u2022 " + item, 9.5, false, l.is_warning);
    }

    void add(const ReportTable& t) {
        if (t.head.empty()) return;
        constexpr double size = 7.5;
        std::vector<double> widths(t.head.size(), 0.0), least = widths;
        const auto measure = [&](const std::vector<std::string>& row, double boldness) {
            for (std::size_t c = 0; c < widths.size() && c < row.size(); ++c) {
                const double wide = boldness * width_of(ansi(row[c]), size) + 8.0;
                widths[c] = std::max(widths[c], std::min(wide, 0.45 * inside));
                for (const std::string& word : wrapped(row[c], size, 0.0))
                    least[c] = std::max(least[c], boldness * width_of(word, size) + 8.0);
            }
        };
        measure(t.head, bold);
        for (const auto& row : t.rows) measure(row, 1.0);
        if (!t.marks.empty()) {
            widths[0] = std::min(widths[0] + mark_width, inside);
            least[0] += mark_width;
        }
        double whole = 0.0, needed = 0.0;
        for (std::size_t c = 0; c < widths.size(); ++c) {
            widths[c] = std::max(widths[c], least[c]);
            whole += widths[c];
            needed += least[c];
        }
        // What is too wide is broken between words, as long as the words fit.
        const double share = whole > needed ? std::max(0.0, (inside - needed) / (whole - needed)) : 1.0;
        for (std::size_t c = 0; c < widths.size(); ++c)
            if (whole > inside)
                widths[c] = (least[c] + share * (widths[c] - least[c])) * std::min(1.0, inside / needed);
        // A head stands above its first rows, and again on each page.
        room(5.0 * size);
        row_of(t.head, widths, size, true);
        for (std::size_t n = 0; n < t.rows.size(); ++n) {
            const std::size_t page = pages_.size();
            room(height_of(t.rows[n], widths, size, !t.marks.empty()));
            if (pages_.size() != page) row_of(t.head, widths, size, true);
            row_of(t.rows[n], widths, size, false, n < t.marks.size() ? &t.marks[n] : nullptr,
                   n < t.warnings.size() && t.warnings[n]);
        }
        y_ -= 6.0;
    }

    void add(const Drawing& d) { add_image(d.figure.image(2.0), {}, d.caption); }
    void add(const render::LabelledPicture& p) {
        if (!p.image.rgb.empty()) add_image(p.image, p, p.caption);
    }
    void add(const PictureGrid& g) {
        constexpr double wide = 0.5 * (inside - gutter);
        for (std::size_t n = 0; n < g.pictures.size(); n += 2) {
            const std::size_t count = std::min<std::size_t>(2, g.pictures.size() - n);
            double high = 0.0, below = 0.0;
            for (std::size_t k = n; k < n + count; ++k) {
                const render::LabelledPicture& p = g.pictures[k];
                if (p.image.rgb.empty()) continue;
                high = std::max(high, wide * static_cast<double>(p.image.height) / p.image.width);
                below = std::max(below, caption_height(p.caption, wide));
            }
            if (!(high > 0.0)) continue;
            room(high + below + 8.0);
            const double top = y_;
            for (std::size_t k = n; k < n + count; ++k)
                if (const render::LabelledPicture& p = g.pictures[k]; !p.image.rgb.empty()) {
                    const double left = margin + static_cast<double>(k - n) * (wide + gutter);
                    draw(p.image, p, left, top, wide);
                    captioned(p.caption, left, top - wide * p.image.height / p.image.width - 2.0, wide);
                }
            y_ = top - high - below - 8.0;
        }
    }

    std::string bytes() {
        end_page();
        // Objects: 1 catalogue, 2 pages, 3 and 4 fonts, then pictures, then a page and its content each.
        std::vector<std::string> objects{
            "<< /Type /Catalog /Pages 2 0 R >>", "",
            "<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica /Encoding /WinAnsiEncoding >>",
            "<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica-Bold /Encoding "
            "/WinAnsiEncoding >>"};
        std::string names;
        for (std::size_t n = 0; n < images_.size(); ++n) {
            names += fmt::format("/I{} {} 0 R ", n, objects.size() + 1);
            objects.push_back(images_[n]);
        }
        std::string kids;
        for (const std::string& content : pages_) {
            kids += fmt::format("{} 0 R ", objects.size() + 1);
            objects.push_back(
                fmt::format("<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {:.0f} {:.0f}] /Contents {} 0 R /Resources << "
                            "/Font << /F1 3 "
                            "0 R /F2 4 0 R >> /XObject << {}>> >> >>",
                            page_width, page_height, objects.size() + 2, names));
            objects.push_back(fmt::format("<< /Length {} >>\nstream\n{}\nendstream", content.size(), content));
        }
        objects[1] = fmt::format("<< /Type /Pages /Count {} /Kids [{}] >>", pages_.size(), kids);
        std::string out = "%PDF-1.4\n%\xE2\xE3\xCF\xD3\n", table;
        for (std::size_t n = 0; n < objects.size(); ++n) {
            table += fmt::format("{:010} 00000 n \n", out.size());
            out += fmt::format("{} 0 obj\n{}\nendobj\n", n + 1, objects[n]);
        }
        const std::size_t start = out.size();
        return out +
               fmt::format(
                   "xref\n0 {0}\n0000000000 65535 f \n{1}trailer\n<< /Size {0} /Root 1 0 R >>\nstartxref\n{2}\n%%EOF\n",
                   objects.size() + 1, table, start);
    }

private:
    void begin_page() {
        page_.clear();
        y_ = page_height - margin;
    }
    void end_page() {
        page_ += fmt::format("BT /F1 7 Tf {:.1f} {:.1f} Td (research use; not a medical device      page {}) Tj ET\n",
                             margin, 0.5 * margin, pages_.size() + 1);
        pages_.push_back(page_);
    }
    void room(double needed) {
        if (y_ - needed >= margin) return;
        end_page();
        begin_page();
    }

    void text(double x, double y, const std::string& shown, double size, bool is_bold, bool is_red = false) {
        page_ += fmt::format("BT {} rg /F{} {} Tf {:.2f} {:.2f} Td ({}) Tj ET\n", is_red ? "0.72 0.11 0.14" : "0 0 0",
                             is_bold ? 2 : 1, size, x, y, shown);
    }

    static std::vector<std::string> wrapped(const std::string& words, double size, double width) {
        std::vector<std::string> all;
        std::string now;
        const std::string line = ansi(words);
        for (std::size_t at = 0; at <= line.size();) {
            const std::size_t end = std::min(line.find(' ', at), line.size());
            const std::string word = line.substr(at, end - at);
            const std::string longer = now.empty() ? word : now + ' ' + word;
            if (!now.empty() && width_of(longer, size) > width) all.push_back(now), now = word;
            else now = longer;
            at = end + 1;
        }
        all.push_back(now);
        return all;
    }

    void lines(const std::string& words, double size, bool is_bold, bool is_red = false) {
        for (const std::string& line : wrapped(words, size, inside / (is_bold ? bold : 1.0))) {
            room(1.35 * size);
            y_ -= 1.35 * size;
            text(margin, y_, line, size, is_bold, is_red);
        }
        y_ -= 3.0;
    }

    static double height_of(const std::vector<std::string>& row, const std::vector<double>& widths, double size,
                            bool is_marked) {
        std::size_t most = 1;
        for (std::size_t c = 0; c < widths.size() && c < row.size(); ++c)
            most = std::max(most,
                            wrapped(row[c], size, widths[c] - 5.0 - (c == 0 && is_marked ? mark_width : 0.0)).size());
        return 1.3 * size * static_cast<double>(most) + 3.0;
    }

    void row_of(const std::vector<std::string>& row, const std::vector<double>& widths, double size, bool is_bold,
                const Vec3* mark = nullptr, bool is_red = false) {
        std::vector<std::vector<std::string>> cells;
        std::size_t most = 1;
        const auto before = [&](std::size_t c) { return c == 0 && mark ? mark_width : 0.0; };
        for (std::size_t c = 0; c < widths.size(); ++c) {
            const double wide = (widths[c] - 5.0 - before(c)) / (is_bold ? bold : 1.0);
            cells.push_back(wrapped(c < row.size() ? row[c] : "", size, wide));
            most = std::max(most, cells.back().size());
        }
        const double high = 1.3 * size * static_cast<double>(most) + 3.0;
        room(high);
        if (mark) square(*mark, margin, y_ - 1.3 * size, 0.8 * size);
        double x = margin;
        for (std::size_t c = 0; c < widths.size(); ++c) {
            for (std::size_t n = 0; n < cells[c].size(); ++n)
                text(x + before(c), y_ - 1.3 * size * static_cast<double>(n + 1), cells[c][n], size, is_bold, is_red);
            x += widths[c];
        }
        y_ -= high;
        page_ += fmt::format("0.85 G 0.5 w {:.1f} {:.1f} m {:.1f} {:.1f} l S\n", margin, y_ - 1.0, page_width - margin,
                             y_ - 1.0);
    }

    void square(const Vec3& colour, double x, double y, double size) {
        page_ += fmt::format("{:.3f} {:.3f} {:.3f} rg {:.2f} {:.2f} {:.2f} {:.2f} re f\n", colour.x, colour.y, colour.z,
                             x, y, size, size);
    }

    void add_image(const display::Image& picture, const render::LabelledPicture& over, const std::string& caption) {
        const double aspect = static_cast<double>(picture.height) / picture.width;
        const double wide = std::min({inside, static_cast<double>(picture.width) * 0.6, 330.0 / aspect});
        room(aspect * wide + 22.0);
        draw(picture, over, margin, y_, wide);
        y_ -= aspect * wide + 2.0;
        lines(caption, caption_size, false);
        y_ -= 4.0;
    }

    static double caption_height(const std::string& caption, double width) {
        return 1.35 * caption_size * static_cast<double>(wrapped(caption, caption_size, width).size()) + 5.0;
    }
    void captioned(const std::string& caption, double left, double top, double width) {
        for (const std::string& line : wrapped(caption, caption_size, width))
            text(left, top -= 1.35 * caption_size, line, caption_size, false);
    }

    /// `left`, `top` and `wide` in points; what is written over the picture with it.
    void draw(const display::Image& picture, const render::LabelledPicture& over, double left, double top,
              double wide) {
        const double scale = wide / picture.width, high = scale * picture.height, low = top - high;
        // The data of a PNG file is what FlateDecode with PNG predictors reads.
        std::string data;
        const std::string png = display::png_bytes(picture);
        for (std::size_t at = 8; at + 12 <= png.size();) {
            std::uint32_t length = 0;
            for (std::size_t k = 0; k < 4; ++k) length = length << 8U | static_cast<unsigned char>(png[at + k]);
            if (png.compare(at + 4, 4, "IDAT") == 0) data.append(png, at + 8, length);
            at += 12 + static_cast<std::size_t>(length);
        }
        images_.push_back(fmt::format(
            "<< /Type /XObject /Subtype /Image /Width {0} /Height {1} /ColorSpace /DeviceRGB /BitsPerComponent 8 "
            "/Filter "
            "/FlateDecode /DecodeParms << /Predictor 15 /Colors 3 /BitsPerComponent 8 /Columns {0} >> /Length {2} "
            ">>\nstream\n{3}\nendstream",
            picture.width, picture.height, data.size(), data));
        page_ +=
            fmt::format("q {:.2f} 0 0 {:.2f} {:.2f} {:.2f} cm /I{} Do Q\n", wide, high, left, low, images_.size() - 1);
        for (const render::PictureText& t : over.texts) {
            const std::string shown = ansi(t.text);
            const double size = std::max(t.size * scale, min_size),
                         away = width_of(shown, size) * (t.anchor == 'm' ? 0.5 : 1.0);
            const double x = left + t.x * scale - (t.anchor == 's' ? 0.0 : away), y = top - t.y * scale;
            if (t.mark) square(*t.mark, x - 14.0 * scale, y, 10.0 * scale);
            text(x, y, shown, size, t.size > 13.0);
        }
        if (over.bar_length > 0.0)
            page_ += fmt::format("0 G 1 w {:.2f} {:.2f} m {:.2f} {:.2f} l S\n", left + over.bar_x * scale,
                                 top - over.bar_y * scale, left + (over.bar_x + over.bar_length) * scale,
                                 top - over.bar_y * scale);
    }

    std::vector<std::string> pages_, images_;
    std::string page_;
    double y_ = 0.0;
};

}  // namespace

std::string pdf_of(const std::string& title, std::span<const ReportBlock> blocks) {
    Pdf pdf(title);
    for (const ReportBlock& block : blocks) std::visit([&](const auto& one) { pdf.add(one); }, block);
    return pdf.bytes();
}

}  // namespace tactus::report
