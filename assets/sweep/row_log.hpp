// SPDX-License-Identifier: Apache-2.0
// Logs of finished points. Each running worker appends to a file of its own, so that nothing is locked, also on shared
// file systems:
//
//   DIR/log/HOST-PID-TIME.jsonl     {"worker":{…}}   then a line for each attempt that came to its end
//
// A line without line end, or one that is not such an object (zeros that a file system filled in), is ignored: its point
// is run again.
#pragma once

#include "assets/file/json.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::sweep {

/// The last attempt of a point.
struct Row {
    std::uint64_t point = 0;
    bool is_ok = false;
    std::uint64_t output = 0;  ///< hash of all that was kept
    std::string reason;  ///< of a failure, for people
    int step = 0;  ///< number of the failed step, from 1; 0 if no step failed or the worker ended
    int exit_code = 0;  ///< of that step
    int signal = 0;  ///< that ended that step, or the worker; 0: none
    double seconds = 0.0;  ///< wall time
    double peak = 0.0;  ///< largest resident memory, bytes
    double finished = 0.0;  ///< s since 1970
    int attempt = 1;
    file::Json values = file::Json::object();
    file::Json files = file::Json::object();  ///< name → hash
};

/// One line, with its end.
std::string row_line(const Row& row);
/// Throws Error for other texts.
Row read_row(std::string_view line);

/// Fixed-length head of a row's line; parsing it costs a tenth of parsing the row.
struct RowHead {
    std::uint64_t point = 0, output = 0;
    bool is_ok = false;
};

/// A log that may grow meanwhile; lines that are appended after a scan began may be missed. It is read in blocks and not
/// mapped: a writer on a full disk cuts its log back to the last whole line, which would end a program that has it mapped.
class LogReader {
public:
    /// Throws Error when it cannot be opened.
    explicit LogReader(const std::filesystem::path& path);
    ~LogReader();
    LogReader(const LogReader&) = delete;
    LogReader& operator=(const LogReader&) = delete;

    const std::filesystem::path& path() const { return path_; }
    /// Calls `take` for each row, with the line's place. Returns the number of damaged lines. Throws Error.
    std::size_t scan(
        const std::function<void(const RowHead& head, std::uint64_t at, std::uint32_t length)>& take) const;
    /// A line of a row. Throws Error when it is no longer there.
    std::string line(std::uint64_t at, std::uint32_t length) const;
    /// Description of the worker; null if the log has none yet.
    file::Json worker() const;

private:
    std::filesystem::path path_;
    int handle_ = -1;
};

/// All logs of a sweep's folder, by name.
std::vector<std::filesystem::path> log_files(const std::filesystem::path& folder);

}  // namespace tactus::sweep
