// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/cutting_guide/kept_guide.hpp"

#include "assets/mesh/write_mesh.hpp"
#include "dsp/core/error.hpp"
#include "tools/analysis/cutting_guide/plan_guide.hpp"
#include "tools/analysis/plan/flap_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace tactus::analysis {

std::vector<std::string> make_kept_guide(reconstruction::KeptGuide& guide, const plan::CasePlan& plan,
                                         const std::filesystem::path& folder) {
    const auto is_plain = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
    };
    if (guide.name.empty() || !std::ranges::all_of(guide.name, is_plain))
        throw Error(fmt::format("'{}' is no name of a guide: letters, digits, '-' and '_'", guide.name));
    const FlapStudy study(plan, plan::state_of(plan), folder);
    GuideChoice choice;
    choice.bone = guide.is_of_jaw ? GuideBone::jaw : GuideBone::fibula;
    choice.cut = guide.is_of_jaw ? guide.cut : 0;
    choice.turn = guide.turn;
    choice.label = guide.label;
    choice.settings.blade = study.inputs().kerf;
    choice.settings.sides = static_cast<cutting_guide::Sides>(guide.sides);
    const PlannedGuide made = plan_guide(study, plan.title, choice);
    std::filesystem::path file = folder / fmt::format("guide-{}.stl", guide.name);
    for (int n = 2; std::filesystem::exists(file); ++n) file = folder / fmt::format("guide-{}-{}.stl", guide.name, n);
    mesh::write_mesh(std::array{mesh::ColouredSurface{made.made.surface, Vec3(0.35, 0.62, 0.72)}}, file);
    guide.mesh = mesh_file(file, folder);
    std::vector<std::string> warnings;
    for (const GuideWarning& warning : made.warnings) warnings.push_back(warning.text);
    return warnings;
}

}  // namespace tactus::analysis
