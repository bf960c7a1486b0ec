// SPDX-License-Identifier: Apache-2.0
#include "dsp/control/deflection_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus::control {

namespace {

double interpolate(const std::vector<double>& x, const std::vector<double>& y, double at) noexcept {
    const auto past = std::upper_bound(x.begin() + 1, x.end() - 1, at);
    const auto i = static_cast<std::size_t>(past - x.begin());
    return y[i - 1] + (y[i] - y[i - 1]) * (at - x[i - 1]) / (x[i] - x[i - 1]);
}

}  // namespace

double DeflectionTable::follow(double deflection, double f) const noexcept {
    const double in = interpolate(force, loading, f), out = interpolate(force, unloading, f);
    return std::clamp(deflection, in, std::max(in, out));
}

double DeflectionTable::min_stiffness() const {
    double least = std::numeric_limits<double>::infinity();
    for (const auto* curve : {&loading, &unloading})
        for (std::size_t i = 1; i < force.size(); ++i)
            if (const double give = (*curve)[i] - (*curve)[i - 1]; give > 0.0)
                least = std::min(least, (force[i] - force[i - 1]) / give);
    return least;
}

std::string DeflectionTable::fault() const {
    if (force.size() < 2) return "a table of deflections needs two rows or more";
    if (loading.size() != force.size() || unloading.size() != force.size()) return "the columns differ in length";
    for (std::size_t i = 0; i < force.size(); ++i) {
        if (!std::isfinite(force[i]) || !std::isfinite(loading[i]) || !std::isfinite(unloading[i]))
            return fmt::format("row {} holds a number that is not finite", i + 1);
        if (i > 0 && !(force[i] > force[i - 1])) return fmt::format("forces must rise; row {} does not", i + 1);
        if (i > 0 && (loading[i] < loading[i - 1] || unloading[i] < unloading[i - 1]))
            return fmt::format("deflections must not fall while the force rises; row {} does", i + 1);
        if (unloading[i] < loading[i])
            return fmt::format("row {}: an object that is let go is not less deflected than one that is pressed",
                               i + 1);
    }
    return {};
}

}  // namespace tactus::control
