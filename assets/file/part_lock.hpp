// SPDX-License-Identifier: Apache-2.0
// A lock that lets only one program at a time write a file that is renamed when it is complete.
#pragma once

#include <filesystem>

namespace tactus::file {

/// Creates `part` if missing and locks it until destroyed; the system releases the lock when the holding process ends.
/// Without it two programs could write one part file, and the first to finish would rename a mixture of both.
class PartLock {
public:
    /// Messages name `path`. Throws Error when another program holds the part, or when it cannot be created.
    PartLock(const std::filesystem::path& part, const std::filesystem::path& path);
    ~PartLock();
    PartLock(const PartLock&) = delete;
    PartLock& operator=(const PartLock&) = delete;

private:
    int handle_ = -1;
};

}  // namespace tactus::file
