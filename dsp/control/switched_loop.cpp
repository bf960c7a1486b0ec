// SPDX-License-Identifier: Apache-2.0
#include "dsp/control/switched_loop.hpp"

#include "dsp/control/position_loop.hpp"
#include "dsp/signal/filter/one_pole.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace tactus::control {

namespace {

/// Where the hand holds the finger at rest, and where it moves to at once; in units of a millimetre, + into the object.
struct HandMove {
    double from, to;
};
constexpr HandMove moves[] = {{-3.0, 3.0},  {-10.0, 10.0}, {-3.0, 2.0},  {-3.0, 0.5},
                              {-3.0, 0.05}, {3.0, -0.5},   {3.0, -0.05}, {-1.0, 0.0}};
constexpr double unit = 1e-3;  // m
constexpr int window = 200, windows = 20;  // periods

/// How far the finger moves in a window, and whether it returns: creep does not.
struct Extent {
    double low = 0.0, high = 0.0, path = 0.0, first = 0.0, last = 0.0;
    bool is_new = true;

    void add(double x) noexcept {
        if (is_new) low = high = first = last = x;
        is_new = false;
        low = std::min(low, x);
        high = std::max(high, x);
        path += std::abs(x - last);
        last = x;
    }
    double size() const noexcept { return high - low; }
    bool returns() const noexcept { return path - std::abs(last - first) > 0.5 * size(); }
};

bool settles_after(const HandMove& move, const LoopModel& model, const ObjectSettings& settings) noexcept {
    ObjectSettings at_edge = settings;
    at_edge.rest = 0.0;
    VirtualObject object;
    object.set(at_edge, model.period);
    object.place(move.from * unit);
    PositionLoop loop;
    const double fastest = model.max_speed > 0.0 ? model.max_speed : 1e9;
    const PositionLoopSettings position{model.gain, model.feed_forward, model.feed_forward_lag, fastest,
                                        0.0,        model.delay};
    const int delay = std::clamp(model.delay, 0, 8);
    std::array<double, 9> under_way{};
    double x = move.from * unit, speed = 0.0, wanted = x;
    const double gained = signal::lag_share(model.motor_lag, model.period),
                 run_on = model.motor_lag > 0.0 ? model.motor_lag * gained : 0.0;
    double first = 0.0, before = 0.0;
    Extent now;
    for (int n = 0; n < window * windows; ++n) {
        const double next = object.step(model.hand_stiffness * (move.to * unit - x));
        std::shift_right(under_way.begin(), under_way.end(), 1);
        under_way[0] = loop(position, next, x, next - wanted, model.period);
        wanted = next;
        const double acts = under_way[static_cast<std::size_t>(delay)];
        x += run_on * speed + (model.period - run_on) * acts;
        speed += gained * (acts - speed);
        if (!(std::abs(x) < 1e3 * unit)) return false;
        now.add(x);
        if ((n + 1) % window != 0) continue;
        const double size = now.returns() ? now.size() : 0.0;
        if (size < 2e-3 * unit) return true;
        // The first window is on the way to the new place.
        if (n + 1 == 2 * window) first = size;
        if (n + 1 > 2 * window && size < 0.2 * first) return true;
        if (n + 1 < window * windows) before = size;
        else return size < 0.99 * before;
        now = {};
    }
    return true;
}

}  // namespace

bool settles(const LoopModel& model, const ObjectSettings& object) noexcept {
    return std::ranges::all_of(moves, [&](const HandMove& move) { return settles_after(move, model, object); });
}

double switched_gain_limit(const LoopModel& model, const ObjectSettings& object) noexcept {
    const double linear = gain_limit(model, object);
    if (!object.one_sided || !(model.hand_stiffness > 0.0)) return linear;
    double limit = 0.0;
    LoopModel at = model;
    for (const double share : {0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.65, 0.8, 0.95}) {
        at.gain = share * linear;
        if (!settles(at, object)) return limit;
        limit = at.gain;
    }
    return linear;
}

}  // namespace tactus::control
