// SPDX-License-Identifier: Apache-2.0
#include "devices/audio/portaudio.hpp"
#include "devices/audio/quiet.hpp"
#include "devices/audio/stream_state.hpp"
#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"

#include <unistd.h>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

using namespace tactus;

TEST_CASE("what is written is what the card gets, then silence that is counted") {
    audio::StreamState state(2, 8);
    const std::array<float, 6> in{1, 2, 3, 4, 5, 6};
    CHECK(state.write(in.data(), 3) == 3);
    std::array<float, 10> out;
    out.fill(9.0F);
    state.feed(out.data(), 5, 700);
    CHECK(out == std::array<float, 10>{1, 2, 3, 4, 5, 6, 0, 0, 0, 0});
    CHECK(state.statistics().underflows == 1);
    CHECK(state.statistics().frames_underflowed == 2);
    CHECK(state.progress().frames == 5);
    CHECK(state.progress().steady_ns == 700);
}

TEST_CASE("silence before the first sound is no underflow") {
    audio::StreamState state(1, 8);
    std::array<float, 4> out{1, 1, 1, 1};
    state.feed(out.data(), out.size(), 1);
    CHECK(out == std::array<float, 4>{});
    CHECK(state.statistics().underflows == 0);
}

TEST_CASE("only whole frames are accepted, and refused ones are counted") {
    audio::StreamState state(3, 4);
    const std::array<float, 60> in{};
    const std::size_t accepted = state.write(in.data(), 20);
    CHECK(accepted == 5);  // 12 samples round up to 16, which hold 5 frames
    CHECK(state.statistics().frames_written == 5);
    CHECK(state.statistics().frames_dropped == 15);
    CHECK(state.writable() == 0);
}

TEST_CASE("frames and time of the card's progress belong together") {
    audio::StreamState state(1, 8);
    std::thread card([&] {
        std::array<float, 1> out{};
        for (std::int64_t i = 1; i <= 100'000; ++i) state.feed(out.data(), 1, 3 * i);
    });
    std::int64_t torn = 0, last = 0;
    while (last < 100'000) {
        const AudioProgress now = state.progress();
        torn += now.steady_ns != 3 * now.frames || now.frames < last;
        last = now.frames;
    }
    card.join();
    CHECK(torn == 0);
}

TEST_CASE("a sink that is not open takes nothing and closes") {
    const auto sink = audio::make_portaudio_sink();
    const float sample = 0.0F;
    CHECK(sink->write(&sample, 1) == 0);
    CHECK(sink->writable() == 0);
    CHECK_NOTHROW(sink->close());
}

TEST_CASE("an output that does not exist is refused with a reason, quietly, and can be tried again") {
    std::FILE* const capture = std::tmpfile();
    REQUIRE(capture != nullptr);
    const int saved = ::dup(STDERR_FILENO);
    ::dup2(::fileno(capture), STDERR_FILENO);
    std::array<std::string, 2> said;
    const auto sink = audio::make_portaudio_sink("an output that nobody has");
    for (std::string& one : said) {
        try {
            sink->prepare(48000.0, {"", ""});
        } catch (const Error& error) {
            one = error.what();
        }
    }
    std::fflush(stderr);
    ::dup2(saved, STDERR_FILENO);
    ::close(saved);
    std::fseek(capture, 0, SEEK_END);
    CHECK(std::ftell(capture) == 0);
    std::fclose(capture);
    CHECK_THAT(said[0], Catch::Matchers::ContainsSubstring("there is no sound output"));
    CHECK(said[1] == said[0]);
}

namespace {

/// Runs one hidden test of this program under another ALSA configuration, which a process reads only once.
bool passes_under(const std::string& configuration, const std::string& tag) {
    const std::string command = "ALSA_CONFIG_PATH='" + configuration + "' '/proc/" + std::to_string(::getpid()) +
                                "/exe' '" + tag + "' >/dev/null 2>&1";
    return std::system(command.c_str()) == 0;
}

}  // namespace

TEST_CASE("an ALSA configuration without a default device is an error, not the end of the process") {
    CHECK(passes_under("/dev/null", "[.broken_alsa]"));
}

TEST_CASE("run by the test of a broken ALSA configuration", "[.broken_alsa]") {
    CHECK_THROWS_WITH(audio::list_audio_cards(), Catch::Matchers::ContainsSubstring("pcm.default"));
}

TEST_CASE("an output opens, asks for sound and closes") {
    const std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("tactus_null_card_" + std::to_string(::getpid()) + ".conf");
    std::ofstream(path) << "pcm.!default { type null }\n";
    CHECK(passes_under(path.string(), "[.null_card]"));
    std::filesystem::remove(path);
}

TEST_CASE("run by the test of an output that opens", "[.null_card]") {
    const auto sink = audio::make_portaudio_sink("default");
    sink->prepare(48000.0, {""});
    const std::array<float, 64> sound{};
    CHECK(sink->write(sound.data(), sound.size()) == sound.size());
    const std::int64_t before = sink->progress().frames;
    while (sink->progress().frames < before + 10'000) std::this_thread::yield();
    CHECK(sink->statistics().underflows > 0);
    CHECK(sink->statistics().frames_written == sound.size());
    CHECK_NOTHROW(sink->close());
    CHECK(sink->writable() == 0);
}
