// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/workers.hpp"

#include "dsp/core/stop.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace tactus::analysis {

RunJobs on_threads(int threads) {
    if (threads < 1) threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    return [threads](int count, const std::function<void(int)>& job) {
        std::atomic<int> next{0};
        std::exception_ptr failure;
        std::mutex failing;
        const IsStopped is_stopped = stop_of_this_thread();
        const auto work = [&] {
            try {
                const StopScope scope(is_stopped);
                for (int n = next++; n < count; n = next++) {
                    leave_if_stopped();
                    job(n);
                }
            } catch (...) {
                next = count;
                const std::lock_guard lock(failing);
                if (!failure) failure = std::current_exception();
            }
        };
        {
            std::vector<std::jthread> others;
            for (int n = 1; n < std::min(threads, count); ++n) others.emplace_back(work);
            work();
        }
        if (failure) std::rethrow_exception(failure);
    };
}

}  // namespace tactus::analysis
