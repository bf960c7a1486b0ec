// SPDX-License-Identifier: Apache-2.0
#include "tools/report/cutting_guide/template_report.hpp"

#include "dsp/core/constants.hpp"
#include "tools/render/flap_scene.hpp"
#include "tools/report/cutting_guide/guide_report.hpp"
#include "tools/report/reconstruction/fibula_result.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <string>
#include <utility>
#include <vector>

namespace tactus::report {

namespace {

constexpr Vec3 template_colour(0.72, 0.55, 0.35), planned_colour(0.90, 0.86, 0.76);

const Fields<cutting_guide::HoleMark>& mark_fields() {
    using M = cutting_guide::HoleMark;
    static const Fields<M> all = Fields<M>("mark of a hole of a plate")
                                     .vector("at_mm", "place", from_si(2, "mm"), [](const M& m) { return m.at; })
                                     .vector("axis", "", fixed(4), [](const M& m) { return m.axis; })
                                     .number("diameter_mm", "diameter", from_si(2, "mm"), &M::diameter);
    return all;
}

std::vector<render::LabelledPicture> template_pictures(const analysis::PlannedTemplate& t) {
    const display::PictureMesh strip = flat_mesh(t.made.surface, template_colour);
    const std::vector<display::PictureMesh> alone{strip},
        on_bone{strip, render::picture_mesh(t.design.bone, {}, {&planned_colour, 1})};
    Vec3 out(0.0);
    for (const Vec3& v : t.design.plate.outward) out += v;
    const Vec3 from = glm::length(out) > 0.1 ? -glm::normalize(out) : Vec3(0.0, 1.0, 0.0);
    return {render::labelled_picture(alone, glm::normalize(from - Vec3(0.0, 0.0, 0.6)),
                                     "The bed, from outside and the head"),
            render::labelled_picture(alone, glm::normalize(from + Vec3(0.0, 0.0, 0.9)), "From outside and the feet"),
            render::labelled_picture(on_bone, glm::normalize(from - Vec3(0.0, 0.0, 0.4)), "In the planned bone")};
}

const Fields<analysis::PlannedTemplate>& planned_template_fields() {
    using T = analysis::PlannedTemplate;
    using Made = cutting_guide::MadeTemplate;
    const auto made = [](auto member) { return [member](const T& t) { return t.made.*member; }; };
    static const Fields<T> all =
        Fields<T>("template on which a plate is bent")
            .remark([](const T&) {
                return "For research, not a medical device. The bed has the shape of the planned bone below the plate.";
            })
            .warnings("",
                      [](const T& t) {
                          std::vector<std::string> texts;
                          for (const analysis::GuideWarning& w : t.warnings) texts.push_back(w.text);
                          return texts;
                      })
            .pictures(template_pictures)
            .text("plate", "template for plate", &T::plate)
            .flag("closed", "closed", [](const T& t) { return t.topology.is_watertight(); })
            .integer("parts", "parts", [](const T& t) { return t.topology.components; })
            .integer("triangles", "triangles", [](const T& t) { return t.made.surface.triangles.size(); })
            .number("volume_mm3", "volume", from_si(0, "mm³"), &T::volume)
            .number("length_mm", "length", from_si(1, "mm"), made(&Made::length))
            .number("width_mm", "width", from_si(1, "mm"), made(&Made::width))
            .number("min_radius_mm", "tightest bend", from_si(1, "mm"), made(&Made::min_radius))
            .number("bone_share", "bone below the plate", fixed(0, "%", "1"), made(&Made::bone_share))
            .number("on_bone_share", "below the plate on the bone, to 0.1 mm", fixed(0, "%", "1"),
                    made(&Made::on_bone_share))
            .number("max_span_mm", "span over the bone, at most", from_si(2, "mm"), made(&Made::max_span))
            .text(
                "marks_kind", "marks",
                [](const T& t) {
                    return std::string(t.choice.settings.marks == cutting_guide::HoleMarks::pins ? "pins" : "dimples");
                })
            .rows("marks", "marks of the holes", mark_fields(), [](const T& t) -> const auto& { return t.made.marks; })
            .rows("warnings", "", guide_warning_fields(), &T::warnings);
    return all;
}

}  // namespace

const Fields<MadeTemplateFile>& template_fields() {
    using M = MadeTemplateFile;
    static const Fields<M> all =
        Fields<M>("template on which a plate is bent, and its file")
            .titled([](const M& m) { return m.plan; })
            .part(planned_template_fields(), [](const M& m) -> const analysis::PlannedTemplate& { return *m.made; })
            .text("file", "file", &M::file)
            .text("", "note", [](const M&) { return std::string(research_note); });
    return all;
}

}  // namespace tactus::report
