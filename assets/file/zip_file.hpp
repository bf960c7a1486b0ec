// SPDX-License-Identifier: Apache-2.0
// Reads the files in a zip into memory, one at a time. Nothing is unpacked to disk, and no name in the zip is used as a
// path.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace tactus::file {

/// True for files that begin with the magic number of a zip.
bool is_zip_file(const std::filesystem::path& path);

class ZipFile {
public:
    struct Entry {
        std::string name;  ///< for messages: the zip's path and the name in it, without control characters
        std::uint64_t size = 0;  ///< bytes, unpacked
        std::uint64_t index = 0;
    };

    /// Reads the list of files. Throws Error for a damaged zip, more than 100000 files, files with overlapping packed
    /// bytes, a compression other than deflate, passwords, and for sizes that deflate cannot reach.
    explicit ZipFile(const std::filesystem::path& path);

    /// The files, without folders and empty files.
    const std::vector<Entry>& entries() const { return entries_; }

    /// The bytes of a file, or its first `most`. Throws Error when they are damaged, and NoRoom when they need more than
    /// the memory limit. Any thread may call it.
    std::string read(const Entry& entry, std::uint64_t most = std::numeric_limits<std::uint64_t>::max()) const;

private:
    struct Close {
        void operator()(void* archive) const;
    };
    std::string path_;
    std::unique_ptr<void, Close> archive_;
    mutable std::mutex one_at_a_time_;
    std::vector<Entry> entries_;
};

}  // namespace tactus::file
