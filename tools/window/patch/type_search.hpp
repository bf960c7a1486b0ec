// SPDX-License-Identifier: Apache-2.0
// Node types by words. No user interface.
#pragma once

#include "tools/window/document/patch_picture.hpp"

#include <string_view>
#include <vector>

namespace tactus::window {

/// The input of a type that a value would go to: one of its type, or one that takes any; null: none.
const PicturePort* input_for(const NodeType& type, const ValueType* value);

/// Names the payload of a type that is dragged from a list of node types.
inline constexpr const char* dragged_type = "node type";

/// Types that suit some words by their name, purpose, or the names, purposes and units of their ports and parameters; best
/// first, and of equal ones those that the patches of the library use most. `feeds`: only types with an input for a value of this type; null: all.
std::vector<const NodeType*> types_for(std::string_view words, const ValueType* feeds);

}  // namespace tactus::window
