// SPDX-License-Identifier: Apache-2.0
// Timing statistics of each group. Written by the group's thread, read by others at any time.
#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace tactus::observe {

/// Counts of durations in ns, in bins of one eighth of an octave: quantiles within 9 %. One writer; wait-free.
class DurationHistogram {
    static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

public:
    void add(std::int64_t ns) noexcept {
        const auto value = static_cast<std::uint64_t>(ns < 0 ? 0 : ns);
        auto& bin = bins_[bin_of(value)];
        bin.store(bin.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
        if (value > max_.load(std::memory_order_relaxed)) max_.store(value, std::memory_order_relaxed);
    }
    std::uint64_t max_ns() const noexcept { return max_.load(std::memory_order_relaxed); }
    /// Adds the counts of another histogram; neither may be written meanwhile.
    void merge(const DurationHistogram& other) noexcept {
        for (std::size_t i = 0; i < bin_count; ++i) bins_[i] += other.bins_[i].load(std::memory_order_relaxed);
        if (other.max_ns() > max_ns()) max_.store(other.max_ns(), std::memory_order_relaxed);
    }

    /// Returns the upper edge of the bin that contains the quantile, in ns; 0 if nothing was counted.
    double quantile_ns(double q) const noexcept {
        std::uint64_t total = 0;
        for (const auto& bin : bins_) total += bin.load(std::memory_order_relaxed);
        const double wanted = q * static_cast<double>(total);
        std::uint64_t seen = 0;
        for (std::size_t i = 0; i < bins_.size(); ++i) {
            seen += bins_[i].load(std::memory_order_relaxed);
            if (seen > 0 && static_cast<double>(seen) >= wanted) {
                const double edge = static_cast<double>(lower_edge(i + 1));
                return edge < static_cast<double>(max_ns()) ? edge : static_cast<double>(max_ns());
            }
        }
        return 0.0;
    }

private:
    static std::size_t bin_of(std::uint64_t value) noexcept {
        if (value < 8) return value;
        const auto octave = static_cast<std::size_t>(std::bit_width(value)) - 1;  // >= 3
        const std::size_t bin = (octave - 2) * 8 + ((value >> (octave - 3)) & 7);
        return bin < bin_count ? bin : bin_count - 1;
    }
    static std::uint64_t lower_edge(std::size_t bin) noexcept {
        if (bin < 8) return bin;
        return (8 + (bin & 7)) << (bin / 8 - 1);
    }

    static constexpr std::size_t bin_count = 320;  // up to 2^41 ns
    std::array<std::atomic<std::uint64_t>, bin_count> bins_{};
    std::atomic<std::uint64_t> max_{0};
};

/// Why a group was late.
enum class LateCause : std::uint8_t {
    woken_late,  ///< the system woke its thread after the requested time
    preempted,   ///< its thread was woken in time and then did not get the processor
    ran_long,    ///< its nodes needed the time
};
inline constexpr std::size_t late_causes = 3;

/// Returns the main cause of a late call: the largest of its late start (whose cause is `started`), the time it was
/// preempted and the time it computed. All in ns.
constexpr LateCause blame(std::int64_t late, LateCause started, std::int64_t wall, std::int64_t computed) noexcept {
    const std::int64_t stood = wall - computed;
    if (computed >= stood && computed >= late) return LateCause::ran_long;
    return late >= stood ? started : LateCause::preempted;
}

/// Counts by cause. One writer; wait-free.
struct LateCounts {
    std::array<std::atomic<std::int64_t>, late_causes> of{};

    void add(LateCause cause, std::int64_t count) noexcept {
        of[static_cast<std::size_t>(cause)].fetch_add(count, std::memory_order_relaxed);
    }
    void merge(const LateCounts& other) noexcept {
        for (std::size_t i = 0; i < late_causes; ++i) of[i] += other.of[i].load(std::memory_order_relaxed);
    }
    std::int64_t operator[](LateCause cause) const noexcept {
        return of[static_cast<std::size_t>(cause)].load(std::memory_order_relaxed);
    }
};

/// Time of one node, from one call in 64. One writer; wait-free.
struct NodeTelemetry {
    std::atomic<std::int64_t> calls{0}, total_ns{0}, max_ns{0};

    void add(std::int64_t ns) noexcept {
        calls.store(calls.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
        total_ns.store(total_ns.load(std::memory_order_relaxed) + ns, std::memory_order_relaxed);
        if (ns > max_ns.load(std::memory_order_relaxed)) max_ns.store(ns, std::memory_order_relaxed);
    }
    double mean_ns() const noexcept {
        const auto n = static_cast<double>(calls.load(std::memory_order_relaxed));
        return n > 0.0 ? static_cast<double>(total_ns.load(std::memory_order_relaxed)) / n : 0.0;
    }
};

struct GroupTelemetry {
    std::atomic<std::int64_t> ticks{0};    ///< activations that ran
    std::atomic<std::int64_t> misses{0};   ///< activations that read an older value than scheduled
    std::atomic<std::int64_t> skipped{0};
    std::atomic<std::int64_t> dropped{0};  ///< publications dropped for lack of room
    std::atomic<std::int64_t> lost_events{0};  ///< events dropped for lack of room, here or on the way to other groups
    LateCounts skip_causes;  ///< of `skipped`, live only
    LateCounts withheld;  ///< values of this group that others missed, by the cause of the delay; live only
    mutable std::atomic<std::int64_t> awaited{0};  ///< missed values not yet explained; written by their consumers
    std::atomic<double> force_N{0.0};  ///< on the hand, in the last tick; with several devices the largest
    mutable std::atomic<double> max_force_N{0.0};  ///< since the last `take_most_force`
    DurationHistogram execution;  ///< ns per call
    DurationHistogram lateness;  ///< ns from release to start, live only

    /// Thread of the group; wait-free.
    void note_force(double newtons) noexcept {
        force_N.store(newtons, std::memory_order_relaxed);
        // A concurrent `take_most_force` returns this value now or at its next call.
        if (newtons > max_force_N.load(std::memory_order_relaxed))
            max_force_N.store(newtons, std::memory_order_relaxed);
    }
    /// Adds the counts of another group; both must have ended.
    void merge(const GroupTelemetry& other) noexcept {
        ticks += other.ticks;
        misses += other.misses;
        skipped += other.skipped;
        dropped += other.dropped;
        lost_events += other.lost_events;
        skip_causes.merge(other.skip_causes);
        withheld.merge(other.withheld);
        execution.merge(other.execution);
        lateness.merge(other.lateness);
    }
    /// Returns the largest force since the previous call; one thread.
    double take_most_force() const noexcept { return max_force_N.exchange(0.0, std::memory_order_relaxed); }
};

}  // namespace tactus::observe
