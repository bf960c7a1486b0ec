// SPDX-License-Identifier: Apache-2.0
// What can be done to scopes by name, and values of them that are typed.
#include "dsp/core/error.hpp"
#include "dsp/core/units.hpp"
#include "tools/window/signal/scopes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace tactus::window {

namespace {

std::string typed_text(double value, const std::string& unit) {
    return fmt::format("{:.9g}{}{}", value, unit.empty() ? "" : " ", unit);
}

/// What is typed, in the unit that is shown.
double typed_as(const std::string& text, const std::string& unit) {
    const double value = parse_as(text, unit) / parse_unit(unit).factor;
    if (!std::isfinite(value)) throw Error(fmt::format("{} is too large", text));
    return value;
}

bool is_flat(Scopes::Scope::View view) {
    return view == Scopes::Scope::View::xy || view == Scopes::Scope::View::waterfall;
}

double middle(const Range& range, bool is_logarithmic) {
    return is_logarithmic ? std::sqrt(range.low * range.high) : 0.5 * (range.low + range.high);
}

}  // namespace

void Scopes::set_level(Scope& scope, const std::string& text) const {
    const double level = typed_as(text, display(scope.port).unit);
    scope.trigger = Trigger{level, !scope.trigger || scope.trigger->is_rising};
}

void Scopes::set_cursor(Scope& scope, std::size_t index, bool is_up, const std::string& text) {
    const Plot& plot = scope.plot;
    if (plot.curves.empty() && !plot.waterfall) throw Error("the scope shows nothing yet");
    if (index > scope.cursors.size()) throw Error("there is no cursor A yet");
    const Range& shown = is_up ? plot.y : plot.x;
    const std::string& unit = is_up ? plot.y_unit : plot.x_unit;
    const double value = typed_as(text, unit);
    if (value < shown.low || value > shown.high)
        throw Error(fmt::format("{} is not shown; the scope shows {} to {}", typed_text(value, unit),
                                fmt::format("{:.6g}", shown.low), typed_text(shown.high, unit)));
    if (index == scope.cursors.size())
        scope.cursors.push_back({middle(plot.x, plot.is_logarithmic), middle(plot.y, false)});
    (is_up ? scope.cursors[index].y : scope.cursors[index].x) = value;
}

void Scopes::add_value_commands(std::vector<Command>& all, std::size_t index) {
    const Scope& scope = scopes_[index];
    const auto add_one = [&](const std::string& what, const std::string& about, const std::string& value, auto take) {
        const std::string asked = fmt::format("scope {}: {}", index + 1, what);
        all.push_back({"scope", fmt::format("Scope {}: {}...", index + 1, what), "", scope.port + " " + about,
                       [this, index, asked, value, take] {
                           if (ask_value)
                               ask_value({asked, value, [this, index, take](const std::string& typed) {
                                              if (index < scopes_.size()) take(scopes_[index], typed);
                                          }});
                       }});
    };
    if (scope.view == Scope::View::wave)
        add_one("level of the trigger", "exact threshold value",
                typed_text(scope.trigger ? scope.trigger->level : middle(scope.y, false), display(scope.port).unit),
                [this](Scope& of, const std::string& typed) { set_level(of, typed); });
    const auto add_cursor = [&](std::size_t which, bool is_up) {
        const char* const name = which == 0 ? "cursor A" : "cursor B";
        const Range& shown = is_up ? scope.plot.y : scope.plot.x;
        const bool has = which < scope.cursors.size();
        const double there = has ? (is_up ? scope.cursors[which].y : scope.cursors[which].x)
                                 : middle(shown, !is_up && scope.plot.is_logarithmic);
        add_one(fmt::format("{} {}", name,
                            is_up                 ? "up at"
                            : is_flat(scope.view) ? "across at"
                                                  : "at"),
                "measure read place", typed_text(there, is_up ? scope.plot.y_unit : scope.plot.x_unit),
                [which, is_up](Scope& of, const std::string& typed) { set_cursor(of, which, is_up, typed); });
    };
    for (std::size_t which = 0; which <= std::min<std::size_t>(scope.cursors.size(), 1); ++which) {
        add_cursor(which, false);
        if (is_flat(scope.view)) add_cursor(which, true);
    }
    if (!scope.cursors.empty())
        all.push_back({"scope", fmt::format("Scope {}: no cursors", index + 1), "", scope.port + " remove measure",
                       [this, index] {
                           if (index < scopes_.size()) scopes_[index].cursors.clear();
                       }});
}

void Scopes::add_commands(std::vector<Command>& all) {
    for (const Feed::Port& port : ports_)
        all.push_back({"scope", fmt::format("Show {} in a scope", port.name), "", "signal wave curve",
                       [this, name = port.name] { add(name); }});
    for (std::size_t i = 0; i < scopes_.size(); ++i) {
        const auto on_scope = [&](const std::string& what, const std::string& about, auto&& change) {
            all.push_back({"scope", fmt::format("Scope {}: {}", i + 1, what), "", scopes_[i].port + " " + about,
                           [this, i, change] {
                               if (i < scopes_.size()) change(scopes_[i]);
                           }});
        };
        for (std::size_t view = 0; view < std::size(view_names); ++view)
            on_scope(view_names[view], "view show",
                     [view](Scope& scope) { set_view(scope, static_cast<Scope::View>(view)); });
        on_scope(scopes_[i].is_frozen ? "go on" : "freeze", "hold stand",
                 [](Scope& scope) { scope.is_frozen = !scope.is_frozen; });
        on_scope("CSV", "save export table", [](Scope& scope) { scope.wants_file = ".csv"; });
        on_scope("PNG", "save export picture", [](Scope& scope) { scope.wants_file = ".png"; });
        on_scope("close", "remove", [](Scope& scope) { scope.wants_close = true; });
        on_scope("no trigger", "", [](Scope& scope) { scope.trigger.reset(); });
        for (const bool is_rising : {true, false})
            on_scope(is_rising ? "trigger where it rises" : "trigger where it falls", "level middle",
                     [is_rising](Scope& scope) {
                         // In the middle of what is shown, where a wave crosses.
                         scope.trigger = Trigger{middle(scope.y, false), is_rising};
                     });
        add_value_commands(all, i);
        if (display(scopes_[i].port).columns == 3)
            for (const auto& [name, column] :
                 {std::pair("x", 0), std::pair("y", 1), std::pair("z", 2), std::pair("magnitude", -1)})
                on_scope(fmt::format("measure {}", name), "column level trigger", [column = column](Scope& scope) {
                    set_column(scope, static_cast<std::size_t>(std::max(column, 0)), column < 0);
                });
    }
}

}  // namespace tactus::window
