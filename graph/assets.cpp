// SPDX-License-Identifier: Apache-2.0
#include "graph/assets.hpp"

#include "graph/value.hpp"

namespace tactus {

std::shared_ptr<const void> SnapshotFile<BoneSnapshot>::load(const std::string& path, void* out) {
    const Bone bone = load_bone(path);
    const auto editor = std::make_shared<const BoneEditor>(bone.distance, bone.density,
                                                           BoneEditorOptions{.max_dirty = 0, .max_versions = 1});
    *static_cast<BoneSnapshot*>(out) = editor->current();
    return editor;
}

}  // namespace tactus
