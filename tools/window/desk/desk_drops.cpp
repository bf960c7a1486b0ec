// SPDX-License-Identifier: Apache-2.0
// Files that are dropped on the window, and scans that become bones.
#include "tools/window/desk/desk.hpp"

#include "tools/run/load_plan.hpp"

#include <utility>

namespace tactus::window {

namespace fs = std::filesystem;

void Desk::take_dropped(const fs::path& file) {
    const FileKind kind = kind_of_file(file);
    if (kind == FileKind::patch || kind == FileKind::take) wishes.open = file;
    else if (take_) bench_.tell("a take is read-only; run the patch to change it", true);
    else if (is_ct(file) && plan_.case_run().is_there()) {
        slices_.open(file);
        use_layout(Layout::plan);
    } else if (kind == FileKind::scan) import_scan(file, node_for_drop(), place_of_drop());
    else if (kind == FileKind::plan) wishes.open = file;
    else if (start_page_.is_open) bench_.tell("open a patch first, then drop " + file.filename().string(), true);
    else take_file(file, node_for_drop(), place_of_drop());
    if (wishes.any()) start_page_.is_open = false;
}

std::optional<Point> Desk::place_of_drop() const {
    return shows(columns_, Panel::patch) ? patch_.mouse_over() : std::nullopt;
}

std::string Desk::node_for_drop() const {
    const std::string under = shows(columns_, Panel::patch) ? patch_.node_under_mouse() : "";
    return under.empty() ? patch_.selected : under;
}

void Desk::take_file(const fs::path& file, const std::string& node, std::optional<Point> at) {
    if (const std::string taken = bench_.take_file(file, node, at); !taken.empty()) patch_.choose_only(taken);
}

void Desk::import_scan(const fs::path& scan, const std::string& node, std::optional<Point> at) {
    std::error_code ignored;
    const fs::path patch = bench_.editor().file();
    const bool is_own = !bench_.is_untitled() && !run::is_of_library(patch);
    import_.open(scan, is_own ? fs::absolute(patch).parent_path() : fs::current_path(ignored),
                 [this, node, at](const fs::path& bone, const std::string& text) {
                     bench_.tell(text);
                     if (!start_page_.is_open) take_file(bone, node, at);
                 });
}

void Desk::ask_import() {
    std::error_code ignored;
    FileChooser chooser(FileChooser::For::open, fs::current_path(ignored),
                        {".nrrd", ".nhdr", ".nii", ".nii.gz", ".dcm", ".zip", ".inv3", ".stl", ".ply", ".obj"});
    chooser.takes_folders = true;
    ask_file("Make a bone of a scan or a mesh", std::move(chooser),
             [this](const fs::path& path) { import_scan(path, patch_.selected, std::nullopt); });
}

}  // namespace tactus::window
