// SPDX-License-Identifier: Apache-2.0
// Checks an OpenVDB file before OpenVDB reads it, because OpenVDB trusts the sizes and counts in a file. The seal of a
// bone file detects damage, but not a malicious file, whose author can compute the seal.
#pragma once

#include <string>

namespace tactus::bone {

/// Parses the bytes before the seal as OpenVDB would: header, metadata, and for each grid the topology and the values
/// of each node. Every count must fit in the rest of the file, and every chunk must unpack to the size of its node.
/// Accepts only the subset that this program writes: format 224, 32-bit float trees 5-4-3 without active tiles, one
/// buffer, no shared trees. Metadata for delayed loading get a type that OpenVDB skips. `file` is for messages. Throws
/// Error; NoRoom when the trees would not fit in memory.
void check_vdb(std::string& bytes, const std::string& file);

}  // namespace tactus::bone
