// SPDX-License-Identifier: Apache-2.0
// Thresholds of guides and sizes without an option of their own, each with its unit, range and source.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace tactus::analysis {

struct GuideChoice;

/// An option of `plan guide`, a key of its results and a row of its report: one list, so that no threshold can be in
/// the code alone.
struct GuideLimit {
    std::string_view option;  ///< "--max-play"
    std::string_view key;  ///< of JSON: "max_play_mm"; of a share, whose unit is %: "min_contact_share"
    std::string_view about;  ///< what it is, and whether it refuses or warns
    std::string_view unit;  ///< "mm", "°" or "%"
    double si;  ///< of one unit
    double low, high;  ///< what the option accepts, in the unit
    std::string_view source;
    double& (*in)(GuideChoice&);  ///< SI

    double of(const GuideChoice& choice) const;  ///< SI
    std::string text_of(const GuideChoice& choice) const;  ///< "3.0 mm"
};

std::span<const GuideLimit> guide_limits();

}  // namespace tactus::analysis
