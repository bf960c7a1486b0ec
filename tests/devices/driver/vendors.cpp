// SPDX-License-Identifier: Apache-2.0
// What is each vendor's own: files and functions that are missing, calibration, watchdogs, errors, locale; and the cap
// of devices whose pushes nobody has confirmed.
#include "devices/driver/confirmation.hpp"
#include "devices/forcedimension/dhd_device.hpp"
#include "devices/haptic/catalogue.hpp"
#include "devices/openhaptics/hd_device.hpp"
#include "dsp/core/clock.hpp"
#include "tests/devices/driver/library_peers.hpp"
#include "tests/devices/hosted/with_host.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/support/skip.hpp"
#include "tests/support/virtual_clock.hpp"

#include <dlfcn.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

using namespace tactus;
using namespace tactus::test;
using Catch::Matchers::ContainsSubstring;

namespace {

std::string error_of(const std::function<void()>& code) {
    try {
        code();
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

std::string open_error(const std::string& driver, const std::string& library) {
    return error_of([&] {
        Options options("device 'hand'", {{"library", library, {}}}, {"p.toml", 3, 1});
        haptic::open_haptic_device(driver, {"p.toml", 4, 1}, options, [](const std::string& name) { return name; });
    });
}

/// A folder of settings of its own.
class OwnConfig {
public:
    OwnConfig() : folder(std::filesystem::temp_directory_path() / ("tactus_config_" + std::to_string(::getpid()))) {
        std::filesystem::remove_all(folder);
        ::setenv("XDG_CONFIG_HOME", folder.c_str(), 1);
    }
    ~OwnConfig() {
        ::unsetenv("XDG_CONFIG_HOME");
        std::filesystem::remove_all(folder);
    }
    std::filesystem::path folder;
};

double max_given(HapticDevice& device, Peer& peer, double newton) {
    double most = 0.0;
    for (int i = 0; i < 60; ++i) {
        device.commit({{i < 20 ? 0.0 : newton, 0.0, 0.0}, {}});
        device.acquire(1e-3);
        most = std::max(most, glm::length(peer.given().force));
        sleep_until(steady_ns() + ms);
    }
    return most;
}

}  // namespace

TEST_CASE("a library or a function that is missing is named") {
    for (const std::string driver : {"force_dimension", "touch"}) {
        CAPTURE(driver);
        CHECK_THAT(open_error(driver, "/none/libx.so"), ContainsSubstring("p.toml:4:1: device 'hand'"));
        CHECK_THAT(open_error(driver, "/none/libx.so"), ContainsSubstring("/none/libx.so"));
        CHECK_THAT(open_error(driver, "/none/libx.so"), ContainsSubstring("(step 'load"));
    }
    CHECK_THAT(open_error("force_dimension", TACTUS_FAKE_EMPTY), ContainsSubstring("has no function dhdClose"));
    CHECK_THAT(open_error("touch", TACTUS_FAKE_EMPTY), ContainsSubstring("has no function hdDisableDevice"));
}

TEST_CASE("a device that is not there is one clear error") {
    const auto dhd = make_dhd_peer();
    dhd->unplug(true);
    CHECK_THAT(open_error("force_dimension", TACTUS_FAKE_DHD),
               ContainsSubstring("no Force Dimension device was found"));
    CHECK_THAT(open_error("force_dimension", TACTUS_FAKE_DHD), ContainsSubstring("'no device found'"));
    const auto hd = make_hd_peer();
    hd->unplug(true);
    CHECK_THAT(open_error("touch", TACTUS_FAKE_HD), ContainsSubstring("'Default PHANToM': Communication Error"));
    CHECK_THAT(open_error("haply", "x"), ContainsSubstring("library"));  // an option that it has not
}

TEST_CASE("what the library says of a device is known without opening it") {
    Options options = options_of({{"library", "/none/libx.so", {}}});
    const auto outline =
        haptic::describe_haptic_device("touch", {}, options, [](const std::string& name) { return name; });
    CHECK_THAT(outline.absence, ContainsSubstring("/none/libx.so"));
    CHECK(haptic::is_real_driver("touch"));
}

TEST_CASE("Force Dimension: enabled before any force, the device's watchdog set, closed in the end", "[virtual]") {
    const VirtualClock clock;
    const auto peer = make_dhd_peer();
    {
        const auto device = open_peer(*peer);
        CHECK(device->info().max_force == 12.0);
        CHECK(device->info().max_torque == 0.2);
        CHECK(device->opened().serial == "4711");
        CHECK(max_given(*device, *peer, 2.0) == 2.0);
        CHECK(tell<int>(*peer, "fake_watchdog") == 160);
        CHECK(tell<int>(*peer, "fake_forces_before_enable") == 0);
        CHECK(tell<int>(*peer, "fake_force_on") == 1);
    }
    CHECK(tell<int>(*peer, "fake_force_on") == 0);
    CHECK(tell<int>(*peer, "fake_is_open") == 0);
    tell<void, int>(*peer, "fake_type", 60);
    const auto falcon = open_peer(*peer);
    CHECK(falcon->info().max_force == 8.0);
    CHECK_FALSE(falcon->info().actuates_torque);
    tell<void, int>(*peer, "fake_type", 999);
    const auto unknown = open_peer(*peer);
    CHECK(unknown->info().max_force == 4.0);
    CHECK_THAT(unknown->info().name, ContainsSubstring("unknown type 999"));
}

TEST_CASE("a device that is not calibrated has no pose and no force until it is", "[virtual]") {
    const VirtualClock clock;
    for (const PeerKind& kind : {PeerKind{"force_dimension", make_dhd_peer}, {"touch", make_hd_peer}}) {
        CAPTURE(kind.driver);
        const auto peer = kind.make();
        tell<void, int>(*peer, "fake_calibrate", 0);
        const auto device = open_peer(*peer);
        CHECK(max_given(*device, *peer, 1.0) == 0.0);
        CHECK_FALSE(device->acquire(1e-3).valid);
        if (kind.driver == "force_dimension") CHECK(tell<int>(*peer, "fake_force_on") == 0);
        tell<void, int>(*peer, "fake_calibrate", 1);
        // As an engine: no force on a hand that nobody sees. Otherwise the last one, of 1 N, may be young enough to be held back.
        CHECK(wait_until([&] {
            device->commit({});
            return device->acquire(1e-3).valid;
        }));
        CHECK(max_given(*device, *peer, 1.0) == 1.0);
        CHECK(tell<int>(*peer, "fake_forces_before_enable") == 0);
    }
}

TEST_CASE("OpenHaptics: units of limits, calibration by the library, errors that do not pile up", "[virtual]") {
    const VirtualClock clock;
    const auto peer = make_hd_peer();
    tell(*peer, "fake_needs_update");
    {
        const auto device = open_peer(*peer);
        CHECK(device->info().max_force == 3.3);
        CHECK(device->info().max_stiffness == 500.0);  // the library says 0.5 N/mm
        CHECK_FALSE(device->info().actuates_torque);
        CHECK(device->opened().serial == "20-1234");
        for (int i = 0; i < 20; ++i) tell(*peer, "fake_warm");
        CHECK(max_given(*device, *peer, 2.0) == 2.0);  // warm motors are no loss
        CHECK(wait_until([&] { return device->acquire(1e-3).valid; }, 200));
        CHECK(tell<int>(*peer, "fake_errors_left") == 0);
        CHECK(tell<int>(*peer, "fake_forces_before_enable") == 0);
        CHECK(device->returns() == 0);
    }
    CHECK(tell<int>(*peer, "fake_is_open") == 0);
    CHECK(tell<int>(*peer, "fake_force_on") == 0);
}

TEST_CASE("a device whose pushes nobody confirmed gives 0.5 N and no torque, one that was confirmed gives all",
          "[virtual]") {
    const VirtualClock clock;
    const OwnConfig config;
    const auto peer = make_dhd_peer();
    driver::Opened opened;
    {
        const auto device = open_peer(*peer, driver::OpenMode::run, true);
        CHECK(device->is_capped());
        CHECK(device->info().max_force == 0.5);
        CHECK_FALSE(device->info().actuates_torque);
        CHECK(max_given(*device, *peer, 5.0) == Approx(0.5));
        opened = device->opened();
    }
    driver::confirm("test", opened);
    driver::Opened other = opened;
    other.serial = "4712";
    CHECK(driver::is_confirmed("test", opened));
    CHECK_FALSE(driver::is_confirmed("test", other));
    CHECK_FALSE(driver::is_confirmed("other", opened));
    {
        const auto device = open_peer(*peer, driver::OpenMode::run, true);
        CHECK_FALSE(device->is_capped());
        CHECK(max_given(*device, *peer, 5.0) == Approx(5.0));
    }
    tell<void, int>(*peer, "fake_number", 4712);  // another one of the same kind
    CHECK(open_peer(*peer, driver::OpenMode::run, true)->is_capped());
    driver::forget("test", opened);
    CHECK_FALSE(driver::is_confirmed("test", opened));
    driver::confirm("test", opened);
    std::ofstream(config.folder / "tactus/devices.json") << "{ not a list";
    CHECK_FALSE(driver::is_confirmed("test", opened));
    CHECK_THAT(error_of([&] { driver::confirm("test", opened); }), ContainsSubstring("devices.json is damaged"));
}

TEST_CASE("a device that comes back as another one is not used", "[virtual]") {
    const VirtualClock clock;
    const auto peer = make_dhd_peer();
    const auto device = open_peer(*peer);
    REQUIRE(wait_until([&] { return device->acquire(1e-3).valid; }));
    peer->unplug(true);
    REQUIRE(wait_until([&] { return !device->acquire(1e-3).valid; }));
    tell<void, int>(*peer, "fake_number", 4712);
    peer->unplug(false);
    CHECK_FALSE(wait_until([&] { return device->acquire(1e-3).valid; }, 200));
    tell<void, int>(*peer, "fake_number", 4711);
    CHECK(wait_until([&] { return device->acquire(1e-3).valid; }));
}

TEST_CASE("a vendor's library reads its numbers with points, whatever language the user speaks", "[kernel]") {
    const OwnConfig config;
    std::filesystem::create_directories(config.folder / "locales");
    const std::string make =
        "localedef -i de_DE -f UTF-8 " + (config.folder / "locales/de_DE.UTF-8").string() + " >/dev/null 2>&1";
    if (std::system(make.c_str()) != 0) return skip("this machine cannot make a German locale");
    ::setenv("LOCPATH", (config.folder / "locales").c_str(), 1);
    ::setenv("LC_ALL", "de_DE.UTF-8", 1);
    ::setenv("TACTUS_DEVICE_HOST", (std::filesystem::path(command()).parent_path() / "tactus-device-host").c_str(), 1);
    {
        const auto device = hosted::open_placed({"touch", "device 'hand'", {{"library", TACTUS_FAKE_HD, {}}}, {}},
                                                [](const std::string& name) { return name; });
        device->prepare(1e-3);
        CHECK(wait_until([&] { return device->acquire(1e-3).valid; }, 2000));
        int valid = 0;
        for (int i = 0; i < 100; ++i) {
            device->commit({});
            valid += device->acquire(1e-3).valid;
            sleep_until(steady_ns() + ms);
        }
        CHECK(valid > 50);  // a late thread makes some of them invalid
    }
    for (const char* name : {"LOCPATH", "LC_ALL", "TACTUS_DEVICE_HOST"}) ::unsetenv(name);
}

TEST_CASE("a device that does not open in time names its step", "[virtual]") {
    const VirtualClock clock;
    const auto peer = make_dhd_peer();
    peer->hang(true);
    const std::string said = error_of([&] {
        driver::DeviceOptions how{.driver = "test"};
        how.open_timeout = std::chrono::milliseconds(100);
        driver::ThreadedDevice device(peer->backend(), how);
    });
    CHECK(said == "the driver did not answer within 0.1 s (step 'open the device')");
    peer->hang(false);
    sleep_until(steady_ns() + 50 * ms);
}
