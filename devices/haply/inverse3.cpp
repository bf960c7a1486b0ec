// SPDX-License-Identifier: Apache-2.0
#include "devices/haply/inverse3.hpp"

#include "devices/haply/inverse_messages.hpp"
#include "devices/haply/web_socket.hpp"
#include "dsp/core/clock.hpp"

#include <fmt/format.h>

#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tactus::haply {

namespace {

using std::chrono::milliseconds;

constexpr milliseconds longest_opening{2000};
constexpr std::int64_t longest_silence_ns = 250'000'000, tell_again_ns = 5'000'000;
constexpr int max_at_once = 64;
constexpr const char* no_device = "the service finds no Inverse3; is it connected and switched on?";

struct Settings {
    std::string address;
    int port = 10001;
    std::size_t force_key = 0;  // auto, vector, values
    double max_force = 4.0;
};

class Inverse3 final : public driver::Backend {
public:
    explicit Inverse3(Settings settings) : settings_(std::move(settings)) {}

    driver::Outline outline() const override {
        driver::Outline outline;
        outline.info = info();
        try {
            WebSocket look;
            look.open(settings_.address, settings_.port, milliseconds(300));
        } catch (const Error& error) {
            outline.absence = error.message();
        }
        return outline;
    }

    driver::Opened open(driver::OpenMode mode, const std::shared_ptr<driver::Exchange>&,
                        const driver::StepLog& step) override {
        step(fmt::format("connect to the Inverse Service at {}:{}", settings_.address, settings_.port));
        try {
            service_.open(settings_.address, settings_.port, longest_opening);
        } catch (const Error& error) {
            throw Error(error.message() + "; is Haply's Inverse Service running?");
        }
        step("hear what devices there are");
        const InverseState state = first_state();
        step("check its axes");
        if (!state.changed_axes.empty())
            throw Error(
                fmt::format("the service has {} for this device, so directions would be wrong; reset it in "
                            "Haply's hub",
                            state.changed_axes));
        device_ = state.device;
        key_ = settings_.force_key == 0 ? force_key_of(state.version)
                                        : (settings_.force_key == 1 ? ForceKey::vector : ForceKey::values);
        is_first_ = true;
        waits_ = false;
        gives_ = mode == driver::OpenMode::run;
        heard_ns_ = steady_ns();
        driver::Opened opened;
        opened.info = info();
        if (!state.type.empty()) opened.info.name = fmt::format("Haply {}", state.type);
        opened.serial = state.device;
        opened.versions = {state.version.empty() ? "service of unknown version" : "service " + state.version};
        return opened;
    }

    /// The service answers each message with one state. Sends the next message after an answer, or when one seems lost.
    bool round(driver::Exchange& exchange) noexcept override {
        try {
            const std::int64_t now = steady_ns();
            if (!waits_ || now - told_ns_ > tell_again_ns) {
                const Wrench force = gives_ ? exchange.force() : Wrench{};
                if (!service_.send(force_text(device_, force.force, key_, is_first_))) return false;
                is_first_ = false;
                waits_ = true;
                told_ns_ = now;
            }
            WebSocket::Heard heard = service_.receive(milliseconds(2));
            if (heard == WebSocket::Heard::nothing) return now - heard_ns_ < longest_silence_ns;
            // Of what waits only the newest counts.
            for (int i = 0; i < max_at_once && heard == WebSocket::Heard::message; ++i) {
                newest_ = service_.text();
                heard = service_.receive(milliseconds(0));
            }
            if (heard == WebSocket::Heard::closed) return false;
            waits_ = false;
            const std::optional<InverseState> state = read_inverse(newest_);
            if (!state || !state->has_pose) return now - heard_ns_ < longest_silence_ns;
            if (state->device != device_ || !state->changed_axes.empty()) return false;
            heard_ns_ = now;
            exchange.publish(state->reading);
            return true;
        } catch (const std::exception&) {
            return false;  // no memory for a text
        }
    }

    void close() noexcept override {
        try {
            if (!device_.empty()) service_.send(force_text(device_, Vec3(0.0), key_, false));
        } catch (const std::exception&) {
            // The service releases the force when it receives nothing.
        }
        device_.clear();
        service_.close();
    }

    std::int64_t round_ns() const noexcept override { return 500'000; }
    bool is_peer() const noexcept override { return true; }

private:
    DeviceInfo info() const {
        DeviceInfo info;
        info.name = "Haply Inverse3";
        info.max_force = settings_.max_force;
        info.max_stiffness = 1000.0;
        info.resolution = 50e-6;
        info.angular_resolution = 2e-3;
        info.delay = 2e-3;
        info.senses_rotation = true;
        return info;
    }

    InverseState first_state() {
        const std::int64_t until = steady_ns() + std::chrono::nanoseconds(longest_opening).count();
        std::string why = "it sends nothing";
        while (steady_ns() < until) {
            const auto heard = service_.receive(milliseconds(100));
            if (heard == WebSocket::Heard::closed) throw Error("the service hung up");
            if (heard == WebSocket::Heard::nothing) continue;
            std::optional<InverseState> state = read_inverse(service_.text());
            if (state && !state->device.empty()) return *state;
            why = no_device;
        }
        throw Error(fmt::format("no inventory from the service: {}", why));
    }

    Settings settings_;
    WebSocket service_;
    std::string device_, newest_;
    ForceKey key_ = ForceKey::vector;
    bool is_first_ = true, waits_ = false, gives_ = false;
    std::int64_t told_ns_ = 0, heard_ns_ = 0;
};

}  // namespace

std::unique_ptr<driver::Backend> make_inverse3(Options& options) {
    static const std::vector<std::string> keys{"auto", "vector", "values"};
    Settings settings;
    settings.address = options.text("address", "127.0.0.1");
    const double port = options.quantity("port", "10001", "1", "65535");
    settings.port = static_cast<int>(port);
    if (settings.port != port)
        throw Error(options.where("port"), fmt::format("{}: option 'port' is a whole number", options.owner()));
    settings.force_key = options.choice("force_key", keys, "auto");
    settings.max_force = options.quantity("max_force", "4 N", "0.1 N", "10 N");
    return std::make_unique<Inverse3>(std::move(settings));
}

}  // namespace tactus::haply
