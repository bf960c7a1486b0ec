// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/bone/fragment_file.hpp"

#include "assets/plan/case_bones.hpp"
#include "tools/analysis/workers.hpp"

namespace tactus::analysis {

bone::Bone bone_of_file(const std::filesystem::path& path) { return plan::bone_from_file(path, on_threads()); }

PoseNumbers numbers_of(const Pose& pose) {
    const Vec3 p = pose.position * 1e3;
    const Quat q = pose.orientation.w < 0.0 ? -pose.orientation : pose.orientation;
    return {{p.x, p.y, p.z}, {q.w, q.x, q.y, q.z}};
}

}  // namespace tactus::analysis
