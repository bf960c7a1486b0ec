// SPDX-License-Identifier: Apache-2.0
// Two alternatives of a plan side by side: numbers of each, and how far each fragment lies from where the other has it.
// No user interface.
#pragma once

#include "assets/plan/case_plan.hpp"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tactus::window {

/// Of one alternative, at its head.
struct AlternativeNumbers {
    std::string name;
    std::size_t steps = 0, shown = 0;  ///< shown: fragments that are not hidden
    std::size_t fits = 0;  ///< fits that hold
    std::size_t facing = 0;  ///< pairs that face each other
    double gap = 0.0;  ///< m: the median over the pairs of their median gap
    double deepest = 0.0;  ///< m
    double overlap = 0.0;  ///< m³, of all pairs
    std::optional<std::size_t> warnings;  ///< of its reconstruction; none: it has none
};

/// The plan as that alternative has it, and its numbers. Takes seconds. Throws Error for files that are missing or have
/// changed.
AlternativeNumbers numbers_of_alternative(const plan::CasePlan& plan, int alternative,
                                          const std::filesystem::path& folder);
std::string words_of(const AlternativeNumbers& numbers);

/// Where that alternative has the fragments; none: hidden.
std::vector<std::optional<Pose>> poses_of_alternative(const plan::CasePlan& plan, int alternative);

/// A line for each fragment that lies elsewhere, or that only one shows: "fragment_02: 3.10 mm, 4.2°". `middles`: of the
/// fragments in the frame of their files, m.
std::vector<std::string> differences(const plan::CasePlan& plan, int first, int second, std::span<const Vec3> middles);

}  // namespace tactus::window
