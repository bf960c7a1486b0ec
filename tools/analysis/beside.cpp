// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/beside.hpp"

#include "dsp/core/realtime.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

namespace tactus::analysis {

void let_others_go_first() noexcept {
    constexpr int lower_by = 10, lowest = 19;
    // On Linux it is a value of the thread, and threads inherit it. Relative to the main thread's: under `nice` an absolute
    // value would be the higher priority, and refused.
    const int of_program = ::getpriority(PRIO_PROCESS, static_cast<id_t>(::getpid()));
    ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), std::min(of_program + lower_by, lowest));
}

namespace {

class Worker {
public:
    ~Worker() { end(); }

    void add(std::function<void()> job) {
        {
            const std::lock_guard lock(mutex_);
            if (has_ended_) return;
            waiting_.push_back(std::move(job));
            if (!thread_.joinable()) thread_ = std::thread([this] { work(); });
        }
        wake_.notify_one();
    }

    std::size_t waiting() const {
        const std::lock_guard lock(mutex_);
        return waiting_.size();
    }

    void end() {
        std::deque<std::function<void()>> dropped;
        std::thread last;
        {
            const std::lock_guard lock(mutex_);
            has_ended_ = true;
            dropped.swap(waiting_);
            last.swap(thread_);
        }
        wake_.notify_one();
        if (last.joinable()) last.join();
    }

private:
    void work() {
        let_others_go_first();
        flush_denormals_to_zero();
        for (;;) {
            std::function<void()> job;
            {
                std::unique_lock lock(mutex_);
                wake_.wait(lock, [&] { return has_ended_ || !waiting_.empty(); });
                if (has_ended_) return;
                job = std::move(waiting_.front());
                waiting_.pop_front();
            }
            job();
        }
    }

    mutable std::mutex mutex_;
    std::condition_variable wake_;
    std::deque<std::function<void()>> waiting_;
    bool has_ended_ = false;
    std::thread thread_;
};

Worker& worker_of(Lane lane) {
    static std::array<Worker, lane_count> workers;
    return workers[static_cast<std::size_t>(lane)];
}

}  // namespace

void do_beside(Lane lane, std::function<void()> job) { worker_of(lane).add(std::move(job)); }

std::size_t jobs_waiting(Lane lane) { return worker_of(lane).waiting(); }

void end_beside() {
    for (std::size_t lane = 0; lane < lane_count; ++lane) worker_of(static_cast<Lane>(lane)).end();
}

}  // namespace tactus::analysis
