// SPDX-License-Identifier: Apache-2.0
// A temporary folder, removed with the object.
#pragma once

#include "dsp/core/error.hpp"

#include <cstdlib>
#include <filesystem>
#include <string>

namespace tactus::run {

class ScratchFolder {
public:
    /// Throws Error when the system's temporary folder is not writable.
    ScratchFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "tactus-XXXXXX").string();
        if (::mkdtemp(name.data()) == nullptr) throw Error(name + ": cannot make a temporary folder");
        path_ = name;
    }
    ~ScratchFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

}  // namespace tactus::run
