// SPDX-License-Identifier: Apache-2.0
#include "graph/node/assets.hpp"

#include "graph/node/value.hpp"

namespace tactus {

std::shared_ptr<const void> SnapshotFile<volume::BoneSnapshot>::load(const std::string& path, void* out) {
    const bone::Bone bone = bone::load_bone(path);
    const auto editor = std::make_shared<const volume::BoneEditor>(
        bone.distance, bone.density, volume::BoneEditorOptions{.max_dirty = 0, .max_versions = 1});
    *static_cast<volume::BoneSnapshot*>(out) = editor->current();
    return editor;
}

}  // namespace tactus
