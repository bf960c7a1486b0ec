// SPDX-License-Identifier: Apache-2.0
// Decisions by the clock: on a virtual clock, where nothing is late, or in real time, where they are logged.
#pragma once

#include "engine/run/decisions.hpp"
#include "engine/run/pause_window.hpp"

namespace tactus::run {

/// Changes take effect at their given logical time.
class ClockDecisions : public Decisions {
public:
    /// `changes` is filled by the control thread, in the order of time. `period` of the group, flicks.
    ClockDecisions(DecisionLog& log, Flicks period, ChangeQueue& changes)
        : Decisions(log), period_(period), changes_(changes) {}

    void apply_parameters(std::int64_t tick, std::int64_t plan, ParamRamps& ramps) noexcept override;
    bool has_changes() noexcept override;
    std::int64_t ramp_length(std::int64_t tick) const noexcept override;
    bool switches_to(const build::GroupProgram& next, std::int64_t tick) noexcept override;
    bool fades_for(const build::GroupProgram& next, std::int64_t tick) noexcept override;
    std::int64_t end_of_call(std::int64_t tick, std::int64_t until,
                             const build::GroupProgram* next) const noexcept override;

protected:
    const Flicks period_;

private:
    ChangeQueue& changes_;
    ParameterChange change_;
    bool has_change_ = false;
};

/// The virtual clock: groups wait for each other.
class OfflineDecisions final : public ClockDecisions {
public:
    /// `pause`: the times at which forces are suspended because a parameter is set that cannot ramp; null: never.
    OfflineDecisions(DecisionLog& log, Flicks period, ChangeQueue& changes, const PauseWindow* pause = nullptr)
        : ClockDecisions(log, period, changes), pause_(pause) {}

    bool holds_off(std::int64_t tick, bool before) noexcept override;
    LinkReading read(const Link& link, const GroupRuntime& producer, std::int64_t tick, int frames) noexcept override;
    void commit(io::DeviceSlot& slot) noexcept override;

private:
    const PauseWindow* pause_;
};

/// Real time: no group waits. A value that is not available is missed; a value that does not fit is dropped.
class LiveDecisions final : public ClockDecisions {
public:
    LiveDecisions(DecisionLog& log, Flicks period, ChangeQueue& changes, const PauseWindow& pause)
        : ClockDecisions(log, period, changes), pause_(pause) {}

    bool holds_off(std::int64_t tick, bool before) noexcept override;
    bool switches_to(const build::GroupProgram& next, std::int64_t tick) noexcept override;
    bool fades_for(const build::GroupProgram& next, std::int64_t tick) noexcept override;
    std::int64_t readable_until(const Link& link, const GroupRuntime& producer, std::int64_t tick,
                                std::int64_t until) const noexcept override;
    bool has_room(const std::vector<Link*>& links, std::int64_t tick, int frames) const noexcept override;
    int overdue(const io::DeviceSlot& slot, const std::vector<build::ValueSource>& sources,
                std::int64_t tick) noexcept override;
    LinkReading read(const Link& link, const GroupRuntime& producer, std::int64_t tick, int frames) noexcept override;
    bool drops(const Link& link, std::int64_t tick, int frames) noexcept override;
    void commit(io::DeviceSlot& slot) noexcept override;

private:
    const PauseWindow& pause_;
};

}  // namespace tactus::run
