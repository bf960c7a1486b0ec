// SPDX-License-Identifier: Apache-2.0
// The reconstruction of the plan of a run: what is measured of it beside the window, and changes of it. A change makes
// a plan with one more step, which a new run of the patch begins with; undo takes the step back. No user interface.
#pragma once

#include "assets/reconstruct/reconstruction.hpp"
#include "tools/study/beside.hpp"
#include "tools/view/plan/case_run.hpp"

#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <string>
#include <vector>

namespace tactus::view {

class FlapRun {
public:
    using Change = std::function<void(reconstruct::Reconstruction&)>;

    FlapRun(Workbench& bench, CaseRun& run) : bench_(bench), run_(run) {}

    /// Once per picture: also goes on with a change. `measures`: somebody sees the verdicts, which take long.
    void tend(bool measures = true);
    /// Of the plan as it is now; null: it has none.
    const std::shared_ptr<const reconstruct::Reconstruction>& reconstruction() const { return now_; }

    /// Verdicts of the plan as it is now: reach of each vessel, clearances, margin; then warnings.
    struct Verdicts {
        std::vector<std::string> lines, warnings;
    };
    const Verdicts& verdicts() const { return verdicts_; }
    bool is_measuring() const { return measuring_.is_busy(); }
    /// A change waits for the steps before it, or is being made; another one is not begun meanwhile. It is made again when
    /// the plan had further steps by then, so that the run does not go on without them.
    bool is_changing() const { return waits_ || changing_.valid() || !changed_.empty(); }

    void change(Change change);
    /// Lays a plate on the segments and the stumps; one of that name is replaced. m.
    void lay_plate(const std::string& name, int screws_per_segment, double screw_length, double height);
    /// The plan with the change, once it is made and has all that the run has written; empty: none. Taken once.
    std::filesystem::path take_changed();

private:
    using WholeChange = std::function<void(reconstruct::Reconstruction&, const cases::CasePlan&)>;
    void begin(WholeChange change);
    void make();
    void tend_change();

    Workbench& bench_;
    CaseRun& run_;
    std::shared_ptr<const reconstruct::Reconstruction> now_;
    std::filesystem::file_time_type of_{}, measured_{};
    study::Beside<Verdicts> measuring_;
    std::future<std::filesystem::path> changing_;  ///< writes a file: its end is waited for
    std::filesystem::path changed_;
    WholeChange change_;  ///< being made
    std::filesystem::file_time_type made_of_{};
    bool waits_ = false, was_live_ = false;  ///< was_live: the run was there when the change was asked for
    Verdicts verdicts_;
};

/// Puts a thing into a list by its name: replaces the one of that name, or adds it.
template <class Named>
void put_named(std::vector<Named>& all, Named one) {
    for (Named& known : all)
        if (known.name == one.name) {
            known = std::move(one);
            return;
        }
    all.push_back(std::move(one));
}

}  // namespace tactus::view
