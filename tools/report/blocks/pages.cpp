// SPDX-License-Identifier: Apache-2.0
#include "tools/report/blocks/pages.hpp"

#include "devices/display/figure_painter.hpp"
#include "tools/report/blocks/picture_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <unordered_map>

namespace tactus::report {

namespace {

using display::Colour;
using display::Figure;

// Points. A printer puts an A4 page on Letter with its middle at the middle, which cuts 25 points above and below.
constexpr double page_width = 595.0, page_height = 842.0, margin = 48.0, top = 60.0, bottom = page_height - 64.0;
constexpr double foot = page_height - 46.0;
constexpr double inside = page_width - 2.0 * margin;
constexpr double gutter = 12.0, mark_width = 10.0, cell_gap = 6.0, caption_size = 8.0, min_size = 6.0;
constexpr double table_size = 7.5, max_column = 0.45 * inside, max_drawing = 420.0;
constexpr double points_per_pixel = 0.75;
constexpr Colour ink{0, 0, 0}, alarm{0xB8, 0x1D, 0x24}, rule{0xD8, 0xD8, 0xD8}, soft{0x55, 0x55, 0x55};

/// Bytes of the character that begins at `at`.
std::size_t length_of(std::string_view text, std::size_t at) {
    std::size_t n = 1;
    while (at + n < text.size() && (static_cast<unsigned char>(text[at + n]) & 0xC0U) == 0x80U) ++n;
    return n;
}

/// Measures and wraps text. Words repeat, so that their widths are kept.
class Wrapper {
public:
    double width(const std::string& text, double size, bool bold) {
        const auto [found, is_new] = widths_[bold].try_emplace(text, 0.0);
        if (is_new) found->second = display::figure_painter().text_width(text, unit, bold) / unit;
        return found->second * size;
    }

    /// Lines of at most this width, broken between words, and within words that are wider, as of scripts without spaces.
    std::vector<std::string> lines(const std::string& text, double size, bool bold, double limit) {
        std::vector<std::string> all(1);
        double used = 0.0;
        const double space = width(" ", size, bold);
        for (std::size_t at = 0; at <= text.size();) {
            const std::size_t end = std::min(text.find(' ', at), text.size());
            const std::string word = text.substr(at, end - at);
            const double wide = width(word, size, bold), before = all.back().empty() ? 0.0 : space;
            if (used + before + wide <= limit) {
                all.back() += (all.back().empty() ? "" : " ") + word;
                used += before + wide;
            } else {
                if (!all.back().empty()) all.emplace_back();
                used = add_word(all, word, size, bold, limit);
            }
            at = end + 1;
        }
        return all;
    }

    /// The widest word: a column that is narrower breaks within words.
    double widest_word(const std::string& text, double size, bool bold) {
        double most = 0.0;
        for (std::size_t at = 0; at <= text.size();) {
            const std::size_t end = std::min(text.find(' ', at), text.size());
            most = std::max(most, width(text.substr(at, end - at), size, bold));
            at = end + 1;
        }
        return most;
    }

private:
    double add_word(std::vector<std::string>& all, const std::string& word, double size, bool bold, double limit) {
        const double whole = width(word, size, bold);
        if (whole <= limit) {
            all.back() = word;
            return whole;
        }
        double used = 0.0;
        for (std::size_t at = 0; at < word.size();) {
            const std::size_t bytes = length_of(word, at);
            const std::string one = word.substr(at, bytes);
            const double wide = width(one, size, bold);
            if (used + wide > limit && !all.back().empty()) {
                all.emplace_back();
                used = 0.0;
            }
            all.back() += one;
            used += wide;
            at += bytes;
        }
        return used;
    }

    static constexpr double unit = 100.0;
    std::unordered_map<std::string, double> widths_[2];
};

/// Lays blocks out from the top of the first page.
class Layout {
public:
    explicit Layout(const std::string& title) {
        begin_page();
        paragraph(title, 17.0, true, false);
    }

    /// Keeps a heading on the page of a drawing or of the first pictures that follow it.
    void keep_with(const ReportBlock& next) {
        double high = 0.0;
        if (const auto* d = std::get_if<Drawing>(&next); d && d->figure.height() <= 1.1 * d->figure.width())
            high = d->figure.height() *
                   std::min({points_per_pixel, inside / d->figure.width(), max_drawing / d->figure.height()});
        if (const auto* g = std::get_if<PictureGrid>(&next);
            g && !g->pictures.empty() && g->pictures[0].image.width > 0)
            high = 0.5 * (inside - gutter) * g->pictures[0].image.height / g->pictures[0].image.width;
        if (high > 0.0) need(high + 60.0);
    }
    void add(const Heading& h) {
        need(60.0);
        y_ += h.depth > 1 ? 8.0 : 12.0;
        paragraph(h.text, h.depth > 1 ? 11.0 : 13.0, true, h.is_warning);
    }
    void add(const Paragraph& p) { paragraph(p.text, 9.5, false, false); }
    void add(const ReportList& l) {
        for (const std::string& item : l.items) paragraph("\u2022 " + item, 9.5, false, l.is_warning);
    }

    void add(const ReportTable& t) {
        if (t.head.empty()) return;
        const std::vector<double> widths = columns_of(t);
        const std::size_t lines_of_head = height_in_lines(t.head, widths, true, false);
        // A head is followed by a row on the same page.
        need(row_height(lines_of_head) + 3.0 * table_size);
        row(t.head, widths, true, nullptr, false);
        for (std::size_t n = 0; n < t.rows.size(); ++n) {
            if (need(row_height(height_in_lines(t.rows[n], widths, false, !t.marks.empty()))))
                row(t.head, widths, true, nullptr, false);
            row(t.rows[n], widths, false, n < t.marks.size() ? &t.marks[n] : nullptr,
                n < t.warnings.size() && t.warnings[n]);
        }
        y_ += 6.0;
    }

    void add(const Drawing& d) {
        // Panels below each other get the rest of the page, or a page of their own.
        const bool is_tall = d.figure.height() > 1.1 * d.figure.width();
        const double words = 3.0 * line_of(caption_size), left = bottom - y_ - words, page = bottom - top - words;
        const double high = !is_tall ? max_drawing : left > 0.7 * page ? left : page;
        const double scale = std::min({points_per_pixel, inside / d.figure.width(), high / d.figure.height()});
        captioned(d.figure, scale, d.caption);
    }
    void add(const PictureGrid& g) {
        constexpr double wide = 0.5 * (inside - gutter);
        std::vector<const render::LabelledPicture*> shown;
        for (const render::LabelledPicture& p : g.pictures)
            if (!p.image.rgb.empty()) shown.push_back(&p);
        for (std::size_t n = 0; n < shown.size(); n += 2) {
            const std::span<const render::LabelledPicture* const> pair(&shown[n],
                                                                       std::min<std::size_t>(2, shown.size() - n));
            double high = 0.0, below = 0.0;
            for (const render::LabelledPicture* p : pair) {
                high = std::max(high, wide * p->image.height / p->image.width);
                below =
                    std::max(below, line_of(caption_size) *
                                        static_cast<double>(text_.lines(p->caption, caption_size, false, wide).size()));
            }
            need(high + below + 12.0);
            double left = margin;
            for (const render::LabelledPicture* p : pair) {
                const double scale = wide / p->image.width;
                page().place(figure_of(*p, min_size / scale), left, y_, scale);
                double line = y_ + scale * p->image.height + 2.0;
                for (const std::string& words : text_.lines(p->caption, caption_size, false, wide))
                    page().text({left, line += line_of(caption_size)}, words, caption_size, ink);
                left += wide + gutter;
            }
            y_ += high + below + 12.0;
        }
    }

    std::vector<Figure> pages() {
        for (std::size_t n = 0; n < pages_.size(); ++n) {
            pages_[n].text({margin, foot}, "research use; not a medical device", 7.0, soft);
            pages_[n].text({page_width - margin, foot}, fmt::format("page {} of {}", n + 1, pages_.size()), 7.0, soft,
                           display::TextAnchor::end);
        }
        return std::move(pages_);
    }

private:
    static constexpr double line_of(double size) { return 1.35 * size; }
    static double row_height(std::size_t lines) { return 1.3 * table_size * static_cast<double>(lines) + 4.0; }

    Figure& page() { return pages_.back(); }
    void begin_page() {
        pages_.emplace_back(page_width, page_height);
        y_ = top;
    }
    /// Begins a page if less than this is left; true if it did.
    bool need(double height) {
        if (y_ + height <= bottom || y_ <= top) return false;
        begin_page();
        return true;
    }

    void paragraph(const std::string& words, double size, bool bold, bool is_warning) {
        for (const std::string& line : text_.lines(words, size, bold, inside)) {
            need(line_of(size));
            page().text({margin, y_ += line_of(size)}, line, size, is_warning ? alarm : ink, display::TextAnchor::start,
                        bold);
        }
        y_ += 3.0;
    }

    void captioned(const Figure& figure, double scale, const std::string& caption) {
        const std::vector<std::string> lines = text_.lines(caption, caption_size, false, inside);
        need(scale * figure.height() + line_of(caption_size) * static_cast<double>(lines.size()) + 8.0);
        page().place(figure, margin, y_, scale);
        y_ += scale * figure.height() + 2.0;
        paragraph(caption, caption_size, false, false);
        y_ += 4.0;
    }

    /// Columns as wide as their text, at most 45 % of the page; a table that is too wide is broken between words as long
    /// as the words fit, then within them.
    std::vector<double> columns_of(const ReportTable& t) {
        std::vector<double> wanted(t.head.size(), 0.0), least = wanted;
        const auto measure = [&](const std::vector<std::string>& cells, bool bold) {
            for (std::size_t c = 0; c < wanted.size() && c < cells.size(); ++c) {
                wanted[c] =
                    std::max(wanted[c], std::min(text_.width(cells[c], table_size, bold) + cell_gap, max_column));
                least[c] =
                    std::max(least[c], std::min(text_.widest_word(cells[c], table_size, bold) + cell_gap, max_column));
            }
        };
        measure(t.head, true);
        for (const auto& cells : t.rows) measure(cells, false);
        if (!t.marks.empty()) wanted[0] += mark_width, least[0] += mark_width;
        double whole = 0.0, needed = 0.0;
        for (std::size_t c = 0; c < wanted.size(); ++c) {
            wanted[c] = std::max(wanted[c], least[c]);
            whole += wanted[c];
            needed += least[c];
        }
        if (whole <= inside) return wanted;
        const double share = whole > needed ? std::max(0.0, (inside - needed) / (whole - needed)) : 0.0;
        for (std::size_t c = 0; c < wanted.size(); ++c)
            wanted[c] = (least[c] + share * (wanted[c] - least[c])) * std::min(1.0, inside / needed);
        return wanted;
    }

    std::vector<std::string> cell_lines(const std::vector<std::string>& cells, std::size_t c,
                                        const std::vector<double>& widths, bool bold, bool is_marked) {
        return text_.lines(c < cells.size() ? cells[c] : "", table_size, bold,
                           widths[c] - cell_gap + 0.01 - (c == 0 && is_marked ? mark_width : 0.0));
    }
    std::size_t height_in_lines(const std::vector<std::string>& cells, const std::vector<double>& widths, bool bold,
                                bool is_marked) {
        std::size_t most = 1;
        for (std::size_t c = 0; c < widths.size(); ++c)
            most = std::max(most, cell_lines(cells, c, widths, bold, is_marked).size());
        return most;
    }

    void row(const std::vector<std::string>& cells, const std::vector<double>& widths, bool bold, const Vec3* mark,
             bool is_warning) {
        const double line = 1.3 * table_size;
        if (mark) {
            const Vec3 c = 255.0 * *mark;
            page().rectangle(
                margin, y_ + line - 0.8 * table_size, 0.8 * table_size, 0.8 * table_size,
                {static_cast<std::uint8_t>(c.x), static_cast<std::uint8_t>(c.y), static_cast<std::uint8_t>(c.z), 1.0});
        }
        double x = margin;
        std::size_t most = 1;
        for (std::size_t c = 0; c < widths.size(); ++c) {
            const std::vector<std::string> lines = cell_lines(cells, c, widths, bold, mark != nullptr);
            for (std::size_t n = 0; n < lines.size(); ++n)
                page().text({x + (c == 0 && mark ? mark_width : 0.0), y_ + line * static_cast<double>(n + 1)}, lines[n],
                            table_size, is_warning ? alarm : ink, display::TextAnchor::start, bold);
            most = std::max(most, lines.size());
            x += widths[c];
        }
        y_ += row_height(most);
        page().line({{margin, y_}, {page_width - margin, y_}}, rule, 0.5);
    }

    Wrapper text_;
    std::vector<Figure> pages_;
    double y_ = top;
};

}  // namespace

std::vector<Figure> pages_of(const std::string& title, std::span<const ReportBlock> blocks) {
    Layout layout(title);
    for (std::size_t n = 0; n < blocks.size(); ++n) {
        if (n + 1 < blocks.size() && std::holds_alternative<Heading>(blocks[n])) layout.keep_with(blocks[n + 1]);
        std::visit([&](const auto& one) { layout.add(one); }, blocks[n]);
    }
    return layout.pages();
}

Pdf pdf_of(const std::string& title, std::span<const ReportBlock> blocks) {
    const std::vector<Figure> pages = pages_of(title, blocks);
    return {display::figure_painter().pdf(pages, 1.0, title), display::missing_glyphs(pages)};
}

}  // namespace tactus::report
