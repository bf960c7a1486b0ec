// SPDX-License-Identifier: Apache-2.0
// Interface of obstacles for a rope.
#pragma once

#include "dsp/core/types.hpp"

#include <glm/geometric.hpp>

namespace tactus::rope {

class Obstacle {
public:
    virtual ~Obstacle() = default;
    /// Returns the signed distance to the surface, m, negative inside; `normal` becomes its gradient, of unit length.
    /// Called in real-time ticks.
    virtual double distance(const Vec3& place, Vec3& normal) const noexcept = 0;
    /// Returns a clearance, m: how far a point may move from `place`, where the distance is `now`, without coming
    /// closer than `near`. For an exact distance this is the difference; other fields must return their own bound. 0 or
    /// less: none.
    virtual double free_way(const Vec3& /*place*/, double now, double near) const noexcept { return now - near; }
};

class Ball final : public Obstacle {
public:
    Ball(const Vec3& centre, double radius) : centre_(centre), radius_(radius) {}
    double distance(const Vec3& place, Vec3& normal) const noexcept override {
        const Vec3 out = place - centre_;
        const double length = glm::length(out);
        normal = length > 1e-12 ? out / length : Vec3(1.0, 0.0, 0.0);
        return length - radius_;
    }

private:
    Vec3 centre_;
    double radius_;
};

/// An infinite cylinder.
class Cylinder final : public Obstacle {
public:
    /// `axis` has unit length.
    Cylinder(const Vec3& point, const Vec3& axis, double radius) : point_(point), axis_(axis), radius_(radius) {}
    double distance(const Vec3& place, Vec3& normal) const noexcept override {
        Vec3 out = place - point_;
        out -= glm::dot(out, axis_) * axis_;
        const double length = glm::length(out);
        normal = length > 1e-12 ? out / length : Vec3(0.0);
        return length - radius_;
    }

private:
    Vec3 point_, axis_;
    double radius_;
};

}  // namespace tactus::rope
