// SPDX-License-Identifier: Apache-2.0
// What travels between groups when one of them stands still for much longer than the link can hold.
#include "engine/run/link.hpp"

#include "dsp/core/random.hpp"
#include "graph/node/port.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/times.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

using namespace tactus;

namespace {

/// A writer and a reader of 1 kHz; the value at activation k is k.
class Pair {
public:
    explicit Pair(patch::WireMode mode = patch::WireMode::hold, run::Link::CallLengths calls = {}) {
        output_.type = &value_type<double>();
        output_.data = reinterpret_cast<std::byte*>(&written_);
        link_.producer_period = link_.consumer_period = ms;
        link_.latency = ms;
        run::LinkWire& wire = link_.wires.emplace_back();
        wire.type = output_.type;
        wire.source = &output_;
        wire.mode = mode;
        wire.target = mode == patch::WireMode::batch ? static_cast<Input*>(&batch_) : &input_;
        link_.prepare(64 * ms, {}, calls);
    }

    /// One activation of the writer. False when there was no room for its value.
    bool write(std::int64_t tick) {
        written_ = static_cast<double>(tick);
        const bool room = link_.has_room(tick, 1);
        if (room) link_.publish(tick, 1);
        done_ = tick + 1;
        return room;
    }

    /// One activation of a writer that repeats what another one did.
    void write_if(bool is_published, std::int64_t tick) {
        if (is_published) link_.publish(tick, 1);
        done_ = tick + 1;
    }
    bool has_room(std::int64_t tick) const { return link_.has_room(tick, 1); }

    /// One activation of the reader: the activation whose value it got.
    double read(std::int64_t tick) {
        const std::int64_t want = link_.wanted(tick);
        link_.read(want > link_.used() ? link_.newest_available(want, done_) : link_.used());
        link_.deliver(tick, 1);
        return input_.data ? input_.get() : 0.0;
    }

    /// The same for a batch: all values that it brought.
    std::vector<double> read_batch(std::int64_t tick) {
        read(tick);
        const auto values = batch_.values();
        return {values.begin(), values.end()};
    }

    const run::Link& link() const { return link_; }

private:
    run::Link link_;
    Output output_;
    In<double> input_;
    Batch<double> batch_;
    double written_ = 0.0;
    std::int64_t done_ = 0;
};

}  // namespace

TEST_CASE("a reader that slept for long goes on with the newest that was kept, then with what is new") {
    for (const std::int64_t sleep : {10, 60, 70, 130, 140, 200, 1000, 100'000}) {
        INFO("slept for " << sleep << " ticks");
        Pair pair;
        std::int64_t tick = 0;
        for (; tick < 50; ++tick) {
            pair.write(tick);
            pair.read(tick);
        }
        const std::int64_t asleep = tick;
        for (; tick < asleep + sleep; ++tick) pair.write(tick);
        // What it was not there to take did not overwrite what it had not yet read.
        CHECK(pair.read(tick) == static_cast<double>(std::min(tick - 1, asleep + pair.link().depth() - 3)));
        for (const std::int64_t awake = tick; tick < awake + 3; ++tick) {
            pair.write(tick);
            pair.read(tick);
        }
        CHECK(pair.write(tick));
        CHECK(pair.read(tick) == static_cast<double>(tick - 1));
    }
}

TEST_CASE("a writer that stood still for long is heard again") {
    for (const std::int64_t pause : {10, 60, 70, 130, 200, 1000, 100'000}) {
        INFO("stood still for " << pause << " ticks");
        Pair pair;
        std::int64_t tick = 0;
        for (; tick < 50; ++tick) {
            pair.write(tick);
            pair.read(tick);
        }
        for (const std::int64_t stood = tick; tick < stood + pause; ++tick) CHECK(pair.read(tick) == 49.0);
        CHECK(pair.write(tick++));
        CHECK(pair.read(tick) == static_cast<double>(tick - 1));
    }
}

TEST_CASE("whoever stands still and for how long, both are soon together again, and no value goes backwards") {
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        const Random random{seed};
        Pair pair;
        double last = -1.0;
        std::int64_t tick = 0;
        for (std::uint64_t round = 0; round < 40; ++round) {
            const auto pick = [&](std::uint64_t n) { return random.uniform(3 * round + n); };
            const std::int64_t stall = static_cast<std::int64_t>(300.0 * pick(0) * pick(1));
            const bool writes = pick(2) < 0.6, reads = pick(2) > 0.4;  // or neither
            for (const std::int64_t from = tick; tick < from + stall; ++tick) {
                if (writes && !reads) pair.write(tick);
                if (!reads || writes) continue;
                const double value = pair.read(tick);
                REQUIRE(value >= last);
                last = value;
            }
            // One value may find the slot taken that is still looked at, and one come before there is room.
            for (const std::int64_t from = tick; tick < from + 6; ++tick) {
                pair.write(tick);
                const double value = pair.read(tick);
                REQUIRE(value >= last);
                last = value;
            }
            INFO("seed " << seed << ", round " << round);
            REQUIRE(last == static_cast<double>(tick - 2));
        }
    }
}

TEST_CASE("a batch after a standstill holds all that was kept, in order") {
    for (const int kept : {1, 30, 60}) {
        INFO(kept << " kept before the writer stood still");
        Pair pair(patch::WireMode::batch);
        std::int64_t tick = 0;
        for (; tick < 20; ++tick) {
            pair.write(tick);
            pair.read(tick);
        }
        for (const std::int64_t from = tick; tick < from + kept; ++tick) CHECK(pair.write(tick));
        tick += 15 * pair.link().depth();  // the slot behind what was kept: another may still be taken
        CHECK(pair.write(tick++));
        const std::vector<double> got = pair.read_batch(tick);
        std::vector<double> wanted;
        for (int n = 0; n <= kept; ++n) wanted.push_back(19.0 + n);
        wanted.back() = static_cast<double>(tick - 1);
        wanted.insert(wanted.end() - 1, 19.0 + kept);
        CHECK(got == wanted);
    }
}

TEST_CASE("a repetition in longer calls has room for all that the live run had room for, whatever was dropped before") {
    for (const int longer : {2, 5, 48, 480})
        for (std::uint64_t seed = 1; seed <= 100; ++seed) {
            const Random random{seed};
            Pair live, again(patch::WireMode::hold, {longer, longer});
            CHECK(again.link().depth() > live.link().depth());
            std::uint64_t draws = 0;
            std::int64_t missing = 0, awake_from = 0;
            for (std::int64_t tick = 0; tick < 2000; ++tick) {
                const bool has_room = live.has_room(tick);
                missing += has_room && !again.has_room(tick);
                live.write_if(has_room, tick);
                again.write_if(has_room, tick);
                // The reader sleeps for up to 150 ticks, and then reads now and then.
                if (tick < awake_from || random.uniform(draws++) < 0.3) continue;
                if (random.uniform(draws++) < 0.02)
                    awake_from = tick + static_cast<std::int64_t>(150.0 * random.uniform(draws++));
                CHECK(live.read(tick) == again.read(tick));
            }
            INFO(longer << " activations a call, seed " << seed);
            CHECK(missing == 0);
        }
}
