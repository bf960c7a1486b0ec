// SPDX-License-Identifier: Apache-2.0
#include "dsp/saw/kerf_heat.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::saw {

namespace {

constexpr std::size_t before = static_cast<std::size_t>(KerfHeat::ahead / KerfHeat::cell);
constexpr double at_rest = 1e-6;  // K
constexpr double longest_step = 4e-3;  // s

}  // namespace

KerfHeat::KerfHeat(const KerfMaterial& material)
    : material_(material),
      columns_(static_cast<std::size_t>(widest / cell)),
      half_(std::min(static_cast<std::size_t>(std::lround(std::max(material.kerf, 0.0) / (2.0 * cell))), columns_ - 1)),
      first_cut_(before),
      rise_((2 * before + static_cast<std::size_t>(deepest / cell)) * columns_, 0.0),
      next_(rise_.size(), 0.0),
      above_(rise_.size(), 0.0),
      cut_row_(before),
      first_row_(before),
      last_row_(before) {}

void KerfHeat::begin_cut() noexcept {
    std::ranges::fill(rise_, 0.0);
    std::ranges::fill(next_, 0.0);
    std::ranges::fill(above_, 0.0);
    cut_row_ = first_row_ = last_row_ = before;
    hottest_ = depth_ = 0.0;
}

/// The teeth have passed the rows before `row`: their bone is gone, with its heat.
void KerfHeat::remove_to(std::size_t row) noexcept {
    for (; cut_row_ < row; ++cut_row_)
        for (std::size_t z = 0; z < half_; ++z) {
            const std::size_t n = cut_row_ * columns_ + z;
            carried_ += 2.0 * rise_[n] * material_.density * material_.heat_capacity * cell * cell;
            rise_[n] = next_[n] = above_[n] = 0.0;
        }
}

void KerfHeat::advance(double elapsed, double depth, double heat, bool irrigated) noexcept {
    if (!(elapsed > 0.0) || !std::isfinite(depth)) return;
    // Explicit diffusion in two directions is stable below cell² / (4 α); short steps also let the source move smoothly.
    const double most = std::min(longest_step, 0.2 * cell * cell / material_.diffusivity());
    const double lasts = std::min(elapsed, 10.0), to = std::clamp(depth, 0.0, deepest - cell);
    const auto steps = static_cast<int>(std::ceil(lasts / most));
    for (int i = 0; i < steps; ++i)
        step(lasts / steps, depth_ + (to - depth_) * (i + 0.5) / steps, std::isfinite(heat) ? std::max(heat, 0.0) : 0.0,
             irrigated);
    depth_ = to;
}

void KerfHeat::step(double h, double depth, double heat, bool irrigated) noexcept {
    const double position = depth / cell;
    const std::size_t row = before + static_cast<std::size_t>(position);
    if (heat > 0.0) {
        remove_to(row);
        first_row_ = std::min(first_row_, row);
        // Half of the heat goes to either side. Between two rows the source moves smoothly; bone that is gone gets none.
        const std::size_t wide = std::max<std::size_t>(half_, 1), at = std::max(row, half_ > 0 ? cut_row_ : row);
        // Heat of a wet floor is made where the water is: it divides as water and half a cell of bone conduct.
        const bool is_wet = irrigated && half_ > 0;
        const double into_cell = material_.conductivity / (0.5 * cell);
        const double stays = is_wet ? into_cell / (into_cell + material_.transfer) : 1.0;
        const double rise = stays * 0.5 * heat * h /
                            (static_cast<double>(wide) * material_.density * material_.heat_capacity * cell * cell);
        // The surface of a wet floor is that of its row.
        const double part = is_wet ? 0.0 : position - std::floor(position);
        for (std::size_t z = 0; z < wide; ++z) {
            rise_[at * columns_ + z] += (1.0 - part) * rise;
            rise_[(at + 1) * columns_ + z] += part * rise;
        }
        last_row_ = std::max(last_row_, at + 2);
    }
    if (irrigated && cut_row_ > before) {
        first_row_ = std::min(first_row_, before);
        last_row_ = std::max(last_row_, cut_row_ + 1);
    }
    if (first_row_ >= last_row_) return;
    first_row_ = std::max<std::size_t>(first_row_ - 1, 1);
    last_row_ = std::min(last_row_ + 1, rows() - 1);

    const double number = material_.diffusivity() * h / (cell * cell);
    // Half a cell of bone lies between the wall and the middle of its cell.
    const double to_wall = 1.0 / (1.0 / material_.transfer + 0.5 * cell / material_.conductivity);
    const double cooling = h * to_wall / (material_.density * material_.heat_capacity * cell);
    hottest_ = 0.0;
    bool first_rests = true, last_rests = true;
    for (std::size_t y = first_row_; y < last_row_; ++y) {
        const double* const here = rise_.data() + y * columns_;
        const double *const back = here - columns_, *const on = here + columns_;
        double* const out = next_.data() + y * columns_;
        double warmest = 0.0;
        for (std::size_t z = 0; z < columns_; ++z) {
            if (is_gone(y, z)) continue;
            const bool at_wall = z == half_ && y >= first_cut_ && y < cut_row_;
            const bool at_floor = z < half_ && y == cut_row_ && y > first_cut_;
            const double inner = z > 0 && !at_wall ? here[z - 1] : here[z];
            const double outer = z + 1 < columns_ ? here[z + 1] : 0.0;
            const double above = at_floor ? here[z] : back[z], below = is_gone(y + 1, z) ? here[z] : on[z];
            double rise = here[z] + number * (above + below + inner + outer - 4.0 * here[z]);
            if (irrigated && (at_wall || at_floor)) rise -= cooling * (here[z] - material_.coolant);
            out[z] = rise;
            warmest = std::max(warmest, std::abs(rise));
            if (z < half_) continue;  // bone that the teeth are about to remove
            hottest_ = std::max(hottest_, rise);
            double& hot_for = above_[y * columns_ + z];
            if (rise <= limit) {
                hot_for = 0.0;
                continue;
            }
            hot_for += h;
            longest_ = std::max(longest_, hot_for);
            reach_ = std::max(reach_, (static_cast<double>(z) + 0.5) * cell);
        }
        if (y == first_row_) first_rests = warmest < at_rest;
        if (y + 1 == last_row_) last_rests = warmest < at_rest;
    }
    std::copy(next_.begin() + static_cast<std::ptrdiff_t>(first_row_ * columns_),
              next_.begin() + static_cast<std::ptrdiff_t>(last_row_ * columns_),
              rise_.begin() + static_cast<std::ptrdiff_t>(first_row_ * columns_));
    // Rows at rest are not computed again until heat comes near.
    if (first_rests) ++first_row_;
    if (last_rests && last_row_ > first_row_) --last_row_;
    peak_ = std::max(peak_, hottest_);
}

double KerfHeat::content() const noexcept {
    double sum = 0.0;
    for (const double rise : rise_) sum += rise;
    return 2.0 * sum * material_.density * material_.heat_capacity * cell * cell;
}

double KerfHeat::at(double depth, double distance) const noexcept {
    const double y = depth / cell + static_cast<double>(before), z = std::abs(distance) / cell - 0.5;
    if (!(y >= 0.0 && y < static_cast<double>(rows() - 1) && z < static_cast<double>(columns_ - 1))) return 0.0;
    const auto row = static_cast<std::size_t>(y), column = static_cast<std::size_t>(std::max(z, 0.0));
    const double b = y - static_cast<double>(row), c = std::max(z, 0.0) - static_cast<double>(column);
    const auto value = [&](std::size_t r, std::size_t k) { return rise_[r * columns_ + (is_gone(r, k) ? half_ : k)]; };
    return (1.0 - b) * ((1.0 - c) * value(row, column) + c * value(row, column + 1)) +
           b * ((1.0 - c) * value(row + 1, column) + c * value(row + 1, column + 1));
}

}  // namespace tactus::saw
