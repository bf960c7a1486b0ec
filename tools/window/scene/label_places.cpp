// SPDX-License-Identifier: Apache-2.0
#include "tools/window/scene/label_places.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>

namespace tactus::window {

namespace {

Box moved_to(const Box& box, double top) { return {box.left, top, box.right, top + box.height()}; }

/// Boxes that only touch do not.
bool overlaps(const Box& a, const Box& b) {
    constexpr double rounding = 1e-6;  // pixels
    return a.left < b.right && b.left < a.right && a.top < b.bottom - rounding && b.top < a.bottom - rounding;
}

}  // namespace

std::vector<Box> label_places(std::span<const Box> wanted, const Box& within) {
    std::vector<std::size_t> order(wanted.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return wanted[i].top; });
    std::vector<Box> places(wanted.begin(), wanted.end()), placed;
    for (const std::size_t i : order) {
        const Box& box = wanted[i];
        const auto is_free = [&](double top) {
            return std::ranges::none_of(placed,
                                        [&, b = moved_to(box, top)](const Box& other) { return overlaps(b, other); });
        };
        const double last = within.bottom - box.height();
        const auto fits = [&](double top) { return last < within.top || (top >= within.top && top <= last); };
        // The nearest free place is the wanted one, or touches an edge of what is placed.
        std::vector<double> tops{last < within.top ? box.top : std::clamp(box.top, within.top, last)};
        for (const Box& other : placed)
            if (other.left < box.right && box.left < other.right) {
                tops.push_back(other.bottom);
                tops.push_back(other.top - box.height());
            }
        std::optional<double> best;
        for (const double top : tops)
            if (fits(top) && is_free(top) && (!best || std::abs(top - box.top) < std::abs(*best - box.top))) best = top;
        places[i] = moved_to(box, best.value_or(tops.front()));
        placed.push_back(places[i]);
    }
    return places;
}

}  // namespace tactus::window
