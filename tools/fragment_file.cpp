// SPDX-License-Identifier: Apache-2.0
#include "tools/fragment_file.hpp"

#include "assets/bone/import.hpp"
#include "tools/workers.hpp"

namespace tactus {

Bone bone_of_file(const std::filesystem::path& path) {
    if (file_of_bone(path).extension() == ".vdb") return load_bone(path);
    ImportOptions options;
    options.input = path;
    options.run = on_threads();
    return import_bone(options);
}

PoseNumbers numbers_of(const Pose& pose) {
    const Vec3 p = pose.position * 1e3;
    const Quat q = pose.orientation.w < 0.0 ? -pose.orientation : pose.orientation;
    return {{p.x, p.y, p.z}, {q.w, q.x, q.y, q.z}};
}

}  // namespace tactus
