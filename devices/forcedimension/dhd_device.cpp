// SPDX-License-Identifier: Apache-2.0
#include "devices/forcedimension/dhd_device.hpp"

#include "devices/driver/buttons.hpp"
#include "devices/forcedimension/dhd_api.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <optional>
#include <string>
#include <utility>

namespace tactus::forcedimension {

namespace {

// The SDK has x towards the user, y to the right, z up.
Vec3 from_sdk(const Vec3& v) noexcept { return {v.y, -v.x, v.z}; }
Vec3 to_sdk(const Vec3& v) noexcept { return {-v.y, v.x, v.z}; }

/// `rows[i][j]`: row i, column j of the rotation of the handle in the SDK's frame.
Quat from_sdk(const double (&rows)[3][3]) noexcept {
    Mat3 turn;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) turn[column][row] = rows[row][column];
    const Quat q = glm::quat_cast(turn);
    const Vec3 axis = from_sdk(Vec3(q.x, q.y, q.z));
    return {q.w, axis.x, axis.y, axis.z};
}

constexpr unsigned char watchdog_of_device = 160;  // of 125 µs: 20 ms
constexpr double delay_s = 1e-3;  // two of the SDK's exchanges and one round of the driver's thread
constexpr int max_failures = 5;
constexpr int rounds_between_looks = 40;

class DhdDevice final : public driver::Backend {
public:
    DhdDevice(std::string library, int serial) : library_(std::move(library)), serial_(serial) {}

    driver::Outline outline() const override {
        driver::Outline outline;
        outline.info.name = "Force Dimension device";
        outline.info.delay = delay_s;
        outline.info.senses_rotation = true;
        try {
            DhdApi api(library_);
        } catch (const Error& error) {
            outline.absence = error.message();
        }
        return outline;
    }

    driver::Opened open(driver::OpenMode mode, const std::shared_ptr<driver::Exchange>&,
                        const driver::StepLog& step) override {
        mode_ = mode;
        is_calibrated_ = gives_force_ = false;
        failures_ = until_look_ = 0;
        step("load the Force Dimension SDK");
        if (!api_) api_.emplace(library_);
        driver::Opened opened;
        opened.versions.push_back("library " + api_->path());
        if (api_->sdk_version) {
            int v[4] = {};
            api_->sdk_version(&v[0], &v[1], &v[2], &v[3]);
            opened.versions.push_back(fmt::format("SDK {}.{}.{}.{}", v[0], v[1], v[2], v[3]));
        }
        step("look for a device");
        if (api_->count() <= 0)
            throw Error(
                fmt::format("no Force Dimension device was found ({}); is it connected and switched on, and may "
                            "you open it (udev rule)?",
                            api_->error()));
        step("open the device");
        open_device();
        step("read its type");
        const int type = api_->system_type(id());
        const Model* const known = find_model(type);
        model_ = known ? *known : unknown_model;
        opened.info = info(type);
        if (unsigned short number = 0; api_->serial && api_->serial(&number, id()) >= 0)
            opened.serial = std::to_string(number);
        step("read whether it is calibrated");
        look();
        if (mode_ == driver::OpenMode::reading) {
            if (!is_calibrated_) step("wait for its calibration: move the handle as in the maker's manual");
            return opened;
        }
        step("set its limits");
        set_limits();
        if (!is_calibrated_)
            std::fprintf(stderr, "%s: not calibrated yet: no pose and no force until it is (see the maker's manual)\n",
                         opened.info.name.c_str());
        return opened;
    }

    bool round(driver::Exchange& exchange) noexcept override {
        if (!is_calibrated_) {
            if (++until_look_ < rounds_between_looks) return true;
            until_look_ = 0;
            if (!look()) return ++failures_ < max_failures;
            if (!is_calibrated_) {
                exchange.publish_loss();
                return true;
            }
        }
        if (mode_ == driver::OpenMode::run && !gives_force_) gives_force_ = api_->enable_force(1, id()) >= 0;
        const Wrench force = exchange.force();
        const bool given = !gives_force_ || give(force) >= 0;
        double x = 0.0, y = 0.0, z = 0.0, rows[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        const bool read = api_->frame(&x, &y, &z, rows, id()) >= 0;
        if (!given || !read) return ++failures_ < max_failures;
        failures_ = 0;
        driver::Reading reading;
        reading.pose = {from_sdk(Vec3(x, y, z)), from_sdk(rows)};
        reading.buttons = buttons();
        exchange.publish(reading);
        return true;
    }

    void close() noexcept override {
        if (id_ < 0) return;
        give({});
        api_->enable_force(0, id());
        api_->stop(id());
        api_->close(id());
        id_ = -1;
    }

    std::int64_t round_ns() const noexcept override { return 250'000; }

private:
    char id() const noexcept { return static_cast<char>(id_); }

    void open_device() {
        if (serial_ < 0) id_ = api_->open_id(0);
        else if (api_->open_serial) id_ = api_->open_serial(serial_);
        else throw Error(fmt::format("{} cannot open a device by its serial number", api_->path()));
        if (id_ < 0) throw Error(fmt::format("the device cannot be opened: {}", api_->error()));
    }

    DeviceInfo info(int type) const {
        DeviceInfo info;
        const char* const said = api_->system_name ? api_->system_name(id()) : nullptr;
        info.name = fmt::format("Force Dimension {}", said && *said ? said : model_.name);
        info.max_force = model_.force;
        info.actuates_torque =
            model_.torque > 0.0 && api_->set_all && (!api_->has_active_wrist || api_->has_active_wrist(id()));
        info.max_torque = info.actuates_torque ? model_.torque : 0.0;
        info.max_stiffness = model_.stiffness;
        info.resolution = model_.resolution;
        info.angular_resolution = 1.6e-3;
        info.delay = delay_s;
        info.senses_rotation = model_.turns;
        if (model_.type == 0) info.name += fmt::format(" (unknown type {})", type);
        return info;
    }

    /// False when the device does not answer.
    bool look() noexcept {
        int status[max_status] = {};
        if (api_->status(status, id()) < 0) return false;
        is_calibrated_ = status[status_reset] != 0;
        return true;
    }

    void set_limits() {
        if (api_->set_max_force) api_->set_max_force(model_.force, id());
        if (api_->set_gravity) api_->set_gravity(1, id());
        if (!api_->set_watchdog) return;
        if (api_->expert_on) api_->expert_on();
        const bool is_set = api_->set_watchdog(watchdog_of_device, id()) >= 0;
        if (api_->expert_off) api_->expert_off();
        if (!is_set)
            std::fprintf(stderr, "Force Dimension: the device's own watchdog could not be set: %s\n",
                         api_->error().c_str());
    }

    int give(const Wrench& on_hand) const noexcept {
        const Vec3 f = to_sdk(on_hand.force), t = to_sdk(on_hand.torque);
        if (api_->set_all && model_.torque > 0.0) return api_->set_all(f.x, f.y, f.z, t.x, t.y, t.z, 0.0, id());
        return api_->set_force(f.x, f.y, f.z, id());
    }

    std::uint32_t buttons() const noexcept {
        if (api_->button_mask) return driver::buttons_of_mask(api_->button_mask(id()));
        return api_->button && api_->button(0, id()) > 0 ? driver::buttons_of_mask(1u) : 0u;
    }

    std::string library_;
    int serial_;
    std::optional<DhdApi> api_;
    Model model_ = unknown_model;
    driver::OpenMode mode_ = driver::OpenMode::run;
    int id_ = -1, failures_ = 0, until_look_ = 0;
    bool is_calibrated_ = false, gives_force_ = false;
};

}  // namespace

std::unique_ptr<driver::Backend> make_force_dimension(Options& options) {
    const std::string library = options.text("library", "");
    const bool has_serial = options.has("serial");
    const double serial = options.quantity("serial", "0", "0", "65535");
    return std::make_unique<DhdDevice>(library, has_serial ? static_cast<int>(serial) : -1);
}

}  // namespace tactus::forcedimension
