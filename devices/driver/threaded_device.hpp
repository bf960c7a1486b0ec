// SPDX-License-Identifier: Apache-2.0
// A device behind a Backend: a thread of its own opens it, runs its rounds, and opens it again when it was lost. The
// tick only exchanges values with this thread, so that neither a vendor's library nor a peer can delay it.
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
    bool is_untested = true;               ///< nobody has tried this driver with its device
    bool ignores_confirmation = false;     ///< by the command that asks for it: the cap of unconfirmed devices holds
    std::chrono::milliseconds open_timeout{10'000};
    std::chrono::milliseconds reopen_every{250};
    std::chrono::milliseconds farewell{200};  ///< that the thread has to close the device
};

/// Most that a device gives until its push directions were confirmed: N. It gives no torque.
inline constexpr double unconfirmed_force = 0.5;

class ThreadedDevice final : public HapticDevice, public haptic::PulledDevice {
public:
    /// Waits until the device is open. Throws Error with the step that failed, or when it takes longer than
    /// open_timeout.
    ThreadedDevice(std::unique_ptr<Backend> backend, DeviceOptions options);
    /// No force; waits for the thread at most `farewell`, then leaves it alone for ever.
    ~ThreadedDevice() override;

    const DeviceInfo& info() const override { return info_; }
    void prepare(double period_s) override;
    DeviceSample acquire(double elapsed_s) noexcept override;
    void commit(const Wrench& on_hand) noexcept override;
    std::shared_ptr<const haptic::PullLink> pull() const noexcept override;

    const Opened& opened() const { return opened_; }
    /// Forces are capped because nobody has confirmed the directions of its pushes.
    bool is_capped() const { return is_capped_; }
    /// Samples since it was opened.
    std::int64_t published() const noexcept;
    /// Steps of the last opening, in order.
    const std::vector<std::string>& steps() const { return steps_; }
    /// Times that the device came back.
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

/// An opening that failed: the text of Error names the step, too.
struct OpenError : Error {
    OpenError(const std::string& message, std::vector<std::string> taken) : Error(message), steps(std::move(taken)) {}

    std::vector<std::string> steps;  ///< in order; the last one failed
};

/// Threads of this process that hang in a driver and were left alone. A process that has one must end by _exit: what
/// runs at an ordinary exit would take memory away from them.
int abandoned_threads() noexcept;

}  // namespace tactus::driver
