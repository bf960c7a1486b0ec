// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/surface_points.hpp"
#include "assets/segmentation/stroke_recorder.hpp"
#include "dsp/fit/surface_brush.hpp"
#include "graph/node/assets.hpp"
#include "graph/node/node.hpp"
#include "graph/node/visual.hpp"

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace tactus::nodes {

struct Brush {
    static constexpr auto about =
        "Paints the surface of a fragment with the device: points within the brush are labelled fracture, or "
        "unlabelled while erasing. The painted bone is written to the run folder, and the strokes on it to seeds.json, "
        "which segment takes as the seeds of a fragment.";

    In<Pose> tool{"pose whose origin is the centre of the brush, in the scene", "m"};
    In<bool> paint{"label points within the brush as fracture"};
    In<bool> erase{optional, "remove the label of points within the brush; takes precedence over 'paint'"};
    In<Pose> body{optional, "pose of the fragment's file frame in the scene; unconnected: the identity", "m"};
    Out<double> painted{"number of points labelled fracture"};
    Out<double> area{"surface area of these points", "m^2"};
    Out<double> distance{"from the centre of the brush to the nearest point, at most 20 mm", "m"};
    Out<Vec3> kept{"newest point of its strokes as seeds.json keeps it, in the fragment's file frame", "m"};
    Out<double> kept_radius{"of the brush at that point, negative: it erases; 0: the brush is lifted", "m"};
    Out<double> kept_points{"number of points of all its strokes"};
    Asset<bone::Bone> bone{"the fragment"};
    Param radius{"1.5 mm", "0.1 mm", "50 mm", "of the brush"};
    Flag start_clean{false, "remove the paint of the file at the start"};
    Text label{"", "name of the fragment in seeds.json; empty: that of the node"};

    std::vector<Visual> visuals() const {
        return {{.kind = VisualKind::asset_bone, .pose = "body", .asset = "bone"},
                {.kind = VisualKind::ball, .pose = "tool", .radius = radius}};
    }

    void prepare(const Setup& setup) {
        name_ = setup.name;
        std::vector<contact::SurfacePoint> points = bone::surface_points(*bone);
        if (points.empty()) setup.fail("bone '" + bone.name + "' has no surface");
        if (start_clean) contact::remove_paint(points);
        if (!label.value.empty() && !segmentation::is_label_name(label.value))
            setup.fail("'label' is one line of 1 to 200 bytes of UTF-8");
        strokes_ = std::make_unique<segmentation::StrokeRecorder>(max_strokes, max_points);
        brush_ = std::make_unique<fit::SurfaceBrush>(std::move(points));
        publish(fit::SurfaceBrush::farthest);
    }

    void process(const Tick&) noexcept {
        if (!is_valid(tool.get()) || (body.connected && !is_valid(body.get()))) {
            strokes_->lift();
            return publish(distance_);
        }
        const Vec3 middle = body.connected ? body->inverse().apply(tool->position) : tool->position;
        const bool erases = erase.connected && erase.get();
        if (erases) brush_->stroke(middle, radius, contact::surface_label::none);
        else if (paint.get()) brush_->stroke(middle, radius, contact::surface_label::fracture);
        const double away = brush_->distance(middle);
        if ((erases || paint.get()) && away <= radius) strokes_->touch(middle, radius, erases);
        else strokes_->lift();
        publish(away);
    }

    void report(Report& report) const {
        report.set(name_, "painted_points", static_cast<double>(brush_->labelled()));
        report.set(name_, "painted_mm2", brush_->area() * 1e6);
        if (strokes_->strokes() > 0) {
            report.set(name_, "strokes", static_cast<double>(strokes_->strokes()));
            if (strokes_->is_full())
                report.set(name_, "lost",
                           std::string("the run was too long for all strokes: seeds.json lacks the last ones"));
            report.results[name_ + " seeds"] = strokes_->label(label.value.empty() ? name_ : label.value);
        }
        auto out = std::make_shared<bone::Bone>(*bone);
        out->points.assign(brush_->points().begin(), brush_->points().end());
        report.results[name_] = std::shared_ptr<const bone::Bone>(std::move(out));
    }

private:
    void publish(double away) noexcept {
        distance_ = away;
        kept_points = static_cast<double>(strokes_->points());
        if (strokes_->is_open()) {
            kept = strokes_->newest_point();
            kept_radius = strokes_->newest_erases() ? -strokes_->newest_radius() : strokes_->newest_radius();
        } else kept_radius = 0.0;
        painted = static_cast<double>(brush_->labelled());
        area = brush_->area();
        distance = away;
    }

    // Ten minutes of a hand that moves 100 mm/s with a brush of 1.5 mm.
    static constexpr std::size_t max_strokes = 10'000, max_points = 160'000;

    std::unique_ptr<fit::SurfaceBrush> brush_;
    std::unique_ptr<segmentation::StrokeRecorder> strokes_;
    std::string name_;
    double distance_ = 0.0;
};

TACTUS_NODE(Brush, tool, paint, erase, body, painted, area, distance, kept, kept_radius, kept_points, bone, radius,
            start_clean, label)
TACTUS_VISUALS(Brush)

}  // namespace tactus::nodes
