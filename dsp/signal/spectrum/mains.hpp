// SPDX-License-Identifier: Apache-2.0
// Orders of the mains among the lines of a vibration: hum, or a machine at such a rate.
#pragma once

#include <cmath>
#include <optional>
#include <span>

namespace tactus::signal {

/// Relative deviation of the mains from 50 or 60 Hz that is accepted everywhere. Grid operators keep it within 0.4 % in
/// normal operation (49.8 to 50.2 Hz); one record shows one value, which its lines have in common.
inline constexpr double mains_range = 5e-3;
/// Nominal frequencies of the mains, Hz.
inline constexpr int mains_frequencies[] = {50, 60};
/// Hum of higher orders is too weak to matter.
inline constexpr int max_mains_order = 12;
/// Hum has one of its first orders: the mains itself, or those of transformers and rectifiers.
inline constexpr int max_founding_order = 3;
/// Of one record: lines of hum are multiples of one frequency, which wanders by less than this fraction meanwhile.
inline constexpr double mains_drift = 4e-4;

/// Order of mains of `nominal` Hz (1 … max_mains_order) that a line at `hz`, known to `uncertainty` Hz, may be; 0:
/// none.
inline int mains_order(double hz, double nominal, double uncertainty = 0.0) {
    const double order = std::round(hz / nominal);
    const bool is_order = order >= 1.0 && order <= max_mains_order &&
                          std::abs(hz - order * nominal) <= mains_range * order * nominal + uncertainty;
    return is_order ? static_cast<int>(order) : 0;
}

/// Whether a line at `hz` may be an order of 50 or 60 Hz.
inline bool is_mains_order(double hz, double uncertainty = 0.0) {
    for (const int nominal : mains_frequencies)
        if (mains_order(hz, nominal, uncertainty) > 0) return true;
    return false;
}

/// Whether sources of hum have orders of the mains with this greatest common divisor: the mains itself, twice it
/// (transformers, rectifiers of one phase) or six times it (of three phases).
constexpr bool is_hum_family(int divisor) { return divisor == 1 || divisor == 2 || divisor == 6; }

/// Whether the orders of `rate` may be a family of hum by their frequency, where the rate is known to `uncertainty` Hz.
inline bool may_be_hum_rate(double rate, double uncertainty = 0.0) {
    for (const int nominal : mains_frequencies)
        if (const int order = mains_order(rate, nominal, uncertainty); order > 0 && is_hum_family(order)) return true;
    return false;
}

/// A line that may be hum.
struct MainsLine {
    double frequency = 0.0, deviation = 0.0;  ///< Hz; standard deviation
    double power = 0.0;
};

/// The frequency of the mains in one record, of which the lines of hum are multiples.
struct MainsComb {
    int nominal = 50;  ///< Hz
    double frequency = 0.0, deviation = 0.0;  ///< Hz; standard deviation
    int lines = 0;

    /// Order (1 … max_mains_order) that a line at `hz` is, where its `deviation` and that of the mains allow it; 0: none.
    int order_of(double hz, double line_deviation) const;
};

/// The comb of `nominal` Hz that most of the lines have in common, and of these the strongest: it has one of the first
/// three orders within `mains_range`, and its orders are a family of hum. None if no lines are such a comb.
/// `lines`: by frequency.
std::optional<MainsComb> fit_mains(std::span<const MainsLine> lines, int nominal);

}  // namespace tactus::signal
