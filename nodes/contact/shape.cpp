// SPDX-License-Identifier: Apache-2.0
#include "dsp/contact/shape.hpp"

#include "dsp/coupling/scene.hpp"
#include "dsp/geometry/triangle_tree.hpp"
#include "graph/node/node.hpp"
#include "nodes/contact/made_bodies.hpp"

#include <algorithm>
#include <memory>

namespace tactus::nodes {

struct Shape {
    static constexpr auto about = "An analytic body: ball, box, upright cylinder, or round block with a hole.";

    Out<coupling::Body> body{"for a scene"};
    Choice kind{
        {"ball", "box", "cylinder", "hole"},
        "ball and box are centred; a cylinder extends up from z = 0; a hole extends down from z = 0 in a round block"};
    Vector size{"20 mm, 20 mm, 20 mm", "of a box"};
    Param diameter{structural, "20 mm", "0.1 mm", "1 m", "of a ball or cylinder, or of the peg that fits the hole"};
    Param height{structural, "20 mm", "0.1 mm", "1 m", "of a cylinder, or of the block with the hole"};
    Param clearance{structural, "0.3 mm", "-5 mm", "50 mm", "diameter of the hole minus 'diameter'"};
    Param wall{structural, "10 mm", "0.1 mm", "1 m", "thickness of the block around the hole"};
    Param bevel{structural, "0 mm", "0 mm", "50 mm", "of a cylinder's lower rim and a hole's mouth, at 45 deg"};
    Param spacing{structural, "0.42 mm", "0.01 mm", "20 mm", "of the surface points"};
    Param voxel{structural, "0.25 mm", "0.01 mm", "20 mm", "of the distance field"};
    Param margin{structural, "3 mm", "1 mm", "100 mm", "of the distance field beyond the body"};
    Flag triangles{false, "also make the surface triangles, for point_proxy and sphere_proxy"};

    void prepare(const Setup& setup) {
        try {
            if (kind.is("ball")) make(contact::Ball{0.5 * diameter});
            else if (kind.is("box")) make(contact::Box{size});
            else if (kind.is("cylinder")) make(contact::make_cylinder(diameter, height, bevel));
            else make(contact::make_bushing(bore(setup), bore(setup) + 2.0 * wall, height, bevel));
        } catch (const Error& error) {
            setup.fail(error.message());
        }
        body = parts_->body();
    }
    void process(const Tick&) noexcept { body = parts_->body(); }

private:
    double bore(const Setup& setup) const {
        if (!(diameter + clearance > 0.0))
            setup.fail("the hole's diameter, 'diameter' plus 'clearance', must be positive");
        return diameter + clearance;
    }

    template <class S>
    void make(const S& shape) {
        const Vec3 low = shape.low() - Vec3(margin), extent = shape.high() + Vec3(margin) - low;
        if (!(extent.x * extent.y * extent.z / (voxel * voxel * voxel) < 2e8))
            throw Error("the distance field would have over 200 million samples; raise 'voxel'");
        if (!(extent.x * extent.y + extent.y * extent.z + extent.z * extent.x < 1e7 * spacing * spacing))
            throw Error("the surface would have over 10 million points; raise 'spacing'");
        const BodyKey key{static_cast<double>(kind.index),
                          size.value.x,
                          size.value.y,
                          size.value.z,
                          diameter,
                          height,
                          clearance,
                          wall,
                          bevel,
                          spacing,
                          voxel,
                          margin,
                          triangles ? 1.0 : 0.0};
        parts_ = MadeBodies::of_process().get(key, [&] {
            return std::make_shared<const BodyParts>(contact::make_pointshell(shape.points(spacing)),
                                                     contact::voxmap_of(shape, voxel, margin), Pose{}, triangles);
        });
    }

    std::shared_ptr<const BodyParts> parts_;
};

TACTUS_NODE(Shape, body, kind, size, diameter, height, clearance, wall, bevel, spacing, voxel, margin, triangles)

}  // namespace tactus::nodes
