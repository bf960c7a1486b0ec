// SPDX-License-Identifier: Apache-2.0
#include "dsp/coupling/held_contact.hpp"
#include "graph/node.hpp"
#include "nodes/contact/contact_params.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tactus::nodes {

struct VoxmapContact {
    static constexpr auto about =
        "Contact of one body of a scene, as points, with the distance fields of all others, at one pose: forces in "
        "proportion to depth. Stands open; couplings bring their own.";

    In<Pose> pose{"of the body", "m"};
    In<tactus::Scene> scene{"everything that can be touched"};
    Out<Wrench> wrench{"on the body, about its origin", "N, N m"};
    Out<double> stiffness{"of all touching points together, along the stiffest of the three axes", "N/m"};
    Out<double> penetration{"of the deepest point", "m"};
    Out<bool> in_contact{"some point has a force"};
    Param held{"0", "-1", "7", "place of the body in the scene"};
    Flag both_ways{false, "the others' points are tried against this body's field too"};
    Param point_stiffness{internal, "10 N/mm", "0 N/mm", "1e6 N/mm", "of the contact, for each point of the surface"};
    Param area_stiffness{internal, "0 N/m^3", "0 N/m^3", "1e15 N/m^3",
                         "of the contact, for each area of the surface; if not 0 it holds instead"};
    Param blend{"0.03 mm", "0 mm", "10 mm", "half the width within which the contact sets in"};
    Param saturation{"0 mm", "0 mm", "1 m", "depth at which the force of a point levels off; 0: never"};
    Choice interpolation{{"trilinear", "quadratic"}, "of the distance; quadratic suits stiff contact"};
    Choice direction{{"field_gradient", "shell_normal"}, "of the forces; shell_normal is that of the thesis"};
    Param points{structural, "1000000", "1000", "20000000", "of all surfaces together; memory is taken for so many"};
    Param budget{"1e9", "64", "1e9", "most points that one evaluation looks at"};

    void prepare(const Setup&) { contact_.emplace(static_cast<std::size_t>(points)); }

    void process(const Tick&) noexcept {
        contact_->set(scene, static_cast<int>(held), {},
                      contact_law(point_stiffness, area_stiffness, blend, saturation, interpolation, direction),
                      both_ways, static_cast<std::size_t>(budget));
        const ContactSum now = is_valid(pose.get()) ? (*contact_)(pose, ContactParts::all) : ContactSum{};
        wrench = now.wrench();
        stiffness = std::max({now.stiffness[0], now.stiffness[7], now.stiffness[14]});
        penetration = now.penetration;
        in_contact = now.in_contact > 0;
        deepest_ = std::max(deepest_, now.penetration);
    }

    void report(Report& report) const { report.set("contact", "penetration_max_mm", deepest_ * 1e3); }

private:
    std::optional<HeldContact> contact_;
    double deepest_ = 0.0;
};

TACTUS_NODE(VoxmapContact, pose, scene, wrench, stiffness, penetration, in_contact, held, both_ways, point_stiffness,
            area_stiffness, blend, saturation, interpolation, direction, points, budget)

}  // namespace tactus::nodes
