// SPDX-License-Identifier: Apache-2.0
// What becomes of a stream whose values can no longer be kept.
#include "engine/io/streams.hpp"

#include "assets/file/growing_file.hpp"
#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <filesystem>
#include <string>

using namespace tactus;

namespace {

namespace fs = std::filesystem;

struct Deeds {
    int takes = 0, finishes = 0;
};

/// Has room for so many values.
struct SmallEnd : io::Sink {
    SmallEnd(Deeds& deeds, int room) : deeds_(deeds), room_(room) {}
    void take(std::int64_t, const std::byte*, std::size_t) override {
        ++deeds_.takes;
        if (room_-- <= 0) throw Error("x.csv: no room");
    }
    void finish() override {
        ++deeds_.finishes;
        if (room_ < -1 || deeds_.finishes > 1) throw Error("finished twice");
    }
    Deeds& deeds_;
    int room_;
};

StreamFormat numbers() {
    StreamFormat format;
    format.file = "x.csv";
    format.type = &value::number;
    format.period = flicks_per_second / 1000;
    return format;
}

void give(io::Stream& stream, std::int64_t tick) {
    const double value = 0.5;
    stream.write(tick, &value, 1, sizeof value);
    stream.drain();
}

/// Files may grow to so many bytes, as on a small disk; for as long as this lives.
struct SmallFiles {
    rlimit before{};
    explicit SmallFiles(rlim_t bytes) {
        std::signal(SIGXFSZ, SIG_IGN);
        ::getrlimit(RLIMIT_FSIZE, &before);
        const rlimit small{bytes, before.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &small);
    }
    ~SmallFiles() {
        ::setrlimit(RLIMIT_FSIZE, &before);
        std::signal(SIGXFSZ, SIG_DFL);
    }
};

struct Scratch {
    fs::path path = fs::temp_directory_path() / ("tactus_streams_" + std::to_string(::getpid()));
    Scratch() { fs::create_directories(path); }
    ~Scratch() { fs::remove_all(path); }
};

}  // namespace

TEST_CASE("a stream whose end fails is completed once, says why, and takes what is written without keeping it") {
    Deeds deeds;
    io::Stream stream(numbers(), std::make_unique<SmallEnd>(deeds, 2));
    for (int tick = 0; tick < 2; ++tick) give(stream, tick);
    CHECK(stream.loss().empty());
    for (int tick = 2; tick < 100'000; ++tick) give(stream, tick);
    CHECK(stream.loss() == "x.csv: no room");
    CHECK(deeds.takes == 3);
    CHECK(deeds.finishes == 1);
    CHECK(stream.dropped() == 0);
    stream.finish();
    CHECK(deeds.finishes == 1);
    CHECK(stream.is_finished());
    CHECK(stream.loss() == "x.csv: no room");
}

TEST_CASE("a stream that cannot be completed says why and throws nothing") {
    struct Stuck : io::Sink {
        void take(std::int64_t, const std::byte*, std::size_t) override {}
        void finish() override { throw Error("x.csv: cannot be renamed"); }
    };
    io::Stream stream(numbers(), std::make_unique<Stuck>());
    give(stream, 0);
    stream.finish();
    CHECK(stream.loss() == "x.csv: cannot be renamed");
}

TEST_CASE("a growing file that finds no more room ends with a whole record, whatever was in one write") {
    const Scratch scratch;
    for (const rlim_t room : {0, 5, 10, 11, 4095, 4096, 20'000, 40'005}) {
        INFO("room for " << room << " bytes");
        const fs::path path = scratch.path / "grown";
        int errors = 0;
        {
            const SmallFiles small(room);
            file::GrowingFile file(path, "shown");
            for (int n = 0; n < 10'000; ++n) {
                try {
                    file.append("0123456789");
                    if (n % 1000 == 999) file.flush();
                } catch (const Error& error) {
                    ++errors;
                    CHECK(error.message().starts_with("shown: cannot be written: "));
                }
            }
            file.close();
        }
        CHECK(errors == 1);
        CHECK(fs::file_size(path) == room / 10 * 10);
    }
}

TEST_CASE("a table and a sound on a small disk are whole files of what had room") {
    const Scratch scratch;
    const fs::path table = scratch.path / "a.csv", sound = scratch.path / "a.wav";
    {
        const SmallFiles small(100'003);
        StreamFormat format = numbers();
        io::Stream rows(format, io::make_csv_sink(table, format));
        format.type = &value::signal;
        io::Stream samples(format, io::make_sound_file_sink(sound, format));
        const std::vector<float> ones(1000, 1.0F);
        for (int n = 0; n < 100; ++n) {
            for (int tick = 0; tick < 1000; ++tick) give(rows, n * 1000 + tick);
            samples.write(n * 1000, ones.data(), ones.size(), sizeof(float));
            samples.drain();
        }
        CHECK_THAT(rows.loss(), Catch::Matchers::ContainsSubstring("a.csv: cannot be written"));
        CHECK_THAT(samples.loss(), Catch::Matchers::ContainsSubstring("a.wav: cannot write"));
        rows.finish();
        samples.finish();
    }
    const std::string text = file::read_whole_file(table);
    CHECK(text.size() > 99'900);
    CHECK(text.ends_with(",0.5\n"));
    const std::string bytes = file::read_whole_file(sound);
    CHECK(bytes.size() > 99'000);
    // The size of the data as the header has it, behind the name of its chunk.
    const std::size_t data = bytes.find("data");
    REQUIRE(data != std::string::npos);
    std::uint32_t size = 0;
    std::memcpy(&size, bytes.data() + data + 4, sizeof size);
    CHECK(size == bytes.size() - data - 8);
    CHECK(size % sizeof(float) == 0);
    for (const auto& entry : fs::directory_iterator(scratch.path)) CHECK(entry.path().extension() != ".part");
}
