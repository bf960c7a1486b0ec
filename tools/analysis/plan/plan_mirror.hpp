// SPDX-License-Identifier: Apache-2.0
// Mirrors the healthy side of a case, registers it to the main fragment, and compares the other fragments with it.
#pragma once

#include "assets/plan/kept_result.hpp"
#include "dsp/fit/registration/mirror.hpp"
#include "tools/analysis/bone/surface_file.hpp"
#include "tools/analysis/plan/plan_case.hpp"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tactus::analysis {

/// Contact between a fragment and the main one at a pose, as plan_gaps measures it.
struct FacesThere {
    double facing = 0.0, contact = 0.0;  ///< m²
    double median = 0.0, deepest = 0.0;  ///< m
    double overlap = 0.0;                ///< m³
};

/// Comparison of a fragment with the mirrored side.
struct MirrorComparison {
    fit::Registration registration;
    Motion away;  ///< motion of its centre from the current to the best pose
    FacesThere before, after;
};

/// Registers the healthy side of a case to its main fragment. Results are cached (see kept_result.hpp): a file is
/// loaded only if a result with it is not cached.
class MirrorStudy {
public:
    /// `healthy`: a bone file, a CT or a mesh; `is_mirrored` false: of the same side as the case, and not mirrored. Throws
    /// Error, also for a file of the plan that has changed.
    MirrorStudy(const plan::CasePlan& plan, const std::filesystem::path& folder, int main,
                const std::filesystem::path& healthy, bool is_mirrored = true);

    const fit::MirrorFit& fit() const { return fit_; }
    const plan::MirrorTarget& target() const { return target_; }  ///< as stored in the plan
    const std::vector<std::string>& notes() const { return notes_; }  ///< about invalid cached results

    /// Registers a fragment to the mirrored side from its pose `from`.
    MirrorComparison compare(int other, const Pose& from);

private:
    const CaseFragment& loaded(int fragment);
    const std::vector<contact::SurfacePoint>& healthy_points();
    const fit::RegistrationTarget& surface();
    std::filesystem::path file_of_fragment(int fragment) const;
    std::vector<contact::SurfacePoint> main_points();
    struct MainPart {
        std::vector<contact::SurfacePoint> points;
        contact::Voxmap map;
    };
    /// Returns the main fragment around another one at these poses.
    MainPart main_part(int other, std::span<const Pose> poses);
    FacesThere faces_there(int moving, const Pose& at, const MainPart& main);
    std::vector<double> known(const plan::ResultKey& key, std::size_t count,
                              const std::function<std::vector<double>()>& make);

    std::vector<plan::PlanFragment> fragments_;
    std::filesystem::path folder_, healthy_;
    int main_;
    fit::MirrorFit fit_;
    plan::MirrorTarget target_;
    Pose stands_;  ///< pose of the main fragment
    std::vector<std::optional<CaseFragment>> loaded_;
    std::vector<contact::SurfacePoint> points_;
    std::optional<fit::RegistrationTarget> surface_;
    std::vector<std::string> notes_;
};

}  // namespace tactus::analysis
