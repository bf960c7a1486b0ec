// SPDX-License-Identifier: Apache-2.0
// Bone files that the program itself would not write.
#pragma once

#include <cstdint>
#include <string>

namespace tactus::test {

/// What stands before the seal of a bone file, with the seal that belongs to it.
std::string sealed(std::string bytes);

/// The grids of such bytes, packed by OpenVDB as its flags say: 1 zip, 2 active values only, 4 Blosc.
std::string repacked(const std::string& bytes, std::uint32_t packing);

}  // namespace tactus::test
