// SPDX-License-Identifier: Apache-2.0
#include "devices/openhaptics/hd_api.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <vector>

namespace tactus::openhaptics {

namespace {

std::vector<std::string> places(const std::string& library) {
    if (!library.empty()) return {library};
    std::vector<std::string> all;
    const auto add = [&](const std::string& folder) {
        for (const std::string& file : driver::libraries_in(folder, "libHD.so")) all.push_back(file);
    };
    if (const char* sdk = std::getenv("OH_SDK_BASE")) {
        add(std::string(sdk) + "/lib");
        add(std::string(sdk) + "/usr/lib");
    }
    add("/usr/local/lib");
    if (const char* home = std::getenv("HOME")) add(std::string(home) + "/.local/lib");
    for (const char* name : {"libHD.so.3.4", "libHD.so.3", "libHD.so"}) all.emplace_back(name);
    return all;
}

}  // namespace

HdApi::HdApi(const std::string& library) : library_("OpenHaptics", places(library)) {
    library_.require(init_device, "hdInitDevice");
    library_.require(disable_device, "hdDisableDevice");
    library_.require(make_current, "hdMakeCurrentDevice");
    library_.require(begin_frame, "hdBeginFrame");
    library_.require(end_frame, "hdEndFrame");
    library_.require(get_error, "hdGetError");
    library_.require(error_string, "hdGetErrorString");
    library_.require(enable, "hdEnable");
    library_.require(disable, "hdDisable");
    library_.require(get_double, "hdGetDoublev");
    library_.require(set_double, "hdSetDoublev");
    library_.require(get_integer, "hdGetIntegerv");
    library_.require(get_string, "hdGetString");
    library_.require(check_calibration, "hdCheckCalibration");
    library_.require(update_calibration, "hdUpdateCalibration");
    library_.require(schedule, "hdScheduleAsynchronous");
    library_.require(unschedule, "hdUnschedule");
    library_.require(start_scheduler, "hdStartScheduler");
    library_.require(stop_scheduler, "hdStopScheduler");
    library_.look_for(set_rate, "hdSetSchedulerRate");
}

std::string HdApi::pop_errors() const {
    std::string oldest;
    // Newest first; the bound is for a library that never runs dry.
    for (int i = 0; i < 64; ++i) {
        const HdError error = get_error();
        if (error.code == 0) break;
        if (error.code >= first_force_error && error.code < first_device_error) continue;
        const char* const said = error_string(error.code);
        oldest = fmt::format("{} (0x{:04x}, internal {})", said ? said : "unknown error", error.code, error.internal);
    }
    return oldest;
}

}  // namespace tactus::openhaptics
