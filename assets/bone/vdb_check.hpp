// SPDX-License-Identifier: Apache-2.0
// OpenVDB trusts the sizes and counts of a file; a bone's seal finds damage, but anyone can compute it anew.
#pragma once

#include <string>

namespace tactus::bone {

/// Follows what OpenVDB will read of a file without its seal: header, metadata, and per grid the topology and the values
/// of each node. Every count must fit in what is left of the file, and every chunk must hold, packed or not, as many bytes
/// as its node has values. Only what this program writes is let through: format 224, 32-bit float trees 5-4-3 without
/// active tiles, one buffer, no grids that share a tree. Metadata that only serve to load a file piece by piece get a type
/// that OpenVDB skips. `file` is for messages. Throws Error; NoRoom when the trees would not fit in memory.
void check_vdb(std::string& bytes, const std::string& file);

}  // namespace tactus::bone
