// SPDX-License-Identifier: Apache-2.0
// What the start page offers: examples of the library, files opened last, takes and plans nearby. No user interface.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tactus::window {

struct StartItem {
    std::string title, note;  ///< note: what it is, or where
    std::filesystem::path path;
    std::filesystem::path picture;  ///< PNG; empty: none
};

struct StartList {
    std::vector<StartItem> examples, recent, takes, plans;
};

/// `folder`: where takes and plans are looked for, and one level below. `recent`: paths, those that are gone are left
/// out. Unreadable places are empty.
StartList start_list(const std::filesystem::path& library, const std::filesystem::path& folder,
                     const std::vector<std::string>& recent);

enum class FileKind { patch, take, plan, bone, scan, sound, table, unknown };
/// By its ending, and of folders by what is in them. A folder that is no take may be a scan: DICOM.
FileKind kind_of_file(const std::filesystem::path& path);
/// A scan that is no mesh.
bool is_ct(const std::filesystem::path& path);

/// Endings of the files that an asset of this type is loaded from; empty: any.
std::vector<std::string> endings_of_asset(std::string_view type_name);

}  // namespace tactus::window
