// SPDX-License-Identifier: Apache-2.0
#include "devices/hosted/hosted_device.hpp"

#include "devices/hosted/force_gate.hpp"
#include "devices/hosted/message.hpp"
#include "dsp/core/clock.hpp"

#include <fmt/format.h>

#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <utility>

namespace tactus::hosted {

namespace {

constexpr std::chrono::milliseconds farewell{100};
constexpr std::int64_t longest_driver_silence_ns = 500'000'000;
constexpr double oldest_sample_s = 20e-3;

}  // namespace

HostedDevice::Socket::Socket() {
    int ends[2];
    if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0)
        throw Error(fmt::format("no socket to a device's process: {}", std::strerror(errno)));
    ours = ends[0];
    theirs = ends[1];
}

void HostedDevice::Socket::close() noexcept {
    close_theirs();
    if (ours >= 0) ::close(std::exchange(ours, -1));
}

void HostedDevice::Socket::close_theirs() noexcept {
    if (theirs >= 0) ::close(std::exchange(theirs, -1));
}

HostedDevice::HostedDevice(const DeviceRequest& request, const Placement& placement,
                           const haptic::PathResolver& resolve)
    : owner_(request.owner),
      where_(request.where),
      placement_(placement),
      block_(SharedBlock::create()),
      process_(std::make_unique<HostProcess>(host_program(), block_.descriptor(), socket_.theirs)) {
    block_.close_descriptor();
    socket_.close_theirs();
    Words open{say_open, request.driver, request.owner};
    append(open, request.where);
    for (const OptionText& option : request.settings) {
        open.insert(open.end(), {option.name, option.text, option.scope});
        append(open, option.where);
    }
    send(socket_.ours, open);
    wait_for(say_ready, resolve);
    try {
        info_ = unpack(block_->info);
        own_delay_s_ = info_.delay;
    } catch (const Error& error) {
        fail(error.message());
    }
}

HostedDevice::~HostedDevice() {
    commit({});
    block_->must_end.store(1, std::memory_order_release);
    socket_.close();
    process_->wait(farewell);
}

void HostedDevice::fail(const std::string& message) const {
    throw Error(where_, fmt::format("{}: {}", owner_, message));
}

/// The reason that the process reported, or the signal that ended it.
std::string HostedDevice::how_it_ended() const {
    if (block_->state.load(std::memory_order_acquire) == HostState::ended)
        if (const std::string reason = text_of(block_->reason, sizeof block_->reason); !reason.empty())
            return fmt::format("its process ended: {}", reason);
    return fmt::format("its process {}", process_->how_it_ended());
}

void HostedDevice::wait_for(const char* reply, const haptic::PathResolver& resolve) {
    const std::int64_t until = steady_ns() + std::llround(1e9 * placement_.open_timeout);
    for (;;) {
        const Received heard = receive(socket_.ours, std::chrono::milliseconds(ms_until(until)));
        if (heard.kind == Received::nothing) {
            process_->kill();
            fail(fmt::format(
                "the driver did not answer within {:.3g} s and was ended; is the device switched on? A slow "
                "one needs a longer open_timeout",
                placement_.open_timeout));
        }
        if (heard.kind == Received::closed) {
            process_->wait(farewell);
            fail(process_->has_ended() ? how_it_ended() : "its process sent an invalid message");
        }
        const std::string& what = heard.said.front();
        if (what == reply) return;
        if (what == say_error) {
            process_->wait(farewell);  // it closes what it had opened
            throw error_of(heard.said);
        }
        if (what != say_resolve || heard.said.size() != 2) fail("its process sent an invalid message");
        try {
            send(socket_.ours, {say_path, resolve(heard.said[1]).string()});
        } catch (const Error& error) {
            send(socket_.ours, error_words(error));
        }
    }
}

void HostedDevice::prepare(double period_s) {
    limit_ns_ = std::llround(1e9 * std::max(oldest_sample_s, 3.0 * placement_.round_s(period_s)));
    send(socket_.ours, {say_prepare, fmt::format("{:a}", period_s), fmt::format("{:a}", placement_.round_s(period_s))});
    wait_for(say_prepared, [this](const std::string& name) -> std::filesystem::path {
        fail(fmt::format("the driver asks for the asset '{}' too late", name));
    });
    heard_ns_ = steady_ns();
    block_->sample.read(newest_, number_);
    // The energy bound needs the whole delay.
    info_.delay = own_delay_s_ + placement_.added_latency_s(period_s);
}

DeviceSample HostedDevice::acquire(double) noexcept {
    // One that is being written for ever is as old as the one before.
    block_->sample.read(newest_, number_);
    pass_pull();
    DeviceSample sample = unpack(newest_);
    sample.valid = sample.valid && newest_.holds_force == 0 && is_young(newest_.published_ns, boot_ns(), limit_ns_);
    return sample;
}

void HostedDevice::pass_pull() noexcept {
    PullRecord record;
    std::uint64_t number = 0;
    if (!block_->pull.read(record, number) || number == pull_number_) return;
    pull_number_ = number;
    if (const auto hand = unpack(record)) pull_->write(*hand);
}

void HostedDevice::commit(const Wrench& on_hand) noexcept { block_->force.write(pack(on_hand, boot_ns())); }

void HostedDevice::drive(const MotorDrive& wanted) noexcept { block_->drive.write(pack(wanted, boot_ns())); }

const std::string& HostedDevice::service() noexcept {
    if (!loss_.empty()) return loss_;
    const std::int64_t now = steady_ns();
    block_->engine_lives_ns.store(now, std::memory_order_release);
    SampleRecord newest;
    std::uint64_t number = 0;
    // A service that was late itself, as after a suspend, proves no silence.
    if (block_->sample.read(newest, number) && newest.published_ns != published_ns_) {
        published_ns_ = newest.published_ns;
        heard_ns_ = now;
    }
    if (process_->has_ended()) loss_ = how_it_ended();
    else if (now - heard_ns_ > longest_driver_silence_ns) {
        process_->kill();
        loss_ = fmt::format("its driver did not return for {} ms; its process was killed",
                            longest_driver_silence_ns / 1'000'000);
    }
    return loss_;
}

std::unique_ptr<HapticDevice> open_placed(const DeviceRequest& request, const haptic::PathResolver& resolve) {
    Options options(request.owner, request.settings, request.where);
    const Placement placement = read_placement(options, request.driver);
    if (placement.own_process) return std::make_unique<HostedDevice>(request, placement, resolve);
    return open_here(request, resolve);
}

std::unique_ptr<HapticDevice> open_here(const DeviceRequest& request, const haptic::PathResolver& resolve) {
    Options options(request.owner, request.settings, request.where);
    read_placement(options, request.driver);
    std::unique_ptr<HapticDevice> device = haptic::open_haptic_device(request.driver, request.where, options, resolve);
    options.finish();
    return device;
}

double added_latency_s(const DeviceRequest& request, double period_s) {
    Options options(request.owner, request.settings, request.where);
    return read_placement(options, request.driver).added_latency_s(period_s);
}

haptic::HardwareOutline describe_here(const DeviceRequest& request, const haptic::PathResolver& resolve) {
    Options options(request.owner, request.settings, request.where);
    read_placement(options, request.driver);
    return haptic::describe_haptic_device(request.driver, request.where, options, resolve);
}

}  // namespace tactus::hosted
