// SPDX-License-Identifier: Apache-2.0
#include "tools/window/files/file_dialog.hpp"

#include "tools/run/load_plan.hpp"
#include "tools/window/frame/pressed.hpp"
#include "tools/window/frame/tooltip.hpp"
#include "tools/window/widgets/spots.hpp"
#include "tools/window/widgets/theme.hpp"

#include <fmt/format.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <utility>

namespace tactus::window {

namespace fs = std::filesystem;

namespace {

std::string size_words(std::uintmax_t bytes) {
    const auto size = static_cast<double>(bytes);
    if (size < 1e3) return fmt::format("{:.0f} B", size);
    if (size < 1e6) return fmt::format("{:.1f} kB", size * 1e-3);
    if (size < 1e9) return fmt::format("{:.1f} MB", size * 1e-6);
    return fmt::format("{:.1f} GB", size * 1e-9);
}

std::string date_words(fs::file_time_type when) {
    const auto system = std::chrono::time_point_cast<std::chrono::seconds>(std::chrono::file_clock::to_sys(when));
    const std::time_t time = std::chrono::system_clock::to_time_t(system);
    std::tm local{};
    if (!::localtime_r(&time, &local)) return "";
    return fmt::format("{:04}-{:02}-{:02} {:02}:{:02}", local.tm_year + 1900, local.tm_mon + 1, local.tm_mday,
                       local.tm_hour, local.tm_min);
}

}  // namespace

void FileDialog::open(const std::string& title, FileChooser chooser, Done done, Done replace) {
    ++opened_;
    makes_folder_ = false;
    title_ = title;
    chooser_ = std::move(chooser);
    done_ = std::move(done);
    replace_ = std::move(replace);
    wants_open_ = true;
    was_opened_ = false;
}

void FileDialog::refuse(const std::string& why) {
    was_refused_ = true;
    if (chooser_) chooser_->problem = why;
}

/// What is done may open this dialog anew.
void FileDialog::finish(const Done& done, const fs::path& file) {
    const int opened = opened_;
    was_refused_ = false;
    const Done call = done;
    call(file);
    if (opened == opened_ && !was_refused_) chooser_.reset();
}

void FileDialog::tools() {
    if (ImGui::Button("new folder")) {
        makes_folder_ = !makes_folder_;
        new_folder_.clear();
    }
    mark_spot("new folder");
    ImGui::SameLine();
    bool hidden = chooser_->shows_hidden();
    const ImGuiIO& io = ImGui::GetIO();
    const bool is_toggled = !chooser_->replaced && io.KeyCtrl && ImGui::IsKeyPressed('H', false);
    if (ImGui::Checkbox("hidden files", &hidden)) chooser_->show_hidden(hidden);
    else if (is_toggled) chooser_->show_hidden(!chooser_->shows_hidden());
    mark_spot("hidden files");
    if (ImGui::IsItemHovered()) show_tooltip("also those that begin with a dot (Ctrl+H)");
    ImGui::SameLine();
    bool by_date = chooser_->order() == FileChooser::Order::newest;
    if (ImGui::Checkbox("newest first", &by_date))
        chooser_->sort_by(by_date ? FileChooser::Order::newest : FileChooser::Order::name);
    mark_spot("newest first");
    if (!makes_folder_) return;
    ImGui::SetNextItemWidth(-1.0f);
    if (new_folder_.empty() && !ImGui::IsAnyItemActive()) ImGui::SetKeyboardFocusHere();
    const bool entered = ImGui::InputTextWithHint("##folder", "name of the new folder, then Enter", &new_folder_,
                                                  ImGuiInputTextFlags_EnterReturnsTrue);
    mark_spot("folder name");
    if (entered && chooser_->make_folder(new_folder_)) {
        makes_folder_ = false;
        wants_focus_ = true;
    }
}

void FileDialog::ask_to_replace() {
    constexpr const char* title = "Replace the file?";
    if (!ImGui::IsPopupOpen(title)) ImGui::OpenPopup(title);
    ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Appearing, ImVec2(0.5f, 0.5f));
    if (!ImGui::BeginPopupModal(title, nullptr, ImGuiWindowFlags_AlwaysAutoResize)) return;
    const fs::path file = *chooser_->replaced;
    ImGui::Text("Replace %s?", file.filename().c_str());
    ImGui::TextDisabled("It was saved at %s.",
                        [&] {
                            std::error_code ignored;
                            return date_words(fs::last_write_time(file, ignored));
                        }()
                            .c_str());
    const bool agreed = ImGui::Button("Replace");
    mark_spot("replace file");
    ImGui::SameLine();
    const bool cancelled = ImGui::Button("Cancel (Esc)") || pressed(ImGuiKey_Escape);
    mark_spot("keep file");
    if (agreed || cancelled) {
        ImGui::CloseCurrentPopup();
        chooser_->replaced.reset();
        wants_focus_ = true;
    }
    ImGui::EndPopup();
    if (agreed) finish(replace_ ? replace_ : done_, file);
}

void FileDialog::places() {
    int number = 0;
    const auto place = [&](const char* name, const fs::path& folder) {
        std::error_code ignored;
        if (folder.empty() || !fs::is_directory(folder, ignored)) return;
        // Letters and arrows belong to the name.
        ++number;
        const bool is_pressed =
            !chooser_->replaced && ImGui::GetIO().KeyAlt && ImGui::IsKeyPressed('0' + number, false);
        if (ImGui::Selectable(name) || is_pressed) chooser_->go_to(folder);
        mark_spot(std::string("place ") + name);
        if (ImGui::IsItemHovered()) show_tooltip(folder);
        const std::string keys = fmt::format("Alt+{}", number);
        ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(keys.c_str()).x);
        ImGui::TextDisabled("%s", keys.c_str());
    };
    const char* const home = std::getenv("HOME");
    std::error_code ignored;
    place("home", home ? home : "");
    place("working folder", fs::current_path(ignored));
    place("library", run::library_folder() / "patches");
    place("small patches", run::library_folder() / "examples");
    place("all files", "/");
}

void FileDialog::files() {
    std::optional<std::string> wanted;
    bool is_double = false;
    for (const FileChooser::Entry& entry : chooser_->entries()) {
        if (entry.is_folder) ImGui::PushStyleColor(ImGuiCol_Text, entry.is_take ? tone::good : tone::warm);
        const std::string shown = entry.is_folder && !entry.is_take ? entry.name + "/" : entry.name;
        if (ImGui::Selectable(shown.c_str(), entry.name == chooser_->name, ImGuiSelectableFlags_AllowDoubleClick)) {
            wanted = entry.name;
            is_double = ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left);
        }
        mark_spot("file " + entry.name);
        if (entry.name == chooser_->name && (pressed(ImGuiKey_DownArrow) || pressed(ImGuiKey_UpArrow)))
            ImGui::SetScrollHereY();
        if (entry.is_folder) ImGui::PopStyleColor();
        if (entry.is_take) {
            ImGui::SameLine();
            ImGui::TextDisabled("take");
        }
        // On a narrow window the name needs the room.
        const std::string note =
            entry.is_folder ? date_words(entry.when) : size_words(entry.size) + "   " + date_words(entry.when);
        const float room = ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(note.c_str()).x;
        if (room > ImGui::CalcTextSize(shown.c_str()).x + 4.0f * ImGui::GetFontSize()) {
            ImGui::SameLine(room);
            ImGui::TextDisabled("%s", note.c_str());
        }
    }
    if (!wanted) return;
    chooser_->name = *wanted;
    if (!is_double) return;
    if (const auto file = chooser_->accept()) finish(done_, *file);
}

bool FileDialog::name() {
    if (ImGui::IsWindowAppearing() || std::exchange(wants_focus_, false)) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(-1.0f);
    // A field in which one types keeps its own text, which only its callback may change.
    std::string typed = chooser_->name;
    const auto step = [](ImGuiInputTextCallbackData* field) {
        if (ImGui::GetIO().KeyAlt) return 0;
        FileChooser& chooser = *static_cast<FileChooser*>(field->UserData);
        chooser.name = field->Buf;
        chooser.step(field->EventKey == ImGuiKey_DownArrow ? 1 : -1);
        field->DeleteChars(0, field->BufTextLen);
        field->InsertChars(0, chooser.name.c_str());
        return 0;
    };
    const bool entered = ImGui::InputTextWithHint(
        "##name", "name or path", &typed, ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_CallbackHistory,
        step, &*chooser_);
    chooser_->name = typed;
    if (!ImGui::IsItemActive()) {
        if (pressed(ImGuiKey_DownArrow)) chooser_->step(1);
        if (pressed(ImGuiKey_UpArrow)) chooser_->step(-1);
    }
    return entered;
}

void FileDialog::draw(const Fonts& fonts) {
    if (std::exchange(wants_open_, false)) {
        ImGui::OpenPopup(title_.c_str());
        const Point all = point(ImGui::GetMainViewport()->Size);
        const Point size{std::min(720.0 * fonts.scale, 0.96 * all.x), std::min(480.0 * fonts.scale, 0.94 * all.y)};
        ImGui::SetNextWindowPos(vec((all - size) * 0.5));
        ImGui::SetNextWindowSize(vec(size));
    }
    if (title_.empty()) return;
    if (!ImGui::BeginPopupModal(title_.c_str(), nullptr, ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize)) {
        if (was_opened_) chooser_.reset();
        return;
    }
    was_opened_ = true;
    const auto leave = [] {
        ImGui::CloseCurrentPopup();
        ImGui::EndPopup();
    };
    if (!chooser_) return leave();
    // Esc leaves the innermost.
    const bool is_inner = makes_folder_ || chooser_->replaced.has_value();
    if (makes_folder_ && pressed(ImGuiKey_Escape)) makes_folder_ = false;
    if (ImGui::SmallButton("up")) chooser_->go_up();
    mark_spot("folder up");
    if (ImGui::IsItemHovered()) show_tooltip("the folder above (Alt+Up)");
    if (ImGui::GetIO().KeyAlt && ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_UpArrow), false))
        chooser_->go_to(chooser_->folder().parent_path());
    ImGui::SameLine();
    ImGui::TextUnformatted(chooser_->folder().c_str());
    tools();
    const float below = 2.0f * ImGui::GetFrameHeightWithSpacing() + ImGui::GetTextLineHeightWithSpacing();
    ImGui::BeginChild("places", ImVec2(11.0f * ImGui::GetFontSize(), -below));
    places();
    ImGui::EndChild();
    ImGui::SameLine();
    ImGui::BeginChild("files", ImVec2(0.0f, -below));
    files();
    ImGui::EndChild();
    if (!chooser_) return leave();
    const bool entered = name();
    mark_spot("file name");
    ImGui::PushStyleColor(ImGuiCol_Text, tone::warm);
    ImGui::TextUnformatted(chooser_->problem.c_str());
    ImGui::PopStyleColor();
    const bool accepted = ImGui::Button("   OK   ");
    mark_spot("accept file");
    ImGui::SameLine();
    const bool is_asking = chooser_->replaced.has_value();
    const bool cancelled = ImGui::Button("Cancel") || (!is_inner && pressed(ImGuiKey_Escape));
    mark_spot("cancel file");
    bool is_folder = false;
    if (chooser_->takes_folders) {
        ImGui::SameLine();
        is_folder = ImGui::Button("Open this folder");
        mark_spot("accept folder");
        if (ImGui::IsItemHovered()) show_tooltip("the slices of a scan: a folder of DICOM files");
    }
    if (cancelled) {
        chooser_.reset();
        return leave();
    }
    if (is_asking) ask_to_replace();
    else if (entered || accepted || is_folder) {
        if (const auto file = is_folder ? chooser_->accept_folder() : chooser_->accept()) finish(done_, *file);
        // Who types goes on typing.
        wants_focus_ = chooser_ && !chooser_->replaced;
    }
    if (!chooser_) return leave();
    ImGui::EndPopup();
}

}  // namespace tactus::window
