// SPDX-License-Identifier: Apache-2.0
#include "devices/openhaptics/hd_device.hpp"

#include "devices/driver/buttons.hpp"
#include "devices/openhaptics/hd_api.hpp"
#include "dsp/core/clock.hpp"
#include "dsp/core/constants.hpp"

#include <fmt/format.h>

#include <atomic>
#include <cstdio>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace tactus::openhaptics {

namespace {

constexpr std::int64_t longest_silence_ns = 500'000'000;
constexpr unsigned short priority = 32767;  // the vendor's default
constexpr double servo_delay_s = 1e-3;  // one tick of the servo loop

// OpenHaptics has x to the right, y up, z towards the user.
Vec3 from_hd(const Vec3& v) noexcept { return {v.x, -v.z, v.y}; }
Vec3 to_hd(const Vec3& v) noexcept { return {v.x, v.z, -v.y}; }

/// 16 numbers by columns, in mm.
Pose pose_of(const double (&m)[16]) noexcept {
    Mat3 turn;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row) turn[column][row] = m[4 * column + row];
    const Quat q = glm::quat_cast(turn);
    const Vec3 axis = from_hd(Vec3(q.x, q.y, q.z));
    return {from_hd(Vec3(m[12], m[13], m[14]) * mm), Quat(q.w, axis.x, axis.y, axis.z)};
}

/// What the vendor's thread works with. Never freed: that thread may hang in it.
struct Servo {
    const HdApi* api = nullptr;
    unsigned device = invalid_device;
    std::shared_ptr<driver::Exchange> exchange;
    bool may_give = false, gives_torque = false;
    std::atomic<bool> is_calibrated{false}, has_ended{false}, is_lost{false}, is_inside{false};
    std::atomic<std::int64_t> called_ns{0};
};

void give(Servo& servo) noexcept {
    const Wrench force = servo.is_calibrated ? servo.exchange->force() : Wrench{};
    const Vec3 f = to_hd(force.force);
    const double newton[3] = {f.x, f.y, f.z};
    servo.api->set_double(current_force, newton);
    if (!servo.gives_torque) return;
    const Vec3 t = to_hd(force.torque) * 1e3;
    const double millinewton_metre[3] = {t.x, t.y, t.z};
    servo.api->set_double(current_torque, millinewton_metre);
}

void run_servo(Servo& servo) noexcept {
    const HdApi& api = *servo.api;
    api.begin_frame(servo.device);
    double transform[16] = {};
    int buttons = 0;
    api.get_double(current_transform, transform);
    api.get_integer(current_buttons, &buttons);
    if (servo.may_give) give(servo);
    api.end_frame(servo.device);
    bool is_good = true;
    for (int i = 0; i < 64; ++i) {
        const unsigned code = api.get_error().code;
        if (code == 0) break;
        // Warm motors and clipped forces are the device's own protection; what it measures is still true.
        if (code >= first_device_error && code <= last_device_error) is_good = false;
    }
    if (!is_good) {
        servo.is_lost = true;
        return;
    }
    driver::Reading reading;
    reading.pose = pose_of(transform);
    reading.buttons = driver::buttons_of_mask(static_cast<std::uint32_t>(buttons));
    reading.is_valid = servo.is_calibrated;
    servo.exchange->publish(reading);
}

unsigned call_servo(void* data) noexcept {
    Servo& servo = *static_cast<Servo*>(data);
    servo.is_inside.store(true);
    if (!servo.has_ended.load() && !servo.is_lost.load()) run_servo(servo);
    servo.called_ns.store(steady_ns());
    servo.is_inside.store(false);
    return servo.has_ended.load() ? 0 : callback_continue;
}

/// To the end of the process: a thread of the vendor that hangs may still use it, as it does the library.
template <class T>
T* keep(std::unique_ptr<T> object) {
    static std::mutex mutex;
    static auto& all = *new std::vector<std::unique_ptr<T>>;
    const std::lock_guard lock(mutex);
    return all.emplace_back(std::move(object)).get();
}

class HdDevice final : public driver::Backend {
public:
    HdDevice(std::string library, std::string config) : library_(std::move(library)), config_(std::move(config)) {}

    driver::Outline outline() const override {
        driver::Outline outline;
        outline.info.name = "3D Systems Touch";
        outline.info.delay = servo_delay_s;
        outline.info.senses_rotation = true;
        try {
            HdApi api(library_);
        } catch (const Error& error) {
            outline.absence = error.message();
        }
        return outline;
    }

    driver::Opened open(driver::OpenMode mode, const std::shared_ptr<driver::Exchange>& exchange,
                        const driver::StepLog& step) override {
        mode_ = mode;
        step("load OpenHaptics");
        if (!api_) api_ = keep(std::make_unique<HdApi>(library_));
        step("open the device");
        open_device();
        step("read what it is");
        driver::Opened opened = describe();
        step("start the servo loop");
        servo_ = keep(std::make_unique<Servo>());
        servo_->api = api_;
        servo_->device = device_;
        servo_->exchange = exchange;
        servo_->gives_torque = opened.info.actuates_torque;
        servo_->may_give = mode_ == driver::OpenMode::run;
        if (servo_->may_give) {
            // Enabled before the servo runs; forces stay zero until the device is calibrated.
            api_->enable(force_output);
            api_->enable(max_force_clamping);
        }
        if (const std::string said = api_->pop_errors(); !said.empty())
            throw Error(fmt::format("the device cannot be prepared: OpenHaptics reports '{}'", said));
        step("read whether it is calibrated");
        look();
        if (!servo_->is_calibrated && mode_ == driver::OpenMode::run)
            std::fprintf(stderr, "%s: not calibrated yet: no force until its stylus was in the inkwell\n",
                         opened.info.name.c_str());
        return opened;
    }

    bool round(driver::Exchange&) noexcept override {
        const std::int64_t now = steady_ns();
        if (!runs_) {
            servo_->called_ns = now;
            handle_ = api_->schedule(call_servo, servo_, priority);
            if (api_->set_rate) api_->set_rate(1000);
            api_->start_scheduler();
            runs_ = true;
            if (!api_->pop_errors().empty()) return false;
        }
        if (servo_->is_lost || now - servo_->called_ns > longest_silence_ns) return false;
        if (!servo_->is_calibrated && ++until_look_ >= 50) {
            until_look_ = 0;
            look();
        }
        return true;
    }

    void close() noexcept override {
        if (servo_) servo_->has_ended = true;
        if (runs_) {
            // A thread of the vendor that hangs still has the device; whoever ends the driver does not wait for it.
            while (servo_->is_inside) sleep_for(1'000'000);
            api_->stop_scheduler();
            api_->unschedule(handle_);
        }
        if (device_ != invalid_device) {
            api_->make_current(device_);
            api_->disable(force_output);
            api_->disable_device(device_);
            api_->pop_errors();
        }
        device_ = invalid_device;
        runs_ = false;
    }

    std::int64_t round_ns() const noexcept override { return 1'000'000; }

private:
    void open_device() {
        // A null name fails with some versions of the vendor's driver.
        const std::vector<std::string> names =
            config_.empty() ? std::vector<std::string>{"Default Device", "Default PHANToM"} : std::vector{config_};
        std::string why;
        for (const std::string& name : names) {
            device_ = api_->init_device(name.c_str());
            const std::string said = api_->pop_errors();
            if (device_ != invalid_device && said.empty()) return;
            if (device_ != invalid_device) api_->disable_device(device_);
            device_ = invalid_device;
            why += fmt::format("{}'{}': {}", why.empty() ? "" : "; ", name, said.empty() ? "no such device" : said);
        }
        throw Error(
            fmt::format("no device can be opened: {}. Run the vendor's setup program, and name what it set up "
                        "with the option 'config'",
                        why));
    }

    std::string text(unsigned what) const {
        const char* const said = api_->get_string(what);
        return said ? said : "";
    }

    driver::Opened describe() {
        api_->make_current(device_);
        driver::Opened opened;
        DeviceInfo& info = opened.info;
        info.name = fmt::format("3D Systems {}", text(model_type));
        double force = 0.0, stiffness = 0.0, torque = 0.0;
        int freedom = 0;
        api_->get_double(max_force, &force);
        api_->get_double(max_stiffness, &stiffness);
        api_->get_integer(output_freedom, &freedom);
        if (freedom >= 6) api_->get_double(max_torque, &torque);
        opened.serial = text(serial_number);
        opened.versions = {"library " + api_->path(), "driver " + text(driver_version)};
        double firmware = 0.0;
        api_->get_double(firmware_version, &firmware);
        if (firmware > 0.0) opened.versions.push_back(fmt::format("firmware {}", firmware));
        api_->pop_errors();  // of parameters that this device does not know
        // What is no number of a device is none that is relied on.
        info.max_force = force > 0.0 && force < 100.0 ? force : 3.3;
        info.max_stiffness = stiffness > 0.0 && stiffness < 100.0 ? stiffness * 1e3 : 500.0;  // from N/mm
        info.actuates_torque = torque > 0.0 && torque < 10'000.0;
        info.max_torque = info.actuates_torque ? torque * 1e-3 : 0.0;
        info.resolution = 55e-6;
        info.angular_resolution = 1e-3;
        info.delay = servo_delay_s;
        info.senses_rotation = true;
        return opened;
    }

    void look() noexcept {
        api_->make_current(device_);
        unsigned said = api_->check_calibration();
        if (said == calibration_needs_update) {
            int style = 0;
            api_->get_integer(calibration_style, &style);
            api_->update_calibration(static_cast<unsigned>(style));
            said = api_->check_calibration();
        }
        servo_->is_calibrated = said == calibration_ok;
        api_->pop_errors();
    }

    std::string library_, config_;
    const HdApi* api_ = nullptr;
    Servo* servo_ = nullptr;
    driver::OpenMode mode_ = driver::OpenMode::run;
    unsigned device_ = invalid_device;
    unsigned long handle_ = 0;
    int until_look_ = 0;
    bool runs_ = false;
};

}  // namespace

std::unique_ptr<driver::Backend> make_touch(Options& options) {
    const std::string library = options.text("library", "");
    return std::make_unique<HdDevice>(library, options.text("config", ""));
}

}  // namespace tactus::openhaptics
