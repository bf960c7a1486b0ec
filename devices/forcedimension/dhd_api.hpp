// SPDX-License-Identifier: Apache-2.0
// The functions of Force Dimension's SDK (DHD, 3.x) that are used, by the vendor's documentation of the C interface.
#pragma once

#include "devices/driver/shared_library.hpp"

#include <array>
#include <string>

namespace tactus::forcedimension {

/// dhdGetStatus is not told how much room there is: 17 places in 3.17, perhaps more in a later SDK.
inline constexpr int most_status = 128;
/// Places in what dhdGetStatus fills.
enum StatusPlace { status_reset = 3, status_force = 5 };

class DhdApi {
public:
    /// Throws Error that names a file or function that is missing. `library`: a file, or "" for the usual places.
    explicit DhdApi(const std::string& library);

    const std::string& path() const { return library_.path(); }
    /// "error (text of the SDK)".
    std::string error() const;

private:
    driver::SharedLibrary library_;

public:
    // Needed.
    int (*open_id)(char) = nullptr;
    int (*close)(char) = nullptr;
    int (*stop)(char) = nullptr;
    int (*count)() = nullptr;
    int (*system_type)(char) = nullptr;
    int (*enable_force)(unsigned char, char) = nullptr;
    int (*status)(int*, char) = nullptr;
    int (*frame)(double*, double*, double*, double (*)[3], char) = nullptr;
    int (*set_force)(double, double, double, char) = nullptr;
    // Older versions have not all of these.
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

/// What a type of device may be given, and what it resolves.
struct Model {
    int type;
    const char* name;
    double force;       ///< N
    double torque;      ///< N·m; 0: no motors at the wrist
    double stiffness;   ///< N/m
    double resolution;  ///< m
    bool turns;         ///< senses rotation
};

/// Null for a type that the table does not have.
const Model* find_model(int type);
/// What a device of an unknown type may be given.
inline constexpr Model unknown_model{0, "unknown Force Dimension device", 4.0, 0.0, 1000.0, 0.1e-3, true};

}  // namespace tactus::forcedimension
