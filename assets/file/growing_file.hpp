// SPDX-License-Identifier: Apache-2.0
// A file that grows by whole records. When the disk is full it ends with the last record that found room.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::file {

class GrowingFile {
public:
    /// Empties or makes `path`. Messages name `shown`. Throws Error.
    explicit GrowingFile(const std::filesystem::path& path, std::filesystem::path shown = {});
    /// Closes; records that still wait are written where that is possible.
    ~GrowingFile();
    GrowingFile(GrowingFile&&) = delete;
    GrowingFile& operator=(GrowingFile&&) = delete;

    /// Adds a record, which reaches the system with `flush`, or when enough of them wait. Throws Error, once: from then
    /// on the file takes nothing more and `append`, `flush` and `close` do nothing.
    void append(std::string_view record);
    /// Hands all records to the system: a crash of the program loses nothing of them. Throws Error as `append`.
    void flush();
    /// The same, and closes. Throws Error as `append`.
    void close();

private:
    [[noreturn]] void fail(int code);

    std::filesystem::path shown_;
    int handle_ = -1;
    std::string waiting_;
    std::vector<std::size_t> ends_;  // of the records in it
    std::int64_t size_ = 0;  // in bytes, of the whole records in the file
    bool has_failed_ = false;
};

}  // namespace tactus::file
