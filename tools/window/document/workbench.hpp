// SPDX-License-Identifier: Apache-2.0
// The model of the window: edits and runs of a patch, independent of the user interface. Called by panels and scripts.
#pragma once

#include "engine/observe/observer.hpp"
#include "graph/compile/load_assets.hpp"
#include "graph/compile/schedule.hpp"
#include "graph/edit/patch_edit.hpp"
#include "graph/edit/patch_editor.hpp"
#include "tools/run/run_choice.hpp"
#include "tools/window/document/faults.hpp"
#include "tools/window/document/kept_edits.hpp"
#include "tools/window/document/patch_picture.hpp"
#include "tools/window/document/unfinished.hpp"
#include "tools/window/document/viewed_run.hpp"

#include <chrono>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tactus::window {

struct Message {
    std::string text;
    bool is_problem = false;
};

/// The file that a parameter of a new node names.
struct NodeFile {
    std::string param;
    std::filesystem::path path;
};

class Workbench {
public:
    /// Reads the patch; compile errors go to `messages`. Throws Error when it cannot be read.
    explicit Workbench(const RunChoice& choice);
    /// A new patch with no file, at its place in the working folder; empty.
    static std::unique_ptr<Workbench> untitled(RunChoice choice);
    bool is_untitled() const;

    const edit::PatchEditor& editor() const { return *editor_; }
    /// The plan of all that is finished and without errors; null when nothing is.
    const compile::Schedule* plan() const { return plan_.get(); }
    /// The errors of the text. A patch that has some does not run, and an edit of it is refused only when it adds
    /// errors and repairs none. For a file with errors that is opened, or saved by another program.
    const std::vector<Fault>& faults() const { return faults_; }
    bool is_broken() const { return !faults_.empty(); }
    const Unfinished& unfinished() const { return unfinished_; }
    const patch::PatchWindow& window() const { return window_; }
    /// The nodes as written, with sub-patches as one.
    const patch::Patch& written() const { return written_; }
    const PatchPicture& picture() const { return picture_; }
    /// Increases when plan and picture change.
    std::int64_t plan_version() const { return plan_version_; }
    std::string title() const;
    /// What opens this patch anew, as it is changed from outside now; without a recording.
    RunChoice choice() const;
    const std::deque<Message>& messages() const { return messages_; }
    /// How many messages there have been; `messages` holds the latest.
    std::int64_t told() const { return told_; }
    void tell(std::string text, bool is_problem = false);

    // Edits. False: refused; the reason is in `messages`, and the text is not changed.
    /// Of a node within a sub-patch: sets the parameter that the sub-patch offers for it.
    bool set(const std::string& node, const std::string& param, const std::string& value);
    bool reset(const std::string& node, const std::string& param);
    bool add(const edit::NewNode& node);
    bool remove(const std::string& node);
    bool rename(const std::string& from, const std::string& to);
    /// Wires "node.port" to "node.port"; replaces an existing wire to that input, unless it takes events of many.
    bool connect(const std::string& from, const std::string& to, const std::string& mode = {});
    /// Removes the wire to that input; of several the one from `from`, or the first when none is given.
    bool disconnect(const std::string& to, const std::string& from = {});
    /// Takes a wire off one input and leads it to another, as one edit. How it is delivered stays where that is possible.
    bool reconnect(const std::string& from, const std::string& old_to, const std::string& to);
    /// The same at its source: the wire to `to` comes from another output.
    bool reconnect_source(const std::string& old_from, const std::string& from, const std::string& to);
    /// A line of the text, from 1; empty: there is none.
    std::string line(int number) const;
    /// Replaces a line of the text, or removes it where nothing is given.
    bool replace_line(int number, const std::optional<std::string>& by);
    /// Writes the proposed name in place of the wrong one.
    bool correct(const Fault& fault);
    /// Moves the saw's site to a point of the bone (scene, m), along the surface's normal, as one edit. Refused for a
    /// patch without a bone to saw.
    bool cut_at(const Vec3& site);
    /// The patch has a bone to saw.
    bool can_cut() const;
    bool undo();
    bool redo();
    /// Refused for a patch of the library; then sets `wants_name`.
    bool save();
    /// Saves as another file and continues with it. A relative name refers to the working folder.
    enum class Existing { refuse, replace };
    bool save_as(const std::string& name, Existing existing = Existing::refuse);
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
    /// Finds edits kept by earlier windows on this patch; for a new one, on patches that never were saved here.
    void find_kept_edits();
    /// A file of kept edits that can be restored or discarded.
    std::optional<std::filesystem::path> offer() const;
    /// Restores them as an edit; their file is removed when the patch is saved.
    bool restore_edits();
    void discard_offer();
    /// A later window offers it again.
    void postpone_offer();
    /// For a moving slider: changes the run but not the text.
    void turn(const std::string& node, const std::string& param, const std::string& value);

    /// Adds a node of a type to a lane: a group of the patch, or a rate. It may lack wires; what does not run yet. The
    /// first node of a hand adds a simulated device. `from`: an output that feeds its input `input`; where that is
    /// refused, the node has no wire. Returns its name; empty: refused.
    std::string add_node(const std::string& type, const std::string& lane,
                         std::optional<patch::PatchPlace> place = std::nullopt, const std::string& from = {},
                         const std::string& input = {}, const std::optional<NodeFile>& file = std::nullopt);
    /// Adds a patch file as a node. `lane`: for those of its nodes that have the rate of the outer patch. Returns its
    /// name; empty: refused.
    std::string add_part(const std::filesystem::path& file, const std::string& lane,
                         std::optional<patch::PatchPlace> place = std::nullopt);
    const std::string& last_added() const { return last_added_; }
    /// The lane that suits a type best: of what it was used with, or a usual rate.
    std::string lane_for(const std::string& type) const;
    /// A lane where a node was put, or that of `lane_for` where it cannot run there: signals need the rate of sound.
    std::string lane_for(const std::string& type, const std::string& wanted) const;
    /// Moves nodes to a group of the patch or to a rate, with places there, as one edit.
    bool move_to_lane(const std::vector<std::string>& nodes, const std::string& lane,
                      const std::map<std::string, patch::PatchPlace>& places = {});
    /// The node stands in the text with a rate or group of its own: not within a sub-patch, and no sub-patch whose nodes
    /// have their own.
    bool has_lane(const std::string& node) const;
    /// The ports of a node of the patch, or of one within a sub-patch; null: not known.
    const TypePorts* ports_of(const std::string& node) const;
    /// The parameter of a sub-patch, "part.level", that stands for one of a node within it; empty: none does.
    std::string offered_as(const std::string& node, const std::string& param) const;
    /// A free node name for the type.
    std::string free_name(const std::string& type) const;

    // Several nodes, as one edit each.
    bool remove(const std::vector<std::string>& nodes, const std::vector<std::string>& comments = {});
    bool place(const std::map<std::string, patch::PatchPlace>& places,
               const std::vector<patch::PatchComment>& comments = {});
    bool place_automatically(const std::vector<std::string>& nodes);
    bool colour(const std::vector<std::string>& nodes, const std::string& name);
    /// For a clipboard. `places`: of nodes that have none in the text. With nodes, comments stand in the lane of the first
    /// of these, by name: the lanes of another patch lie elsewhere.
    std::string copy(const std::vector<std::string>& nodes, const std::map<std::string, patch::PatchPlace>& places = {},
                     const std::vector<std::string>& comments = {}) const;
    /// The names that nodes and comments have here.
    struct Pasted {
        std::vector<std::string> nodes, comments;
    };
    /// Adds what `copy` gave, as one edit. Nothing: refused.
    Pasted paste(const std::string& copied, patch::PatchPlace by);
    /// Moves nodes into a file beside the patch, and puts a node of that patch in their place.
    bool make_sub_patch(const std::vector<std::string>& nodes, const std::string& name);
    bool open_sub_patch(const std::string& node, bool wanted);

    // Comments.
    bool comment(const patch::PatchComment& comment);
    bool remove_comment(const std::string& name);
    /// Adds one with a free name, and returns that; empty: refused.
    std::string add_comment(patch::PatchPlace place, const std::string& text);

    // Files and devices.
    /// Names a file as an asset, and lets a parameter of a node use it.
    bool use_file(const std::string& node, const std::string& param, const std::filesystem::path& file);
    /// Replaces the file of an asset.
    bool replace_asset(const std::string& asset, const std::filesystem::path& file);
    /// A file for a node: for `node` when it takes such files, else for one that lacks one, else in place of the only one of
    /// its kind. Where no node takes it, a sound and a bone bring a node along, `at` a place of the picture. Returns the node; empty:
    /// nothing takes it, and the reason is in `messages`.
    std::string take_file(const std::filesystem::path& file, const std::string& node,
                          std::optional<Point> at = std::nullopt);
    bool set_driver(const std::string& device, const std::string& driver);
    /// An empty value removes the setting.
    bool set_device(const std::string& device, const std::string& name, const std::string& value);
    bool keep_layout(const std::string& layout);
    /// Makes the force on the first hand audible, or no longer: nodes `force_tone` and `audio_output`, as one edit.
    bool hear_force(bool wanted);
    bool hears_force() const;
    /// The patch has a hand that gets forces.
    bool can_hear_force() const;

    /// Throws Error unless the saved file compiles to the shown plan.
    void check_saved();
    /// Why the wire is not possible; none: it is.
    std::optional<std::string> objection(const std::string& from, const std::string& to) const;

    // The run.
    void run();
    /// Ends the run and begins another one with this file for an asset. A file that the patch does not take leaves all as
    /// it is; the reason is in `messages`. A run that then cannot begin is followed by one with the file `otherwise`.
    void run_with(const std::string& asset, const std::filesystem::path& file,
                  const std::filesystem::path& otherwise = {});
    /// The run began with what the one before had written.
    bool goes_on() const { return goes_on_; }
    /// The hand of the patch can be moved by mouse and keys in place of the device that the patch names.
    bool can_take_hand() const;
    bool has_taken_hand() const { return !hand_settings_.empty(); }
    /// Lets the window move the hand, or the device of the patch again: an override of this and later runs, no edit.
    /// False: refused; the reason is in `messages`.
    bool use_hand_of_window(bool wanted);
    /// Does so, and the run begins again, at the next `tend` at which `is_settled` says that it may.
    void want_hand(bool wanted) { wanted_hand_ = wanted; }
    /// Whether all that was done in the run is in its files; told why not.
    std::function<bool()> is_settled;
    /// An asset and its file with which a new run begins: an opened plan as it is by then. Throws Error.
    std::function<std::optional<std::pair<std::string, std::filesystem::path>>()> asset_for_run;
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
    struct Ends {
        std::string from, to;
    };
    bool lead(const Ends& before, const Ends& now, const std::string& done);
    /// What a text means.
    struct Judged {
        patch::Patch written;
        Unfinished unfinished;
        std::string running;  ///< the text without what is unfinished
        std::unique_ptr<compile::Schedule> plan;
        std::vector<Fault> faults;
        /// The first error, as the command line reports it; none: there is no error.
        std::optional<std::string> problem() const;
    };
    Judged judge(std::string_view text) const;
    std::optional<std::string> check(std::string_view text);
    std::optional<std::string> refusal(std::string_view text);
    void tell_faults();
    void tell_unfinished();
    void adopt();
    void adopt_text();
    void follow();
    void change_hand();
    void begin_with_hand(bool of_window);
    void use_asset(const std::string& asset, const std::filesystem::path& file);
    void go_back();
    void take_over_file();
    void keep_beside(const std::string& text);
    EditedText edited() const;
    void look_at_file();
    bool has_same_parts();

    RunChoice choice_;
    compile::AssetCache assets_;
    std::unique_ptr<edit::PatchEditor> editor_;
    Judged checked_;
    std::shared_ptr<const compile::Schedule> plan_;
    std::shared_ptr<const compile::Schedule> followed_;  // the plan last applied to the run
    PatchPicture picture_;
    std::int64_t plan_version_ = 0;
    std::deque<Message> messages_;
    std::int64_t told_ = 0;
    patch::Patch written_;
    Unfinished unfinished_;
    patch::PatchWindow window_;
    std::string running_text_, last_added_;
    std::vector<Fault> faults_;
    bool was_never_saved_ = false;  // a new patch: a file of its name is another window's
    std::optional<bool> wanted_hand_;
    std::optional<std::pair<std::string, std::filesystem::path>> otherwise_;  // an asset and its file
    bool goes_on_ = false, next_goes_on_ = false;
    std::vector<std::string> hand_settings_;  // with which the window has taken the hand, among the overrides
    std::shared_ptr<observe::Observer> observer_;
    std::unique_ptr<ViewedRun> run_;
    std::filesystem::path last_take_;
    int runs_ = 0;
    bool has_take_ = false;  // the run was recorded at least in part
    std::vector<std::filesystem::path> offers_;
    KeptEdits kept_;
    std::int64_t dropped_version_ = -1;
    std::chrono::steady_clock::time_point looked_{};
    using WrittenAt = std::map<std::filesystem::path, std::filesystem::file_time_type>;
    WrittenAt written_at_;  // of the patch and its sub-patches, without a run
};

}  // namespace tactus::window
