// SPDX-License-Identifier: Apache-2.0
// What can be done with a patch and its run in the window, without the window: the panels and scripts both call this.
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

/// A node that is to come, while its inputs still lack wires: only as a whole it can become an edit.
struct Draft {
    edit::NewNode node;
    std::vector<PicturePort> inputs, outputs;

    bool is_complete() const;  ///< every input that needs a wire has one
};

struct Message {
    std::string text;
    bool is_problem = false;
};

class Workbench {
public:
    /// Reads the patch; whether it compiles is told in `messages`. Throws Error when it cannot be read at all.
    explicit Workbench(const RunChoice& choice);

    const edit::PatchEditor& editor() const { return *editor_; }
    /// Of the text; null when it does not compile, which only a file saved elsewhere can do.
    const compile::Plan* plan() const { return plan_.get(); }
    const PatchPicture& picture() const { return picture_; }
    /// Rises whenever plan and picture are new.
    std::int64_t plan_version() const { return plan_version_; }
    std::string title() const;
    const std::deque<Message>& messages() const { return messages_; }
    void tell(std::string text, bool is_problem = false);

    // Edits. False: refused, and `messages` says why; the text is as it was.
    bool set(const std::string& node, const std::string& param, const std::string& value);
    bool reset(const std::string& node, const std::string& param);
    bool add(const edit::NewNode& node);
    bool remove(const std::string& node);
    bool rename(const std::string& from, const std::string& to);
    /// "node.port" to "node.port"; a wire that leads there gives way.
    bool connect(const std::string& from, const std::string& to, const std::string& mode = {});
    bool disconnect(const std::string& to);
    bool undo();
    bool redo();
    /// A patch of the library is not changed: then it is refused, and `wants_name` is set.
    bool save();
    /// As another file, which must not be there yet; the patch is that one from then on. A relative name is in the
    /// working folder.
    bool save_as(const std::string& name);
    /// What a copy could be called, in the working folder.
    std::filesystem::path free_file() const;
    bool wants_name = false;

    // Edits that are not saved.
    bool has_unsaved_edits() const;  ///< and were not dropped
    /// They are not wanted: `keep_edits` leaves them.
    void drop_edits();
    /// They are wanted after all.
    void want_edits() { dropped_version_ = -1; }
    /// Before the bench goes: keeps them in a file, and says on standard error where.
    void keep_edits() noexcept;
    /// Finds what earlier windows on this patch have kept.
    void find_kept_edits();
    /// A file with edits of an earlier window that waits to be restored or discarded.
    std::optional<std::filesystem::path> offer() const;
    /// They are an edit of the text; their file goes when the patch is saved.
    bool restore_edits();
    void discard_offer();
    /// While a slider moves: the run follows, the text does not yet.
    void turn(const std::string& node, const std::string& param, const std::string& value);

    /// Begins a draft of that type in a group of the picture; without inputs to wire it becomes an edit at once.
    void begin_draft(const std::string& type, int group);
    std::optional<Draft>& draft() { return draft_; }
    /// Wires an output to an input of the draft; as soon as it is complete it becomes an edit.
    void connect_draft(const std::string& from, const std::string& input);
    /// A name of that kind that no node has yet.
    std::string free_name(const std::string& type) const;

    /// Throws Error unless the file compiles to the plan that is shown.
    void check_saved();
    /// Why that wire cannot be, or nothing.
    std::optional<std::string> objection(const std::string& from, const std::string& to) const;

    // The run.
    void run();
    void stop();
    void pause(bool wanted);
    /// From now on, or no more. What runs is not disturbed; where nothing runs, a run begins.
    void record(bool wanted);
    bool is_recording() const { return status()->is_recording; }
    const std::filesystem::path& take() const { return last_take_; }
    ViewedRun* running() { return run_.get(); }
    std::shared_ptr<const RunStatus> status() const;
    std::shared_ptr<observe::Observer> observer() const { return observer_; }
    /// Rises with every run that begins: what was seen of the one before is over.
    int runs() const { return runs_; }

    /// Once per picture.
    void tend();

    /// Asked for in the window, for who holds this bench: to look at `take()`, or from a take back at its patch.
    bool wants_take = false, wants_patch = false;
    bool has_patch_behind = false;  ///< a take that was opened from the run of a patch

private:
    bool edit(const edit::PatchEditor::Edit& how, std::string done);
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
    std::shared_ptr<const compile::Plan> followed_;  // what the run was brought to last
    PatchPicture picture_;
    std::int64_t plan_version_ = 0;
    std::deque<Message> messages_;
    std::optional<Draft> draft_;
    std::shared_ptr<observe::Observer> observer_;
    std::unique_ptr<ViewedRun> run_;
    std::filesystem::path last_take_;
    int runs_ = 0;
    bool has_take_ = false;  // the run was recorded, at least in part
    std::vector<std::filesystem::path> offers_;
    std::filesystem::path restored_;  // where the edits that were restored are kept until the patch is saved
    std::int64_t dropped_version_ = -1;
};

}  // namespace tactus::view
