// SPDX-License-Identifier: Apache-2.0
// The model of the window: edits and runs of a patch, independent of the user interface. Called by panels and scripts.
#pragma once

#include "engine/observe/observer.hpp"
#include "graph/compile/load_assets.hpp"
#include "graph/compile/plan.hpp"
#include "graph/edit/patch_edit.hpp"
#include "graph/edit/patch_editor.hpp"
#include "tools/session/run_choice.hpp"
#include "tools/view/patch/patch_picture.hpp"
#include "tools/view/viewed_run.hpp"

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tactus::view {

/// A new node whose inputs still lack wires. It becomes an edit when it is complete.
struct Draft {
    edit::NewNode node;
    std::vector<PicturePort> inputs, outputs;

    bool is_complete() const;  ///< true when every required input has a wire
};

struct Message {
    std::string text;
    bool is_problem = false;
};

class Workbench {
public:
    /// Reads the patch; compile errors go to `messages`. Throws Error when it cannot be read.
    explicit Workbench(const RunChoice& choice);

    const edit::PatchEditor& editor() const { return *editor_; }
    /// The plan of the text; null when it does not compile, which happens only for files saved by other programs.
    const compile::Plan* plan() const { return plan_.get(); }
    const PatchPicture& picture() const { return picture_; }
    /// Increases when plan and picture change.
    std::int64_t plan_version() const { return plan_version_; }
    std::string title() const;
    const std::deque<Message>& messages() const { return messages_; }
    void tell(std::string text, bool is_problem = false);

    // Edits. False: refused; the reason is in `messages`, and the text is not changed.
    bool set(const std::string& node, const std::string& param, const std::string& value);
    bool reset(const std::string& node, const std::string& param);
    bool add(const edit::NewNode& node);
    bool remove(const std::string& node);
    bool rename(const std::string& from, const std::string& to);
    /// Wires "node.port" to "node.port"; replaces an existing wire to that input, unless it takes events of many.
    bool connect(const std::string& from, const std::string& to, const std::string& mode = {});
    /// Removes the wire to that input; of several the one from `from`, or the first when none is given.
    bool disconnect(const std::string& to, const std::string& from = {});
    /// Moves the saw's site to a point of the bone (scene, m), along the surface's normal, as one edit. Refused for a
    /// patch without a bone to saw.
    bool cut_at(const Vec3& site);
    /// The patch has a bone to saw.
    bool can_cut() const;
    bool undo();
    bool redo();
    /// Refused for a patch of the library; then sets `wants_name`.
    bool save();
    /// Saves as a new file and continues with it. The file must not exist. A relative name refers to the working
    /// folder.
    bool save_as(const std::string& name);
    /// A proposed name for a copy in the working folder.
    std::filesystem::path free_file() const;
    bool wants_name = false;

    // Unsaved edits.
    bool has_unsaved_edits() const;  ///< unsaved and not dropped
    /// Discards them: `keep_edits` does not keep them.
    void drop_edits();
    /// Revokes drop_edits.
    void want_edits() { dropped_version_ = -1; }
    /// Called at the end: keeps them in a file and prints the path on standard error.
    void keep_edits() noexcept;
    /// Finds edits kept by earlier windows on this patch.
    void find_kept_edits();
    /// A file of kept edits that can be restored or discarded.
    std::optional<std::filesystem::path> offer() const;
    /// Restores them as an edit; their file is removed when the patch is saved.
    bool restore_edits();
    void discard_offer();
    /// For a moving slider: changes the run but not the text.
    void turn(const std::string& node, const std::string& param, const std::string& value);

    /// Starts a draft of a node type in a group; without required inputs it becomes an edit at once.
    void begin_draft(const std::string& type, int group);
    std::optional<Draft>& draft() { return draft_; }
    /// Wires an output to an input of the draft; a complete draft becomes an edit.
    void connect_draft(const std::string& from, const std::string& input);
    /// A free node name for the type.
    std::string free_name(const std::string& type) const;

    /// Throws Error unless the saved file compiles to the shown plan.
    void check_saved();
    /// Why the wire is not possible; none: it is.
    std::optional<std::string> objection(const std::string& from, const std::string& to) const;

    // The run.
    void run();
    void stop();
    void pause(bool wanted);
    /// Presses a button of the run that is a node of the patch.
    void press(const std::string& node);
    /// Starts or stops recording without disturbing the run; starts a run when none is active.
    void record(bool wanted);
    bool is_recording() const { return status()->is_recording; }
    const std::filesystem::path& take() const { return last_take_; }
    ViewedRun* running() { return run_.get(); }
    std::shared_ptr<const RunStatus> status() const;
    std::shared_ptr<observe::Observer> observer() const { return observer_; }
    /// Increases with every new run.
    int runs() const { return runs_; }

    /// Called once per frame.
    void tend();

    /// Requests of the window to its owner: open `take()`, or return from a take to its patch.
    bool wants_take = false, wants_patch = false;
    bool has_patch_behind = false;  ///< the take was opened from a patch

private:
    bool edit(const edit::PatchEditor::Edit& how, std::string done);
    edit::InputTakes taken_by(const std::string& to) const;
    std::optional<std::string> check(std::string_view text);
    void adopt();
    void adopt_text();
    void follow();
    void take_over_file();
    void drop_restored();
    std::filesystem::path keep_text() const;
    bool has_same_parts();

    RunChoice choice_;
    compile::AssetCache assets_;
    std::unique_ptr<edit::PatchEditor> editor_;
    std::unique_ptr<compile::Plan> checked_;
    std::shared_ptr<const compile::Plan> plan_;
    std::shared_ptr<const compile::Plan> followed_;  // the plan last applied to the run
    PatchPicture picture_;
    std::int64_t plan_version_ = 0;
    std::deque<Message> messages_;
    std::optional<Draft> draft_;
    std::shared_ptr<observe::Observer> observer_;
    std::unique_ptr<ViewedRun> run_;
    std::filesystem::path last_take_;
    int runs_ = 0;
    bool has_take_ = false;  // the run was recorded at least in part
    std::vector<std::filesystem::path> offers_;
    std::filesystem::path restored_;  // file of restored edits, removed when the patch is saved
    std::int64_t dropped_version_ = -1;
};

}  // namespace tactus::view
