// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/sweep/run_point.hpp"

#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/hash.hpp"
#include "tools/exit_code.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <fstream>

namespace tactus::analysis {

namespace fs = std::filesystem;
using file::Json;
using sweep::Row;

namespace {

/// Standard output and error go to the captures until destroyed.
class Redirected {
public:
    Redirected(const run::Capture& out, const run::Capture& err) {
        std::fflush(nullptr);
        out_ = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3);
        err_ = ::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3);
        ::dup2(out.handle(), STDOUT_FILENO);
        ::dup2(err.handle(), STDERR_FILENO);
    }
    ~Redirected() {
        std::fflush(nullptr);
        ::dup2(out_, STDOUT_FILENO);
        ::dup2(err_, STDERR_FILENO);
        ::close(out_);
        ::close(err_);
    }
    Redirected(const Redirected&) = delete;
    Redirected& operator=(const Redirected&) = delete;

private:
    int out_, err_;
};

void reset_peak() {
    std::ofstream("/proc/self/clear_refs") << "5";  // sets the largest resident size to the present one
}

double peak_of_this_process() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with("VmHWM:")) return std::strtod(line.c_str() + 6, nullptr) * 1024.0;
    return 0.0;
}

/// One line for a row: printable, valid UTF-8, at most 300 bytes.
std::string short_line(std::string_view text) {
    std::string out;
    for (std::size_t i = 0; i < text.size() && out.size() < 300; ++i) {
        const auto c = static_cast<unsigned char>(text[i]);
        const std::size_t more = c < 0x80 ? 0 : c >= 0xf0 && c < 0xf5 ? 3 : c >= 0xe0 ? 2 : c >= 0xc2 ? 1 : 9;
        const bool is_valid = more < 9 && c < 0xf5 && i + more < text.size() &&
                              std::ranges::all_of(text.substr(i + 1, more), [](char d) { return (d & 0xc0) == 0x80; });
        if (more == 0) out += c < 0x20 || c == 0x7f ? ' ' : static_cast<char>(c);
        else if (is_valid && more < 3) out += text.substr(i, more + 1), i += more;
        else out += '?';
    }
    // A lone surrogate or an overlong form is no JSON text.
    try {
        Json(out).dump();
    } catch (const std::exception&) {
        for (char& c : out) c = (c & 0x80) != 0 ? '?' : c;
    }
    return out;
}

/// The last line that is not empty, without the name of the program.
std::string last_line(const std::string& text) {
    std::string_view left = text;
    while (!left.empty() && (left.back() == '\n' || left.back() == ' ' || left.back() == '\r')) left.remove_suffix(1);
    if (const std::size_t end = left.rfind('\n'); end != std::string_view::npos) left.remove_prefix(end + 1);
    if (left.starts_with("tactus: ")) left.remove_prefix(8);
    return short_line(left);
}

/// How far a pointer leads, and what is there: "/rows/0 has file, error".
std::string nearest(const Json& json, std::string pointer) {
    while (!value_at(json, pointer)) pointer.resize(pointer.rfind('/'));
    const Json& last = *value_at(json, pointer);
    std::string there;
    if (last.is_array()) there = fmt::format("a list of {}", last.size());
    else if (last.is_object()) {
        std::size_t count = 0;
        for (const auto& [key, value] : last.items())
            if (++count <= 8) there += (count > 1 ? ", " : "") + key;
        if (count > 8) there += fmt::format(" and {} more", count - 8);
    } else there = last.dump();
    return fmt::format("{} has {}", pointer.empty() ? "the top level" : pointer, there);
}

void keep_value(Row& row, Hash& hash, const sweep::KeptValue& kept, const Json& json) {
    const Json* found = value_at(json, kept.pointer);
    if (!found)
        throw Error(
            fmt::format("the JSON has no {} for '{}': {}", kept.pointer, kept.name, nearest(json, kept.pointer)));
    Json value = *found;
    if (value.is_array() || value.is_object()) value = Json(value.dump());
    hash.add_text(kept.name);
    hash.add_text(value.dump());
    row.values[kept.name] = std::move(value);
}

/// Copies a file and returns the hash of its bytes.
std::uint64_t keep_file(const fs::path& from, const fs::path& to, bool is_copied) {
    Hash hash;
    file::add_file(hash, from);
    if (!is_copied) return hash.value();
    std::error_code failure;
    fs::create_directories(to.parent_path(), failure);
    if (!failure) fs::copy_file(from, to, failure);
    // Without the folder, which differs from point to point: equal failures are counted together.
    if (failure) throw Error(fmt::format("{} cannot be kept: {}", to.filename().string(), failure.message()));
    return hash.value();
}

class PointRun {
public:
    PointRun(const PointContext& context, std::size_t index)
        : context_(context),
          sweep_(context.folder->sweep()),
          id_(context.folder->tasks().id(index)),
          point_(context.folder->tasks().point(index)) {
        row_.point = id_;
    }

    Row run() {
        const auto begin = std::chrono::steady_clock::now();
        reset_peak();
        try {
            for (std::size_t s = 0; s < sweep_.steps.size() && row_.reason.empty(); ++s) run_step(s);
            // Also when a step failed: perhaps for this reason.
            if (const fs::path changed = context_.folder->changed_file(point_); !changed.empty())
                row_.reason = fmt::format(
                    "{} has changed since the sweep was prepared; run 'tactus sweep run' again to use the new content",
                    changed.string());
            if (row_.reason.empty()) publish_files();
            row_.is_ok = row_.reason.empty();
        } catch (const std::exception& error) {
            row_.reason = short_line(error.what());
        }
        std::error_code ignored;
        if (!kept_.empty()) fs::remove_all(kept_, ignored);
        if (!row_.is_ok) {
            row_.values = Json::object();
            row_.files = Json::object();
        } else {
            row_.output = hash_.value();
            row_.step = row_.exit_code = 0;
        }
        row_.peak = std::max(peak_of_this_process(), child_peak_);
        row_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        row_.finished = std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
        return std::move(row_);
    }

private:
    void run_step(std::size_t s) {
        const sweep::Step& step = sweep_.steps[s];
        std::vector<std::string> words = sweep::words_of(sweep_, step, point_, id_, context_.scratch, context_.program);
        const run::Capture out("output"), err("errors");
        run::Finished finished;
        if (step.is_own && context_.run_verb) {
            const Redirected to(out, err);
            finished.code = context_.run_verb(words);
        } else {
            if (step.is_own) words.insert(words.begin(), context_.program.string());
            finished = run::run_process(words, context_.scratch, out, err, context_.limits);
            child_peak_ = std::max(child_peak_, finished.peak);
        }
        const std::string which = sweep_.steps.size() > 1 ? fmt::format("step {}: ", s + 1) : std::string();
        row_.step = static_cast<int>(s + 1);
        row_.exit_code = finished.code;
        row_.signal = finished.signal;
        if (finished.is_late) {
            row_.reason = fmt::format("{}took longer than {:g} s", which, context_.limits.seconds);
            return;
        }
        if (finished.signal != 0) {
            row_.reason =
                fmt::format("{}killed by signal {} ({})", which, finished.signal, ::strsignal(finished.signal));
            return;
        }
        if (std::ranges::find(step.accepted, finished.code) == step.accepted.end()) {
            const std::string why = last_line(err.text());
            row_.reason = fmt::format("{}exit code {}{}{}", which, finished.code, why.empty() ? "" : ": ", why);
            return;
        }
        try {
            if (!step.values.empty()) keep_values(step, out);
            for (const std::string& name : step.files) keep(name);
        } catch (const Error& error) {
            row_.reason = which + short_line(error.what());
        }
    }

    void keep_values(const sweep::Step& step, const run::Capture& out) {
        const std::string text = step.from.empty() ? out.text() : file::read_whole_file(context_.scratch / step.from);
        const Json json = Json::parse_or_null(text);
        if (json.is_null())
            throw Error(step.from.empty() ? "standard output is not JSON; add \"--json\" to the step"
                                          : fmt::format("{} is not JSON", step.from));
        for (const sweep::KeptValue& value : step.values) keep_value(row_, hash_, value, json);
        // Verbs that run a patch state a hash over all of its outputs.
        if (const Json* output = json.find("output_hash"); output && output->is_string())
            hash_.add_text(output->as_text());
    }

    void keep(const std::string& name) {
        if (kept_.empty() && context_.keeps_files) {
            const fs::path target = context_.folder->files_of(id_);
            kept_ = target.parent_path() / (".part-" + process_name());
        }
        const std::uint64_t content = keep_file(context_.scratch / name, kept_ / name, context_.keeps_files);
        hash_.add_text(name);
        hash_.add_word(content);
        row_.files[name] = sweep::text_of_id(content);
    }

    /// A whole folder appears, or none. Another runner may have been faster: its row states its hashes.
    void publish_files() {
        if (kept_.empty()) return;
        const fs::path target = context_.folder->files_of(id_);
        if (::rename(kept_.c_str(), target.c_str()) == 0) {
            kept_.clear();
            return;
        }
        const int code = errno;
        if (code == ENOTEMPTY || code == EEXIST) {
            // What is there may be of a failed attempt, or damaged: the hashes decide.
            bool is_equal = true;
            for (const auto& [name, hash] : row_.files.items()) {
                Hash found;
                try {
                    file::add_file(found, target / name);
                } catch (const Error&) {
                    is_equal = false;
                    break;
                }
                is_equal = is_equal && sweep::text_of_id(found.value()) == hash.as_text();
            }
            if (is_equal) return;
            throw Error(fmt::format("{}: has other files than this run made; move the folder away and run again",
                                    target.string()));
        }
        throw Error(fmt::format("{}: cannot be written: {}", target.string(), std::strerror(code)));
    }

    const PointContext& context_;
    const sweep::Sweep& sweep_;
    std::uint64_t id_;
    sweep::Point point_;
    Row row_;
    Hash hash_;
    double child_peak_ = 0.0;
    fs::path kept_;
};

}  // namespace

const Json* value_at(const Json& json, std::string_view pointer) {
    const Json* at = &json;
    while (at && !pointer.empty()) {
        pointer.remove_prefix(1);
        const std::size_t end = std::min(pointer.find('/'), pointer.size());
        std::string key;
        for (std::size_t i = 0; i < end; ++i) {
            if (pointer[i] == '~' && i + 1 < end && (pointer[i + 1] == '0' || pointer[i + 1] == '1'))
                key += pointer[++i] == '0' ? '~' : '/';
            else key += pointer[i];
        }
        pointer.remove_prefix(end);
        if (at->is_array()) {
            std::size_t index = 0;
            const auto [stop, failure] = std::from_chars(key.data(), key.data() + key.size(), index);
            const bool is_index = failure == std::errc{} && stop == key.data() + key.size() && index < at->size();
            at = is_index ? &(*at)[index] : nullptr;
        } else {
            at = at->find(key);
        }
    }
    return at;
}

Row run_point(const PointContext& context, std::size_t index) { return PointRun(context, index).run(); }

}  // namespace tactus::analysis
