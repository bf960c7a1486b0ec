// SPDX-License-Identifier: Apache-2.0
// Registers the unbroken bone (the mirrored healthy side, or an earlier scan) to fragments.
#pragma once

#include "assets/plan/case_plan.hpp"
#include "dsp/fit/registration/registration.hpp"
#include "dsp/geometry/iso_surface.hpp"
#include "tools/analysis/bone/kept_numbers.hpp"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tactus::analysis {

/// The target of a plan in the frame of the case; `folder` is the plan's folder. Throws Error. Does not check
/// whether the file has changed; see check_files.
std::vector<contact::SurfacePoint> laid_target(const plan::MirrorTarget& target, const std::filesystem::path& folder);
/// The same for a surface in the frame of the target's file.
geometry::TriangleSurface laid_surface(const plan::MirrorTarget& target, geometry::TriangleSurface surface);

/// The same as a registration target, for the plan's state; empty if it has no healthy side.
std::optional<fit::RegistrationTarget> healthy_side(const plan::PlanState& state, const std::filesystem::path& folder);

/// m, largest accepted median. The two sides of a body, and two scans, differ by about a millimetre; a misplaced or
/// different bone differs by several.
inline constexpr double max_intact_median = 2e-3;

/// Count of the numbers of a registration of the unbroken bone, see IntactBone.
inline constexpr std::size_t intact_numbers = 11 + 4 + 7;

/// The unbroken bone of a file: a bone file, a CT or a mesh. Loaded on demand.
class IntactBone {
public:
    IntactBone(std::filesystem::path file, bool mirror) : file_(std::move(file)), mirror_(mirror) {}

    /// Registers it to a fragment from any position. Returns the registration of the fragment's points to it, and its
    /// pose on the fragment. Throws Error for a file without surface.
    std::vector<double> numbers_on(std::span<const contact::SurfacePoint> main);
    /// Describes invalid cached points; otherwise empty.
    const std::string& note() const { return note_; }
    /// Returns its points in the frame of the fragment, from the numbers after the registration.
    std::vector<contact::SurfacePoint> laid(NumberReader& numbers);

private:
    const std::vector<contact::SurfacePoint>& points();

    std::filesystem::path file_;
    bool mirror_;
    std::vector<contact::SurfacePoint> points_;
    std::string note_;
};

}  // namespace tactus::analysis
