// SPDX-License-Identifier: Apache-2.0
// Parameters on which a force on a hand depends change over a tenth of a second. The value at an activation follows from
// its index alone, so that a run on any number of threads, in calls of any length, live or repeated, has the same bits.
#pragma once

#include "dsp/core/time.hpp"
#include "graph/node/param.hpp"

#include <atomic>
#include <cstdint>

namespace tactus::run {

/// From one value to another. With n activations since `begin`, rounded down to whole steps, and one step more, the value
/// has come n / length of the way; there it stays.
struct ParamRamp {
    explicit ParamRamp(Param& param_) : param(&param_) {}

    Param* param;
    std::atomic<std::int64_t> newest_plan{0};  ///< a later one does not need it any more. Control thread
    // Thread of the group:
    bool is_running = false;
    double from = 0.0, to = 0.0;
    std::int64_t begin = 0, length = 0;
    ParamRamp* next = nullptr;  ///< of those that run
};

/// Those of one group. Its own thread only; wait-free.
class ParamRamps {
public:
    /// Activations that a change takes in a group of `period`: a tenth of a second.
    static std::int64_t length(Flicks period) noexcept;

    explicit ParamRamps(Flicks period) noexcept;

    /// From activation `tick` on, `param` goes to `value` within `length` activations; at once when that is 0, or when
    /// there is no `ramp` or the plan numbered `plan` does not need it. A value above the parameter's largest is that.
    void set(Param& param, ParamRamp* ramp, double value, std::int64_t tick, std::int64_t length,
             std::int64_t plan) noexcept;
    /// The largest value of `param` is `most`. A larger one, or one on its way there, goes to `most` as by `set`.
    void limit(Param& param, ParamRamp* ramp, double most, std::int64_t tick, std::int64_t length,
               std::int64_t plan) noexcept;
    /// Ends those that `plan` does not need any more.
    void keep(std::int64_t plan) noexcept;
    /// Gives all parameters the values of `tick`.
    void advance(std::int64_t tick) noexcept;
    /// The first activation in tick + 1 … until − 1 at which a value changes, or `until`.
    std::int64_t next_change(std::int64_t tick, std::int64_t until) const noexcept;

private:
    ParamRamp* find(const Param& param) const noexcept;
    void remove(ParamRamp& ramp) noexcept;

    std::int64_t step_;  // activations between two values
    ParamRamp* first_ = nullptr;
};

}  // namespace tactus::run
