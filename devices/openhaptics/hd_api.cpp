// SPDX-License-Identifier: Apache-2.0
#include "devices/openhaptics/hd_api.hpp"

#include <fmt/format.h>

namespace tactus::openhaptics {

namespace {

driver::LibraryPlaces places() {
    return {"OH_SDK_BASE", {"lib", "usr/lib"}, {"libHD.so"}, {"libHD.so.3.4", "libHD.so.3", "libHD.so"}};
}

}  // namespace

HdApi::HdApi(const std::string& library) : library_("OpenHaptics", driver::library_candidates(library, places())) {
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
