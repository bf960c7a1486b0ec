// SPDX-License-Identifier: Apache-2.0
// Computations beside the pictures of a window: they read, and nobody waits for one that is wanted no longer.
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

namespace tactus::study {

/// This thread, and those that it makes from now on, get the priority of background work.
void let_others_go_first() noexcept;

/// Each lane has one thread of low priority and does one job after another: a bone of the scene does not wait for a study
/// of a plan, and many bones do not take the processors from the forces.
enum class Lane : std::uint8_t {
    scene,  ///< meshes and sections: a second at most
    studies,  ///< of a plan or a scan: many seconds
};

/// Does `job` after those that were given to the lane before. It must not throw.
void do_beside(Lane lane, std::function<void()> job);
/// Of a lane: given and not begun.
std::size_t jobs_waiting(Lane lane);
/// Drops what was not begun and waits for the rest; from then on nothing is begun. The end of the program calls this
/// before what a job may use is gone.
void end_beside();

/// The result of one computation that only reads. Its end asks the computation to stop, and does not wait for it.
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

    /// In place of what was begun before. `work`: T() or T(std::stop_token); it owns what it reads.
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

    /// Begun, and not taken.
    bool is_busy() const { return result_.valid(); }
    /// Begun, and `take` does not wait.
    bool is_ready() const {
        return result_.valid() && result_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    }
    /// Waits for it. Throws what the computation threw.
    T take() { return result_.get(); }
    void let_go() {
        stop_.request_stop();
        result_ = {};
    }

private:
    std::future<T> result_;
    std::stop_source stop_{std::nostopstate};
};

}  // namespace tactus::study
