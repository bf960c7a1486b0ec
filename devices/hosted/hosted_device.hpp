// SPDX-License-Identifier: Apache-2.0
// The engine's side of a device whose driver runs in a separate process.
#pragma once

#include "devices/haptic/catalogue.hpp"
#include "devices/hosted/block.hpp"
#include "devices/hosted/host_process.hpp"
#include "devices/hosted/placement.hpp"
#include "graph/node/device.hpp"
#include "graph/node/options.hpp"

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tactus::hosted {

/// A device as a patch declares it.
struct DeviceRequest {
    std::string driver, owner;  ///< owner: "device 'hand'", for messages
    std::vector<OptionText> settings;
    SourceLocation where;
};

class HostedDevice final : public HapticDevice, public haptic::PulledDevice {
public:
    /// Starts the process and waits until the driver has opened its device. Throws Error with the driver's text, or when
    /// it takes longer than placement.open_timeout.
    HostedDevice(const DeviceRequest& request, const Placement& placement, const haptic::PathResolver& resolve);
    /// Removes the force, asks the process to end, waits at most 100 ms, then kills it.
    ~HostedDevice() override;

    const DeviceInfo& info() const override { return info_; }
    /// Throws Error with the driver's text, or when it takes longer than open_timeout.
    void prepare(double period_s) override;
    /// The newest sample. Not valid when it is older than 20 ms or three rounds of the process, or while the process holds
    /// forces back. Wait-free, no system call.
    DeviceSample acquire(double elapsed_s) noexcept override;
    /// Wait-free, no system call.
    void commit(const Wrench& on_hand) noexcept override;
    void drive(const MotorDrive& wanted) noexcept override;
    std::shared_ptr<const haptic::PullLink> pull() const noexcept override { return pull_; }

    /// Control thread of a live run, at least every half second: refreshes the engine's heartbeat and checks the
    /// process, which is killed after 500 ms of silence. Returns the reason if the device is lost, otherwise "". Does
    /// not wait.
    const std::string& service() noexcept;
    const std::string& loss() const noexcept { return loss_; }

    /// boot_ns of the commit whose force was active at the last acquired sample; 0: none.
    std::int64_t answered_ns() const noexcept { return newest_.answers_ns; }
    pid_t process() const noexcept { return process_->id(); }

private:
    void pass_pull() noexcept;
    class Socket {
    public:
        Socket();
        ~Socket() { close(); }
        Socket(const Socket&) = delete;
        Socket& operator=(const Socket&) = delete;
        void close() noexcept;
        void close_theirs() noexcept;
        int ours = -1, theirs = -1;
    };

    void wait_for(const char* reply, const haptic::PathResolver& resolve);
    [[noreturn]] void fail(const std::string& message) const;
    std::string how_it_ended() const;

    std::string owner_;
    SourceLocation where_;
    Placement placement_;
    SharedBlock block_;
    Socket socket_;
    std::unique_ptr<HostProcess> process_;
    DeviceInfo info_;
    double own_delay_s_ = 0.0;  // of the device, without that of its process
    std::int64_t limit_ns_ = 20'000'000;
    const std::shared_ptr<haptic::PullLink> pull_ = std::make_shared<haptic::PullLink>();
    // Thread of the tick.
    SampleRecord newest_;
    std::uint64_t number_ = 0, pull_number_ = 0;
    // Control thread.
    std::int64_t published_ns_ = 0, heard_ns_ = 0;
    std::string loss_;
};

/// Opens a device in this process or in a separate one, as its options specify. Throws Error.
std::unique_ptr<HapticDevice> open_placed(const DeviceRequest& request, const haptic::PathResolver& resolve);

/// Opens it in this process regardless of its options, for runs that are not live. Throws Error.
std::unique_ptr<HapticDevice> open_here(const DeviceRequest& request, const haptic::PathResolver& resolve);

/// Returns the delay in s that a separate process, if the options request one, adds to a device whose nodes have
/// `period_s`. Throws Error for invalid options.
double added_latency_s(const DeviceRequest& request, double period_s);

/// Returns the hardware driver's description of the device without opening it. Throws Error for invalid options.
haptic::HardwareOutline describe_here(const DeviceRequest& request, const haptic::PathResolver& resolve);

}  // namespace tactus::hosted
