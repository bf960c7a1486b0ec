// SPDX-License-Identifier: Apache-2.0
// Bytes as a file in memory, for readers that take a path.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

namespace tactus {

/// A symbolic link with the wanted name, alone in a folder, to a file in memory that holds `data`.
class MemoryFile {
public:
    MemoryFile(const std::uint8_t* data, std::size_t size, const std::string& name)
        : file_(memfd_create("fuzz", 0)), folder_("/dev/shm/fuzz-" + std::to_string(getpid())), path_(folder_ / name) {
        for (std::size_t done = 0; done < size;) {
            const ssize_t part = write(file_, data + done, size - done);
            if (part <= 0) break;
            done += static_cast<std::size_t>(part);
        }
        std::error_code ignored;
        std::filesystem::create_directory(folder_, ignored);
        std::filesystem::create_symlink("/proc/self/fd/" + std::to_string(file_), path_, ignored);
    }
    ~MemoryFile() {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
        close(file_);
    }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;

    const std::filesystem::path& path() const { return path_; }

private:
    int file_;
    std::filesystem::path folder_, path_;
};

}  // namespace tactus
