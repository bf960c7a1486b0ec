// SPDX-License-Identifier: Apache-2.0
// The module tactus-cairo: drawing lists as pixels and PDF, by Cairo and Pango.
#include "devices/display/figure_painter.hpp"

#include "dsp/core/error.hpp"

#include <cairo/cairo-pdf.h>
#include <pango/pangocairo.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

namespace tactus::display {

namespace {

template <auto Free>
struct Freed {
    template <class T>
    void operator()(T* one) const {
        Free(one);
    }
};
using Surface = std::unique_ptr<cairo_surface_t, Freed<cairo_surface_destroy>>;
using Context = std::unique_ptr<cairo_t, Freed<cairo_destroy>>;
using Layout = std::unique_ptr<PangoLayout, Freed<g_object_unref>>;
using TextContext = std::unique_ptr<PangoContext, Freed<g_object_unref>>;

void check(cairo_status_t status) {
    if (status != CAIRO_STATUS_SUCCESS) throw Error(std::string("cannot draw: ") + cairo_status_to_string(status));
}

constexpr double halo_width = 3.0;

/// Neither hinted nor rounded: the same widths at every resolution.
TextContext text_context() {
    TextContext context(pango_font_map_create_context(pango_cairo_font_map_get_default()));
    cairo_font_options_t* options = cairo_font_options_create();
    cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
    cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
    pango_cairo_context_set_font_options(context.get(), options);
    cairo_font_options_destroy(options);
    pango_cairo_context_set_resolution(context.get(), 96.0);
    pango_context_set_round_glyph_positions(context.get(), FALSE);
    return context;
}

Layout layout_of(PangoContext* context, const std::string& text, double size, bool bold) {
    Layout layout(pango_layout_new(context));
    PangoFontDescription* font = pango_font_description_new();
    pango_font_description_set_family(font, "DejaVu Sans");
    pango_font_description_set_absolute_size(font, size * PANGO_SCALE);
    pango_font_description_set_weight(font, bold ? PANGO_WEIGHT_BOLD : PANGO_WEIGHT_NORMAL);
    pango_layout_set_font_description(layout.get(), font);
    pango_font_description_free(font);
    pango_layout_set_single_paragraph_mode(layout.get(), TRUE);
    pango_layout_set_text(layout.get(), text.data(), static_cast<int>(text.size()));
    return layout;
}

double width_of(PangoLayout* layout) {
    int wide = 0, high = 0;
    pango_layout_get_size(layout, &wide, &high);
    return static_cast<double>(wide) / PANGO_SCALE;
}

double baseline_of(PangoLayout* layout) { return static_cast<double>(pango_layout_get_baseline(layout)) / PANGO_SCALE; }

class Drawer {
public:
    explicit Drawer(cairo_t* to) : to_(to), text_(text_context()) {}

    void draw(const Figure& figure) {
        cairo_set_source_rgb(to_, 1.0, 1.0, 1.0);
        cairo_rectangle(to_, 0.0, 0.0, figure.width(), figure.height());
        cairo_fill(to_);
        cairo_set_line_join(to_, CAIRO_LINE_JOIN_ROUND);
        bool is_clipped = false;
        for (const Figure::Item& item : figure.items()) {
            if (const auto* clip = std::get_if<Figure::Clip>(&item)) {
                if (is_clipped) cairo_restore(to_);
                is_clipped = clip->on;
                if (!is_clipped) continue;
                cairo_save(to_);
                cairo_rectangle(to_, clip->x, clip->y, clip->width, clip->height);
                cairo_clip(to_);
            } else {
                std::visit([this](const auto& one) { add(one); }, item);
            }
        }
        if (is_clipped) cairo_restore(to_);
        check(cairo_status(to_));
    }

private:
    void set(const Colour& c) { cairo_set_source_rgba(to_, c.red / 255.0, c.green / 255.0, c.blue / 255.0, c.opacity); }
    void path(const std::vector<FigurePoint>& points) {
        cairo_new_path(to_);
        for (const FigurePoint& p : points) cairo_line_to(to_, p.x, p.y);
    }

    void add(const Figure::Line& line) {
        set(line.colour);
        path(line.points);
        cairo_set_line_width(to_, line.width);
        cairo_set_dash(to_, &line.dash, line.dash > 0.0 ? 1 : 0, 0.0);
        cairo_stroke(to_);
    }
    void add(const Figure::Fill& fill) {
        set(fill.colour);
        path(fill.outline);
        cairo_fill(to_);
    }
    void add(const Figure::Clip&) {}
    void add(const Figure::Group&) {}

    void add(const Figure::Text& text) {
        const Layout layout = layout_of(text_.get(), text.text, text.size, text.bold);
        const double wide = width_of(layout.get());
        const double before = text.anchor == TextAnchor::start    ? 0.0
                              : text.anchor == TextAnchor::middle ? 0.5 * wide
                                                                  : wide;
        cairo_save(to_);
        cairo_translate(to_, text.at.x, text.at.y);
        if (text.turned) cairo_rotate(to_, -0.5 * std::numbers::pi);
        cairo_move_to(to_, -before, -baseline_of(layout.get()));
        if (text.halo) {
            pango_cairo_layout_path(to_, layout.get());
            cairo_set_source_rgb(to_, 1.0, 1.0, 1.0);
            cairo_set_line_width(to_, halo_width * text.size / 13.0);
            cairo_set_dash(to_, nullptr, 0, 0.0);
            cairo_stroke(to_);
            cairo_move_to(to_, -before, -baseline_of(layout.get()));
        }
        set(text.colour);
        pango_cairo_show_layout(to_, layout.get());
        cairo_restore(to_);
        cairo_new_path(to_);
    }

    template <class Pixel>
    void raster(double x, double y, double width, double height, int columns, int rows, cairo_filter_t filter,
                Pixel&& at) {
        if (columns < 1 || rows < 1) return;
        const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, columns, rows));
        check(cairo_surface_status(surface.get()));
        unsigned char* const data = cairo_image_surface_get_data(surface.get());
        const int stride = cairo_image_surface_get_stride(surface.get());
        for (int row = 0; row < rows; ++row) {
            auto* line = reinterpret_cast<std::uint32_t*>(data + static_cast<std::ptrdiff_t>(row) * stride);
            for (int column = 0; column < columns; ++column) line[column] = at(column, row);
        }
        cairo_surface_mark_dirty(surface.get());
        cairo_save(to_);
        cairo_translate(to_, x, y);
        cairo_rectangle(to_, 0.0, 0.0, width, height);
        cairo_scale(to_, width / columns, height / rows);
        cairo_set_source_surface(to_, surface.get(), 0.0, 0.0);
        cairo_pattern_set_filter(cairo_get_source(to_), filter);
        cairo_pattern_set_extend(cairo_get_source(to_), CAIRO_EXTEND_PAD);
        cairo_fill(to_);
        cairo_restore(to_);
    }
    void add(const Figure::Cells& c) {
        raster(c.x, c.y, c.width, c.height, c.columns, c.rows, CAIRO_FILTER_NEAREST, [&](int column, int row) {
            const Colour& colour = c.palette[c.cells[static_cast<std::size_t>(row * c.columns + column)]];
            return std::uint32_t{colour.red} << 16 | std::uint32_t{colour.green} << 8 | std::uint32_t{colour.blue};
        });
    }
    void add(const Figure::Picture& p) {
        raster(p.x, p.y, p.width, p.height, p.image.width, p.image.height, CAIRO_FILTER_GOOD, [&](int column, int row) {
            const std::uint8_t* pixel = p.image.pixel(column, row);
            return std::uint32_t{pixel[0]} << 16 | std::uint32_t{pixel[1]} << 8 | std::uint32_t{pixel[2]};
        });
    }

    cairo_t* to_;
    TextContext text_;
};

cairo_status_t append(void* to, const unsigned char* data, unsigned int size) {
    static_cast<std::string*>(to)->append(reinterpret_cast<const char*>(data), size);
    return CAIRO_STATUS_SUCCESS;
}

class CairoPainter final : public FigurePainter {
public:
    Image image(const Figure& figure, double scale) const override {
        Image out{static_cast<int>(std::lround(figure.width() * scale)),
                  static_cast<int>(std::lround(figure.height() * scale)),
                  {}};
        const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, out.width, out.height));
        check(cairo_surface_status(surface.get()));
        const Context context(cairo_create(surface.get()));
        cairo_set_source_rgb(context.get(), 1.0, 1.0, 1.0);
        cairo_paint(context.get());
        cairo_scale(context.get(), scale, scale);
        Drawer(context.get()).draw(figure);
        cairo_surface_flush(surface.get());
        const unsigned char* const data = cairo_image_surface_get_data(surface.get());
        const int stride = cairo_image_surface_get_stride(surface.get());
        out.rgb.reserve(3 * static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height));
        for (int y = 0; y < out.height; ++y) {
            const auto* line = reinterpret_cast<const std::uint32_t*>(data + static_cast<std::ptrdiff_t>(y) * stride);
            for (int x = 0; x < out.width; ++x)
                for (const int shift : {16, 8, 0}) out.rgb.push_back(static_cast<std::uint8_t>(line[x] >> shift));
        }
        return out;
    }

    std::string pdf(std::span<const Figure> pages, double points_per_unit, const std::string& title) const override {
        std::string bytes;
        {
            const Surface surface(cairo_pdf_surface_create_for_stream(append, &bytes, 1.0, 1.0));
            check(cairo_surface_status(surface.get()));
            cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_TITLE, title.c_str());
            cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATOR, "Tactus");
            // Without a date Cairo writes the present one.
            cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE, "2000-01-01T00:00:00Z");
            for (const Figure& page : pages) {
                cairo_pdf_surface_set_size(surface.get(), page.width() * points_per_unit,
                                           page.height() * points_per_unit);
                const Context context(cairo_create(surface.get()));
                cairo_scale(context.get(), points_per_unit, points_per_unit);
                Drawer(context.get()).draw(page);
                cairo_show_page(context.get());
                check(cairo_status(context.get()));
            }
            cairo_surface_finish(surface.get());
            check(cairo_surface_status(surface.get()));
        }
        return bytes;
    }

    double text_width(const std::string& text, double size, bool bold) const override {
        // One context per thread: making one takes longer than measuring a word.
        thread_local const TextContext context = text_context();
        return width_of(layout_of(context.get(), text, size, bold).get());
    }

    std::u32string missing(const std::string& text) const override {
        std::u32string all;
        if (std::ranges::all_of(text, [](char c) { return c >= ' ' && c <= '~'; })) return all;
        thread_local const TextContext context = text_context();
        const Layout layout = layout_of(context.get(), text, 12.0, false);
        PangoLayoutIter* at = pango_layout_get_iter(layout.get());
        do {
            const PangoLayoutRun* run = pango_layout_iter_get_run_readonly(at);
            for (int n = 0; run && n < run->glyphs->num_glyphs; ++n) {
                const PangoGlyph glyph = run->glyphs->glyphs[n].glyph;
                if (glyph == PANGO_GLYPH_EMPTY || !(glyph & PANGO_GLYPH_UNKNOWN_FLAG)) continue;
                const auto code = static_cast<char32_t>(glyph & ~PANGO_GLYPH_UNKNOWN_FLAG);
                if (all.find(code) == std::u32string::npos) all += code;
            }
        } while (pango_layout_iter_next_run(at));
        pango_layout_iter_free(at);
        return all;
    }

    std::vector<std::vector<FigurePoint>> outlines(const std::string& text, double size, bool bold,
                                                   double& width) const override {
        constexpr double drawn_size = 100.0;  // at which curves are flattened
        const Surface surface(cairo_recording_surface_create(CAIRO_CONTENT_ALPHA, nullptr));
        const Context context(cairo_create(surface.get()));
        const TextContext texts = text_context();
        const Layout layout = layout_of(texts.get(), text, drawn_size, bold);
        const double scale = size / drawn_size;
        width = width_of(layout.get()) * scale;
        cairo_set_tolerance(context.get(), 0.2);
        cairo_move_to(context.get(), 0.0, -baseline_of(layout.get()));
        pango_cairo_layout_path(context.get(), layout.get());
        cairo_path_t* path = cairo_copy_path_flat(context.get());
        std::vector<std::vector<FigurePoint>> shapes(1);
        for (int n = 0; n < path->num_data; n += path->data[n].header.length) {
            const cairo_path_data_t* part = &path->data[n];
            if (part->header.type == CAIRO_PATH_MOVE_TO) shapes.emplace_back();
            if (part->header.type == CAIRO_PATH_CLOSE_PATH) continue;
            const FigurePoint point{part[1].point.x * scale, part[1].point.y * scale};
            auto& shape = shapes.back();
            if (shape.empty() || shape.back().x != point.x || shape.back().y != point.y) shape.push_back(point);
        }
        cairo_path_destroy(path);
        for (auto& shape : shapes)
            if (shape.size() > 1 && shape.front().x == shape.back().x && shape.front().y == shape.back().y)
                shape.pop_back();
        std::erase_if(shapes, [](const auto& shape) { return shape.size() < 3; });
        return shapes;
    }
};

}  // namespace

extern "C" __attribute__((visibility("default"))) const FigurePainter* tactus_figure_painter() {
    static const CairoPainter painter;
    return &painter;
}

}  // namespace tactus::display
