// SPDX-License-Identifier: Apache-2.0
// A device behind a Backend: its own thread opens it, runs its rounds, and reopens it after a loss. The tick only
// exchanges values with this thread, so that neither a vendor's library nor a network client can delay it.
#pragma once

#include "devices/driver/backend.hpp"
#include "dsp/core/error.hpp"

#include <chrono>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace tactus::driver {

struct DeviceOptions {
    std::string driver;                    ///< its name in the catalogue
    OpenMode mode = OpenMode::run;
    bool is_untested = true;               ///< this driver has not been tested with its device
    bool ignores_confirmation = false;     ///< for the confirming command: keeps the cap of unconfirmed devices
    std::chrono::milliseconds open_timeout{10'000};
    std::chrono::milliseconds reopen_every{250};
    std::chrono::milliseconds farewell{200};  ///< time that the thread has to close the device
};

/// Largest force of a device before its push directions are confirmed, N. Its torque is then zero.
inline constexpr double unconfirmed_force = 0.5;

class ThreadedDevice final : public HapticDevice, public haptic::PulledDevice {
public:
    /// Waits until the device is open. Throws Error with the step that failed, or when it takes longer than
    /// open_timeout.
    ThreadedDevice(std::unique_ptr<Backend> backend, DeviceOptions options);
    /// Removes the force. Waits for the thread at most `farewell`, then abandons it.
    ~ThreadedDevice() override;

    const DeviceInfo& info() const override { return info_; }
    void prepare(double period_s) override;
    DeviceSample acquire(double elapsed_s) noexcept override;
    void commit(const Wrench& on_hand) noexcept override;
    std::shared_ptr<const haptic::PullLink> pull() const noexcept override;

    const Opened& opened() const { return opened_; }
    /// True if forces are capped because the push directions are not confirmed.
    bool is_capped() const { return is_capped_; }
    /// Samples since it was opened.
    std::int64_t published() const noexcept;
    /// Steps of the last opening, in order.
    const std::vector<std::string>& steps() const { return steps_; }
    /// Number of times that the device was reopened after a loss.
    int returns() const noexcept;

    struct Shared;

private:
    void leave() noexcept;

    DeviceOptions options_;
    std::shared_ptr<Shared> shared_;
    DeviceInfo info_;
    Opened opened_;
    std::vector<std::string> steps_;
    bool is_capped_ = false;
};

/// A failed opening; the text of Error also names the step.
struct OpenError : Error {
    OpenError(const std::string& message, std::vector<std::string> taken) : Error(message), steps(std::move(taken)) {}

    std::vector<std::string> steps;  ///< in order; the last one failed
};

/// Number of threads of this process that hang in a driver and were abandoned. If there are any, the process must end
/// by _exit, because an ordinary exit would free memory that they use.
int abandoned_threads() noexcept;

}  // namespace tactus::driver
