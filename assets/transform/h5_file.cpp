// SPDX-License-Identifier: Apache-2.0
#include "assets/transform/h5_file.hpp"

#include "assets/file/module.hpp"
#include "assets/file/whole_file.hpp"
#include "dsp/core/clock.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>

namespace tactus::transform {

namespace {

constexpr rlim_t max_seconds = 10;
constexpr double max_memory =
    1e9;  // bytes, beyond those of this process; parameters of displacement fields are not read
constexpr char refusal_mark = '!';

const H5Codec& codec() {
    using Make = const H5Codec*();
    static const H5Codec& loaded = *reinterpret_cast<Make*>(file::load_module(h5_module, h5_codec_symbol))();
    return loaded;
}

/// Three lines per transform: type, parameters, fixed parameters.
std::string message_of(const std::vector<ItkTransform>& transforms) {
    std::string text;
    for (const ItkTransform& t : transforms)
        text += fmt::format("{}\n{}\n{}\n", t.type, fmt::join(t.parameters, " "), fmt::join(t.fixed, " "));
    return text;
}

std::vector<double> numbers_of(const std::string& line) {
    std::vector<double> numbers;
    std::istringstream stream(line);
    for (std::string word; stream >> word;) numbers.push_back(std::strtod(word.c_str(), nullptr));
    return numbers;
}

std::vector<ItkTransform> transforms_of(const std::string& message) {
    std::vector<ItkTransform> transforms;
    std::istringstream stream(message);
    for (std::string type, parameters, fixed; std::getline(stream, type);) {
        std::getline(stream, parameters);
        std::getline(stream, fixed);
        transforms.push_back({type, numbers_of(parameters), numbers_of(fixed)});
    }
    return transforms;
}

/// Bounds the memory of this process: the HDF5 library reserves what damaged sizes state.
void limit_memory() {
    rlimit memory{};
    ::getrlimit(RLIMIT_AS, &memory);
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const double present = static_cast<double>(pages) * static_cast<double>(::sysconf(_SC_PAGESIZE));
    memory.rlim_cur = static_cast<rlim_t>(std::min(static_cast<double>(memory.rlim_max), present + max_memory));
    ::setrlimit(RLIMIT_AS, &memory);
}

/// Runs in the new process and ends it.
[[noreturn]] void answer(const H5Codec& codec, const std::filesystem::path& path, int to) {
    const rlimit seconds{max_seconds, max_seconds}, no_core{0, 0};
    ::setrlimit(RLIMIT_CPU, &seconds);
    ::setrlimit(RLIMIT_CORE, &no_core);
    limit_memory();
    std::string message;
    try {
        message = message_of(codec.read(path));
    } catch (const std::exception& error) {
        message = refusal_mark + std::string(error.what());
    }
    for (std::size_t at = 0; at < message.size();) {
        const ssize_t written = ::write(to, message.data() + at, message.size() - at);
        if (written <= 0) ::_exit(1);
        at += static_cast<std::size_t>(written);
    }
    ::_exit(0);
}

/// Returns what the process wrote until it ended; none if that takes longer than twice the processor time it may use,
/// as with a network file system that does not answer.
std::optional<std::string> received(int from) {
    const std::int64_t end = steady_ns() + 2 * static_cast<std::int64_t>(max_seconds) * 1'000'000'000;
    std::string all;
    std::array<char, 4096> part;
    while (true) {
        pollfd waits{from, POLLIN, 0};
        const int ready = ::poll(&waits, 1, ms_until(end));
        if (ready < 0 && errno == EINTR) continue;
        if (ready <= 0) return std::nullopt;
        const ssize_t got = ::read(from, part.data(), part.size());
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return all;
        all.append(part.data(), static_cast<std::size_t>(got));
    }
}

}  // namespace

std::vector<ItkTransform> read_h5(const std::filesystem::path& path) {
    file::require_file(path);
    const H5Codec& loaded = codec();
    std::array<int, 2> ends{};
    if (::pipe(ends.data()) != 0) throw Error(fmt::format("{}: {}", path.string(), std::strerror(errno)));
    const pid_t child = ::fork();
    if (child == 0) {
        ::close(ends[0]);
        answer(loaded, path, ends[1]);
    }
    ::close(ends[1]);
    const std::optional<std::string> message = child > 0 ? received(ends[0]) : std::string();
    if (!message) ::kill(child, SIGKILL);
    ::close(ends[0]);
    int status = 0;
    while (child > 0 && ::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (child < 0) throw Error(fmt::format("{}: no process can be started to read it", path.string()));
    if (!message) throw Error(fmt::format("{}: was not read within {} s", path.string(), 2 * max_seconds));
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        throw Error(fmt::format("{}: is damaged: the HDF5 library fails on it", path.string()));
    if (message->starts_with(refusal_mark)) throw Error(fmt::format("{}: {}", path.string(), message->substr(1)));
    std::vector<ItkTransform> transforms = transforms_of(*message);
    // ITK stores a composite as an empty transform before its parts.
    if (transforms.size() == 2 && transforms.front().type.starts_with("CompositeTransform"))
        transforms.erase(transforms.begin());
    return transforms;
}

void write_h5(const std::filesystem::path& path, const ItkTransform& transform) {
    file::write_whole_file(path, codec().bytes_of(transform));
}

}  // namespace tactus::transform
