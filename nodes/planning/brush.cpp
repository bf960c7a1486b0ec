// SPDX-License-Identifier: Apache-2.0
#include "dsp/contact/sample_surface.hpp"
#include "graph/assets.hpp"
#include "graph/node.hpp"

#include <glm/geometric.hpp>

#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace tactus::nodes {

struct Brush {
    static constexpr auto about =
        "Paints the surface of a fragment with the device: what lies within the brush is fracture from then on, or "
        "none "
        "while erasing. The painted bone goes to the folder of the run.";

    In<Pose> tool{"its origin is the middle of the brush, in the scene", "m"};
    In<bool> paint{"what the brush meets is fracture"};
    In<bool> erase{optional, "what the brush meets is none; goes before painting"};
    In<Pose> body{optional, "the fragment's file frame in the scene; unconnected: as filed", "m"};
    Out<double> painted{"points that are fracture"};
    Out<double> area{"that they stand for", "m^2"};
    Out<double> distance{"from the middle of the brush to the nearest point", "m"};
    Asset<Bone> bone{"the fragment"};
    Param radius{"1.5 mm", "0.1 mm", "50 mm", "of the brush"};
    Flag start_clean{false, "take the file's paint off first"};

    void prepare(const Setup& setup) {
        name_ = setup.name;
        points_ = bone->points;
        if (points_.empty()) points_ = sample_surface(bone->distance, {});
        if (points_.empty()) setup.fail("bone '" + bone.name + "' has no surface");
        if (start_clean)
            for (SurfacePoint& p : points_) p.label = surface_label::none;
        count_ = 0;
        area_ = 0.0;
        for (const SurfacePoint& p : points_)
            if (p.label == surface_label::fracture) ++count_, area_ += p.area;
        tell(0.0);
    }

    void process(const Tick&) noexcept {
        if (!is_valid(tool.get()) || (body.connected && !is_valid(body.get()))) return tell(distance_);
        const Vec3 middle = body.connected ? body->inverse().apply(tool->position) : tool->position;
        const bool erases = erase.connected && erase.get(), paints = paint.get() && !erases;
        double least = 1.0;  // m: nobody paints from farther away
        const double reach = radius * radius;
        for (SurfacePoint& p : points_) {
            const Vec3 apart = p.position - middle;
            const double square = glm::dot(apart, apart);
            least = square < least ? square : least;
            if (square > reach) continue;
            if (paints && p.label != surface_label::fracture) {
                p.label = surface_label::fracture;
                ++count_;
                area_ += p.area;
            } else if (erases && p.label == surface_label::fracture) {
                p.label = surface_label::none;
                --count_;
                area_ -= p.area;
            }
        }
        tell(std::sqrt(least));
    }

    void report(Report& report) const {
        report.set(name_, "painted_points", static_cast<double>(count_));
        report.set(name_, "painted_mm2", area_ * 1e6);
        auto out = std::make_shared<Bone>(*bone);
        out->points = points_;
        report.results[name_] = std::shared_ptr<const Bone>(std::move(out));
    }

private:
    void tell(double away) noexcept {
        distance_ = away;
        painted = static_cast<double>(count_);
        area = area_;
        distance = away;
    }

    std::vector<SurfacePoint> points_;
    std::string name_;
    std::ptrdiff_t count_ = 0;
    double area_ = 0.0, distance_ = 0.0;
};

TACTUS_NODE(Brush, tool, paint, erase, body, painted, area, distance, bone, radius, start_clean)

}  // namespace tactus::nodes
