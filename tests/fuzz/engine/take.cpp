// SPDX-License-Identifier: Apache-2.0
// Take::load: whatever stands in the texts of a take, it is read or refused with one message.
#include "dsp/core/error.hpp"
#include "engine/take/take_reader.hpp"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string_view>

namespace fs = std::filesystem;

namespace {

// A take in memory whose log is whole, so that only its texts decide.
const fs::path& folder() {
    static const fs::path made = [] {
        fs::path path = "/dev/shm/fuzz-take-" + std::to_string(getpid());
        fs::create_directories(path);
        for (const char* name : {"patch-0.toml", "patch-1.toml"}) std::ofstream(path / name) << "title = \"a\"\n";
        tactus::take::TimingLogWriter(path / "timing.log", 0, 1.0).finish();
        std::atexit([] { fs::remove_all("/dev/shm/fuzz-take-" + std::to_string(getpid())); });
        return path;
    }();
    return made;
}

}  // namespace

// The texts of take.json, events.jsonl and result.json, one after the other, between lines of "----".
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::string_view rest(reinterpret_cast<const char*>(data), size);
    for (const char* name : {"take.json", "events.jsonl", "result.json"}) {
        const std::size_t end = rest.find("----\n");
        std::ofstream(folder() / name, std::ios::binary) << rest.substr(0, end);
        rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 5);
    }
    try {
        const tactus::take::Take take = tactus::take::Take::load(folder());
        for (const tactus::take::TakeStreamInfo& stream : take.streams)
            if (stream.period < 1 || stream.start < 0) std::abort();
        take.differences();
        for (const tactus::take::TakeDamage& damage : take.damages())
            if (damage.holds == damage.written) std::abort();
    } catch (const tactus::Error& error) {
        if (error.message().empty() || error.message().find('\n') != std::string::npos) std::abort();
    }
    return 0;
}
