// SPDX-License-Identifier: Apache-2.0
#include "devices/driver/threaded_device.hpp"

#include "devices/driver/confirmation.hpp"
#include "dsp/core/clock.hpp"

#include <fmt/format.h>

#include <locale.h>
#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdio>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

namespace tactus::driver {

namespace {

std::atomic<int> abandoned{0};

/// Numbers in the text of a vendor's files have a point, whatever language the user's programs speak.
class CLocale {
public:
    CLocale() : locale_(::newlocale(LC_ALL_MASK, "C", nullptr)), before_(::uselocale(locale_)) {}
    ~CLocale() {
        ::uselocale(before_);
        if (locale_) ::freelocale(locale_);
    }
    CLocale(const CLocale&) = delete;
    CLocale& operator=(const CLocale&) = delete;

private:
    locale_t locale_, before_;
};

constexpr int above_groups = 82, below_groups = 5;  // below the watchdogs; above what is not real-time

void make_real_time(int priority) noexcept {
    sched_param parameters{};
    parameters.sched_priority = priority;
    ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &parameters);
}

}  // namespace

int abandoned_threads() noexcept { return abandoned.load(); }

/// Owned by the device and by its thread; whoever is last takes it down.
struct ThreadedDevice::Shared {
    DeviceOptions options;
    std::unique_ptr<Backend> backend;
    std::shared_ptr<Exchange> exchange = std::make_shared<Exchange>();
    std::atomic<bool> must_end{false};
    std::atomic<int> returns{0};

    std::mutex mutex;
    std::condition_variable changed;
    enum class State { opens, is_open, failed } state = State::opens;  // of the first opening
    bool is_over = false;
    Opened opened;
    bool is_capped = false;
    std::string error;
    std::vector<std::string> steps;

    Opened open();
    void begin(const Opened& now, bool capped);
    void run() noexcept;
    bool serve() noexcept;
    void wait(std::chrono::milliseconds time) noexcept;
    void fail(const std::string& message) noexcept;
};

Opened ThreadedDevice::Shared::open() {
    {
        const std::lock_guard lock(mutex);
        steps.clear();
    }
    return backend->open(options.mode, exchange, [this](const std::string& step) {
        const std::lock_guard lock(mutex);
        steps.push_back(step);
    });
}

void ThreadedDevice::Shared::begin(const Opened& now, bool capped) {
    ForceLimits limits{now.info.max_force, now.info.actuates_torque ? now.info.max_torque : 0.0,
                       !now.info.without_motors};
    if (capped) limits = {std::min(limits.force, unconfirmed_force), 0.0};
    if (options.mode == OpenMode::reading) limits = {};
    exchange->begin(limits, std::max(now.info.resolution, 1e-9), std::max(now.info.angular_resolution, 1e-9));
}

void ThreadedDevice::Shared::fail(const std::string& message) noexcept {
    const std::lock_guard lock(mutex);
    error = message;
    state = State::failed;
    changed.notify_all();
}

void ThreadedDevice::Shared::wait(std::chrono::milliseconds time) noexcept {
    std::unique_lock lock(mutex);
    changed.wait_for(lock, time, [this] { return must_end.load(); });
}

/// Until the device is lost or the end; true: lost.
bool ThreadedDevice::Shared::serve() noexcept {
    std::int64_t next = steady_ns();
    while (!must_end.load(std::memory_order_acquire)) {
        if (!backend->round(*exchange)) return true;
        const std::int64_t step = backend->round_ns(), now = steady_ns();
        // Also a round that takes longer leaves time to others.
        next = std::max(next + step, now + step / 4);
        sleep_until(next);
    }
    return false;
}

void ThreadedDevice::Shared::run() noexcept {
    const CLocale c_locale;
    try {
        const Opened now = open();
        const bool needs = !now.info.without_motors && options.is_untested;
        const bool capped = needs && (options.ignores_confirmation || !is_confirmed(options.driver, now));
        begin(now, capped);
        const std::lock_guard lock(mutex);
        opened = now;
        is_capped = capped;
        state = State::is_open;
        changed.notify_all();
    } catch (const std::exception& error_now) {
        backend->close();
        fail(error_now.what());
        return;
    }
    make_real_time(backend->is_peer() ? below_groups : above_groups);
    bool is_open = true;
    while (!must_end.load(std::memory_order_acquire)) {
        if (is_open && !serve()) break;
        backend->close();
        exchange->publish_loss();
        is_open = false;
        wait(options.reopen_every);
        if (must_end.load()) break;
        try {
            const Opened again = open();
            if (again.serial != opened.serial || again.setup != opened.setup) {
                backend->close();
                continue;  // another device: nobody has said that it may be used
            }
            begin(again, is_capped);
            is_open = true;
            ++returns;
        } catch (const std::exception&) {
            backend->close();
        }
    }
    if (is_open) backend->close();
}

ThreadedDevice::ThreadedDevice(std::unique_ptr<Backend> backend, DeviceOptions options)
    : options_(std::move(options)), shared_(std::make_shared<Shared>()) {
    shared_->options = options_;
    shared_->backend = std::move(backend);
    std::thread([shared = shared_] {
        shared->run();
        const std::lock_guard lock(shared->mutex);
        shared->is_over = true;
        shared->changed.notify_all();
    }).detach();
    std::unique_lock lock(shared_->mutex);
    shared_->changed.wait_for(lock, options_.open_timeout, [&] { return shared_->state != Shared::State::opens; });
    const std::vector<std::string> steps = shared_->steps;
    const std::string last = steps.empty() ? "" : fmt::format(" (step '{}')", steps.back());
    if (shared_->state == Shared::State::opens) {
        lock.unlock();
        leave();
        throw OpenError(fmt::format("the driver did not answer within {:.3g} s{}",
                                    std::chrono::duration<double>(options_.open_timeout).count(), last),
                        steps);
    }
    if (shared_->state == Shared::State::failed) {
        const std::string why = shared_->error;
        lock.unlock();
        leave();
        throw OpenError(why + last, steps);
    }
    opened_ = shared_->opened;
    is_capped_ = shared_->is_capped;
    steps_ = steps;
    info_ = opened_.info;
    if (!is_capped_) return;
    info_.max_force = std::min(info_.max_force, unconfirmed_force);
    info_.max_torque = 0.0;
    info_.actuates_torque = false;
    std::fprintf(stderr,
                 "%s: untested on hardware: at most %.1f N and no torque until you have confirmed its push directions "
                 "with 'tactus devices --verify %s'\n",
                 info_.name.c_str(), unconfirmed_force, options_.driver.c_str());
}

void ThreadedDevice::leave() noexcept {
    shared_->exchange->commit({});
    std::unique_lock lock(shared_->mutex);
    shared_->must_end.store(true, std::memory_order_release);
    shared_->changed.notify_all();
    if (!shared_->changed.wait_for(lock, options_.farewell, [&] { return shared_->is_over; })) ++abandoned;
}

ThreadedDevice::~ThreadedDevice() { leave(); }

void ThreadedDevice::prepare(double period_s) {
    shared_->exchange->expect(period_s);
    shared_->exchange->commit({});
}

DeviceSample ThreadedDevice::acquire(double) noexcept { return shared_->exchange->newest(); }

void ThreadedDevice::commit(const Wrench& on_hand) noexcept { shared_->exchange->commit(on_hand); }

std::shared_ptr<const haptic::PullLink> ThreadedDevice::pull() const noexcept {
    return {shared_->exchange, &shared_->exchange->pull};
}

std::int64_t ThreadedDevice::published() const noexcept { return shared_->exchange->published(); }

int ThreadedDevice::returns() const noexcept { return shared_->returns.load(); }

}  // namespace tactus::driver
