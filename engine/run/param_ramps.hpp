// SPDX-License-Identifier: Apache-2.0
// Parameters on which a force on a hand depends change over a tenth of a second. The value at an activation depends on
// its index alone. Therefore a run on any number of threads, in calls of any length, live or repeated, has the same
// bits.
#pragma once

#include "dsp/core/time.hpp"
#include "graph/node/param.hpp"

#include <atomic>
#include <cstdint>

namespace tactus::run {

/// A ramp from one value to another. At the n-th activation after `begin`, n rounded down to whole steps plus one step,
/// it has covered n / length of the difference; then it stays at the new value.
struct ParamRamp {
    explicit ParamRamp(Param& param_) : param(&param_) {}

    Param* param;
    std::atomic<std::int64_t> newest_plan{0};  ///< no later plan needs this ramp. Control thread
    // Thread of the group:
    bool is_running = false;
    double from = 0.0, to = 0.0;
    std::int64_t begin = 0, length = 0;
    ParamRamp* next = nullptr;  ///< next running ramp
};

/// The ramps of one group. Group's thread only; wait-free.
class ParamRamps {
public:
    /// Number of activations of a ramp in a group of `period`: a tenth of a second.
    static std::int64_t length(Flicks period) noexcept;

    explicit ParamRamps(Flicks period) noexcept;

    /// From activation `tick` on, `param` moves to `value` within `length` activations; immediately if that is 0, if
    /// there is no `ramp`, or if plan number `plan` does not need it. Values above the parameter's maximum are clamped.
    void set(Param& param, ParamRamp* ramp, double value, std::int64_t tick, std::int64_t length,
             std::int64_t plan) noexcept;
    /// Sets the maximum of `param` to `most`. A larger value or target moves to `most` as by `set`.
    void limit(Param& param, ParamRamp* ramp, double most, std::int64_t tick, std::int64_t length,
               std::int64_t plan) noexcept;
    /// Ends the ramps that `plan` no longer needs.
    void keep(std::int64_t plan) noexcept;
    /// Sets all ramped parameters to their values at `tick`.
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
