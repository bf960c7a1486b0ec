// SPDX-License-Identifier: Apache-2.0
#include "dsp/simulate/device_model.hpp"

#include "dsp/core/rotation.hpp"

#include <glm/common.hpp>

#include <numbers>

namespace tactus::simulate {
namespace {

// "stated": on the maker's data sheet. "assumed": no data sheet has it; typical of the class.
constexpr DeviceModel models[] = {
    {.name = "touch",
     .about = "3D Systems Touch (formerly SensAble PHANTOM Omni)",
     .mass = 0.045,               // stated: apparent mass at the tip 45 g
     .inertia = 2e-5,             // assumed: stylus of 20 g and 15 cm
     .viscous = 0.1,              // assumed: Coulomb friction dominates (Diolaiti et al. 2006)
     .friction = 0.26,            // stated: backdrive friction < 0.26 N
     .angular_viscous = 1e-4,     // assumed
     .angular_friction = 1e-3,    // assumed
     .resolution = 55e-6,         // stated: 450 dpi, 0.055 mm
     .angular_resolution = 1e-3,  // assumed: potentiometers at 12 bit over a turn, rounded down
     .force_step = 1.6e-3,        // assumed: 12 bit over ± 3.3 N
     .max_force = 3.3,            // stated
     .delay = 1e-3,               // assumed: one tick of the 1 kHz servo loop
     .max_stiffness = 1020.0},    // stated: 1.26, 2.31 and 1.02 N/mm along x, y and z
    {.name = "omega",
     .about = "Force Dimension omega.6 class, force only",
     .mass = 0.2,                 // assumed
     .inertia = 5e-5,             // assumed
     .viscous = 0.5,              // assumed
     .friction = 0.2,             // assumed
     .angular_viscous = 1e-4,     // assumed
     .angular_friction = 1e-3,    // assumed
     .resolution = 10e-6,         // stated: better than 0.01 mm
     .angular_resolution = 1.6e-3,// stated: 0.09 degrees
     .force_step = 6e-3,          // assumed: 12 bit over ± 12 N
     .max_force = 12.0,           // stated
     .delay = 0.5e-3,             // assumed: two frames at the stated rate of 4 kHz
     .max_stiffness = 14500.0},   // stated: 14.5 N/mm in closed loop
    {.name = "falcon",
     .about = "Novint Falcon",
     .mass = 0.3,                 // assumed
     .inertia = 1e-4,             // assumed
     .viscous = 1.0,              // assumed
     .friction = 0.5,             // assumed
     .angular_viscous = 1e-4,     // assumed
     .angular_friction = 1e-3,    // assumed
     .resolution = 63.5e-6,       // stated: better than 400 dpi
     .angular_resolution = 0.0,   // the handle does not turn
     .force_step = 4.4e-3,        // assumed: 12 bit over ± 8.9 N
     .max_force = 8.9,            // stated: more than 2 lbf
     .delay = 1e-3,               // assumed: one transfer each way at the stated 1 kHz
     .max_stiffness = 3000.0},    // CHAI3D 3.3, CDeltaDevices: closed loop at 1 kHz
};

double nearest(double value, double step) noexcept { return step > 0.0 ? std::round(value / step) * step : value; }
Vec3 nearest(const Vec3& v, double step) noexcept {
    return {nearest(v.x, step), nearest(v.y, step), nearest(v.z, step)};
}

Vec3 driven(const Vec3& wanted, double most, double step) noexcept {
    const double length = glm::length(wanted);
    return nearest(length > most ? wanted * (most / length) : wanted, step);
}

}  // namespace

std::span<const DeviceModel> device_models() { return models; }

const DeviceModel* find_device_model(std::string_view name) {
    for (const DeviceModel& model : models)
        if (model.name == name) return &model;
    return nullptr;
}

ModelledDevice::ModelledDevice(const DeviceModel& model, HandDynamics hand) : model_(model) {
    hand.mass += model.mass;
    hand.inertia += model.inertia;
    hand.friction = model.friction;
    hand.drag = model.viscous;
    hand.angular_friction = model.angular_friction;
    hand.angular_drag = model.angular_viscous;
    hand_.dynamics = hand;
    place({});
}

void ModelledDevice::place(const Pose& start) noexcept {
    hand_.pose = start;
    hand_.twist = twist_ = {};
    commands_ = {};
    newest_ = 0;
    time_ = 0.0;
    speed_.prepare(model_.resolution);
    spin_.prepare(model_.angular_resolution);
    angle_ = Vec3(0.0);
    seen_ = start;
    sense(0.0);
}

void ModelledDevice::give(const Wrench& command) noexcept {
    newest_ = (newest_ + 1) % commands_.size();
    const Wrench known = is_finite(command) ? command : Wrench{};
    commands_[newest_] = {time_,
                          {driven(known.force, model_.max_force, model_.force_step),
                           driven(known.torque, model_.max_torque, model_.torque_step)}};
}

Wrench ModelledDevice::acting() const noexcept {
    for (std::size_t back = 0; back + 1 < commands_.size(); ++back) {
        const Command& one = commands_[(newest_ + commands_.size() - back) % commands_.size()];
        // The margin allows for the rounding of summed times.
        if (one.time + model_.delay <= time_ + 1e-9) return one.wrench;
    }
    return {};
}

void ModelledDevice::sense(double elapsed_s) noexcept {
    const Pose before = seen_;
    seen_.position = nearest(hand_.pose.position, model_.resolution);
    const Vec3 turned = rotation_between({1.0, 0.0, 0.0, 0.0}, hand_.pose.orientation);
    seen_.orientation = model_.angular_resolution > 0.0 ? rotation_by(nearest(turned, model_.angular_resolution))
                                                        : hand_.pose.orientation;
    angle_ += rotation_between(before.orientation, seen_.orientation);
    twist_ = {speed_(seen_.position, elapsed_s), spin_(angle_, elapsed_s)};
}

}  // namespace tactus::simulate
