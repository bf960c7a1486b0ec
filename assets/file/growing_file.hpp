// SPDX-License-Identifier: Apache-2.0
// An append-only file of whole records. On a full disk it ends with the last complete record.
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
    /// Creates or truncates `path`. Messages name `shown`. Throws Error.
    explicit GrowingFile(const std::filesystem::path& path, std::filesystem::path shown = {});
    /// Closes; writes buffered records if possible.
    ~GrowingFile();
    GrowingFile(GrowingFile&&) = delete;
    GrowingFile& operator=(GrowingFile&&) = delete;

    /// Buffers a record; it is written by `flush`, or when the buffer is full. Throws Error on the first failure; after
    /// that `append`, `flush` and `close` do nothing.
    void append(std::string_view record);
    /// Writes all buffered records to the system, so that a crash of the program does not lose them. Throws Error like
    /// `append`.
    void flush();
    /// Flushes and closes. Throws Error like `append`.
    void close();

private:
    [[noreturn]] void fail(int code);

    std::filesystem::path shown_;
    int handle_ = -1;
    std::string waiting_;
    std::vector<std::size_t> ends_;  // end of each buffered record
    std::int64_t size_ = 0;  // in bytes, of the whole records in the file
    bool has_failed_ = false;
};

}  // namespace tactus::file
