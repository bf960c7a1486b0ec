// SPDX-License-Identifier: Apache-2.0
#include "tools/view/signal/scopes.hpp"

#include "devices/display/png.hpp"
#include "dsp/core/error.hpp"
#include "tools/view/signal/level_meter.hpp"
#include "tools/view/signal/readings.hpp"
#include "tools/view/spots.hpp"
#include "tools/view/theme.hpp"

#include <fmt/format.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>

namespace tactus::view {

void Scopes::add(const std::string& port, bool is_spectrum) {
    Scope scope;
    scope.port = port;
    if (is_spectrum) scope.view = Scope::View::spectrum;
    scopes_.push_back(std::move(scope));
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

const Trace* Scopes::other(const Scope& scope, std::size_t index, const Feed& feed) const {
    return index < scope.held_others.size() ? &scope.held_others[index] : feed.trace(scope.others[index]);
}

void Scopes::refresh_wave(Scope& scope, const Trace& trace, const Feed& feed, double now, int pixels) {
    const Display shown = display(scope.port);
    double origin = 0.0;
    if (scope.trigger) {
        // A tenth before the crossing, and all of the rest after it.
        const Trigger raw{scope.trigger->level / shown.factor, scope.trigger->is_rising};
        const auto at = trigger_time(trace, 0, raw, {now - LiveFeed::kept_s, now - 0.9 * scope.span});
        if (at) now = (origin = *at) + 0.9 * scope.span;
    }
    scope.plot = time_plot(trace, shown, now, scope.span, pixels, origin);
    Level level = level_of(trace, 0, {now - scope.span, now});
    for (double* part : {&level.low, &level.high, &level.mean, &level.rms}) *part *= shown.factor;
    const bool has_several = std::min(shown.columns, trace.columns.size()) > 1 && !trace.names.empty();
    scope.reading = level_words(level, shown.unit, has_several ? trace.names[0] : "");
    if (scope.trigger && origin == 0.0) scope.reading += ", no crossing of the trigger's level";
    if (is_sound(scope.port) && level.count > 0) scope.meter = level;
    for (std::size_t i = 0; i < scope.others.size(); ++i) {
        const Trace* trace_of = other(scope, i, feed);
        if (!trace_of) continue;
        const Display over_it = display(scope.others[i]);
        Plot over = time_plot(*trace_of, over_it, now, scope.span, pixels, origin);
        for (Curve& curve : over.curves) {
            curve.name = scope.others[i] + (curve.name.empty() ? "" : " " + curve.name);
            if (over_it.unit != shown.unit) curve.name += over_it.unit.empty() ? " (no unit)" : " in " + over_it.unit;
            curve.ink = tone::curves[scope.plot.curves.size() % std::size(tone::curves)];
            scope.plot.curves.push_back(std::move(curve));
        }
        scope.plot.y = {std::min(scope.plot.y.low, over.y.low), std::max(scope.plot.y.high, over.y.high)};
    }
    scope.y = scope.plot.y = fitted(scope.y, scope.plot.y);
}

void Scopes::refresh(Scope& scope, const Feed& feed, int pixels) {
    const Trace* live = feed.trace(scope.port);
    if (scope.is_frozen && !scope.held && live) {
        scope.held = *live;
        scope.held_at = live->times.empty() ? feed.now() : live->times.back();
        scope.held_others.clear();
        for (const std::string& port : scope.others) {
            const Trace* trace = feed.trace(port);
            scope.held_others.push_back(trace ? *trace : Trace{});
        }
    }
    if (!scope.is_frozen) {
        scope.held.reset();
        scope.held_others.clear();
    }
    const Trace* trace = scope.held ? &*scope.held : live;
    if (!trace) return;
    const double now = scope.held ? scope.held_at : trace->times.empty() ? feed.now() : trace->times.back();
    const Display shown = display(scope.port);
    // All but waves are updated every 0.1 s, which looks immediate and saves time.
    const bool is_due = std::abs(now - scope.computed_at) >= 0.1;
    if (scope.view != Scope::View::wave && !is_due) return;
    scope.computed_at = now;
    scope.reading.clear();
    scope.meter.reset();
    switch (scope.view) {
        case Scope::View::wave: refresh_wave(scope, *trace, feed, now, pixels); break;
        case Scope::View::spectrum:
            scope.plot = spectrum_plot(*trace, shown, rate(scope.port), now, scope.span, reference_);
            break;
        case Scope::View::waterfall:
            scope.plot = waterfall_plot(*trace, shown, rate(scope.port), now, scope.span);
            if (scope.plot.waterfall->rows > 0) {
                const double top = top_of(*scope.plot.waterfall);
                scope.reading = fmt::format("black {:.0f}, white {:.0f} {}", top - 90.0, top, scope.plot.level_unit);
            }
            break;
        case Scope::View::histogram: scope.plot = histogram_plot(*trace, shown, now, scope.span); break;
        case Scope::View::xy: {
            // Alone: its second column over its first, as of a pose.
            const Trace* up = scope.others.empty() ? nullptr : other(scope, 0, feed);
            scope.plot =
                up ? xy_plot(*trace, 0, shown, *up, 0, display(scope.others[0]), now, scope.span)
                   : xy_plot(*trace, 0, shown, *trace, trace->columns.size() > 1 ? 1 : 0, shown, now, scope.span);
            break;
        }
    }
    scope.plot.title = scope.port;
}

void Scopes::write(std::size_t index, const Feed& feed, const std::filesystem::path& path) {
    if (index >= scopes_.size()) throw Error(fmt::format("there are {} scopes", scopes_.size()));
    Scope& scope = scopes_[index];
    ports_ = feed.ports();
    refresh(scope, feed, 700);
    if (path.extension() == ".csv") {
        const Trace* trace = scope.held ? &*scope.held : feed.trace(scope.port);
        if (!trace || trace->times.empty()) throw Error(fmt::format("there are no values of {} yet", scope.port));
        // Of a wave what is shown, also where a trigger holds it.
        const double now = scope.held ? scope.held_at : trace->times.back();
        const Range wave{scope.plot.origin + scope.plot.x.low, scope.plot.origin + scope.plot.x.high};
        const bool is_wave = scope.view == Scope::View::wave;
        write_csv(*trace, is_wave ? wave : Range{now - scope.span, now}, units(scope.port), path);
    } else display::write_png(figure_of(scope.plot).image(), path.string());
    bench_.tell(fmt::format("wrote {}", path.string()));
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
    for (const Curve& curve : plot.curves) {
        line.clear();
        for (const Point& p : curve.points) line.push_back(vec({x_of(p.x), y_of(p.y)}));
        if (curve.is_reference)
            for (const ImVec2& p : line)
                paint.list()->AddLine(p, ImVec2(p.x, static_cast<float>(inner.bottom)), faded(curve.ink, 0.22), 1.5f);
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
}

void Scopes::draw(const Feed* feed, const Fonts& fonts) {
    // Lists may have tens of thousands of entries.
    if (feed && (feed != listed_of_ || listed_ != feed->ports_version())) {
        listed_of_ = feed;
        listed_ = feed->ports_version();
        ports_ = feed->ports();
    }
    if (ImGui::Button("+ scope") && feed)
        for (const Feed::Port& port : ports_) {
            add(port.name);
            break;
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
        bool closes = false;
        head(scopes_[i], i, *feed, closes);
        refresh(scopes_[i], *feed, std::max(50, static_cast<int>(ImGui::GetContentRegionAvail().x) - 60));
        body(scopes_[i], i, *feed, fonts, height);
        if (closes) closed = i;
        ImGui::PopID();
    }
    if (closed < scopes_.size()) scopes_.erase(scopes_.begin() + static_cast<std::ptrdiff_t>(closed));
}

}  // namespace tactus::view
