// SPDX-License-Identifier: Apache-2.0
// One program at a time writes a file that is renamed when it is whole.
#pragma once

#include <filesystem>

namespace tactus::file {

/// Makes `part` where it is missing and holds it until destroyed; the system lets go when the holder dies. Without it two
/// programs would write into one part, and the first to end would give the mixture its name.
class PartLock {
public:
    /// Messages name `path`. Throws Error when another program holds the part, or it cannot be made.
    PartLock(const std::filesystem::path& part, const std::filesystem::path& path);
    ~PartLock();
    PartLock(const PartLock&) = delete;
    PartLock& operator=(const PartLock&) = delete;

private:
    int handle_ = -1;
};

}  // namespace tactus::file
