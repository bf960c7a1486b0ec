// SPDX-License-Identifier: Apache-2.0
// Runs to which everything happens at random: edits, sets, pauses, signals, drivers that block and devices that are lost,
// a full disk, a control thread and a whole process that stand still. Nothing may crash, each fault must leave its hands
// without force in time, and each take must repeat its run to the bit. TACTUS_CHAOS=600 goes on for so many seconds;
// TACTUS_CHAOS_SEED chooses where to begin.
#include "dsp/core/random.hpp"
#include "tests/engine/chaos.hpp"
#include "tests/engine/repeat.hpp"
#include "tests/engine/watched_hand.hpp"
#include "tests/support/catch.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <thread>

using namespace tactus;
using namespace tactus::test;

namespace {

constexpr std::int64_t one_ms = 1'000'000;  // ns

/// A thread that only sleeps, above the groups and below the guards. When it is late, the machine is to blame.
class Reference {
public:
    Reference() : thread_([this](const std::stop_token& stop) { run(stop); }) {}

    /// It was late between two times.
    bool was_late(std::int64_t from, std::int64_t to) const {
        const std::lock_guard lock(lock_);
        return std::ranges::any_of(late_, [&](const auto& span) { return span.first < to && span.second > from; });
    }
    std::size_t times() const {
        const std::lock_guard lock(lock_);
        return late_.size();
    }

private:
    void run(const std::stop_token& stop) {
        sched_param parameters{};
        parameters.sched_priority = 83;
        pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
        while (!stop.stop_requested()) {
            const std::int64_t due = steady_now() + one_ms;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            const std::int64_t now = steady_now();
            if (now - due < 2 * one_ms) continue;
            const std::lock_guard lock(lock_);
            late_.emplace_back(due - one_ms, now);
        }
    }

    mutable std::mutex lock_;
    std::vector<std::pair<std::int64_t, std::int64_t>> late_;
    std::jthread thread_;
};

/// A hand that must be without force at a time.
struct Verdict {
    const WatchedHand* hand;
    std::int64_t since_ns, by_ns;
    std::string what;
};

struct Draws {
    Random random;
    std::uint64_t count = 0;
    double uniform() { return random.uniform(count++); }
    bool chance(double p) { return uniform() < p; }
    std::int64_t below(std::int64_t n) { return static_cast<std::int64_t>(uniform() * static_cast<double>(n)); }
};

std::string random_patch(Draws& draws) {
    PatchText patch;
    // A hand that is made anew only comes in where the force is small: mostly the spring stays.
    add_hand(patch, "left", fmt::format("{:.2f} N/mm", 0.2 + 2.0 * draws.uniform()),
             draws.chance(0.8) ? "spring" : "other");
    add_hand(patch, "right", fmt::format("{:.2f} N/mm", 0.2 + 2.0 * draws.uniform()), "spring", "500 Hz");
    patch.nodes.push_back({"a", "chaos", "1 kHz", {{"gain", fmt::format("{:.3f}", draws.uniform())}}});
    patch.nodes.push_back({"voice", "chaos_signal", "48 kHz", {}});
    patch.nodes.push_back({"slow", "chaos", draws.chance(0.5) ? "4 Hz" : "60 Hz", {}});
    patch.wires.insert(patch.wires.end(), {"a.out -> slow.in", "voice.level -> a.in"});
    if (draws.chance(0.5)) patch.wires.emplace_back("slow.out -> voice.glide as linear");
    if (draws.chance(0.5)) patch.nodes.push_back({"more", "chaos", draws.chance(0.5) ? "200 Hz" : "1 kHz", {}});
    return patch.toml();
}

/// Sends the own process to sleep for a while, from outside.
void stall_process(std::int64_t for_ms) {
    const pid_t own = ::getpid(), child = ::fork();
    if (child == 0) {
        ::kill(own, SIGSTOP);
        ::usleep(static_cast<useconds_t>(for_ms * 1000));
        ::kill(own, SIGCONT);
        ::_exit(0);
    }
    ::waitpid(child, nullptr, 0);
}

class Round {
public:
    Round(std::uint64_t seed, const Reference& reference)
        : draws_{Random{mix(seed)}}, reference_(reference), left_(watched_hand("left")), right_(watched_hand("right")) {
        left_.depth = right_.depth = 0.2e-3;  // so that forces come in again after all that happens
    }

    void run();
    std::int64_t judged = 0, not_judged = 0, deeds = 0;

private:
    void act(run::Engine& engine);
    void begin_fault(WatchedHand& hand);
    void judge();
    void check_steps(const WatchedHand& hand) const;

    Draws draws_;
    const Reference& reference_;
    WatchedHand &left_, &right_;
    WatchedHand* faulty_ = nullptr;
    WatchedHand::Blocks kind_ = WatchedHand::Blocks::never;
    std::int64_t next_ns_ = 0, fault_ends_ns_ = 0, pause_ends_ns_ = 0, fault_began_ns_ = 0;
    std::vector<Verdict> verdicts_;
};

void Round::begin_fault(WatchedHand& hand) {
    faulty_ = &hand;
    fault_began_ns_ = steady_now();
    std::erase_if(verdicts_, [&](const Verdict& v) { return v.hand == &hand && v.by_ns > fault_began_ns_; });
    fault_ends_ns_ = fault_began_ns_ + (5 + draws_.below(150)) * one_ms;
    switch (draws_.below(4)) {
        case 0: kind_ = WatchedHand::Blocks::in_acquire; break;
        case 1: kind_ = WatchedHand::Blocks::in_commit; break;
        case 2: kind_ = WatchedHand::Blocks::in_commit_of_the_guard; break;
        default: kind_ = WatchedHand::Blocks::never;
    }
    hand.is_stale = kind_ == WatchedHand::Blocks::never;
    hand.blocks = kind_;
}

void Round::act(run::Engine& engine) {
    const std::int64_t now = steady_now();
    if (faulty_ && now >= fault_ends_ns_) {
        // Blocked in its commit a hand cannot be reached; else it is without force 20 ms after the driver hung, or after
        // its samples stood still: ten ticks more.
        const bool hangs = kind_ == WatchedHand::Blocks::in_acquire && faulty_->is_blocked;
        const double ticks_ms = faulty_ == &left_ ? 10.0 : 20.0;
        if (hangs)
            verdicts_.push_back({faulty_, faulty_->blocked_ns, faulty_->blocked_ns + 20 * one_ms, "hung when read"});
        if (faulty_->is_stale)
            verdicts_.push_back({faulty_, fault_began_ns_,
                                 fault_began_ns_ + static_cast<std::int64_t>((ticks_ms + 12.0) * 1e6), "stale"});
        faulty_->is_stale = false;
        faulty_->blocks = WatchedHand::Blocks::never;
        // What was asked of it until now; later forces may come in again.
        std::erase_if(verdicts_, [&](const Verdict& v) { return v.hand == faulty_ && v.by_ns > now; });
        faulty_ = nullptr;
    }
    if (pause_ends_ns_ != 0 && now >= pause_ends_ns_) {
        engine.pause(false);
        pause_ends_ns_ = 0;
    }
    if (now < next_ns_) return;
    next_ns_ = now + (30 + draws_.below(120)) * one_ms;
    ++deeds;
    switch (draws_.below(8)) {
        case 0:
        case 1: engine.edit([text = random_patch(draws_)] { return compile_text(text); }, {}); break;
        case 2: engine.set("a", "gain", fmt::format("{:.4f}", draws_.uniform())); break;
        case 3:
            engine.set("right_spring", "stiffness", fmt::format("{:.3f} N/mm", 0.2 + 2.0 * draws_.uniform()));
            break;
        case 4:
            if (pause_ends_ns_ != 0) break;
            engine.pause(true);
            pause_ends_ns_ = now + (60 + draws_.below(150)) * one_ms;
            if (faulty_) break;
            for (const WatchedHand* hand : {&left_, &right_})
                verdicts_.push_back({hand, now, now + 20 * one_ms, "pause"});
            break;
        case 5:
            if (!faulty_) begin_fault(draws_.chance(0.5) ? left_ : right_);
            break;
        case 6:
            for (int i = 0; i < 20; ++i) ::kill(::getpid(), SIGUSR1);
            break;
        default:
            if (draws_.chance(0.5)) std::this_thread::sleep_for(std::chrono::milliseconds(draws_.below(150)));
            else stall_process(1 + draws_.below(150));
    }
}

void Round::judge() {
    for (const Verdict& v : verdicts_) {
        if (reference_.was_late(v.since_ns - 5 * one_ms, v.by_ns)) {
            ++not_judged;
            continue;
        }
        ++judged;
        INFO(v.what << " of the " << (v.hand == &left_ ? "left" : "right") << " hand");
        CHECK(v.hand->force_at(v.by_ns) == 0.0);
    }
}

/// No force rises by more than the limit of the slew in one commit.
void Round::check_steps(const WatchedHand& hand) const {
    const auto given = hand.given();
    double largest = 0.0;
    for (std::size_t i = 1; i < given.size(); ++i) largest = std::max(largest, given[i].force_N - given[i - 1].force_N);
    CHECK(largest <= (&hand == &left_ ? 1.0 : 2.0) + 1e-9);
}

void Round::run() {
    const auto folder = scratch("campaign");
    const bool is_full = draws_.chance(0.2);
    run::Engine::PortHashes live_hashes;
    bool is_lost = false;
    {
        take::TakeWriter take(folder,
                              {.patch_file = "p.toml", .overrides = {}, .seed = {}, .seconds = 60.0, .live = true});
        run::EngineOptions options;
        options.seconds = 60.0;
        options.live = true;
        options.take = &take;
        run::Engine engine(compile_text(random_patch(draws_)), options);
        rlimit before{};
        ::getrlimit(RLIMIT_FSIZE, &before);
        std::atomic<bool> stop{false};
        std::int64_t stopped = 0;
        const std::int64_t ends = steady_now() + (1500 + draws_.below(2500)) * one_ms;
        run::LiveOptions live;
        live.stop = &stop;
        live.watch = [&] {
            if (stop || left_.logical_s < 0.3) return;
            if (is_full) {
                const rlimit small{static_cast<rlim_t>(400'000), before.rlim_max};
                ::setrlimit(RLIMIT_FSIZE, &small);
            }
            if (steady_now() < ends) return act(engine);
            // Half of the runs end with whatever is going on.
            stopped = steady_now();
            stop = true;
            for (const WatchedHand* hand : {&left_, &right_})
                if (hand != faulty_) verdicts_.push_back({hand, stopped, stopped + 20 * one_ms, "stop"});
        };
        engine.run_live(live);
        ::setrlimit(RLIMIT_FSIZE, &before);
        // It ends; how soon is a matter of the machine, which may be busy.
        CHECK(steady_now() - stopped < 30'000 * one_ms);
        engine.complete();
        is_lost = take.is_lost();
        live_hashes = engine.port_hashes();
    }
    left_.blocks = right_.blocks = WatchedHand::Blocks::never;
    judge();
    check_steps(left_);
    check_steps(right_);
    const Repetition again = repeat(folder, 2);
    if (again.difference) {
        WARN("the take is kept in " << folder.string());
        FAIL_CHECK(again.difference->port << " differs at tick " << again.difference->tick << ", "
                                          << again.difference->time << " s");
        return;
    }
    if (!is_lost) CHECK(again.hashes == live_hashes);
    std::filesystem::remove_all(folder);
}

}  // namespace

TEST_CASE("whatever happens to a run at random, hands are let go of in time and the take repeats it", "[live]") {
    const char *length = std::getenv("TACTUS_CHAOS"), *first = std::getenv("TACTUS_CHAOS_SEED");
    const double seconds = length ? std::atof(length) : 4.0;
    std::uint64_t seed = first ? std::strtoull(first, nullptr, 10) : 1;
    struct sigaction nothing = {}, before = {};
    nothing.sa_handler = [](int) {};
    ::sigaction(SIGUSR1, &nothing, &before);
    ::signal(SIGXFSZ, SIG_IGN);
    const Reference reference;
    const std::int64_t ends = steady_now() + static_cast<std::int64_t>(seconds * 1e9);
    std::int64_t rounds = 0, deeds = 0, judged = 0, not_judged = 0;
    do {
        INFO("TACTUS_CHAOS_SEED=" << seed);
        Round round(seed++, reference);
        round.run();
        ++rounds;
        deeds += round.deeds;
        judged += round.judged;
        not_judged += round.not_judged;
    } while (steady_now() < ends);
    ::sigaction(SIGUSR1, &before, nullptr);
    if (length)
        fmt::print(
            "{} rounds, {} deeds, {} faults judged, {} not judged, because the machine was late; it was {} times\n",
            rounds, deeds, judged, not_judged, reference.times());
    CHECK(judged + not_judged > 0);
}
