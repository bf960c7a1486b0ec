// SPDX-License-Identifier: Apache-2.0
#include "tools/window/view.hpp"

#include "assets/plan/plan_file.hpp"
#include "devices/haptic/window_hand.hpp"
#include "dsp/core/error.hpp"
#include "tools/exit_code.hpp"
#include "tools/terminal.hpp"
#include "tools/window/desk/desk.hpp"
#include "tools/window/frame/picture_meter.hpp"
#include "tools/window/script.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <functional>
#include <optional>
#include <thread>
#include <utility>

namespace tactus::window {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

namespace {

// Limits the frame rate, also when vertical sync does not.
constexpr auto picture_time = std::chrono::microseconds(16'667);

/// Before a window is opened. Throws Error.
void check(const ViewChoice& view) {
    if (view.scan.empty()) return;
    const std::string scan = view.scan.string();
    if (!fs::exists(view.scan)) throw Error(fmt::format("--scan: there is no {}", scan));
    if (!is_ct(view.scan))
        throw Error(fmt::format("--scan: {} is no scan; give a CT: .nrrd, .nii, a folder of DICOM", scan));
}

/// The patch in which a plan is shown and changed.
RunChoice run_of_plan(RunChoice choice, const fs::path& plan) {
    const bool is_reconstruction = plan::state_of(plan::load_case_plan(plan)).reconstruction != nullptr;
    choice.patch = is_reconstruction ? "planning-reconstruction" : "planning-trauma";
    choice.overrides.assets = {"case=" + fs::absolute(plan).string()};
    return choice;
}

/// The window and its content.
class Viewer {
public:
    Viewer(const ViewChoice& view, const std::atomic<bool>& interrupted)
        : view_(view),
          interrupted_(interrupted),
          window_("Tactus", view.width, view.height, view.scale),
          layout_(view.layout),
          scan_(view.scan) {
        ++haptic::window_hand().windows;
        if (!view.script.empty()) {
            script_.emplace(view.script);
            script_->open = [this](const std::string& what) {
                wanted_.open = what;
                is_wanted_by_script_ = true;
            };
        }
    }

    ~Viewer() {
        keep_edits();
        --haptic::window_hand().windows;
    }
    Viewer(const Viewer&) = delete;
    Viewer& operator=(const Viewer&) = delete;

    /// `plan`: that the patch is opened for. What is open stays until the new one is read. Throws Error.
    void open_patch(const RunChoice& choice, const fs::path& plan = {}) {
        RunChoice next = choice;
        // An earlier run in this window may have left results in the folder.
        next.is_further = has_opened_;
        auto bench = std::make_unique<Workbench>(next);
        auto document = plan.empty() ? nullptr : std::make_unique<PlanDocument>(plan);
        close();
        has_opened_ = true;
        choice_ = std::move(next);
        plan_ = std::move(document);
        bench_ = std::move(bench);
        bench_->find_kept_edits();
        memory_.opened(plan.empty() ? bench_->editor().file() : plan);
        set_up();
    }

    void open_untitled() {
        RunChoice next = choice_;
        next.is_further = has_opened_;
        auto bench = Workbench::untitled(next);
        close();
        has_opened_ = true;
        plan_.reset();
        bench_ = std::move(bench);
        bench_->find_kept_edits();
        set_up();
    }
    void open_start_page() {
        open_untitled();
        desk_->open_start_page();
    }

    void open_take(const fs::path& folder) {
        auto take = std::make_unique<TakeBench>(folder);
        auto bench = std::make_unique<Workbench>(choice_of(take->take()));
        if (bench_ && !take_) {
            // The patch as it is called and as it was changed by now.
            behind_.reset();
            const PlanDocument* const plan = desk_->plan_document();
            if (!bench_->is_untitled()) behind_ = Behind{bench_->choice(), plan ? plan->file() : fs::path()};
        }
        close();
        plan_.reset();
        take_ = std::move(take);
        bench_ = std::move(bench);
        bench_->has_patch_behind = behind_.has_value();
        memory_.opened(folder);
        set_up();
    }

    Workbench& bench() { return *bench_; }

    /// Runs until the window closes. True: continue the run without it.
    bool show() {
        for (;;) {
            const auto begin = Clock::now();
            if (interrupted_) return false;
            const bool has_picture = window_.begin();
            if (window_.take_left()) desk_->scene().hand().let_go();
            if (has_picture) {
                if (script_) script_->move_mouse();
                desk_->draw();
                window_.end();
                desk_->scene().hand().end_picture();
            } else {
                desk_->rest();
                desk_->scene().hand().begin_picture();
                desk_->scene().hand().end_picture();
            }
            if (script_) script_->step(*desk_, window_);
            for (const std::string& file : window_.take_dropped()) desk_->take_dropped(file);
            if (desk_->wishes.any()) wish(std::exchange(desk_->wishes, {}));
            if (wanted_.any()) open_wanted();
            if (std::exchange(bench_->wants_take, false)) attempt([&] { open_take(fs::path(bench_->take())); });
            if (std::exchange(bench_->wants_patch, false) && behind_)
                attempt([&] {
                    const Behind behind = *behind_;
                    open_patch(behind.choice, behind.plan);
                });
            if (view_.meter) view_.meter->add(desk_->scene().pictures());
            if (const std::optional<bool> goes_on = farewell()) return *goes_on;
            std::this_thread::sleep_until(begin + picture_time);
        }
    }

private:
    /// Called on every way out of a patch. The patch of a take is read-only.
    void keep_edits() noexcept {
        if (!bench_ || take_) return;
        try {
            if (desk_) desk_->end_typing();
        } catch (const std::exception&) {
            // What was edited before is kept.
        }
        bench_->keep_edits();
        if (desk_) desk_->keep_plan();
    }

    void close() {
        keep_edits();
        desk_.reset();
        bench_.reset();
        take_.reset();
    }

    void set_up() {
        desk_ = std::make_unique<Desk>(window_, *bench_, take_.get(), memory_);
        if (plan_) {
            plan_->find_kept();
            desk_->open_plan(std::move(plan_));
        }
        desk_->show_title();
        std::optional<Layout> layout;
        // Given for what is opened first; others have their own.
        if (!bench_->is_untitled()) layout = layout_of_name(std::exchange(layout_, {}));
        if (!layout) layout = memory_.layout_of(desk_->opened_file());
        if (!layout) layout = layout_of_name(bench_->window().layout);
        desk_->layout = layout.value_or(Layout::patch);
        desk_->scene().use(view_.sight);
        if (!scan_.empty()) desk_->slices().open(scan_);
        if (view_.reference.empty()) return;
        desk_->scopes().set_reference(view_.reference);
    }

    /// Asks first when edits or a run would be left behind.
    void wish(DeskWishes wishes) {
        desk_->end_typing();
        if (wishes.start_page) return desk_->open_start_page();
        asked_ = std::move(wishes);
        is_leaving_ = true;
    }

    /// Brings what waits in a pause into the plan before the person is asked what becomes of it. True: not done yet.
    bool must_wait_to_leave() {
        is_closing_ = is_closing_ || window_.wants_to_close();
        if (!is_closing_ && !is_leaving_) return false;
        if (!take_ && desk_->brings_what_waits()) {
            window_.keep_open();
            return true;
        }
        if (std::exchange(is_closing_, false)) window_.close();
        if (std::exchange(is_leaving_, false)) {
            using Leaving = Questions::Leaving;
            const bool asks = !take_ && desk_->questions.has_unsaved();
            desk_->questions.leaving = asks ? Leaving::asks : Leaving::leaves;
        }
        return false;
    }

    /// Opens something; where that fails, what was open stays.
    void attempt(const std::function<void()>& open) {
        try {
            open();
        } catch (const std::exception& error) {
            // A script says where it fails; a person reads it in the window.
            if (std::exchange(is_wanted_by_script_, false)) throw;
            if (!desk_) open_start_page();
            // Who did not want to save goes on with what is there: the next way out asks again.
            desk_->questions.want_all();
            bench_->tell(error.what(), true);
        }
    }

    void open_wanted() {
        const DeskWishes wanted = std::exchange(wanted_, {});
        attempt([&] {
            if (bench_ && !bench_->editor().file().empty()) scan_.clear();
            if (wanted.new_patch) return open_untitled();
            // Throws also where a folder cannot be searched.
            if (fs::exists(wanted.open / "take.json")) return open_take(wanted.open);
            RunChoice choice = choice_;
            choice.overrides = {};
            choice.record.clear();
            if (kind_of_file(wanted.open) == FileKind::plan)
                return open_patch(run_of_plan(choice, wanted.open), wanted.open);
            choice.patch = wanted.open.string();
            open_patch(choice);
        });
        is_wanted_by_script_ = false;
    }

    /// True when the run continues after the window closes.
    std::optional<bool> farewell() {
        using Farewell = Desk::Farewell;
        if (window_.wants_to_close()) desk_->end_typing();
        const bool runs = bench_->running() && !bench_->running()->is_over();
        // A run of limited length closes the window at its end; a script is run to its end.
        if (choice_.seconds && bench_->running() && !runs && (!script_ || script_->is_done())) return false;
        if (script_ && script_->wants_to_close()) return view_.keep_running;
        if (must_wait_to_leave()) return std::nullopt;
        using Leaving = Questions::Leaving;
        Questions& questions = desk_->questions;
        if (questions.leaving == Leaving::none && desk_->farewell == Farewell::none) asked_ = {};
        if (asked_.any() && (questions.leaving == Leaving::leaves || desk_->farewell == Farewell::ends)) {
            questions.leaving = Leaving::none;
            if (runs && desk_->farewell != Farewell::ends) {
                desk_->farewell_is_of_window = false;
                desk_->farewell = Farewell::asks;
            } else {
                desk_->farewell = Farewell::none;
                wanted_ = std::exchange(asked_, {});
            }
        } else if (questions.leaving == Leaving::leaves) window_.close();
        else if (window_.wants_to_close() && !take_ && questions.has_unsaved()) {
            window_.keep_open();
            questions.leaving = Leaving::asks;
        }
        if (window_.wants_to_close()) {
            questions.leaving = Leaving::none;
            if (!runs) return false;
            if (view_.keep_running) return true;
            window_.keep_open();
            asked_ = {};
            desk_->farewell_is_of_window = true;
            desk_->farewell = Farewell::asks;
        }
        if (desk_->farewell == Farewell::goes_on) return true;
        if (desk_->farewell == Farewell::ends) return false;
        return std::nullopt;
    }

    /// The patch to which a take leads back.
    struct Behind {
        RunChoice choice;
        fs::path plan;
    };

    const ViewChoice& view_;
    const std::atomic<bool>& interrupted_;
    Window window_;
    RunChoice choice_;
    std::string layout_;
    std::unique_ptr<PlanDocument> plan_;  ///< that the patch was opened for, until the desk has it
    std::optional<Behind> behind_;
    std::optional<Script> script_;
    std::unique_ptr<TakeBench> take_;
    std::unique_ptr<Workbench> bench_;
    std::unique_ptr<Desk> desk_;
    bool is_wanted_by_script_ = false;
    bool is_closing_ = false, is_leaving_ = false;  ///< for what is asked, once all steps are in the plan
    DeskWishes wanted_, asked_;  ///< asked: waits for what becomes of unsaved edits
    WindowMemory memory_;
    fs::path scan_;  ///< given for what is opened first; another case has another one
    bool has_opened_ = false;

public:
    /// Closes the window but keeps the bench with its run.
    std::unique_ptr<Workbench> let_go() {
        keep_edits();
        desk_.reset();
        return std::move(bench_);
    }
};

}  // namespace

int view_run(const ViewedRunChoice& choice, const std::atomic<bool>& interrupted) {
    check(choice.view);
    std::unique_ptr<Workbench> bench;
    bool goes_on = false;
    {
        Viewer viewer(choice.view, interrupted);
        viewer.open_patch(choice);
        viewer.bench().run();
        goes_on = viewer.show();
        bench = viewer.let_go();
    }
    ViewedRun* const run = bench->running();
    if (!run) return done;
    if (goes_on && !choice.json) say(stderr, "the window is closed; the patch keeps running, Ctrl-C ends it\n");
    while (!run->is_over()) {
        if (!goes_on || interrupted) run->stop();
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    if (const std::string failure = bench->status()->failure; !failure.empty()) throw Error(failure);
    for (const std::string& loss : run->losses()) say(stderr, fmt::format("tactus: {}\n", loss));
    say(stdout, choice.json ? run->summary_json() : run->summary_text());
    return run->losses().empty() ? done : output_lost;
}

void watch_run(const ViewedRunChoice& choice, const std::atomic<bool>& interrupted) {
    check(choice.view);
    Viewer viewer(choice.view, interrupted);
    viewer.open_patch(choice);
    viewer.bench().run();
    viewer.show();
    const std::unique_ptr<Workbench> bench = viewer.let_go();
    while (!bench->running()->is_over()) {
        bench->running()->stop();
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    if (const std::string failure = bench->status()->failure; !failure.empty()) throw Error(failure);
}

int view_file(const FileViewChoice& choice, const std::atomic<bool>& interrupted) {
    check(choice.view);
    const bool is_plan = kind_of_file(choice.file) == FileKind::plan;
    RunChoice patch;
    if (is_plan) patch = run_of_plan(patch, choice.file);
    else patch.patch = choice.file.string();
    Viewer viewer(choice.view, interrupted);
    if (choice.file.empty()) viewer.open_start_page();
    else if (fs::is_directory(choice.file)) viewer.open_take(choice.file);
    else viewer.open_patch(patch, is_plan ? choice.file : fs::path());
    viewer.show();
    return done;
}

}  // namespace tactus::window
