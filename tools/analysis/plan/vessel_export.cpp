// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/plan/vessel_export.hpp"

#include "assets/vessel/track_file.hpp"
#include "dsp/vessel/line_branch.hpp"
#include "tools/analysis/plan/flap_export.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::analysis {

void export_vessel(const std::string& name, std::span<const Vec3> points, double radius,
                   const std::vector<std::string>& types, const std::filesystem::path& out,
                   std::vector<std::string>& taken) {
    vessel::Track track;
    track.branches.push_back(vessel::branch_of_line(points, radius));
    if (track.branches[0].nodes.size() < 2) return;
    const std::string stem = file_name_of(name);
    std::string free = stem;
    const auto is_taken = [&] {
        return std::ranges::any_of(
            types, [&](const std::string& type) { return std::ranges::find(taken, free + type) != taken.end(); });
    };
    for (int n = 2; is_taken(); ++n) free = fmt::format("{}-{}", stem, n);
    for (const std::string& type : types) {
        vessel::write_track(track, out / (free + type));
        taken.push_back(free + type);
    }
}

}  // namespace tactus::analysis
