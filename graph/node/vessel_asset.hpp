// SPDX-License-Identifier: Apache-2.0
// The centreline of a vessel as an asset, for the few nodes that name one; see graph/node/assets.hpp.
#pragma once

#include "assets/vessel/course_file.hpp"
#include "graph/node/param.hpp"

namespace tactus {

template <>
struct AssetLoader<vessel::Course> {
    static constexpr std::string_view name = "course of a vessel";
    static vessel::Course load(const std::string& path) { return vessel::load_course(path); }
};

}  // namespace tactus
