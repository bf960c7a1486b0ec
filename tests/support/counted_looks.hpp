// SPDX-License-Identifier: Apache-2.0
// How often a computation looks whether it is to stop, and what becomes of one that is told so at one of these looks.
#pragma once

#include "dsp/core/stop.hpp"

#include <atomic>
#include <cstdint>

namespace tactus::test {

/// Of this thread's computations, while it lives.
class CountedLooks {
public:
    /// 0: never.
    explicit CountedLooks(std::int64_t stops_at = 0)
        : scope_([this, stops_at] { return ++count_ >= stops_at && stops_at > 0; }) {}

    std::int64_t count() const { return count_; }

private:
    std::atomic<std::int64_t> count_{0};
    StopScope scope_;
};

template <class Work>
std::int64_t looks_of(Work work) {
    const CountedLooks looks;
    work();
    return looks.count();
}

/// Whether it leaves when it is told so at that look, the first being 1.
template <class Work>
bool leaves_at(std::int64_t look, Work work) {
    const CountedLooks looks(look);
    try {
        work();
    } catch (const Stopped&) {
        return true;
    }
    return false;
}

}  // namespace tactus::test
