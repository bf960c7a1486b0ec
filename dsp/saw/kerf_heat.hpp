// SPDX-License-Identifier: Apache-2.0
// Temperature of the bone along a kerf: a source that moves with the teeth (Jaeger 1942), in a section across it.
#pragma once

#include <cstddef>
#include <vector>

namespace tactus::saw {

/// Compact bone and what takes its heat away. Conductivity: 0.53 to 0.58 W/(m K) for bovine cortical bone (Davidson and
/// James 2000). The heat capacity lies within the published range of 1150 to 1640 J/(kg K).
struct KerfMaterial {
    double conductivity = 0.56;  ///< W/(m K)
    double density = 1800.0;  ///< kg/m³
    double heat_capacity = 1300.0;  ///< J/(kg K)
    /// W/(m² K), of irrigation on walls and floor of the kerf: laminar flow in a slot with one warm wall has a Nusselt
    /// number of 4.86; 0.62 W/(m K) of water over the hydraulic diameter, twice the 0.15 mm between blade and wall.
    double transfer = 10e3;
    double coolant = -17.0;  ///< K above the bone at rest: water of 20 °C
    double kerf = 1e-3;  ///< m: what the teeth remove takes its heat along; 0: a line that removes nothing

    double diffusivity() const { return conductivity / (density * heat_capacity); }  ///< m²/s
};

/// Temperature rise above the bone at rest, in the half plane beside the kerf: depth along the cut, distance from its
/// middle. The plane of the cut is a plane of symmetry: ahead of the teeth no heat crosses it. The floor of the kerf, half
/// a kerf wide, is heated evenly; the bone that the teeth pass leaves with its heat. Walls and floor are insulated or
/// irrigated. Along the teeth the heat is even, and none leaves at their ends.
///
/// Finite volumes of 0.25 mm, explicit in time; heat is conserved to rounding. `advance` does not allocate.
class KerfHeat {
public:
    static constexpr double cell = 0.25e-3;  ///< m
    static constexpr double deepest = 60e-3;  ///< m, of the cut
    static constexpr double widest = 8e-3;  ///< m from the middle: beyond it the bone stays at rest
    static constexpr double ahead = 8e-3;  ///< m beyond the deepest cut and before its start

    /// Allocates.
    explicit KerfHeat(const KerfMaterial& material = {});

    /// Over `elapsed` s the teeth move to `depth` (m from where the cut began) and make `heat` W per metre of tooth line
    /// (0: they do not cut). `irrigated`: water reaches the walls behind the deepest cut.
    void advance(double elapsed, double depth, double heat, bool irrigated) noexcept;

    double hottest() const { return hottest_; }  ///< K, now, of bone beside the kerf
    double peak() const { return peak_; }  ///< K, since the start
    /// Longest time for which one place of the bone was hotter than `limit`, s.
    double longest_above() const { return longest_; }
    /// Greatest distance from the middle of the cut at which bone was hotter than `limit`, m.
    double reach() const { return reach_; }
    /// Heat in the bone now, J per metre of tooth line, both sides of the kerf.
    double content() const noexcept;
    /// Heat that bone which the teeth removed has taken along since the start, J per metre, both sides.
    double carried() const noexcept { return carried_; }
    /// K, at that depth and distance from the middle (m), between the cells; in the kerf that of its wall; 0 outside.
    double at(double depth, double distance) const noexcept;

    /// A new cut in bone at rest; what was reached stays.
    void begin_cut() noexcept;

    double limit = 10.0;  ///< K: 47 °C in bone of 37 °C (Eriksson and Albrektsson 1983)

private:
    void step(double h, double depth, double heat, bool irrigated) noexcept;
    void remove_to(std::size_t row) noexcept;
    bool is_gone(std::size_t row, std::size_t column) const noexcept {
        return column < half_ && row >= first_cut_ && row < cut_row_;
    }
    std::size_t rows() const { return rise_.size() / columns_; }

    KerfMaterial material_;
    std::size_t columns_;  // away from the kerf
    std::size_t half_;  // columns of half the kerf
    std::size_t first_cut_;  // row where the cut began
    std::vector<double> rise_, next_, above_;  // K, K, s; by depth, then by distance
    std::size_t cut_row_;  // first row that is not cut yet
    std::size_t first_row_, last_row_;  // rows that are not at rest, [first, last)
    double depth_ = 0.0, hottest_ = 0.0, peak_ = 0.0, longest_ = 0.0, reach_ = 0.0, carried_ = 0.0;
};

}  // namespace tactus::saw
