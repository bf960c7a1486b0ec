// SPDX-License-Identifier: Apache-2.0
// The layout of the window: all panels.
#pragma once

#include "tools/window/desk/fault_list.hpp"
#include "tools/window/desk/questions.hpp"
#include "tools/window/desk/run_bar.hpp"
#include "tools/window/desk/take_bench.hpp"
#include "tools/window/document/plan_document.hpp"
#include "tools/window/document/plan_preview.hpp"
#include "tools/window/document/workbench.hpp"
#include "tools/window/files/file_dialog.hpp"
#include "tools/window/files/import_dialog.hpp"
#include "tools/window/files/start_page.hpp"
#include "tools/window/files/window_memory.hpp"
#include "tools/window/frame/command_list.hpp"
#include "tools/window/frame/layout.hpp"
#include "tools/window/frame/value_dialog.hpp"
#include "tools/window/frame/window.hpp"
#include "tools/window/patch/node_panel.hpp"
#include "tools/window/patch/patch_panel.hpp"
#include "tools/window/plan/plan_panel.hpp"
#include "tools/window/scene/calibration_panel.hpp"
#include "tools/window/scene/plan_slices.hpp"
#include "tools/window/scene/scene_panel.hpp"
#include "tools/window/signal/scopes.hpp"
#include "tools/window/training/train_panel.hpp"

#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace tactus::window {

/// What the desk asks of its owner.
struct DeskWishes {
    std::filesystem::path open;  ///< a patch, a take or a plan
    bool new_patch = false, start_page = false;
    bool any() const { return !open.empty() || new_patch || start_page; }
};

class Desk {
public:
    Desk(Window& window, Workbench& bench, TakeBench* take, WindowMemory& memory);
    ~Desk() { bench_.asset_for_run = nullptr; }
    Desk(const Desk&) = delete;
    Desk& operator=(const Desk&) = delete;

    /// Draws one frame, between Window::begin and Window::end.
    void draw();
    /// Instead of `draw` while no picture is shown: what is traced goes on without gaps.
    void rest();

    Workbench& bench() { return bench_; }
    TakeBench* take() { return take_; }
    PatchPanel& patch() { return patch_; }
    const PatchPanel& patch() const { return patch_; }
    NodePanel& nodes() { return nodes_; }
    Scopes& scopes() { return scopes_; }
    ScenePanel& scene() { return scene_; }
    PlanSlices& slices() { return slices_; }
    const Feed* feed() const;

    Layout layout = Layout::patch;
    /// Changes the layout, and remembers it for this patch.
    void use_layout(Layout wanted);
    /// The plan that this patch was opened for, as the document; null: there is none.
    PlanDocument* plan_document() { return plan_document_.get(); }
    void open_plan(std::unique_ptr<PlanDocument> plan);
    /// What a person has opened: what the window remembers and is named after.
    std::filesystem::path opened_file() const {
        return plan_document_ ? plan_document_->file() : bench_.editor().file();
    }
    /// Called on every way out: what is unsaved is kept for a later window.
    void keep_plan() noexcept;
    void show_title();
    DeskWishes wishes;
    /// Lays the start page over what is open, which stays as it is until something is chosen.
    void open_start_page();
    /// What is being typed in the patch becomes an edit, as if its field had been left: before it is saved or left behind.
    void end_typing();
    /// Before the plan is left: true while a step that was asked for is not in it yet.
    bool brings_what_waits() { return plan_.case_run().brings_what_waits(); }
    /// A file dropped on the window.
    void take_dropped(const std::filesystem::path& file);

    /// Dialog when the window closes or another patch opens: end or continue the run?
    enum class Farewell { none, asks, ends, goes_on } farewell = Farewell::none;
    bool farewell_is_of_window = true;  ///< else another patch opens, and the run cannot go on
    /// Dialogs for unsaved edits: before closing, and when the window opens.
    Questions questions;

private:
    void follow_run();
    void tend_plan();
    /// True while no run shows the opened plan: the scene then shows the preview.
    bool shows_preview() const;
    /// `height`: of a vertical splitter; a horizontal one fills the width. Returns how far it is moved, pixels.
    double splitter(const std::string& id, bool upright, double height);
    /// Whether a panel has something to show.
    PanelRoom room_of(Panel panel);
    /// Columns for the panels there are, with the borders where a person has put them.
    void arrange(double width);
    void draw_column(std::size_t index, double height);
    void draw_panel(Panel panel, double height);
    void draw_patch(double height);
    void draw_scopes(double height);
    void draw_scene(double height);
    void draw_first_step(const Vec3& feed);
    void draw_node(double height);
    void draw_tree(double height);
    void draw_steps(double height);
    void draw_slices(double height);
    void draw_task(double height);
    void show_messages(double height);
    void draw_faults(double height, double gap);
    void ask_farewell();
    void shortcuts();
    std::vector<Command> make_commands();
    void add_file_commands(std::vector<Command>& all);
    void add_edit_commands(std::vector<Command>& all);
    void add_view_commands(std::vector<Command>& all);
    void add_run_commands(std::vector<Command>& all);
    /// Commands and all that they can be applied to: types to add, nodes to go to, wires to make, examples to open.
    std::vector<Command> all_commands();
    void ask_file(const std::string& title, FileChooser chooser, FileDialog::Done done);
    void ask_open();
    EditButtons edit_buttons();
    void save();
    bool save_plan();
    void tell_saved(const plan::MergedAlternatives& changed);
    void ask_save_plan_as();
    void ask_save_as();
    void ask_scan();
    void ask_import();
    /// Opens the dialog that makes a bone of it, which then goes to the node, if the patch has one for it.
    void import_scan(const std::filesystem::path& scan, const std::string& node, std::optional<Point> at);
    void take_file(const std::filesystem::path& file, const std::string& node, std::optional<Point> at);
    /// The node under the pointer, where the patch is seen; else the chosen one.
    std::string node_for_drop() const;
    std::optional<Point> place_of_drop() const;
    void ask_part();
    /// The picture of the patch is on the screen: keys of the patch mean it.
    bool sees_patch() const { return !start_page_.is_open && shows(columns_, Panel::patch); }
    void ask_value(const std::string& node, const std::string& param, const std::string& value);
    void ask_device_setting();
    void go_to_largest_force();
    void draw_start();
    void draw_dialogs();
    void draw_problem();
    void keep_borders();

    Window& window_;
    Workbench& bench_;
    std::unique_ptr<PlanDocument> plan_document_;
    PlanPreview preview_;
    std::string told_problem_;  ///< of the preview
    bool wants_plan_name_ = false, shows_unsaved_ = false;
    TakeBench* take_;
    std::unique_ptr<LiveFeed> live_;
    int runs_ = 0;
    Fonts fonts_;
    PatchPanel patch_;
    NodePanel nodes_;
    Scopes scopes_;
    ScenePanel scene_;
    CalibrationPanel calibration_;
    PlanPanel plan_;
    PlanSlices slices_;
    TrainPanel train_;
    std::set<std::string> looked_at_;
    WindowMemory& memory_;
    StartPage start_page_;
    FaultList faults_;
    FileDialog dialog_;
    ImportDialog import_;
    CommandList list_;
    bool wants_menus_ = false;
    std::vector<Command> commands_;
    ValueDialog value_;
    std::vector<LayoutColumn> columns_;
    std::vector<std::vector<LayoutColumn>> moved_;  ///< columns of other layouts and panels, for when they return
    std::vector<std::vector<LayoutColumn>> placed_;  ///< those whose borders a person has moved, the latest last
    bool knows_borders_ = false, moves_border_ = false;
    std::int64_t start_told_ = 0;  ///< messages when the start page opened
    std::int64_t told_seen_ = 0;
};

}  // namespace tactus::window
