// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/content_hash.hpp"

#include "dsp/core/hash.hpp"

#include <fmt/format.h>

namespace tactus::bone {

std::string content_hash(const Bone& bone) {
    Hash hash;
    for (const volume::Grid* grid : {&bone.distance, &bone.density}) {
        for (int axis = 0; axis < 3; ++axis) {
            hash.add_word(static_cast<std::uint64_t>(grid->size[static_cast<std::size_t>(axis)]));
            for (const double number : {grid->origin[axis], grid->spacing[axis]})
                hash.add_bytes(&number, sizeof(number));
        }
        hash.add_bytes(grid->values.data(), grid->values.size() * sizeof(grid->values[0]));
    }
    return fmt::format("{:016x}", hash.value());
}

}  // namespace tactus::bone
