// SPDX-License-Identifier: Apache-2.0
// Distances on the drawn surfaces of a plan's fragments, as colours: to what faces them, or to the healthy side.
#pragma once

#include "assets/plan/case_plan.hpp"
#include "devices/display/legend.hpp"
#include "dsp/fit/registration/registration.hpp"
#include "engine/observe/seen_values.hpp"
#include "tools/analysis/plan/plan_case.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

namespace tactus::render {

struct SurfaceMap {
    enum class Kind : std::uint8_t {
        gaps,  ///< as fit::gap_between: signed, negative inside the other; of several neighbours the deepest overlap,
        ///< without one the smallest gap
        healthy,  ///< as fit::RegistrationTarget::distance: never negative
    };
    Kind kind = Kind::gaps;
    /// m, for each vertex of make_body_surface; by the content of the body. Infinite where nothing faces it.
    std::map<std::uint64_t, std::vector<float>> distance;
};

/// Of the fragments where the plan's state has them; hidden ones face nothing. `bodies`: of each fragment, in the order
/// of the plan; null ones are left out. Takes seconds. Throws Error for a file that is missing or has changed, and
/// without a healthy side where one is asked for. `stop`: leaves out the fragments that are still to come.
SurfaceMap make_surface_map(SurfaceMap::Kind kind, const plan::CasePlan& plan, const std::filesystem::path& folder,
                            std::span<const std::shared_ptr<const observe::SeenBody>> bodies,
                            std::stop_token stop = {});

/// The same again and again, wherever the fragments are: loads their files once.
class SurfaceMapper {
public:
    /// Throws Error as make_surface_map does.
    SurfaceMapper(SurfaceMap::Kind kind, const plan::CasePlan& plan, const std::filesystem::path& folder);

    /// `poses`: of the fragments' files in the scene; none: hidden, or not there.
    SurfaceMap map(std::span<const std::shared_ptr<const observe::SeenBody>> bodies,
                   std::span<const std::optional<Pose>> poses, std::stop_token stop = {}) const;

private:
    SurfaceMap::Kind kind_;
    std::vector<analysis::CaseFragment> fragments_;
    std::optional<fit::RegistrationTarget> healthy_;
};

/// "gaps" or "mirror". Throws Error with the names.
SurfaceMap::Kind parse_map_kind(const std::string& name);

/// sRGB at a finite distance, full at `range` (m): from light to red for a gap or a distance, to blue for an overlap.
Vec3 map_colour(double distance, double range);
/// What the colours mean.
std::vector<display::Legend::Scale> map_scales(SurfaceMap::Kind kind, double range);

}  // namespace tactus::render
