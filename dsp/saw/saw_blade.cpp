// SPDX-License-Identifier: Apache-2.0
#include "dsp/saw/saw_blade.hpp"

#include "dsp/saw/lag_norm.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::saw {

SawBlade::SawBlade(const SawShape& shape, double stiffness)
    : teeth_(shape, stiffness), faces_(shape, stiffness), squares_(BladeFaces::count) {
    // Largest curvature of ½‖u‖₈²: as in contact::blade_contact, whose 44 teeth have 4 and 88 points of faces 22.
    const double teeth = static_cast<double>(teeth_.teeth().size());
    tooth_spring_ = stiffness / (4.0 * std::sqrt(std::sqrt(teeth / 44.0)));
    face_spring_ = stiffness / 22.0;
}

SawContact SawBlade::step(const volume::BoneSnapshot& bone, const Pose& pose, const Drive& drive,
                          const CuttingLaw& law) noexcept {
    SawContact contact;
    if (!is_valid(pose) || glm::length(pose.position) > 1e3 || !(drive.dt > 0.0)) {
        teeth_.forget();
        faces_.forget();
        return contact;
    }
    teeth_.follow(bone, pose, drive);
    contact.feed = teeth_.cut(law, drive, tooth_spring_) / drive.dt;
    teeth_.settle();
    faces_.follow(bone, pose, drive.running, drive.dt);
    const Mat3 axes(pose.rotate({1, 0, 0}), pose.rotate({0, 1, 0}), pose.rotate({0, 0, 1}));
    push_teeth(axes, pose.position, law, drive.running, contact);
    push_faces(axes, pose.position, contact);
    contact.side = std::abs(glm::dot(contact.wrench.force, axes[2]));
    return contact;
}

void SawBlade::push_teeth(const Mat3& axes, const Vec3& about, const CuttingLaw& law, bool running,
                          SawContact& into) noexcept {
    const double norm = teeth_.squared_norm();
    if (!(norm > 0.0)) return;
    const double bearing = teeth_.bearing();
    for (const Tooth& tooth : teeth_.teeth()) {
        const double square = tooth.square();
        if (!(square > 0.0)) continue;
        const double k = spring8(tooth_spring_, square, norm);
        const Vec3 push(tooth.lag.x * k, tooth.lag.y * k, tooth.lag.z * (k * tooth.bending));
        const Vec3 force = axes * -push;
        into.wrench.force += force;
        into.wrench.torque += glm::cross(tooth.at - about, force);
        into.lag = std::max(into.lag, std::sqrt(square));
        const double thrust = std::max(push.y, 0.0);
        into.thrust += thrust;
        ++into.count;
        if (!(tooth.density[1] > 0.0) || !(thrust > 0.0)) continue;
        into.teeth += bearing;
        const double share = tooth.density[1] / law.reference_density;
        if (running) into.along += law.along(thrust / (bearing * share)) * bearing * share;
    }
}

void SawBlade::push_faces(const Mat3& axes, const Vec3& about, SawContact& into) noexcept {
    const auto points = faces_.points();
    bool any = false;
    for (std::size_t n = 0; n < points.size(); ++n) {
        squares_[n] = points[n].seated ? faces_.square(points[n]) : 0.0;
        any |= squares_[n] > 0.0;
    }
    if (!any) return;
    const double norm = squared_norm8(squares_);
    for (std::size_t n = 0; n < points.size(); ++n) {
        if (!(squares_[n] > 0.0)) continue;
        const FacePoint& p = points[n];
        const double k = spring8(face_spring_, squares_[n], norm);
        const Vec3 lag = faces_.lag(p);
        const Vec3 force = axes * -Vec3(lag.x * k, lag.y * k, lag.z * (k * p.bending));
        into.wrench.force += force;
        into.wrench.torque += glm::cross(p.at - about, force);
        into.lag = std::max(into.lag, std::sqrt(squares_[n]));
        ++into.count;
    }
}

}  // namespace tactus::saw
