// SPDX-License-Identifier: Apache-2.0
#include "tools/window/files/import_dialog.hpp"

#include "tools/window/document/start_list.hpp"
#include "tools/window/frame/pressed.hpp"
#include "tools/window/widgets/spots.hpp"
#include "tools/window/widgets/theme.hpp"

#include <fmt/format.h>
#include <imgui_stdlib.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <utility>

namespace tactus::window {

namespace fs = std::filesystem;

namespace {

constexpr const char* import_title = "Make a bone of a scan";
constexpr std::array<const char*, 4> units{"as the file states", "mm", "cm", "m"};
constexpr std::array<const char*, 2> parts{"largest", "all"};

/// "300", "300 HU"; none: no number.
std::optional<double> hounsfield(const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (end == text.c_str() || !std::isfinite(value)) return std::nullopt;
    const std::string rest = text.substr(static_cast<std::size_t>(end - text.c_str()));
    const std::size_t first = rest.find_first_not_of(' ');
    if (first != std::string::npos && rest.substr(first) != "HU") return std::nullopt;
    return value;
}

}  // namespace

void ImportDialog::open(const fs::path& scan, const fs::path& folder, Done done) {
    if (is_open_) return;
    scan_ = fs::absolute(scan);
    done_ = std::move(done);
    out_ = free_bone(scan_, folder).string();
    is_mesh_ = !is_ct(scan_);
    threshold_.clear();
    problem_.clear();
    unit_ = parts_ = 0;
    is_open_ = wants_open_ = true;
}

void ImportDialog::begin() {
    bone::ImportOptions options;
    options.input = scan_;
    options.component = parts[static_cast<std::size_t>(parts_)];
    if (is_mesh_ && unit_ > 0) options.unit = units[static_cast<std::size_t>(unit_)];
    if (!is_mesh_ && !threshold_.empty()) {
        options.threshold = hounsfield(threshold_);
        if (!options.threshold) {
            problem_ = fmt::format("the threshold '{}' is no number of HU, as 300", threshold_);
            return;
        }
    }
    problem_.clear();
    import_.begin(options, fs::path(out_));
}

void ImportDialog::close() {
    is_open_ = false;
    ImGui::CloseCurrentPopup();
}

void ImportDialog::ask(const Fonts& fonts) {
    const auto label = [&](const char* words) {
        ImGui::AlignTextToFramePadding();
        ImGui::TextUnformatted(words);
        ImGui::SameLine(static_cast<float>(120.0 * fonts.scale));
        ImGui::SetNextItemWidth(-1.0f);
    };
    if (is_mesh_) {
        label("Unit of length");
        ImGui::Combo("##unit", &unit_, units.data(), static_cast<int>(units.size()));
    } else {
        label("Threshold");
        if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
        ImGui::InputTextWithHint("##threshold", "HU; empty: the one that suits the scan", &threshold_);
        mark_spot("import threshold");
    }
    label("Parts to keep");
    ImGui::Combo("##parts", &parts_, parts.data(), static_cast<int>(parts.size()));
    label("Save the bone as");
    ImGui::InputText("##out", &out_);
    mark_spot("import out");
    if (!problem_.empty()) {
        ImGui::PushStyleColor(ImGuiCol_Text, tone::bad);
        ImGui::TextWrapped("%s", problem_.c_str());
        ImGui::PopStyleColor();
    }
    const bool wants = ImGui::Button("Import (Enter)") || pressed(ImGuiKey_Enter) || pressed(ImGuiKey_KeyPadEnter);
    mark_spot("import");
    ImGui::SameLine();
    if (ImGui::Button("Cancel (Esc)") || pressed(ImGuiKey_Escape)) close();
    else if (wants) begin();
}

void ImportDialog::show_progress(const Fonts& fonts) {
    const ScanImport::Progress now = import_.progress();
    ImGui::ProgressBar(static_cast<float>(now.share), vec({-1.0, 18.0 * fonts.scale}));
    ImGui::TextDisabled("%s", now.doing.c_str());
    if (ImGui::Button("Stop (Esc)") || pressed(ImGuiKey_Escape)) import_.stop();
    mark_spot("stop the import");
    const auto result = import_.take_result();
    if (!result) return;
    if (result->bone.empty()) {
        problem_ = result->text;
        return;
    }
    close();
    done_(result->bone, result->text);
}

void ImportDialog::draw(const Fonts& fonts) {
    if (!is_open_) return;
    // A question that came meanwhile has closed it.
    const bool is_closed = !ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup);
    if (std::exchange(wants_open_, false) || is_closed) ImGui::OpenPopup(import_title);
    ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Appearing, ImVec2(0.5f, 0.5f));
    ImGui::SetNextWindowSize(vec({560.0 * fonts.scale, 0.0}));
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, vec({8.0 * fonts.scale, 6.0 * fonts.scale}));
    if (ImGui::BeginPopupModal(import_title, nullptr, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove)) {
        ImGui::PushTextWrapPos(0.0f);
        ImGui::TextDisabled("%s", scan_.c_str());
        ImGui::PopTextWrapPos();
        if (import_.is_busy()) show_progress(fonts);
        else ask(fonts);
        ImGui::EndPopup();
    }
    ImGui::PopStyleVar();
}

}  // namespace tactus::window
