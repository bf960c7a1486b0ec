// SPDX-License-Identifier: Apache-2.0
// What is heard of a card, with one that a test plays: its frame k has the sample k.
#include "engine/io/card_input.hpp"

#include "engine/io/sound_heard.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/realtime_check.hpp"

#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <set>
#include <thread>
#include <vector>

using namespace tactus;

namespace {

constexpr double rate = 48'000.0;
constexpr std::int64_t ns_of(double frames) { return static_cast<std::int64_t>(frames * 1e9 / rate); }

/// A card of two channels with callbacks of 256 frames, and a group with calls of 48.
struct Bench {
    std::shared_ptr<audio::InputRing> ring = std::make_shared<audio::InputRing>(2, 8192);
    io::CardInput input{ring, rate, 0.005};
    std::int64_t captured = 0, first = 0;
    std::vector<float> heard[2] = {std::vector<float>(48), std::vector<float>(48)};

    void callback(std::int64_t at_ns, std::size_t frames = 256) {
        std::vector<float> both(2 * frames);
        for (std::size_t i = 0; i < frames; ++i) {
            both[2 * i] = static_cast<float>(captured + static_cast<std::int64_t>(i));
            both[2 * i + 1] = -both[2 * i];
        }
        ring->capture(both.data(), frames, at_ns, false);
        captured += static_cast<std::int64_t>(frames);
    }
    /// All up to that time, by the card and by the group; the group is `late` s behind, the card has stopped at `stop`.
    void run(double seconds, double late = 0.0, double stop = 1e9) {
        const double until = seconds * rate;
        while (static_cast<double>(first + 48) <= until) {
            const double now = static_cast<double>(first + 48) + late * rate;
            while (static_cast<double>(captured + 256) <= std::min(now, stop * rate))
                callback(ns_of(static_cast<double>(captured + 256)));
            for (int channel = 0; channel < 2; ++channel)
                input.read(channel, first, heard[channel].data(), 48, ns_of(static_cast<double>(first + 48)));
            first += 48;
            for (int i = 0; i < 48; ++i) {
                const float x = heard[0][static_cast<std::size_t>(i)];
                CHECK(heard[1][static_cast<std::size_t>(i)] == -x);  // the channels stay together
                if (x > 0.0F) offsets.insert(first - 48 + i - static_cast<std::int64_t>(x));
            }
        }
    }
    std::set<std::int64_t> offsets;  ///< activation less frame, of all that was heard
};

}  // namespace

TEST_CASE("a group hears every frame of a card at one distance, however its thread is late") {
    Bench bench;
    bench.run(0.3);
    bench.run(0.6, 0.003);
    bench.run(0.9, 0.0001);
    CHECK(bench.offsets.size() == 1);
    CHECK(bench.input.xruns() == 0);
    CHECK(bench.input.resyncs() == 0);
    // A callback and the margin, and no more than a callback beyond.
    CHECK(*bench.offsets.begin() >= 256 + 240 - 48);
    CHECK(*bench.offsets.begin() <= 256 + 240 + 256 + 48);
    CHECK(bench.input.latency_s() == Approx((256.0 + 240.0) / rate));
}

TEST_CASE("what a card is heard at does not change when the first call is late") {
    Bench in_time, late;
    in_time.run(0.3);
    late.run(0.3, 0.09);
    REQUIRE(in_time.offsets.size() == 1);
    REQUIRE(late.offsets.size() == 1);
    CHECK(std::abs(*late.offsets.begin() - *in_time.offsets.begin()) <= 1);
}

TEST_CASE("frames that come too late are silence and counted, none is heard twice, and the distance is chosen anew") {
    Bench bench;
    bench.run(0.3);
    const std::int64_t offset = *bench.offsets.begin();
    std::vector<float> all;
    // The card pauses for 50 ms, and goes on with the frame at which it stopped.
    while (bench.first < 48'000) {
        const std::int64_t now = ns_of(static_cast<double>(bench.first + 48));
        const std::int64_t there = bench.first + 48 < 16'800 ? 14'400 : bench.first + 48 - 2'400;
        while (bench.captured + 256 <= there) bench.callback(now);
        for (int channel = 0; channel < 2; ++channel)
            bench.input.read(channel, bench.first, bench.heard[channel].data(), 48, now);
        bench.first += 48;
        for (std::size_t i = 0; i < 48; ++i) {
            CHECK(bench.heard[1][i] == -bench.heard[0][i]);
            if (bench.heard[0][i] != 0.0F) all.push_back(bench.heard[0][i]);
        }
    }
    CHECK(bench.input.xruns() == 1);
    CHECK(bench.input.resyncs() == 1);
    CHECK(bench.input.frames_missed() > 1000);
    // Every frame once, in order, and in the end without a gap.
    for (std::size_t i = 1; i < all.size(); ++i) REQUIRE(all[i] > all[i - 1]);
    for (std::size_t i = all.size() - 10'000; i < all.size(); ++i) REQUIRE(all[i] == all[i - 1] + 1.0F);
    const std::int64_t later = bench.first - 1 - static_cast<std::int64_t>(all.back());
    CHECK(later > offset + 2'400 - 256);
    CHECK(later < offset + 2'400 + 512);
}

TEST_CASE("what waits much longer than it needs to is left out, once") {
    Bench bench;
    bench.run(0.3);
    for (int i = 0; i < 16; ++i) bench.callback(ns_of(0.3 * rate));  // what a driver had held back
    const auto behind = [&] { return bench.captured - static_cast<std::int64_t>(bench.heard[0].back()); };
    CHECK(behind() > 4000);
    for (int call = 0; call < 200; ++call) {
        const std::int64_t now = ns_of(static_cast<double>(bench.first + 48));
        while (bench.captured - 4096 + 256 <= bench.first + 48) bench.callback(now);
        bench.input.read(0, bench.first, bench.heard[0].data(), 48, now);
        bench.first += 48;
    }
    CHECK(behind() < 1000);
    CHECK(bench.input.resyncs() == 1);
    CHECK(bench.input.xruns() == 0);
}

TEST_CASE("a card that has not begun, and one that is lost, is silent and no overrun") {
    Bench bench;
    bench.input.read(0, 0, bench.heard[0].data(), 48, 1'000'000);
    CHECK(bench.heard[0][0] == 0.0F);
    CHECK(bench.input.xruns() == 0);
    bench.run(0.2);
    const std::int64_t later = ns_of(0.2 * rate) + 2'000'000'000;
    const std::uint64_t xruns = bench.input.xruns();
    bench.heard[0].assign(48, 1.0F);
    bench.input.read(0, bench.first + 96'000, bench.heard[0].data(), 48, later);
    CHECK(bench.heard[0] == std::vector<float>(48, 0.0F));
    CHECK(bench.input.xruns() == xruns);
}

TEST_CASE("hearing a card neither allocates nor locks") {
    Bench bench;
    bench.callback(ns_of(256));
    const RealtimeViolations seen = watch([&] {
        for (int i = 0; i < 100; ++i) {
            bench.input.read(0, bench.first, bench.heard[0].data(), 48, ns_of(static_cast<double>(bench.first + 48)));
            bench.first += 48;
        }
    });
    CHECK(seen.describe() == "none");
}

TEST_CASE("a reader never gets frames of two times, however fast the card overwrites them") {
    audio::InputRing ring(1, 4096);
    std::atomic<bool> ends{false};
    std::thread card([&] {
        std::vector<float> block(16);
        for (std::int64_t k = 0; !ends; k += 16) {
            for (std::size_t i = 0; i < 16; ++i)
                block[i] = static_cast<float>((k + static_cast<std::int64_t>(i)) % 65536);
            ring.capture(block.data(), 16, k, false);
        }
    });
    float out[32];
    int whole = 0, torn = 0;
    // The machine may be busy with other things: both threads must have had their turns.
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    for (int i = 0; whole < 20'000 && (i < 200'000 || whole == 0); ++i) {
        if (i % 1000 == 999) {
            if (std::chrono::steady_clock::now() > end) break;
            std::this_thread::yield();
        }
        // Now the newest, now those that are overwritten next.
        const std::int64_t first = std::max<std::int64_t>(ring.view().captured - (i % 2 == 0 ? 40 : 4090), 0);
        if (!ring.read(first, 32, 0, out)) continue;
        ++whole;
        for (int k = 0; k < 32; ++k) torn += out[k] != static_cast<float>((first + k) % 65536);
    }
    ends = true;
    card.join();
    CHECK(torn == 0);
    CHECK(whole > 0);
}

TEST_CASE("without a card a file is heard from activation 0 on, and silence after it") {
    io::SoundHeard heard;
    heard.port.samples.resize(4);
    heard.file = {1.0F, 2.0F, 3.0F, 4.0F, 5.0F};
    heard.fill(3, 4, 0);
    CHECK(heard.port.first == 3);
    CHECK(heard.port.samples == std::vector<float>{4.0F, 5.0F, 0.0F, 0.0F});
}
