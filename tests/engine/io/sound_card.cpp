// SPDX-License-Identifier: Apache-2.0
// What the engine makes of a card, with one that a test plays.
#include "engine/io/sound_card.hpp"
#include "devices/audio/stream_state.hpp"
#include "engine/run/run_clock.hpp"
#include "tests/support/catch.hpp"

#include <array>
#include <memory>
#include <numeric>
#include <thread>
#include <vector>

using namespace tactus;

namespace {

constexpr Flicks period = flicks_per_second / 48000;

class PlayedSink : public AudioSink {
public:
    explicit PlayedSink(std::size_t frames = 4096) : state(1, frames) {}
    const std::string& name() const override { return name_; }
    void prepare(double, const std::vector<std::string>&) override {}
    std::size_t write(const float* samples, std::size_t frames) noexcept override {
        return state.write(samples, frames);
    }
    std::size_t writable() const noexcept override { return state.writable(); }
    AudioStatistics statistics() const noexcept override { return state.statistics(); }
    AudioProgress progress() const noexcept override { return state.progress(); }
    void leave_out(std::int64_t frames) noexcept override { state.leave_out(frames); }
    void close() override {}

    std::vector<float> ask(std::size_t frames, std::int64_t now_ns) {
        std::vector<float> out(frames, -1.0F);
        state.feed(out.data(), frames, now_ns);
        return out;
    }

    audio::StreamState state;

private:
    std::string name_ = "played";
};

struct CardBench {
    explicit CardBench(std::size_t frames = 4096) {
        auto owned = std::make_unique<PlayedSink>(frames);
        sink = owned.get();
        card = std::make_unique<io::SoundCard>(std::move(owned), io::CardUse{period, 0.005});
        card->open({"played"});
        channel = &card->channel(0);
    }
    void write(std::int64_t first, std::size_t count) const {
        std::vector<float> values(count);
        std::iota(values.begin(), values.end(), static_cast<float>(first));
        channel->write(first, values.data(), count, sizeof(float));
    }
    PlayedSink* sink;
    std::unique_ptr<io::SoundCard> card;
    io::SoundChannel* channel;
};

}  // namespace

TEST_CASE("activations that never ran are silence of the same length on the card") {
    const CardBench bench;
    bench.write(100, 3);
    bench.write(105, 2);
    CHECK(bench.sink->ask(7, 1) == std::vector<float>{100, 101, 102, 0, 0, 105, 106});
}

TEST_CASE("what finds no room is counted, and the clock still knows which frame plays") {
    const CardBench bench(64);
    bench.write(0, 1000);
    CHECK(bench.sink->statistics().frames_dropped == 936);
    control::TrimmedClock clock{0, 0, 1.0};
    bench.sink->ask(64, 1'000'000);
    bench.card->service(1'000'000, 0, &clock);
    // Frame 1000 comes next, at 20.8 ms of a clock that has come to 1 ms: it is much too late.
    CHECK(bench.card->follower().excess_s() == Approx(0.001 - (1000 + 240 + 64) / 48000.0).margin(1e-6));
    CHECK(clock.slope == Approx(1.0 - control::TrimmedClock::furthest));
}

TEST_CASE(
    "a card that is heard gets silence whenever no node plays on it, also when edits bring one and take it away") {
    auto owned = std::make_unique<PlayedSink>();
    PlayedSink& sink = *owned;
    io::CardUse use{period, 0.005};
    use.is_played = false;
    io::SoundCard card(std::move(owned), use, std::make_shared<audio::InputRing>(2, 4096));
    card.open({""});
    std::vector<float> heard(2);
    const auto call = [&](std::int64_t first, bool plays) {
        for (int channel = 0; channel < 2; ++channel) card.hear(channel, first, heard.data(), 2, 0);
        const float values[] = {static_cast<float>(first), static_cast<float>(first + 1)};
        if (plays) card.channel(0).write(first, values, 2, sizeof(float));
    };
    call(0, false);
    call(2, false);
    CHECK(sink.statistics().frames_written == 4);
    call(4, true);  // its first block comes too late
    call(6, true);
    call(8, true);
    CHECK(sink.statistics().frames_written == 10);
    call(10, false);
    call(12, false);
    call(14, false);
    CHECK(sink.ask(16, 1) == std::vector<float>{0, 0, 0, 0, 0, 0, 6, 7, 8, 9, 0, 0, 0, 0, 0, 0});
    CHECK(card.statistics().frames_dropped == 0);
}

TEST_CASE("a card that asks for nothing is lost after half a second, once, and found when it asks again") {
    const CardBench bench;
    control::TrimmedClock clock{0, 0, 1.0};
    const std::int64_t ms = 1'000'000;
    bench.write(0, 480);
    bench.sink->ask(64, 10 * ms);
    CHECK_FALSE(bench.card->service(11 * ms, 0, &clock));
    CHECK_FALSE(bench.card->service(509 * ms, 0, &clock));
    CHECK(bench.card->service(512 * ms, 77, &clock));
    CHECK(bench.card->is_lost());
    CHECK(bench.card->lost_at() == 77);
    CHECK(clock.slope == 1.0);
    CHECK_FALSE(bench.card->service(5000 * ms, 0, &clock));
    bench.sink->ask(64, 5001 * ms);
    CHECK_FALSE(bench.card->service(5002 * ms, 0, &clock));
    CHECK_FALSE(bench.card->is_lost());
    CHECK(bench.card->losses() == 1);
}

TEST_CASE("a card that never asked is lost as well") {
    const CardBench bench;
    control::TrimmedClock clock{0, 0, 1.0};
    CHECK_FALSE(bench.card->service(1, 0, &clock));
    CHECK(bench.card->service(600'000'000, 0, &clock));
}

TEST_CASE("readers of the run's clock see whole lines only") {
    run::RunClock clock;
    std::atomic<bool> end{false};
    control::TrimmedClock none{7, 8, 9.0};
    CHECK_FALSE(clock.try_get(none));
    CHECK(none.logical == 7);
    clock.set({0, 0, 1.0});
    std::thread trimmer([&] {
        for (std::int64_t i = 1; i <= 200'000; ++i) clock.set({i, 3 * i, 1.0 + static_cast<double>(i)});
        end = true;
    });
    control::TrimmedClock line{0, 0, 1.0};
    std::int64_t torn = 0;
    while (!end) {
        line = clock.get(line);
        torn += line.steady_ns != 3 * line.logical || line.slope != 1.0 + static_cast<double>(line.logical);
        // Who has read nothing yet is told so.
        control::TrimmedClock first{-1, -3, 0.0};
        const bool read = clock.try_get(first);
        torn += (first.logical >= 0) != read || first.steady_ns != 3 * first.logical;
    }
    trimmer.join();
    CHECK(torn == 0);
}

TEST_CASE("the clock is trimmed where time is, not where the furthest group is: nothing jumps") {
    const CardBench bench;
    control::TrimmedClock clock{0, 0, 1.0};
    constexpr Flicks slow = 5 * flicks_per_second;  // a group of 0.2 Hz has come to here already
    std::int64_t frames = 0, worst = 0;
    for (std::int64_t ms = 10; ms < 2000; ms += 10) {
        const std::int64_t now = ms * 1'000'000;
        bench.write(frames, 500);
        bench.sink->ask(480, now);
        frames += 500;
        const auto present = static_cast<Flicks>(static_cast<double>(now) * 0.7056);
        const std::int64_t before = clock.when(present);
        bench.card->service(now, slow, &clock);
        worst = std::max(worst, std::abs(clock.when(present) - before));
    }
    CHECK(clock.slope != 1.0);
    CHECK(worst < 100);
}
