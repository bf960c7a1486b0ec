// SPDX-License-Identifier: Apache-2.0
#include "devices/forcedimension/dhd_api.hpp"

#include <fmt/format.h>

namespace tactus::forcedimension {

namespace {

/// libdrd holds libdhd.
driver::LibraryPlaces places() {
    return {"FDSDK",
            {"lib/release/lin-*-gcc", "lib"},
            {"libdrd.so", "libdhd.so"},
            {"libdrd.so.3", "libdhd.so.3", "libdrd.so", "libdhd.so"}};
}

// The lower figure of the maker's sheet and of CHAI3D's table (src/devices/CDeltaDevices.cpp) where they differ.
constexpr Model models[] = {
    {63, "delta.3", 20.0, 0.0, 5000.0, 20e-6, false},  {64, "delta.6", 20.0, 0.2, 5000.0, 20e-6, true},
    {31, "delta.3", 20.0, 0.0, 5000.0, 20e-6, false},  {61, "delta.6", 20.0, 0.2, 5000.0, 20e-6, true},
    {32, "omega.3", 12.0, 0.0, 5000.0, 10e-6, false},  {33, "omega.3", 12.0, 0.0, 5000.0, 10e-6, false},
    {34, "omega.6", 12.0, 0.0, 5000.0, 10e-6, true},   {36, "omega.6", 12.0, 0.0, 5000.0, 10e-6, true},
    {35, "omega.7", 12.0, 0.0, 5000.0, 10e-6, true},   {37, "omega.7", 12.0, 0.0, 5000.0, 10e-6, true},
    {206, "sigma.3", 12.0, 0.0, 4000.0, 10e-6, false}, {104, "sigma.7", 12.0, 0.2, 4000.0, 10e-6, true},
    {105, "sigma.7", 12.0, 0.2, 4000.0, 10e-6, true},  {106, "sigma.6+", 12.0, 0.2, 4000.0, 10e-6, true},
    {107, "sigma.6+", 12.0, 0.2, 4000.0, 10e-6, true}, {203, "lambda.3", 12.0, 0.0, 4000.0, 20e-6, false},
    {108, "lambda.7", 12.0, 0.2, 4000.0, 20e-6, true}, {109, "lambda.7", 12.0, 0.2, 4000.0, 20e-6, true},
    {131, "lambda.6", 12.0, 0.2, 4000.0, 20e-6, true}, {132, "lambda.6", 12.0, 0.2, 4000.0, 20e-6, true},
    {60, "Falcon", 8.0, 0.0, 3000.0, 64e-6, false},
};

}  // namespace

DhdApi::DhdApi(const std::string& library)
    : library_("the Force Dimension SDK", driver::library_candidates(library, places())) {
    library_.require(open_id, "dhdOpenID");
    library_.require(close, "dhdClose");
    library_.require(stop, "dhdStop");
    library_.require(count, "dhdGetDeviceCount");
    library_.require(system_type, "dhdGetSystemType");
    library_.require(enable_force, "dhdEnableForce");
    library_.require(status, "dhdGetStatus");
    library_.require(frame, "dhdGetPositionAndOrientationFrame");
    library_.require(set_force, "dhdSetForce");
    library_.look_for(open_serial, "dhdOpenSerial");
    library_.look_for(serial, "dhdGetSerialNumber");
    library_.look_for(system_name, "dhdGetSystemName");
    library_.look_for(sdk_version, "dhdGetSDKVersion");
    library_.look_for(last_error, "dhdErrorGetLastStr");
    library_.look_for(button_mask, "dhdGetButtonMask");
    library_.look_for(button, "dhdGetButton");
    library_.look_for(set_all, "dhdSetForceAndTorqueAndGripperForce");
    library_.look_for(set_max_force, "dhdSetMaxForce");
    library_.look_for(set_gravity, "dhdSetGravityCompensation");
    library_.look_for(has_active_wrist, "dhdHasActiveWrist");
    library_.look_for(expert_on, "dhdEnableExpertMode");
    library_.look_for(expert_off, "dhdDisableExpertMode");
    library_.look_for(set_watchdog, "dhdSetWatchdog");
}

std::string DhdApi::error() const {
    const char* const said = last_error ? last_error() : nullptr;
    return said && *said ? fmt::format("the SDK reports '{}'", said) : "the SDK gives no reason";
}

const Model* find_model(int type) {
    for (const Model& model : models)
        if (model.type == type) return &model;
    return nullptr;
}

}  // namespace tactus::forcedimension
