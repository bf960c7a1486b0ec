// SPDX-License-Identifier: Apache-2.0
// What a run leaves in a folder when it was ended, and what had stood there before.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace tactus::campaign {

/// Bytes of each file below a folder, by its path within.
using Snapshot = std::map<std::string, std::string>;
Snapshot snapshot_of(const std::filesystem::path& folder);

/// What is wrong with the files below `folder`. Files of `before` are as they were; only those named in `may_change` may
/// be others, which open. New files are whole: tables have whole rows without NUL bytes, sounds, pictures, JSON and bones
/// open, takes repeat their run as far as they go. Files that are not complete are called `.part`, and there is none
/// where `may_be_cut` is false.
std::vector<std::string> faults_in(const std::filesystem::path& folder, const Snapshot& before,
                                   const std::vector<std::string>& may_change, bool may_be_cut);

}  // namespace tactus::campaign
