// SPDX-License-Identifier: Apache-2.0
// A driver outside of the tree: an arm that some program reads and that it reaches by UDP, on this machine. The program sends its
// position as four doubles, x, y, z in m (right, away, up) and the buttons, and gets back the force on the hand: three doubles, N.
//
//     TACTUS_DEVICE_HOST=build/udp_arm tactus run patch.toml
//
// The engine starts this program for each device of the patch that has its driver; watchdogs, limits, the fade after a bad sample
// and the reconnection are those of every driver.
#include <tactus/devices/haptic/catalogue.hpp>
#include <tactus/devices/hosted/device_host.hpp>
#include <tactus/dsp/core/error.hpp>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <memory>
#include <string>

namespace {

using namespace tactus;

class UdpArm final : public driver::Backend {
public:
    UdpArm(int port, double max_force) : port_(port) {
        info_.name = "arm at UDP port " + std::to_string(port);
        info_.max_force = max_force;
        info_.damping = 2.0;  // N s/m of the mechanism in a hand; measure that of yours, it limits the stiffness
    }

    driver::Outline outline() const override { return {info_, ""}; }

    driver::Opened open(driver::OpenMode, const std::shared_ptr<driver::Exchange>& exchange,
                        const driver::StepLog& step) override {
        step("bind UDP port " + std::to_string(port_));
        socket_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
        sockaddr_in here{};
        here.sin_family = AF_INET;
        here.sin_port = htons(static_cast<std::uint16_t>(port_));
        here.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        if (socket_ < 0 || ::bind(socket_, reinterpret_cast<const sockaddr*>(&here), sizeof(here)) != 0)
            throw Error("UDP port " + std::to_string(port_) + " cannot be used: " + std::strerror(errno));
        exchange->begin({.force = info_.max_force}, 10e-6, 0.0);  // positions are right to 10 µm
        return {info_, "", "", {}, 3};
    }

    bool round(driver::Exchange& exchange) noexcept override {
        std::array<double, 4> said{};
        bool is_new = false;
        for (socklen_t size = sizeof(arm_); ::recvfrom(socket_, said.data(), sizeof(said), 0,
                                                       reinterpret_cast<sockaddr*>(&arm_), &size) == sizeof(said);)
            is_new = true;
        if (is_new) {
            driver::Reading reading;
            reading.pose.position = {said[0], said[1], said[2]};
            reading.buttons = said[3] > 0.5 ? button_trigger : 0;
            exchange.publish(reading);  // without one for 20 ms, the sample is invalid and the force fades
        }
        const Vec3 force = exchange.force().force;
        const std::array<double, 3> sent{force.x, force.y, force.z};
        if (arm_.sin_port != 0)
            static_cast<void>(::sendto(socket_, sent.data(), sizeof(sent), 0, reinterpret_cast<const sockaddr*>(&arm_),
                                       sizeof(arm_)));
        return true;
    }

    void close() noexcept override {
        if (socket_ >= 0) ::close(socket_);
        socket_ = -1;
    }

    bool is_peer() const noexcept override { return true; }

private:
    int port_ = 0, socket_ = -1;
    DeviceInfo info_;
    sockaddr_in arm_{};  // who spoke last
};

std::unique_ptr<driver::Backend> make_udp_arm(Options& options) {
    const auto port = static_cast<int>(options.quantity("port", "47000", "1024", "65535"));
    return std::make_unique<UdpArm>(port, options.quantity("max_force", "4 N", "0 N", "20 N"));
}

}  // namespace

int main() {
    haptic::HapticDriver driver;
    driver.name = "udp_arm";
    driver.summary = "an arm behind a UDP port";
    driver.is_real = true;  // runs in real time, in this process
    driver.backend = make_udp_arm;
    haptic::add_haptic_driver(driver);
    return hosted::run_device_host();
}
