// SPDX-License-Identifier: Apache-2.0
// The functions of OpenHaptics' device layer (HD, 3.x) that the driver uses, from the vendor's reference, appendix A.
#pragma once

#include "devices/driver/shared_library.hpp"

#include <string>

namespace tactus::openhaptics {

inline constexpr unsigned invalid_device = 0xFFFFFFFFu;

/// Returned by the vendor's library by value.
struct HdError {
    unsigned code;
    int internal;
    unsigned device;
};

// Parameters, capabilities, results.
inline constexpr unsigned current_buttons = 0x2000, current_transform = 0x2052, current_force = 0x2700,
                          current_torque = 0x2701;
inline constexpr unsigned model_type = 0x2501, driver_version = 0x2502, serial_number = 0x2504,
                          firmware_version = 0x2505, output_freedom = 0x2554, calibration_style = 0x2555,
                          max_stiffness = 0x2602, max_force = 0x2603, max_torque = 0x2622;
inline constexpr unsigned force_output = 0x4000, max_force_clamping = 0x4001;
inline constexpr unsigned calibration_ok = 0x5000, calibration_needs_update = 0x5001;
/// Codes from first_force_error up to first_device_error: warm motors, clipped forces, the device's own protection.
/// From there to last_device_error: the device itself is lost.
inline constexpr unsigned first_force_error = 0x0200, first_device_error = 0x0300, last_device_error = 0x03FF;

using HdCallback = unsigned (*)(void*);
inline constexpr unsigned callback_continue = 1;

class HdApi {
public:
    /// Throws Error that names the missing file or function. `library`: a file, or "" for the usual locations.
    explicit HdApi(const std::string& library);

    const std::string& path() const { return library_.path(); }
    /// Empties the error stack. Returns the text of the oldest error that is not about force, or "".
    std::string pop_errors() const;

private:
    driver::SharedLibrary library_;

public:
    unsigned (*init_device)(const char*) = nullptr;
    void (*disable_device)(unsigned) = nullptr;
    void (*make_current)(unsigned) = nullptr;
    void (*begin_frame)(unsigned) = nullptr;
    void (*end_frame)(unsigned) = nullptr;
    HdError (*get_error)() = nullptr;
    const char* (*error_string)(unsigned) = nullptr;
    void (*enable)(unsigned) = nullptr;
    void (*disable)(unsigned) = nullptr;
    void (*get_double)(unsigned, double*) = nullptr;
    void (*set_double)(unsigned, const double*) = nullptr;
    void (*get_integer)(unsigned, int*) = nullptr;
    const char* (*get_string)(unsigned) = nullptr;
    unsigned (*check_calibration)() = nullptr;
    void (*update_calibration)(unsigned) = nullptr;
    unsigned long (*schedule)(HdCallback, void*, unsigned short) = nullptr;
    void (*unschedule)(unsigned long) = nullptr;
    void (*start_scheduler)() = nullptr;
    void (*stop_scheduler)() = nullptr;
    void (*set_rate)(unsigned long) = nullptr;  ///< null in old versions, which run at 1 kHz
};

}  // namespace tactus::openhaptics
