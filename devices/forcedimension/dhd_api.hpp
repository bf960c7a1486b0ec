// SPDX-License-Identifier: Apache-2.0
// The functions of Force Dimension's SDK (DHD, 3.x) that the driver uses, from the vendor's documentation of the C
// interface.
#pragma once

#include "devices/driver/shared_library.hpp"

#include <array>
#include <string>

namespace tactus::forcedimension {

/// Buffer size for dhdGetStatus, which does not check it: version 3.17 writes 17 entries, a later SDK perhaps more.
inline constexpr int max_status = 128;
/// Indices in the result of dhdGetStatus.
enum StatusPlace { status_reset = 3, status_force = 5 };

class DhdApi {
public:
    /// Throws Error that names the missing file or function. `library`: a file, or "" for the usual locations.
    explicit DhdApi(const std::string& library);

    const std::string& path() const { return library_.path(); }
    /// "error (text of the SDK)".
    std::string error() const;

private:
    driver::SharedLibrary library_;

public:
    // Required functions.
    int (*open_id)(char) = nullptr;
    int (*close)(char) = nullptr;
    int (*stop)(char) = nullptr;
    int (*count)() = nullptr;
    int (*system_type)(char) = nullptr;
    int (*enable_force)(unsigned char, char) = nullptr;
    int (*status)(int*, char) = nullptr;
    int (*frame)(double*, double*, double*, double (*)[3], char) = nullptr;
    int (*set_force)(double, double, double, char) = nullptr;
    // Functions that older versions may lack.
    int (*open_serial)(int) = nullptr;
    int (*serial)(unsigned short*, char) = nullptr;
    const char* (*system_name)(char) = nullptr;
    void (*sdk_version)(int*, int*, int*, int*) = nullptr;
    const char* (*last_error)() = nullptr;
    unsigned (*button_mask)(char) = nullptr;
    int (*button)(int, char) = nullptr;
    int (*set_all)(double, double, double, double, double, double, double, char) = nullptr;
    int (*set_max_force)(double, char) = nullptr;
    int (*set_gravity)(int, char) = nullptr;
    bool (*has_active_wrist)(char) = nullptr;
    int (*expert_on)() = nullptr;
    int (*expert_off)() = nullptr;
    int (*set_watchdog)(unsigned char, char) = nullptr;
};

/// Limits and resolution of a type of device.
struct Model {
    int type;
    const char* name;
    double force;       ///< N
    double torque;      ///< N·m; 0: no motors at the wrist
    double stiffness;   ///< N/m
    double resolution;  ///< m
    bool turns;         ///< senses rotation
};

/// Returns null for a type that is not in the table.
const Model* find_model(int type);
/// Conservative limits for a device of unknown type.
inline constexpr Model unknown_model{0, "unknown Force Dimension device", 4.0, 0.0, 1000.0, 0.1e-3, true};

}  // namespace tactus::forcedimension
