// SPDX-License-Identifier: Apache-2.0
#include "dsp/saw/saw_blade.hpp"

#include "dsp/saw/lag_norm.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::saw {

SawBlade::SawBlade(const SawShape& shape, double stiffness)
    : shape_(shape),
      teeth_(shape, stiffness),
      body_(blade_body(shape, stiffness), stiffness, shape.kerf),
      front_(blade_front(shape, stiffness), stiffness, 0.0, false),
      take_over_(stiffness, 0.5 * shape.length + shape.height) {
    // Largest curvature of ½‖u‖₈²: as in contact::blade_contact, whose 44 teeth have 4.
    tooth_spring_ = stiffness / (4.0 * std::sqrt(std::sqrt(static_cast<double>(teeth_.teeth().size()) / 44.0)));
}

SawContact SawBlade::step(const volume::BoneSnapshot& bone, const Pose& pose, const Drive& drive, const CuttingLaw& law,
                          const PlacedSolid* guide) noexcept {
    SawContact contact;
    const Pose in_guide = guide ? guide->back * pose : pose;
    if (!is_valid(pose) || glm::length(pose.position) > 1e3 || !(drive.dt > 0.0)) {
        teeth_.forget();
        hold_.drop();
        take_over_.drop();
        stuck_ = false;
        return contact;
    }
    const bool jumped =
        hold_.state() != HoldState::waiting && is_jump(last_, pose, 0.5 * shape_.length + shape_.height, drive.dt);
    if (jumped) {
        teeth_.carry(pose);
        body_.carry(pose);
        if (guide) front_.carry(in_guide);
    }
    const bool was_waiting = hold_.state() == HoldState::waiting;
    hold_.tick(drive.dt, drive.release || jumped, stuck_, [&] {
        return teeth_.is_free(bone, pose) && body_.is_free({bone, guide}, pose) &&
               (!guide || front_.is_free(*guide->solid, in_guide));
    });
    last_ = pose;
    contact.state = hold_.state();
    if (hold_.state() == HoldState::engaged) {
        if (was_waiting) {
            teeth_.seat(pose);
            body_.seat(pose);
            front_.seat(in_guide);
        }
        teeth_.follow(bone, pose, drive);
        contact.feed = teeth_.cut(law, drive, tooth_spring_) / drive.dt;
        teeth_.settle();
        body_.follow({bone, guide}, pose, drive.running);
        if (guide) front_.follow(*guide->solid, in_guide, drive.running);
    } else if (!was_waiting) {
        teeth_.release(pose, hold_.kept());
        body_.release(pose, hold_.kept());
        if (guide) front_.release(in_guide, hold_.kept());
    } else {
        stuck_ = false;
        take_over_.drop();
        return contact;
    }
    const Mat3 axes(pose.rotate({1, 0, 0}), pose.rotate({0, 1, 0}), pose.rotate({0, 0, 1}));
    double energy = push_teeth(axes, pose.position, law, drive.running, contact);
    const auto add = [&](const ToolBody::Sum& body) {
        contact.wrench = contact.wrench + body.wrench;
        contact.magnitudes += body.magnitudes;
        contact.lag = std::max(contact.lag, body.lag);
        contact.count += body.count;
        energy += body.energy;
    };
    add(body_.push(pose.position));
    if (guide) {
        ToolBody::Sum front = front_.push(in_guide.position);
        front.wrench = {guide->pose.rotate(front.wrench.force), guide->pose.rotate(front.wrench.torque)};
        add(front);
    }
    contact.side = std::abs(glm::dot(contact.wrench.force, axes[2]));
    stuck_ = contact.lag >= max_lag || glm::dot(contact.wrench.force, axes[1]) > 0.0 ||
             (contact.count > 0 && drive.rendered < 1.0);
    contact.wrench = take_over_.follow(contact.wrench, energy, pose, drive.dt);
    return contact;
}

/// Returns the energy of their springs, J.
double SawBlade::push_teeth(const Mat3& axes, const Vec3& about, const CuttingLaw& law, bool running,
                            SawContact& into) noexcept {
    const double norm = teeth_.squared_norm();
    if (!(norm > 0.0)) return 0.0;
    const double bearing = teeth_.bearing();
    for (const Tooth& tooth : teeth_.teeth()) {
        const double square = tooth.square();
        if (!(square > 0.0)) continue;
        const double k = spring8(tooth_spring_, square, norm) * saturation_share(tooth.raw_square());
        const Vec3 push(tooth.lag.x * k, tooth.lag.y * k, tooth.lag.z * (k * tooth.bending));
        const Vec3 force = axes * -push;
        into.wrench.force += force;
        into.wrench.torque += glm::cross(tooth.at - about, force);
        into.magnitudes += glm::length(force);
        into.lag = std::max(into.lag, std::sqrt(tooth.raw_square()));
        const double thrust = std::max(push.y, 0.0);
        into.thrust += thrust;
        ++into.count;
        if (!(tooth.density[1] > 0.0) || !(thrust > 0.0)) continue;
        into.teeth += bearing;
        const double share = tooth.density[1] / law.reference_density;
        if (running) into.along += law.along(thrust / (bearing * share)) * bearing * share;
    }
    return 0.5 * tooth_spring_ * norm;
}

}  // namespace tactus::saw
