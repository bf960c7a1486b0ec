// SPDX-License-Identifier: Apache-2.0
// Background computations for a window: they only read, and a computation that is no longer wanted is not waited for.
#pragma once

#include <chrono>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <future>
#include <memory>
#include <stop_token>
#include <utility>

namespace tactus::analysis {

/// Gives this thread, and those that it creates from now on, the priority of background work.
void let_others_go_first() noexcept;

/// Each lane has one thread of low priority that executes one job after another. So neither a mesh of the scene nor a
/// dragged fragment waits for a study of a plan, and many bones do not take processor time from the forces.
enum class Lane : std::uint8_t {
    scene,  ///< meshes and sections: at most a second
    studies,  ///< of a plan or a scan: many seconds
    moves,  ///< what moves a fragment of a plan: its bodies and fits, for which a hand waits
};
inline constexpr std::size_t lane_count = 3;

/// Queues `job` after the earlier jobs of the lane. It must not throw.
void do_beside(Lane lane, std::function<void()> job);
/// Number of queued jobs of a lane that have not started.
std::size_t jobs_waiting(Lane lane);
/// Drops queued jobs and waits for running ones; afterwards no job is started. Call it at the end of the program,
/// before the data that jobs may use is destroyed.
void end_beside();

/// The result of one computation that only reads. The destructor requests the computation to stop, without waiting for
/// it.
template <class T>
class Beside {
public:
    Beside() = default;
    ~Beside() { let_go(); }
    Beside(Beside&& other) noexcept
        : result_(std::move(other.result_)), stop_(std::exchange(other.stop_, std::stop_source(std::nostopstate))) {}
    Beside& operator=(Beside&& other) noexcept {
        let_go();
        result_ = std::move(other.result_);
        stop_ = std::exchange(other.stop_, std::stop_source(std::nostopstate));
        return *this;
    }

    /// Starts a computation instead of the previous one. `work`: T() or T(std::stop_token); it must own its input.
    template <class Work>
    void begin(Lane lane, Work work) {
        let_go();
        stop_ = std::stop_source();
        auto result = std::make_shared<std::promise<T>>();
        result_ = result->get_future();
        auto kept = std::make_shared<Work>(std::move(work));
        do_beside(lane, [result, kept, stop = stop_.get_token()] {
            if (stop.stop_requested()) return;
            try {
                if constexpr (std::invocable<Work&, std::stop_token>) result->set_value((*kept)(stop));
                else result->set_value((*kept)());
            } catch (...) {
                result->set_exception(std::current_exception());
            }
        });
    }

    /// True if a computation was started and its result not taken.
    bool is_busy() const { return result_.valid(); }
    /// True if the result is available, so that `take` does not wait.
    bool is_ready() const {
        return result_.valid() && result_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    }
    /// Waits for the result and returns it. Rethrows an exception of the computation.
    T take() { return result_.get(); }
    void let_go() {
        stop_.request_stop();
        result_ = {};
    }

private:
    std::future<T> result_;
    std::stop_source stop_{std::nostopstate};
};

}  // namespace tactus::analysis
