// SPDX-License-Identifier: Apache-2.0
// The decisions of an earlier run, read from its log.
#pragma once

#include "engine/run/decisions.hpp"

#include "engine/take/timing_log.hpp"

#include <cstddef>

namespace tactus::run {

class ReplayedDecisions final : public Decisions {
public:
    /// `records` of this group; `changes` by their number in the log, which must outlive this.
    ReplayedDecisions(DecisionLog& log, take::GroupRecords records, const ReplayedChanges& changes)
        : Decisions(log), records_(std::move(records)), changes_(changes) {
        records_.read_ahead(read_ahead);
    }

    std::int64_t skip_from(std::int64_t tick) const noexcept override;
    void apply_parameters(std::int64_t tick, std::int64_t plan, ParamRamps& ramps) noexcept override;
    bool is_replayed() const noexcept override { return true; }
    std::int64_t ramp_length(std::int64_t tick) const noexcept override;
    bool holds_off(std::int64_t tick, bool before) noexcept override;
    bool switches_to(const build::GroupProgram& next, std::int64_t tick) noexcept override;
    bool fades_for(const build::GroupProgram& next, std::int64_t tick) noexcept override;
    std::int64_t end_of_call(std::int64_t tick, std::int64_t until,
                             const build::GroupProgram* next) const noexcept override;
    std::int64_t awaited(const Link& link, std::int64_t tick) const noexcept override;
    bool has_room(const std::vector<Link*>& links, std::int64_t tick, int frames) const noexcept override;
    bool may_begin(const std::vector<Link*>& links, std::int64_t tick) const noexcept override;
    void acquire(io::DeviceSlot& slot, std::int64_t tick, Flicks elapsed) noexcept override;
    int overdue(const io::DeviceSlot& slot, const std::vector<build::ValueSource>& sources,
                std::int64_t tick) noexcept override;
    void hear(io::SoundHeard& heard, std::int64_t tick, int frames, std::int64_t due_ns) noexcept override;
    LinkReading read(const Link& link, const GroupRuntime& producer, std::int64_t tick, int frames) noexcept override;
    bool drops(const Link& link, std::int64_t tick, int frames) noexcept override;
    void commit(io::DeviceSlot& slot) noexcept override;
    void pass(std::int64_t tick) noexcept override;

private:
    /// Returns the record that covers an activation, or null. `source` −1: any.
    const take::TimingRecord* find(take::TimingKind kind, int source, std::int64_t tick) const noexcept;
    /// Returns the record of the switch to a plan at an activation, or null.
    const take::TimingRecord* find_switch(std::int64_t plan, std::int64_t tick) const noexcept;

    static constexpr std::int64_t read_ahead = 4096;  // activations; calls are shorter, so none reads a file

    mutable take::GroupRecords records_;  // reads on when later records are requested
    const ReplayedChanges& changes_;
    std::size_t first_ = 0;  ///< records before this one are past
    std::int64_t switched_to_ = 0;  ///< plan that took over last, by its number
    std::size_t applied_ = 0;  ///< changes of parameters before this one are applied
};

}  // namespace tactus::run
