// SPDX-License-Identifier: Apache-2.0
#include "assets/training/session_file.hpp"

#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"

#include <unistd.h>
#include <filesystem>
#include <string>

using namespace tactus;
namespace fs = std::filesystem;

namespace {

struct Scratch {
    fs::path path = fs::temp_directory_path() / ("tactus_session_" + std::to_string(::getpid()) + ".json");
    ~Scratch() { fs::remove(path); }
};

training::SessionFile sample() {
    return {"P07",
            {{"one", "/tasks/one.toml", 0x0123456789abcdefu}, {"two", "/tasks/two.toml", 7}},
            {{"01-one", "2026-01-02T03:04:05.006Z", 12.5, true}}};
}

}  // namespace

TEST_CASE("a session comes back from its file") {
    const Scratch scratch;
    training::save_session_file(sample(), scratch.path);
    const training::SessionFile back = training::load_session_file(scratch.path);
    CHECK(back.trainee == "P07");
    REQUIRE(back.tasks.size() == 2);
    CHECK(back.tasks[0].hash == 0x0123456789abcdefu);
    CHECK(back.tasks[1].file == "/tasks/two.toml");
    REQUIRE(back.attempts.size() == 1);
    CHECK(back.attempts[0].folder == "01-one");
    CHECK(back.attempts[0].seconds == 12.5);
    CHECK(back.attempts[0].ended_early);
}

TEST_CASE("a damaged session, and one that names a folder outside of it, is refused") {
    const Scratch scratch;
    training::save_session_file(sample(), scratch.path);
    const std::string good = file::read_whole_file(scratch.path);
    const auto taken = [&](const std::string& text) {
        file::write_whole_file(scratch.path, text);
        try {
            training::load_session_file(scratch.path);
        } catch (const Error& error) {
            return std::string(error.what()).find(scratch.path.string()) == std::string::npos;
        }
        return true;
    };
    const auto with = [&](const std::string& what, const std::string& by) {
        std::string text = good;
        return text.replace(text.find(what), what.size(), by);
    };
    CHECK(taken(good));
    for (std::size_t length = 0; length + 2 < good.size(); length += 7) CHECK_FALSE(taken(good.substr(0, length)));
    CHECK_FALSE(taken(with("\"format\": 1", "\"format\": 2")));
    for (const char* folder : {"../..", "..", ".", "", "a/b", "/etc"}) CHECK_FALSE(taken(with("01-one", folder)));
    CHECK_FALSE(taken(with("0123456789abcdef", "no hash")));
    CHECK_FALSE(taken(with("\"01-one\"", "5")));
}
