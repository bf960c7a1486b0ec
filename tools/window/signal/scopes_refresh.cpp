// SPDX-License-Identifier: Apache-2.0
// What scopes compute for a picture: curves, levels, what is held.
#include "tools/window/signal/readings.hpp"
#include "tools/window/signal/scopes.hpp"
#include "tools/window/widgets/theme.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace tactus::window {

const Trace* Scopes::other(const Scope& scope, std::size_t index, const Feed& feed) const {
    if (!scope.held) return feed.trace(scope.others[index]);
    return index < scope.held_others.size() ? &scope.held_others[index] : nullptr;
}

void Scopes::add_overlay(Scope& scope, const std::string& port) {
    scope.others.push_back(port);
    scope.computed_at = -1.0;
}

void Scopes::remove_overlay(Scope& scope, std::size_t index) {
    const auto at = static_cast<std::ptrdiff_t>(index);
    scope.others.erase(scope.others.begin() + at);
    // What is frozen stays.
    if (index < scope.held_others.size()) scope.held_others.erase(scope.held_others.begin() + at);
    scope.computed_at = -1.0;
}

Scopes::Measured Scopes::measured(Scope& scope, const Trace& trace) {
    if (scope.is_magnitude && trace.columns.size() >= 3) {
        scope.magnitude = magnitude_of(trace);
        return {&scope.magnitude, 0};
    }
    return {&trace, std::min(scope.column, std::max<std::size_t>(trace.columns.size(), 1) - 1)};
}

std::string Scopes::overlay_name(const Scope& scope, std::size_t index, const std::string& curve) const {
    const std::string port = scope.others[index], its = display(port).unit;
    std::string name = port + (curve.empty() ? "" : " " + curve);
    if (its != display(scope.port).unit) name += its.empty() ? " (no unit)" : " in " + its;
    return name;
}

void Scopes::refresh_wave(Scope& scope, const Trace& trace, const Feed& feed, double now, int pixels) {
    const Display shown = display(scope.port);
    const Measured its = measured(scope, trace);
    std::optional<double> crossing;
    if (scope.trigger) {
        // A tenth before the crossing, and all of the rest after it. A lone crossing is shown before the rest is there.
        const Trigger raw{scope.trigger->level / shown.factor, scope.trigger->is_rising};
        const double whole = now - 0.9 * scope.span;
        crossing = trigger_time(*its.trace, its.column, raw, {now - LiveFeed::kept_s, whole});
        if (!crossing) crossing = trigger_time(*its.trace, its.column, raw, {whole, now});
        if (crossing) now = *crossing + 0.9 * scope.span;
    }
    const double origin = crossing.value_or(0.0);
    // Times since a crossing are no times of the run.
    if ((origin != 0.0) != (scope.plot.origin != 0.0)) scope.cursors.clear();
    scope.plot = time_plot(trace, shown, now, scope.span, pixels, origin);
    if (its.trace != &trace) {
        Plot length = time_plot(*its.trace, {shown.factor, shown.unit, 1}, now, scope.span, pixels, origin);
        length.curves[0].ink = tone::curves[scope.plot.curves.size() % std::size(tone::curves)];
        scope.plot.curves.push_back(std::move(length.curves[0]));
        scope.plot.y = {std::min(scope.plot.y.low, length.y.low), std::max(scope.plot.y.high, length.y.high)};
    }
    Level level = level_of(*its.trace, its.column, {now - scope.span, now});
    for (double* part : {&level.low, &level.high, &level.mean, &level.rms}) *part *= shown.factor;
    const bool has_several = std::min(shown.columns, trace.columns.size()) > 1 && its.column < its.trace->names.size();
    scope.reading = level_words(level, shown.unit, has_several ? its.trace->names[its.column] : "");
    if (scope.trigger && !crossing)
        scope.reading += std::string(scope.reading.empty() ? "" : ", ") + "no crossing of the trigger's level";
    if (is_sound(scope.port) && level.count > 0) scope.meter = level;
    for (std::size_t i = 0; i < scope.others.size(); ++i) {
        const Trace* trace_of = other(scope, i, feed);
        if (!trace_of) continue;
        Plot over = time_plot(*trace_of, display(scope.others[i]), now, scope.span, pixels, origin);
        for (Curve& curve : over.curves) {
            curve.name = overlay_name(scope, i, curve.name);
            curve.ink = tone::curves[scope.plot.curves.size() % std::size(tone::curves)];
            scope.plot.curves.push_back(std::move(curve));
        }
        scope.plot.y = {std::min(scope.plot.y.low, over.y.low), std::max(scope.plot.y.high, over.y.high)};
    }
    scope.y = scope.plot.y = fitted(scope.y, scope.plot.y);
    say_flaws(scope, trace, now);
}

Plot Scopes::spectrum(Scope& scope, const Trace& trace, const Feed& feed, double now) const {
    const Measured its = measured(scope, trace);
    Plot plot =
        spectrum_plot(*its.trace, its.column, display(scope.port), rate(scope.port), now, scope.span, reference_);
    for (std::size_t i = 0; i < scope.others.size(); ++i) {
        const Trace* over = other(scope, i, feed);
        if (!over) continue;
        Plot its_plot = spectrum_plot(*over, 0, display(scope.others[i]), rate(scope.others[i]), now, scope.span, {});
        Curve& curve = its_plot.curves[0];
        curve.name = overlay_name(scope, i, curve.name);
        curve.ink = tone::curves[plot.curves.size() % std::size(tone::curves)];
        plot.curves.push_back(std::move(curve));
    }
    fit_levels(plot);
    return plot;
}

void Scopes::say_flaws(Scope& scope, const Trace& trace, double now) const {
    Flaws all;
    const std::size_t count = std::min(display(scope.port).columns, trace.columns.size());
    for (std::size_t c = 0; c < count; ++c) {
        const Flaws flaws = flaws_of(trace, c, {now - scope.span, now});
        all.missing = flaws.missing;
        all.not_finite += flaws.not_finite;
    }
    scope.trouble = flaw_words(all);
}

void Scopes::refresh_held(Scope& scope, const Feed& feed) {
    if (!scope.is_frozen) {
        scope.held.reset();
        scope.held_others.clear();
        return;
    }
    const Trace* live = feed.trace(scope.port);
    if (!scope.held && live) {
        scope.held = *live;
        scope.held_at = live->times.empty() ? feed.now() : live->times.back();
        scope.held_others.clear();
    }
    if (!scope.held) return;
    // One that is drawn over it later may be traced from the next picture on.
    scope.held_others.resize(scope.others.size());
    for (std::size_t i = 0; i < scope.others.size(); ++i)
        if (const Trace* trace = feed.trace(scope.others[i]); trace && scope.held_others[i].times.empty())
            scope.held_others[i] = *trace;
}

void Scopes::refresh(Scope& scope, const Feed& feed, int pixels) {
    refresh_held(scope, feed);
    const Trace* trace = scope.held ? &*scope.held : feed.trace(scope.port);
    if (!trace) return;
    const double now = scope.held ? scope.held_at : trace->times.empty() ? feed.now() : trace->times.back();
    const Display shown = display(scope.port);
    // All but waves are updated every 0.1 s, which looks immediate and saves time.
    const bool is_due = std::abs(now - scope.computed_at) >= 0.1;
    if (scope.view != Scope::View::wave && !is_due) return;
    scope.computed_at = now;
    scope.reading.clear();
    scope.meter.reset();
    if (scope.view == Scope::View::wave) refresh_wave(scope, *trace, feed, now, pixels);
    else {
        const Measured its = measured(scope, *trace);
        switch (scope.view) {
            case Scope::View::wave: break;
            case Scope::View::spectrum: scope.plot = spectrum(scope, *trace, feed, now); break;
            case Scope::View::waterfall:
                scope.plot = waterfall_plot(*its.trace, its.column, shown, rate(scope.port), now, scope.span);
                if (scope.plot.note.empty()) {
                    const double top = top_of(*scope.plot.waterfall);
                    scope.reading =
                        fmt::format("black {:.0f}, white {:.0f} {}", top - 90.0, top, scope.plot.level_unit);
                }
                break;
            case Scope::View::histogram:
                scope.plot = histogram_plot(*its.trace, its.column, shown, now, scope.span);
                break;
            case Scope::View::xy: {
                // Alone: its second column over its first, as of a pose; of another one that is chosen over it.
                const Trace* up = scope.others.empty() ? nullptr : other(scope, 0, feed);
                const std::size_t next = trace->columns.size() > 1 ? 1 : 0;
                scope.plot =
                    up ? xy_plot(*its.trace, its.column, shown, *up, 0, display(scope.others[0]), now, scope.span)
                       : xy_plot(*trace, 0, shown, *its.trace,
                                 its.trace == trace && its.column == 0 ? next : its.column, shown, now, scope.span);
                break;
            }
        }
        if (!scope.plot.note.empty()) scope.reading += (scope.reading.empty() ? "" : ", ") + scope.plot.note;
        say_flaws(scope, *trace, now);
    }
    scope.plot.title = scope.port;
}

}  // namespace tactus::window
