// SPDX-License-Identifier: Apache-2.0
// Compares every value of a replayed run with the value in the take, bit by bit, during the replay.
#pragma once

#include "engine/io/streams.hpp"
#include "engine/run/group_runtime.hpp"
#include "engine/take/take_reader.hpp"

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace tactus::take {

struct TakeDifference {
    std::string port;
    std::int64_t tick = 0;
    double time = 0.0;  ///< logical time, s
    std::vector<std::string> channels;
    std::vector<double> expected, got;
};

class TakeComparison {
public:
    explicit TakeComparison(const Take& take) : take_(take) {}

    /// Returns the sink for the values of a group, for EngineOptions::tap. Null if the take has no values of the group.
    std::unique_ptr<io::Sink> tap(const io::FrameLayout& layout, const run::GroupRuntime& group);

    // After the run:
    std::uint64_t compared_values() const { return compared_; }
    /// The earliest difference in logical time; at equal times the first name.
    const std::optional<TakeDifference>& first_difference() const { return first_; }

    // For the implementation of the sinks.
    void count(std::uint64_t values);
    void differs(TakeDifference difference);

private:
    const Take& take_;
    std::mutex lock_;
    std::uint64_t compared_ = 0;
    std::optional<TakeDifference> first_;
};

}  // namespace tactus::take
