// SPDX-License-Identifier: Apache-2.0
// Slices of the scan beside the scene of a plan: axial, coronal and sagittal, with the outlines of its fragments and a
// cursor that the scene shares.
#pragma once

#include "tools/window/document/case_run.hpp"
#include "tools/window/files/file_chooser.hpp"
#include "tools/window/files/window_memory.hpp"
#include "tools/window/frame/commands.hpp"
#include "tools/window/scene/scene_panel.hpp"
#include "tools/window/slices/plan_outlines.hpp"
#include "tools/window/slices/plan_scan.hpp"
#include "tools/window/slices/slice_view.hpp"

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace tactus::window {

class PlanSlices {
public:
    PlanSlices(Workbench& bench, ScenePanel& scene, CaseRun& run, WindowMemory& memory)
        : bench_(bench), scene_(scene), run_(run), memory_(memory) {}

    /// Fills the current child window.
    void draw(const Fonts& fonts);
    /// While the slices are not drawn: there is no cursor in the scene.
    void rest() { scene_.cursor.reset(); }
    void add_commands(std::vector<Command>& all);
    /// Shows a CT, and remembers it for the plan when it could be read.
    void open(const std::filesystem::path& scan);
    bool is_shown() const { return is_shown_; }
    /// As long as nobody has shown or hidden them.
    void propose(bool shown) {
        if (!is_chosen_) is_shown_ = shown;
    }

    /// Opens a dialog for a scan, and calls `open`.
    std::function<void()> ask_scan;

private:
    void toggle();
    void read(const std::filesystem::path& scan);
    void find_scan();
    void tend();
    void head(const Fonts& fonts);
    void slice(std::size_t number, Point size, const Fonts& fonts);
    void draw_outlines(const Painter& paint, const SlicePlane& plane, Point middle, double scale);
    void move_cursor(const Vec3& to);
    void follow_cursor(Point size);

    Workbench& bench_;
    ScenePanel& scene_;
    CaseRun& run_;
    WindowMemory& memory_;
    PlanScan scan_;
    PlanOutlines outlines_;
    SliceSight sight_;
    GreyWindow window_;
    std::array<SliceTexture, 3> textures_;
    /// plan: of which a scan was looked for; asked: being read; given: shown, empty when it is of the fragments.
    std::filesystem::path plan_, asked_, given_;
    Vec3 known_cursor_{0.0};
    int scans_ = 0;  ///< counts those that were read
    bool is_shown_ = true, is_chosen_ = false;
};

}  // namespace tactus::window
