// SPDX-License-Identifier: Apache-2.0
// libtactus as a program sees it: by its C functions, through the shared library.
#include "tests/support/catch.hpp"
#include "tests/tools/embed/any_calls.hpp"
#include "tools/embed/tactus.h"

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <new>
#include <random>
#include <string>
#include <thread>
#include <vector>

using Catch::Matchers::ContainsSubstring;
namespace fs = std::filesystem;

namespace {

std::atomic<long> allocations{0};

}  // namespace

// Those of the library are bound to these.
[[gnu::noinline]] void* operator new(std::size_t size) {
    ++allocations;
    if (void* const found = std::malloc(size ? size : 1)) return found;
    throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* what) noexcept { std::free(what); }
[[gnu::noinline]] void operator delete(void* what, std::size_t) noexcept { std::free(what); }

namespace {

struct FreePatch {
    void operator()(tactus_patch* patch) const { tactus_free_patch(patch); }
};
struct FreeRun {
    void operator()(tactus_run* run) const { tactus_free_run(run); }
};
using Patch = std::unique_ptr<tactus_patch, FreePatch>;
using Run = std::unique_ptr<tactus_run, FreeRun>;

tactus_error error;

Patch loaded(const char* name) {
    Patch patch(tactus_load(name, &error));
    INFO(error.text);
    REQUIRE(patch);
    return patch;
}

tactus_options with_seconds(double seconds) {
    tactus_options options{};
    options.size = sizeof(options);
    options.seconds = seconds;
    return options;
}

Run started(const Patch& patch, const tactus_options* options = nullptr) {
    Run run(tactus_start(patch.get(), options, &error));
    INFO(error.text);
    REQUIRE(run);
    return run;
}

std::uint64_t hash_of(const Run& run) {
    INFO(error.text);
    REQUIRE(tactus_finish(run.get(), &error) == 0);
    return tactus_hash(run.get());
}

/// touch-sphere with a hand that this program moves.
Run with_hand(const Patch& patch, const tactus_options* options = nullptr) {
    const tactus_device device{8.0, 0.0, 2.0, 0.0};
    REQUIRE(tactus_attach_hand(patch.get(), "simulated", &device, &error) == 0);
    return started(patch, options);
}

tactus_motion at_depth(double depth) {
    tactus_motion motion{};
    motion.position[2] = -depth;
    return motion;
}

double force_of(const Run& run, int hand = 0) {
    std::array<double, 6> wrench{};
    tactus_hand_force(run.get(), hand, wrench.data());
    return wrench[2];
}

}  // namespace

TEST_CASE("a patch that a program advances, in whatever steps, has the bits of a rendered one") {
    const Patch patch = loaded("touch-sphere");
    const tactus_options options = with_seconds(0.5);
    const Run rendered = started(patch, &options);
    REQUIRE(tactus_render(rendered.get(), &error) == 0);
    const std::uint64_t expected = hash_of(rendered);
    CHECK(expected != 0);
    for (const double step : {0.5, 0.001, 0.0007}) {
        const Run run = started(patch);
        for (double t = 0.0; t < 0.5 - 1e-9; t += step) tactus_advance(run.get(), std::min(step, 0.5 - t), &error);
        CHECK(tactus_time(run.get()) == Approx(0.5));
        CHECK(hash_of(run) == expected);
    }
}

TEST_CASE("a hand that the program moves feels the patch, and an invalid one feels nothing within 20 ms") {
    const Patch patch = loaded("touch-sphere");
    const Run run = with_hand(patch);
    const int hand = tactus_find_hand(run.get(), "simulated", &error);
    REQUIRE(hand == 0);
    const auto advance = [&](double seconds, const tactus_motion& motion) {
        for (int tick = 0; tick < std::lround(seconds / 0.001); ++tick) {
            tactus_move_hand(run.get(), hand, &motion);
            REQUIRE(tactus_advance(run.get(), 0.001, &error) == 0);
        }
    };
    advance(0.5, at_depth(-0.01));
    CHECK(force_of(run) == 0.0);
    for (int mm = -10; mm <= 2; ++mm) advance(0.05, at_depth(0.001 * mm));
    advance(0.5, at_depth(0.002));
    // A spring of 1 N/mm in series with points of 10 N/mm each.
    CHECK(force_of(run) > 1.0);
    CHECK(force_of(run) < 2.0);
    tactus_motion lost = at_depth(0.002);
    lost.invalid = 1;
    advance(0.02, lost);
    CHECK(force_of(run) == 0.0);
}

TEST_CASE("what a device is said to give limits the force") {
    const Patch patch = loaded("touch-sphere");
    const tactus_device weak{0.5, 0.0, 2.0, 0.0};
    REQUIRE(tactus_attach_hand(patch.get(), "simulated", &weak, &error) == 0);
    const Run run = started(patch);
    for (int tick = 0; tick < 2000; ++tick) {
        const tactus_motion motion = at_depth(-0.005 + 1e-5 * std::min(tick, 900));
        tactus_move_hand(run.get(), 0, &motion);
        REQUIRE(tactus_advance(run.get(), 0.001, &error) == 0);
        REQUIRE(std::abs(force_of(run)) <= 0.5 + 1e-12);
    }
    CHECK(force_of(run) == Approx(0.5));
}

TEST_CASE("every value of an output is fetched once, in order, and the newest one is the last of them") {
    const Patch patch = loaded("touch-sphere");
    const Run run = with_hand(patch);
    tactus_output_info info{};
    const int output = tactus_output(run.get(), "place.pose", 1, &info, &error);
    REQUIRE(output >= 0);
    CHECK(info.columns == 7);
    CHECK(std::string(info.type) == "pose");
    CHECK(info.rate == 1000.0);
    std::vector<double> times(5000), values(7 * 5000);
    std::size_t count = 0;
    for (int part = 0; part < 10; ++part) {
        const tactus_motion motion = at_depth(-0.001 * part);
        tactus_move_hand(run.get(), 0, &motion);
        REQUIRE(tactus_advance(run.get(), 0.02, &error) == 0);
        CHECK(tactus_available(run.get(), output) == 20);
        // In two bites.
        count += tactus_fetch(run.get(), output, times.data() + count, values.data() + 7 * count, 7);
        count += tactus_fetch(run.get(), output, times.data() + count, values.data() + 7 * count, 1000);
    }
    REQUIRE(count == 200);
    for (std::size_t i = 0; i < count; ++i) {
        CHECK(times[i] == Approx(0.001 * double(i)).margin(1e-12));
        CHECK(values[7 * i + 2] == Approx(0.029 + 0.001 * double(i / 20)).margin(1e-9));
    }
    std::array<double, 7> newest{};
    tactus_newest(run.get(), output, newest.data());
    CHECK(newest[2] == values[7 * 199 + 2]);
    CHECK(tactus_output(run.get(), "scene.scene", 0, nullptr, &error) == -1);
    CHECK_THAT(error.text, ContainsSubstring("no numbers to read"));
    CHECK(tactus_output(run.get(), "place.frame", 1, nullptr, &error) == -1);
    CHECK_THAT(error.text, ContainsSubstring("before the run begins"));
}

TEST_CASE("a long render gives every sample of a signal") {
    const Patch patch(tactus_parse("[nodes.s]\ntype = \"sine\"\nrate = \"48 kHz\"\n", nullptr, &error));
    REQUIRE(patch);
    const tactus_options options = with_seconds(30.0);
    const Run run = started(patch, &options);
    const int output = tactus_output(run.get(), "s.signal", 1, nullptr, &error);
    REQUIRE(tactus_render(run.get(), &error) == 0);
    REQUIRE(tactus_available(run.get(), output) == 30u * 48000u);
    std::vector<double> values(30u * 48000u);
    REQUIRE(tactus_fetch(run.get(), output, nullptr, values.data(), values.size()) == values.size());
    CHECK(values[30u * 48000u - 1] == Approx(std::sin(2e2 * M_PI * (30.0 - 1.0 / 48000.0))).margin(1e-4));
}

TEST_CASE("a program's loop that advances a run allocates nothing") {
    const Patch patch = loaded("touch-sphere");
    const Run run = with_hand(patch);
    const int newest = tactus_output(run.get(), "coupling.wrench", 0, nullptr, &error);
    REQUIRE(tactus_advance(run.get(), 0.01, &error) == 0);
    const long before = allocations;
    for (int tick = 0; tick < 200; ++tick) {
        const tactus_motion motion = at_depth(-0.005 + 4e-5 * tick);
        tactus_move_hand(run.get(), 0, &motion);
        tactus_advance(run.get(), 0.001, &error);
    }
    CHECK(allocations == before);
    std::array<double, 6> wrench{};
    tactus_newest(run.get(), newest, wrench.data());
    CHECK(wrench[2] > 0.0);
}

TEST_CASE("errors name the place, and what to do") {
    CHECK_FALSE(tactus_load("touch-spere", &error));
    CHECK_THAT(error.text, ContainsSubstring("touch-sphere"));
    CHECK_FALSE(
        tactus_parse("[nodes.a]\ntype = \"sine\"\nrate = \"48 kHz\"\n\n[nodes.b]\ntype = \"sin\"\nrate = \"1 kHz\"\n",
                     "/tmp", &error));
    CHECK(std::string(error.file) == "/tmp/patch");
    CHECK(error.line == 6);
    CHECK(error.column > 0);
    CHECK_THAT(error.text, ContainsSubstring("sine"));

    const Patch patch = loaded("touch-sphere");
    CHECK(tactus_configure(patch.get(), "coupling.stifness=1 N/mm", &error) == -1);
    CHECK_THAT(error.text, ContainsSubstring("stiffness"));
    CHECK(tactus_attach_hand(patch.get(), "omega", nullptr, &error) == -1);
    CHECK_THAT(error.text, ContainsSubstring("simulated"));
    const tactus_device odd{std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0, 0.0};
    CHECK(tactus_attach_hand(patch.get(), "simulated", &odd, &error) == -1);
    // What was refused has changed nothing.
    const tactus_options options = with_seconds(0.05);
    const Run run = started(patch, &options);
    CHECK(tactus_set(run.get(), "coupling.stiffness", "1 parsec", &error) == -1);
    CHECK(tactus_set(run.get(), "coupling", "1", &error) == -1);
    CHECK(tactus_find_hand(run.get(), "simulated", &error) == -1);
    tactus_options short_size = options;
    short_size.size = 3;
    CHECK_FALSE(tactus_start(patch.get(), &short_size, &error));
    CHECK(tactus_render(run.get(), &error) == -1);  // it has been advanced, by 0 s
    CHECK_THAT(error.text, ContainsSubstring("advance"));
}

TEST_CASE("two threads on one run: one works, the other gets an error, and the run is whole") {
    const Patch patch = loaded("touch-sphere");
    const Run run = started(patch);
    std::atomic<int> refused{0}, done{0};
    const auto work = [&] {
        tactus_error own;
        for (int i = 0; i < 100; ++i)
            if (tactus_advance(run.get(), 0.001, &own) == 0) ++done;
            else if (std::string(own.text).find("another thread") != std::string::npos) ++refused;
    };
    std::thread one(work), two(work);
    one.join();
    two.join();
    CHECK(done + refused == 200);
    CHECK(tactus_time(run.get()) == Approx(0.001 * done));
}

TEST_CASE("two threads on one patch: one is served, the other gets an error, and no setting is lost or torn") {
    const Patch patch = loaded("touch-sphere");
    std::atomic<int> refused{0}, set{0}, begun{0}, others{0};
    const auto note = [&](const tactus_error& own) {
        if (std::string(own.text).find("another thread") != std::string::npos) ++refused;
        else ++others;
    };
    const auto work = [&](const char* setting) {
        tactus_error own;
        for (int i = 0; i < 20; ++i) {
            if (tactus_configure(patch.get(), setting, &own) == 0) ++set;
            else note(own);
            if (Run run(tactus_start(patch.get(), nullptr, &own)); run) ++begun;
            else note(own);
        }
    };
    std::thread one(work, "coupling.stiffness=0.4 N/mm"), two(work, "coupling.stiffness=0.6 N/mm");
    one.join();
    two.join();
    CHECK(others == 0);
    CHECK(set + begun + refused == 80);
    CHECK(set > 0);
    CHECK(begun > 0);
}

TEST_CASE("a run writes its results into a folder, and refuses one that has some") {
    const fs::path folder = fs::temp_directory_path() / ("tactus_embed_" + std::to_string(std::rand()));
    const Patch patch = loaded("touch-sphere");
    tactus_options options = with_seconds(0.1);
    const std::string name = folder.string();
    options.folder = name.c_str();
    {
        const Run run = started(patch, &options);
        REQUIRE(tactus_render(run.get(), &error) == 0);
        const std::uint64_t hash = hash_of(run);
        std::array<char, 17> text{};
        std::snprintf(text.data(), text.size(), "%016llx", static_cast<unsigned long long>(hash));
        CHECK_THAT(tactus_summary(run.get()), ContainsSubstring(text.data()));
    }
    CHECK(fs::exists(folder / "summary.json"));
    std::ifstream force(folder / "force.csv");
    CHECK(std::count(std::istreambuf_iterator<char>(force), {}, '\n') == 101);
    CHECK_FALSE(tactus_start(patch.get(), &options, &error));
    CHECK_THAT(error.text, ContainsSubstring("results"));
    fs::remove_all(folder);
}

TEST_CASE("calls in any order, with any arguments, give errors and never a crash") {
    std::mt19937 random(7);
    const auto pick = [&](int count) { return static_cast<int>(random() % static_cast<unsigned>(count)); };
    for (int round = 0; round < 200; ++round) tactus::test::make_any_calls(pick, 60);
    SUCCEED();
}

TEST_CASE("the library exports what is Tactus', and nothing of the libraries within") {
    std::FILE* const names = ::popen("nm -DC --defined-only " TACTUS_SO " | cut -c20-", "r");
    REQUIRE(names);
    int functions = 0, others = 0;
    for (std::array<char, 4096> line{}; std::fgets(line.data(), line.size(), names);) {
        const std::string name(line.data());
        if (name.starts_with("tactus_")) ++functions;
        else if (name.find("tactus::") == std::string::npos) {
            UNSCOPED_INFO(name);
            ++others;
        }
    }
    ::pclose(names);
    CHECK(functions == 32);
    CHECK(others == 0);
}

TEST_CASE("a live run goes on beside the program's loop, and a hand that is moved no more feels nothing after 20 ms",
          "[live]") {
    using clock = std::chrono::steady_clock;
    const Patch patch = loaded("touch-sphere");
    tactus_options options = with_seconds(0.0);
    options.live = 1;
    const Run run = with_hand(patch, &options);
    const auto begin = clock::now();
    const auto seconds = [&] { return std::chrono::duration<double>(clock::now() - begin).count(); };
    double felt = 0.0;
    while (seconds() < 1.2) {
        const tactus_motion motion = at_depth(-0.01 + std::min(0.012, 0.02 * seconds()));
        tactus_move_hand(run.get(), 0, &motion);
        felt = std::max(felt, force_of(run));
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    CHECK(felt > 0.5);
    CHECK(tactus_set(run.get(), "coupling.stiffness", "0.9 N/mm", &error) == 0);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    CHECK(force_of(run) == 0.0);
    CHECK(tactus_finish(run.get(), &error) == 0);
    CHECK(tactus_set(run.get(), "coupling.stiffness", "1 N/mm", &error) == -1);
    CHECK_THAT(error.text, ContainsSubstring("over"));
}
