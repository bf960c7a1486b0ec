// SPDX-License-Identifier: Apache-2.0
#include "tools/window/signal/scopes.hpp"

#include "dsp/core/error.hpp"
#include "tools/window/signal/level_meter.hpp"
#include "tools/window/signal/readings.hpp"
#include "tools/window/widgets/spots.hpp"
#include "tools/window/widgets/theme.hpp"

#include <fmt/format.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <utility>

namespace tactus::window {

void Scopes::add(const std::string& port, bool is_spectrum) {
    const Scope::View view = is_spectrum ? Scope::View::spectrum : Scope::View::wave;
    for (Scope& known : scopes_)
        if (known.port == port && known.view == view) {
            known.is_called = true;
            return;
        }
    Scope scope;
    scope.port = port;
    scope.view = view;
    scopes_.push_back(std::move(scope));
}

double Scopes::longest_span() const {
    double longest = 0.1;
    // A trigger looks as far back as a live trace goes, and shows a little of what was before.
    for (const Scope& scope : scopes_)
        longest = std::max(longest, scope.trigger ? LiveFeed::kept_s + 0.1 * scope.span : scope.span);
    return longest;
}

void Scopes::freeze(bool wanted) {
    for (Scope& scope : scopes_) scope.is_frozen = wanted;
}

void Scopes::set_reference(const std::filesystem::path& path) {
    reference_ = path.empty() ? signal::Spectrum{} : spectrum_of_file(path);
    for (Scope& scope : scopes_) scope.computed_at = -1.0;
}

std::set<std::string> Scopes::traced() const {
    std::set<std::string> ports;
    for (const Scope& scope : scopes_) {
        ports.insert(scope.port);
        ports.insert(scope.others.begin(), scope.others.end());
    }
    return ports;
}

std::string Scopes::unit(const std::string& port) const {
    const std::size_t dot = port.find('.');
    const int node = bench_.picture().find(port.substr(0, dot));
    if (node >= 0)
        for (const PicturePort& p : bench_.picture().nodes[static_cast<std::size_t>(node)].outputs)
            if (p.name == port.substr(dot + 1)) return p.unit;
    return {};
}

Display Scopes::display(const std::string& port) const {
    for (const Feed::Port& known : ports_)
        if (known.name == port) return display_of(*known.type, unit(port));
    return {1.0, unit(port), 1};
}

std::vector<std::string> Scopes::units(const std::string& port) const {
    for (const Feed::Port& known : ports_)
        if (known.name == port) return column_units(*known.type, unit(port));
    return {};
}

bool Scopes::is_sound(const std::string& port) const {
    return std::ranges::any_of(
        ports_, [&](const Feed::Port& known) { return known.name == port && known.type == &value::signal; });
}

double Scopes::rate(const std::string& port) const {
    for (const Feed::Port& known : ports_)
        if (known.name == port) return known.rate;
    return 1000.0;
}

void Scopes::waterfall(const Scope& scope, const Painter& paint, const Box& inner) const {
    if (!scope.plot.waterfall || scope.plot.waterfall->rows == 0) return;
    const Waterfall& all = *scope.plot.waterfall;
    const double top = top_of(all), wide = inner.width() / all.columns, high = inner.height() / all.rows;
    for (int row = 0; row < all.rows; ++row)
        for (int c = 0; c < all.columns; ++c) {
            const double left = inner.left + c * wide, bottom = inner.bottom - row * high;
            paint.list()->AddRectFilled(vec({left, bottom - high}), vec({left + wide, bottom}),
                                        waterfall_ink(all.at(row, c), top));
        }
}

std::string Scopes::cursor_words(const Scope& scope, const Feed& feed, std::span<const Point> at) const {
    switch (scope.view) {
        case Scope::View::wave: {
            const Trace* trace = scope.held ? &*scope.held : feed.trace(scope.port);
            return wave_words(scope.plot, {trace, display(scope.port)}, at);
        }
        case Scope::View::spectrum: return spectrum_words(scope.plot, at);
        case Scope::View::waterfall: return waterfall_words(scope.plot, at);
        case Scope::View::histogram: return histogram_words(scope.plot, at);
        case Scope::View::xy: return xy_words(scope.plot, at);
    }
    return {};
}

void Scopes::body(Scope& scope, std::size_t index, const Feed& feed, const Fonts& fonts, double height) {
    const Painter paint(ImGui::GetWindowDrawList(), fonts);
    const Point corner = point(ImGui::GetCursorScreenPos());
    const double width = static_cast<double>(ImGui::GetContentRegionAvail().x), s = fonts.scale, small = 11.0 * s;
    ImGui::InvisibleButton("plot", vec({width, height}));
    mark_spot(fmt::format("scope {} plot", index));
    const Box all{corner.x, corner.y, corner.x + width, corner.y + height};
    const double meter = scope.meter ? 12.0 * s : 0.0;
    const Box inner{all.left + 52.0 * s, all.top + 6.0 * s, all.right - 8.0 * s - meter, all.bottom - 18.0 * s};
    paint.box(all, colour(0x0f1319), 4.0 * s);
    const Plot& plot = scope.plot;
    if (!(plot.y.span() > 0.0) || inner.width() < 20.0 || inner.height() < 12.0) return;
    const auto x_of = [&](double v) { return inner.left + plot.across(v) * inner.width(); };
    const auto y_of = [&](double v) { return inner.bottom - plot.up(v) * inner.height(); };
    const std::vector<double> across = plot.x_ticks(static_cast<int>(inner.width() / (52.0 * s))),
                              up = linear_ticks(plot.y, std::max(2, static_cast<int>(inner.height() / (24.0 * s))));
    const double x_step = across.size() > 1 ? across[1] - across[0] : 1.0, y_step = up.size() > 1 ? up[1] - up[0] : 1.0;
    for (const double v : across) {
        paint.line({x_of(v), inner.top}, {x_of(v), inner.bottom}, tone::grid);
        const std::string label = plot.is_logarithmic ? fmt::format("{:g}", v) : tick_label(v, x_step);
        paint.text({x_of(v) - 0.5 * paint.width_of(label, small), inner.bottom + 3.0 * s}, small, tone::dim, label);
    }
    for (const double v : up) {
        paint.line({inner.left, y_of(v)}, {inner.right, y_of(v)}, tone::grid);
        paint.text_left_of({inner.left - 5.0 * s, y_of(v) - 0.6 * small}, small, tone::dim, tick_label(v, y_step));
    }
    paint.list()->PushClipRect(vec({inner.left, inner.top}), vec({inner.right, inner.bottom}), true);
    waterfall(scope, paint, inner);
    if (scope.trigger && scope.view == Scope::View::wave)
        paint.line({inner.left, y_of(scope.trigger->level)}, {inner.right, y_of(scope.trigger->level)}, tone::dim);
    std::vector<ImVec2> line;
    for (const Curve& curve : plot.curves)
        for (const std::span<const Point> piece : pieces_of(curve)) {
            line.clear();
            for (const Point& p : piece) line.push_back(vec({x_of(p.x), y_of(p.y)}));
            if (curve.is_reference)
                for (const ImVec2& p : line)
                    paint.list()->AddLine(p, ImVec2(p.x, static_cast<float>(inner.bottom)), faded(curve.ink, 0.22),
                                          1.5f);
            // A lone value would be a line without length.
            if (line.size() == 1) paint.dot({x_of(piece[0].x), y_of(piece[0].y)}, 1.3 * s, curve.ink);
            paint.list()->AddPolyline(line.data(), static_cast<int>(line.size()), curve.ink, 0,
                                      static_cast<float>(1.3 * s));
        }
    const bool hovered = ImGui::IsItemHovered();
    const Point mouse = point(ImGui::GetIO().MousePos);
    const Point pointed{plot.value_at((mouse.x - inner.left) / inner.width()),
                        plot.height_at((inner.bottom - mouse.y) / inner.height())};
    if (hovered && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
        if (scope.cursors.size() == 2) scope.cursors.clear();
        scope.cursors.push_back(pointed);
    }
    const bool is_flat = scope.view == Scope::View::xy || scope.view == Scope::View::waterfall;
    for (const Point& cursor : scope.cursors) {
        paint.line({x_of(cursor.x), inner.top}, {x_of(cursor.x), inner.bottom}, tone::chosen, 1.2 * s);
        if (is_flat) paint.line({inner.left, y_of(cursor.y)}, {inner.right, y_of(cursor.y)}, tone::chosen, 1.2 * s);
    }
    paint.list()->PopClipRect();
    if (scope.meter)
        draw_level_meter(paint, {all.right - meter, inner.top, all.right - 2.0 * s, inner.bottom}, *scope.meter);

    Point at{inner.left + 6.0 * s, inner.top + 2.0 * s};
    paint.text(at, small, tone::dim, plot.y_unit);
    at.x += paint.width_of(plot.y_unit, small) + 12.0 * s;
    for (const Curve& curve : plot.curves) {
        std::string text = curve.name;
        if (curve.last) text += fmt::format(" {:.4g}", *curve.last);
        paint.text(at, small, curve.ink, text);
        at.x += paint.width_of(text, small) + 12.0 * s;
    }
    std::span<const Point> read = scope.cursors;
    if (read.empty() && hovered) read = std::span(&pointed, 1);
    paint.text_left_of({inner.right - 4.0 * s, inner.top + 2.0 * s}, small, tone::chosen,
                       cursor_words(scope, feed, read));
    paint.text_left_of({inner.right - 4.0 * s, inner.bottom - 1.4 * small}, small, tone::dim, scope.reading);
    paint.text({inner.left + 6.0 * s, inner.bottom - 1.4 * small}, small, tone::bad, scope.trouble);
    if (ImGui::GetTime() < scope.called_until) paint.frame(all, tone::chosen, 4.0 * s, 2.0 * s);
}

void Scopes::draw(const Feed* feed, const Fonts& fonts) {
    // Lists may have tens of thousands of entries.
    if (feed && (feed != listed_of_ || listed_ != feed->ports_version())) {
        listed_of_ = feed;
        listed_ = feed->ports_version();
        ports_ = feed->ports();
    }
    if (ImGui::Button("+ scope") && feed)
        if (!ports_.empty()) {
            Scope scope;
            scope.port = ports_.front().name;
            scopes_.push_back(std::move(scope));
        }
    ImGui::SameLine();
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - 6.0f * ImGui::GetFontSize());
    const bool entered = ImGui::InputTextWithHint("##reference", "reference beneath the spectra: a sound file",
                                                  &wanted_reference_, ImGuiInputTextFlags_EnterReturnsTrue);
    ImGui::SameLine();
    if (ImGui::Button("load") || entered) {
        try {
            set_reference(wanted_reference_);
        } catch (const Error& error) {
            bench_.tell(error.what(), true);
        }
    }
    if (!feed) return ImGui::TextDisabled("no run");
    if (scopes_.empty()) ImGui::TextDisabled("double-click an output of the patch to see it here");
    const double row = static_cast<double>(ImGui::GetFrameHeightWithSpacing());
    const double each = static_cast<double>(ImGui::GetContentRegionAvail().y) /
                        std::max<double>(1.0, static_cast<double>(scopes_.size()));
    const double height = std::max(each - row - 8.0 * fonts.scale, 70.0 * fonts.scale);
    std::size_t closed = scopes_.size();
    for (std::size_t i = 0; i < scopes_.size(); ++i) {
        ImGui::PushID(static_cast<int>(i));
        bool closes = std::exchange(scopes_[i].wants_close, false);
        head(scopes_[i], i, *feed, closes);
        if (std::exchange(scopes_[i].is_called, false)) {
            ImGui::SetScrollHereY(0.0f);
            scopes_[i].called_until = ImGui::GetTime() + 1.0;
        }
        if (const std::string ending = std::exchange(scopes_[i].wants_file, {}); !ending.empty())
            save(i, *feed, ending);
        refresh(scopes_[i], *feed, std::max(50, static_cast<int>(ImGui::GetContentRegionAvail().x) - 60));
        body(scopes_[i], i, *feed, fonts, height);
        if (closes) closed = i;
        ImGui::PopID();
    }
    if (closed < scopes_.size()) scopes_.erase(scopes_.begin() + static_cast<std::ptrdiff_t>(closed));
}

}  // namespace tactus::window
