// SPDX-License-Identifier: Apache-2.0
#include "tools/window/plan/flap_panel.hpp"

#include "assets/reconstruction/flap_files.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "tools/analysis/plan/flap_study.hpp"
#include "tools/window/frame/tooltip.hpp"
#include "tools/window/widgets/spots.hpp"
#include "tools/window/widgets/theme.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <utility>

namespace tactus::window {

namespace {

std::array<float, 3> in_mm(const Vec3& at) {
    return {static_cast<float>(at.x / mm), static_cast<float>(at.y / mm), static_cast<float>(at.z / mm)};
}
Vec3 vector_of(const std::array<float, 3>& v) {
    return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

}  // namespace

void FlapPanel::open(Form form) {
    // A click elsewhere, as for a measured point, closes a form.
    const bool goes_on = is_draft_ && form.of.empty() && form.kind == form_.kind;
    if (!goes_on) form_ = std::move(form);
    wants_dialog_ = true;
}

template <class Named>
void FlapPanel::line(const char* what, const Named& one, Form form, std::vector<Named> reconstruction::Flap::* list) {
    ImGui::PushID(fmt::format("{} {}", what, one.name).c_str());
    if (ImGui::SmallButton("x"))
        flap_.change([list, name = one.name](reconstruction::Reconstruction& all) {
            std::erase_if(all.flap.*list, [&](const Named& known) { return known.name == name; });
        });
    mark_spot(fmt::format("remove {} {}", what, one.name));
    if (ImGui::IsItemHovered()) show_tooltip("a step of the plan; 'undo step' brings it back");
    ImGui::SameLine();
    form.of = form.name = one.name;
    if (ImGui::Selectable(fmt::format("{} {}", what, one.name).c_str())) open(std::move(form));
    mark_spot(fmt::format("{} {}", what, one.name));
    ImGui::PopID();
}

void FlapPanel::lists(const reconstruction::Reconstruction& all) {
    const auto add = [&](const char* label, Kind kind) {
        const float end = ImGui::GetItemRectMax().x + ImGui::GetStyle().ItemSpacing.x + ImGui::CalcTextSize(label).x +
                          2.0f * ImGui::GetStyle().FramePadding.x;
        if (kind != Kind::plate && end < ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x)
            ImGui::SameLine();
        if (ImGui::SmallButton(label)) {
            Form form;
            form.kind = kind;
            form.margin = static_cast<float>(all.flap.margin / mm);
            open(std::move(form));
        }
        mark_spot(label);
    };
    add("+ plate", Kind::plate);
    add("+ implant", Kind::implant);
    add("+ vessel", Kind::vessel);
    add("+ site", Kind::site);
    add("margin...", Kind::margin);
    for (const reconstruction::Plate& plate : all.flap.plates) {
        Form form;
        form.kind = Kind::plate;
        if (!plate.screws.empty()) form.screw_length = static_cast<float>(plate.screws.front().length / mm);
        if (plate.laid) {
            form.height = static_cast<float>(plate.laid->height / mm);
            form.screws = plate.laid->screws_per_segment;
        } else form.note = "The plan does not say how this plate was laid: height and number of screws are guesses.";
        line("plate", plate, form, &reconstruction::Flap::plates);
    }
    for (const reconstruction::DentalImplant& implant : all.flap.implants) {
        Form form;
        form.kind = Kind::implant;
        form.at = in_mm(implant.head);
        form.axis = in_mm(implant.axis * mm);
        form.diameter = static_cast<float>(implant.diameter / mm);
        form.length = static_cast<float>(implant.length / mm);
        line("implant", implant, form, &reconstruction::Flap::implants);
    }
    for (const reconstruction::FlapVessel& vessel : all.flap.vessels) {
        Form form;
        form.kind = Kind::vessel;
        form.is_vein = vessel.kind == reconstruction::VesselKind::vein;
        line("vessel", vessel, form, &reconstruction::Flap::vessels);
    }
    for (const reconstruction::RecipientSite& site : all.flap.sites) {
        Form form;
        form.kind = Kind::site;
        form.is_vein = site.kind == reconstruction::VesselKind::vein;
        form.at = in_mm(site.at);
        line("site", site, form, &reconstruction::Flap::sites);
    }
    ImGui::TextDisabled("margin %.1f mm%s", all.flap.margin / mm, all.tumour ? "" : ", no tumour");
}

/// A place, from what was measured in the scene or typed.
void FlapPanel::places() {
    ImGui::InputFloat3("place, mm (LPS)", form_.at.data(), "%.2f");
    const std::span<const Vec3> marks = scene_.marks();
    ImGui::BeginDisabled(marks.empty());
    if (ImGui::Button("at the measured point")) {
        form_.at = in_mm(marks.front());
        if (marks.size() > 1 && glm::length(marks[1] - marks[0]) > 0.0)
            form_.axis = in_mm(glm::normalize(marks[1] - marks[0]) * mm);
    }
    mark_spot("at the measured point");
    ImGui::EndDisabled();
    if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
        show_tooltip(
            "press 'measure' in the scene and click a place; for an implant a second one, towards which it "
            "goes");
}

bool FlapPanel::apply() {
    const Form f = form_;
    const auto kind = f.is_vein ? reconstruction::VesselKind::vein : reconstruction::VesselKind::artery;
    switch (f.kind) {
        case Kind::plate:
            return flap_.lay_plate(
                {f.name, f.of, f.screws, static_cast<double>(f.screw_length) * mm, static_cast<double>(f.height) * mm});
        case Kind::implant:
            return flap_.change([f](reconstruction::Reconstruction& all) {
                const Vec3 axis = vector_of(f.axis);
                if (!(glm::length(axis) > 0.0)) throw Error("implant: 0, 0, 0 is no direction");
                put_named(all.flap.implants, f.of,
                          {f.name, vector_of(f.at) * mm, glm::normalize(axis), static_cast<double>(f.diameter) * mm,
                           static_cast<double>(f.length) * mm});
            });
        case Kind::vessel: {
            std::optional<reconstruction::FlapVessel> read;
            std::vector<std::string> notes;
            try {
                if (!f.file.empty()) read = reconstruction::read_vessel(f.file, kind, 0, notes);
            } catch (const Error& error) {
                bench_.tell(error.what(), true);
                return false;
            }
            for (const std::string& note : notes) bench_.tell(note);
            return flap_.change([f, kind, read](reconstruction::Reconstruction& all) {
                const auto known = std::ranges::find(all.flap.vessels, f.of, &reconstruction::FlapVessel::name);
                if (!read && known == all.flap.vessels.end()) throw Error(fmt::format("no vessel '{}'", f.of));
                reconstruction::FlapVessel vessel = read ? *read : *known;
                vessel.name = f.name;
                vessel.kind = kind;
                put_named(all.flap.vessels, f.of, std::move(vessel));
            });
        }
        case Kind::site:
            return flap_.change([f, kind](reconstruction::Reconstruction& all) {
                put_named(all.flap.sites, f.of, {f.name, kind, vector_of(f.at) * mm});
            });
        case Kind::margin:
            return flap_.change([f, folder = run_.file().parent_path()](reconstruction::Reconstruction& all) {
                if (!f.file.empty()) {
                    reconstruction::read_surface(f.file);  // refuses what is no mesh
                    all.tumour = analysis::mesh_file(f.file, folder);
                }
                all.flap.margin = static_cast<double>(f.margin) * mm;
            });
    }
    return false;
}

void FlapPanel::dialog() {
    if (std::exchange(wants_dialog_, false)) ImGui::OpenPopup("reconstruction");
    if (!ImGui::BeginPopup("reconstruction")) return;
    is_draft_ = form_.of.empty() && form_.kind != Kind::margin;
    ImGui::PushItemWidth(16.0f * ImGui::GetFontSize());
    constexpr const char* titles[] = {"Plate", "Dental implant", "Vessel of the leg", "Vessel of the neck",
                                      "Tumour and margin"};
    ImGui::TextUnformatted(titles[static_cast<std::size_t>(form_.kind)]);
    const bool has_name = form_.kind != Kind::margin;
    if (has_name) {
        if (ImGui::IsWindowAppearing() && form_.name.empty()) ImGui::SetKeyboardFocusHere();
        ImGui::InputText("name", &form_.name);
        mark_spot("name of the part");
    }
    switch (form_.kind) {
        case Kind::plate:
            ImGui::SliderInt("screws per segment", &form_.screws, 0, 6);
            mark_spot("screws of the plate");
            ImGui::SliderFloat("screws, mm", &form_.screw_length, 1.0f, 40.0f, "%.1f");
            ImGui::SliderFloat("above the axes, mm", &form_.height, -15.0f, 15.0f, "%.1f");
            mark_spot("height of the plate");
            break;
        case Kind::implant:
            places();
            ImGui::InputFloat3("axis into the bone", form_.axis.data(), "%.3f");
            ImGui::SliderFloat("diameter, mm", &form_.diameter, 0.5f, 15.0f, "%.1f");
            ImGui::SliderFloat("length, mm", &form_.length, 1.0f, 40.0f, "%.1f");
            break;
        case Kind::vessel:
            ImGui::InputTextWithHint("file",
                                     form_.of.empty() ? ".csv of 'tactus vessel', or .mrk.json of 3D Slicer"
                                                      : "empty: its course stays as it is",
                                     &form_.file);
            mark_spot("file of the vessel");
            ImGui::Checkbox("vein", &form_.is_vein);
            break;
        case Kind::site:
            places();
            ImGui::Checkbox("vein", &form_.is_vein);
            break;
        case Kind::margin:
            ImGui::InputTextWithHint("tumour", "a closed mesh; empty: as it is", &form_.file);
            ImGui::SliderFloat("margin, mm", &form_.margin, 0.0f, 50.0f, "%.1f");
            mark_spot("margin of the tumour");
            break;
    }
    const bool can =
        (!has_name || !form_.name.empty()) && (form_.kind != Kind::vessel || !form_.file.empty() || !form_.of.empty());
    ImGui::BeginDisabled(!can || flap_.is_changing());
    if (ImGui::Button("apply") && apply()) {
        applied_ = form_;
        is_draft_ = false;
        ImGui::CloseCurrentPopup();
    }
    mark_spot("apply to the plan");
    ImGui::EndDisabled();
    ImGui::SameLine();
    if (ImGui::Button("cancel")) {
        is_draft_ = false;
        ImGui::CloseCurrentPopup();
    }
    if (!form_.note.empty()) ImGui::TextDisabled("%s", form_.note.c_str());
    ImGui::TextDisabled("A step of the plan; the run begins again with it.");
    ImGui::PopItemWidth();
    ImGui::EndPopup();
}

void FlapPanel::tend() {
    flap_.tend(std::exchange(is_drawn_, false));
    if (flap_.take_refusal() && applied_) {
        form_ = *std::exchange(applied_, std::nullopt);
        wants_dialog_ = true;
    }
    // What was taken does not come back when another change is refused.
    if (!flap_.is_changing()) applied_.reset();
    if (run_.plan()) scene_.use_plan(run_.file(), *run_.plan(), run_.version());
}

void FlapPanel::draw() {
    is_drawn_ = true;
    const std::shared_ptr<const reconstruction::Reconstruction> all = flap_.reconstruction();
    if (!all) return;
    ImGui::TextWrapped("reconstruction (for research, not a medical device)");
    ImGui::BeginDisabled(flap_.is_changing());
    lists(*all);
    ImGui::EndDisabled();
    dialog();
    if (flap_.is_measuring() || flap_.is_changing()) ImGui::TextDisabled("...");
    for (const std::string& text : flap_.verdicts().warnings) {
        ImGui::PushStyleColor(ImGuiCol_Text, tone::warm);
        ImGui::TextWrapped("%s", text.c_str());
        ImGui::PopStyleColor();
    }
    for (const std::string& text : flap_.verdicts().lines) ImGui::TextWrapped("%s", text.c_str());
    ImGui::Separator();
}

}  // namespace tactus::window
