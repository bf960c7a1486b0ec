// SPDX-License-Identifier: Apache-2.0
#include "assets/sweep/row_log.hpp"

#include "assets/sweep/task_list.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>

namespace tactus::sweep {

namespace fs = std::filesystem;
using file::Json;

namespace {

// {"point":"0123456789abcdef","ok":1,"output":"0123456789abcdef",…
constexpr std::string_view before_id = "{\"point\":\"", after_id = "\",\"ok\":", before_output = ",\"output\":\"";
constexpr std::size_t id_at = before_id.size(), ok_at = id_at + 16 + after_id.size(),
                      output_at = ok_at + 1 + before_output.size(), head_length = output_at + 17;

std::optional<RowHead> head_of(std::string_view line) {
    if (line.size() < head_length || !line.starts_with(before_id) || line.back() != '}' ||
        line.substr(id_at + 16, after_id.size()) != after_id ||
        line.substr(ok_at + 1, before_output.size()) != before_output || line[output_at + 16] != '"' ||
        line.find('\0') != std::string_view::npos)  // a page that was never written, between two rows
        return {};
    const auto point = id_of_text(line.substr(id_at, 16)), output = id_of_text(line.substr(output_at, 16));
    if (!point || !output || (line[ok_at] != '0' && line[ok_at] != '1')) return {};
    return RowHead{*point, *output, line[ok_at] == '1'};
}

}  // namespace

std::string row_line(const Row& row) {
    Json rest{{"seconds", row.seconds}, {"peak", row.peak}, {"finished", row.finished}, {"attempt", row.attempt}};
    if (!row.is_ok) {
        rest["reason"] = row.reason;
        rest["step"] = row.step;
        rest["exit_code"] = row.exit_code;
        rest["signal"] = row.signal;
    }
    if (row.values.size() > 0) rest["values"] = row.values;
    if (row.files.size() > 0) rest["files"] = row.files;
    return fmt::format("{}{}{}{}{}{}\",{}\n", before_id, text_of_id(row.point), after_id, row.is_ok ? 1 : 0,
                       before_output, text_of_id(row.output), rest.dump().substr(1));
}

Row read_row(std::string_view line) {
    const auto head = head_of(line);
    if (!head) throw Error("no row of a sweep");
    const Json json = Json::parse(line);
    Row row;
    row.point = head->point;
    row.output = head->output;
    row.is_ok = head->is_ok;
    row.reason = json.value("reason", std::string());
    row.step = json.value("step", 0);
    row.exit_code = json.value("exit_code", 0);
    row.signal = json.value("signal", 0);
    row.seconds = json.value("seconds", 0.0);
    row.peak = json.value("peak", 0.0);
    row.finished = json.value("finished", 0.0);
    row.attempt = json.value("attempt", 1);
    if (const Json* values = json.find("values"); values && values->is_object()) row.values = *values;
    if (const Json* files = json.find("files"); files && files->is_object()) row.files = *files;
    return row;
}

LogReader::LogReader(const fs::path& path) : path_(path), handle_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (handle_ < 0) throw Error(fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno)));
}

LogReader::~LogReader() { ::close(handle_); }

namespace {

std::size_t read_at(int handle, const fs::path& path, char* to, std::size_t size, std::uint64_t at) {
    std::size_t got = 0;
    while (got < size) {
        const ssize_t count = ::pread(handle, to + got, size - got, static_cast<off_t>(at + got));
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) throw Error(fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno)));
        if (count == 0) break;
        got += static_cast<std::size_t>(count);
    }
    return got;
}

}  // namespace

std::size_t LogReader::scan(
    const std::function<void(const RowHead& head, std::uint64_t at, std::uint32_t length)>& take) const {
    std::size_t damaged = 0, filled = 0;
    std::string block(1 << 20, '\0');
    for (std::uint64_t begin = 0;;) {
        const std::size_t got = read_at(handle_, path_, block.data() + filled, block.size() - filled, begin + filled);
        filled += got;
        std::size_t at = 0;
        while (const void* end = std::memchr(block.data() + at, '\n', filled - at)) {
            const auto length = static_cast<std::size_t>(static_cast<const char*>(end) - (block.data() + at));
            const std::string_view text(block.data() + at, length);
            if (const auto head = head_of(text)) take(*head, begin + at, static_cast<std::uint32_t>(length));
            else if (!text.starts_with("{\"worker\":")) ++damaged;
            at += length + 1;
        }
        if (got == 0) return damaged;  // what is left is half-written
        std::memmove(block.data(), block.data() + at, filled - at);
        begin += at;
        filled -= at;
        if (filled == block.size()) {
            if (block.size() >= std::size_t{1} << 28) return damaged + 1;  // no line of ours
            block.resize(2 * block.size());
        }
    }
}

std::string LogReader::line(std::uint64_t at, std::uint32_t length) const {
    std::string text(length, '\0');
    if (read_at(handle_, path_, text.data(), length, at) != length)
        throw Error(fmt::format("{}: became shorter while it was read; start again", path_.string()));
    return text;
}

Json LogReader::worker() const {
    std::string begin(1 << 16, '\0');
    begin.resize(read_at(handle_, path_, begin.data(), begin.size(), 0));
    const std::size_t end = begin.find('\n');
    if (end == std::string::npos) return {};
    const Json json = Json::parse_or_null(std::string_view(begin).substr(0, end));
    const Json* worker = json.find("worker");
    return worker ? *worker : Json();
}

std::vector<fs::path> log_files(const fs::path& folder) {
    std::vector<fs::path> files;
    std::error_code failure;
    for (fs::directory_iterator entry(folder / "log", failure), end; !failure && entry != end; entry.increment(failure))
        if (entry->path().extension() == ".jsonl") files.push_back(entry->path());
    std::ranges::sort(files);
    return files;
}

}  // namespace tactus::sweep
