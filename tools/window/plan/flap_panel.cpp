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

void FlapPanel::ask_guide() {
    Form form;
    form.kind = Kind::guide;
    form.name = "guide-1";
    const auto all = flap_.reconstruction();
    for (int n = 2;
         all && std::ranges::find(all->guides, form.name, &reconstruction::KeptGuide::name) != all->guides.end(); ++n)
        form.name = fmt::format("guide-{}", n);
    open(std::move(form));
}

void FlapPanel::ask_paddle() {
    Form form;
    form.kind = Kind::paddle;
    if (const auto all = flap_.reconstruction(); all && all->flap.paddle) {
        form.at = in_mm(all->flap.paddle->at);
        form.paddle_length = static_cast<float>(all->flap.paddle->length / mm);
        form.paddle_width = static_cast<float>(all->flap.paddle->width / mm);
        form.is_at_perforators = false;
    }
    open(std::move(form));
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
    const auto ask = [&](const char* label, void (FlapPanel::*what)()) {
        const float end = ImGui::GetItemRectMax().x + ImGui::GetStyle().ItemSpacing.x + ImGui::CalcTextSize(label).x +
                          2.0f * ImGui::GetStyle().FramePadding.x;
        if (end < ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x) ImGui::SameLine();
        if (ImGui::SmallButton(label)) (this->*what)();
        mark_spot(label);
    };
    ask("+ guide", &FlapPanel::ask_guide);
    ask("paddle...", &FlapPanel::ask_paddle);
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
    for (const reconstruction::KeptGuide& guide : all.guides) {
        ImGui::PushID(guide.name.c_str());
        if (ImGui::SmallButton("x"))
            flap_.change([name = guide.name](reconstruction::Reconstruction& now) {
                std::erase_if(now.guides, [&](const reconstruction::KeptGuide& known) { return known.name == name; });
            });
        mark_spot(fmt::format("remove guide {}", guide.name));
        if (ImGui::IsItemHovered()) show_tooltip("a step of the plan; 'undo step' brings it back. Its file stays");
        ImGui::SameLine();
        if (ImGui::Selectable(fmt::format("guide {}", guide.name).c_str())) {
            Form form;
            form.kind = Kind::guide;
            form.of = form.name = guide.name;
            form.bone = guide.is_of_jaw ? 1 : 0, form.cut = guide.cut, form.sides = guide.sides;
            form.turn = static_cast<float>(guide.turn / degree), form.label = guide.label;
            open(std::move(form));
        }
        mark_spot(fmt::format("guide {}", guide.name));
        ImGui::PopID();
    }
    if (all.flap.paddle)
        ImGui::TextDisabled("paddle %.0f x %.0f mm", all.flap.paddle->length / mm, all.flap.paddle->width / mm);
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
        case Kind::guide: {
            reconstruction::KeptGuide guide;
            guide.name = f.name, guide.label = f.label;
            guide.is_of_jaw = f.bone == 1, guide.cut = f.bone == 1 ? f.cut : 0, guide.sides = f.sides;
            guide.turn = static_cast<double>(f.turn) * degree;
            return flap_.make_guide(std::move(guide), f.of);
        }
        case Kind::paddle: {
            FlapRun::PaddleChoice choice;
            if (!f.is_at_perforators) choice.at = vector_of(f.at) * mm;
            choice.length = static_cast<double>(f.paddle_length) * mm;
            choice.width = static_cast<double>(f.paddle_width) * mm;
            return flap_.lay_paddle(choice);
        }
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
    const bool has_name = form_.kind != Kind::margin && form_.kind != Kind::paddle;
    is_draft_ = form_.of.empty() && has_name;
    ImGui::PushItemWidth(16.0f * ImGui::GetFontSize());
    constexpr const char* titles[] = {
        "Plate",         "Dental implant", "Vessel of the leg", "Vessel of the neck", "Tumour and margin",
        "Cutting guide", "Skin paddle"};
    ImGui::TextUnformatted(titles[static_cast<std::size_t>(form_.kind)]);
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
        case Kind::guide:
            ImGui::Combo("for", &form_.bone, "fibula\0jaw\0");
            mark_spot("bone of the guide");
            if (form_.bone == 1) ImGui::Combo("cuts", &form_.cut, "both\0the first\0the last\0");
            ImGui::SliderInt("walls of a slot", &form_.sides, 1, 3);
            ImGui::SliderFloat("turn of the approach, degrees", &form_.turn, -180.0f, 180.0f, "%.0f");
            mark_spot("turn of the guide");
            ImGui::InputTextWithHint("label", "empty: the plan's title", &form_.label);
            break;
        case Kind::paddle:
            ImGui::Checkbox("at the perforators", &form_.is_at_perforators);
            if (!form_.is_at_perforators) places();
            ImGui::SliderFloat("length, mm", &form_.paddle_length, 5.0f, 400.0f, "%.0f");
            mark_spot("length of the paddle");
            ImGui::SliderFloat("width, mm", &form_.paddle_width, 5.0f, 200.0f, "%.0f");
            if (const auto all = flap_.reconstruction(); all && all->flap.paddle) {
                if (ImGui::Button("remove") && flap_.remove_paddle()) ImGui::CloseCurrentPopup();
                mark_spot("remove the paddle");
            }
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
