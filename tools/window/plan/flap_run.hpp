// SPDX-License-Identifier: Apache-2.0
// The reconstruction of the plan of a run: what is measured of it beside the window, and changes of it. A change makes
// a plan with one more step, which a new run of the patch begins with; undo takes the step back. No user interface.
#pragma once

#include "assets/reconstruction/reconstruction.hpp"
#include "dsp/core/error.hpp"
#include "tools/analysis/beside.hpp"
#include "tools/window/document/case_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tactus::window {

class FlapRun {
public:
    using Change = std::function<void(reconstruction::Reconstruction&)>;

    FlapRun(Workbench& bench, CaseRun& run) : bench_(bench), run_(run) {}

    /// Once per picture: also goes on with a change. `measures`: somebody sees the verdicts, which take long.
    void tend(bool measures = true);
    /// Of the plan as it is now; null: it has none.
    const std::shared_ptr<const reconstruction::Reconstruction>& reconstruction() const { return now_; }

    /// Verdicts of the plan as it is now: reach of each vessel, clearances, margin; then warnings.
    struct Verdicts {
        std::vector<std::string> lines, warnings;
    };
    const Verdicts& verdicts() const { return verdicts_; }
    bool is_measuring() const { return measuring_.is_busy(); }
    /// A change waits for the steps before it, or is being made; another one is not begun meanwhile. It is made again when
    /// the plan had further steps by then, so that the run does not go on without them.
    bool is_changing() const { return waits_ || changing_.valid() || !changed_.empty(); }

    /// False: not now; the reason is in the messages.
    bool change(Change change);
    struct PlateChoice {
        std::string name;
        std::string of;  ///< the plate that is laid anew; empty: it is another one
        int screws_per_segment = 2;
        double screw_length = 12e-3, height = 0.0;  ///< m
    };
    /// Lays a plate on the segments and the stumps.
    bool lay_plate(const PlateChoice& choice);
    /// Makes a guide, which is kept in the plan; `of`: the one that it replaces, empty: it is another one. A guide that must
    /// not be printed changes nothing.
    bool make_guide(reconstruction::KeptGuide guide, const std::string& of = "");
    struct PaddleChoice {
        std::optional<Vec3> at;  ///< m, frame of the donor; none: at the perforators
        double length = 60e-3, width = 40e-3;  ///< m
    };
    bool lay_paddle(const PaddleChoice& choice);
    bool remove_paddle();
    /// Whether a change that had begun was refused since; the reason is in the messages. Taken once.
    bool take_refusal() { return std::exchange(was_refused_, false); }
    /// The plan with the change, once it is made and has all that the run has written; empty: none. Taken once.
    std::filesystem::path take_changed();

private:
    using WholeChange = std::function<void(reconstruction::Reconstruction&, const plan::CasePlan&)>;
    bool begin(WholeChange change);
    void make();
    void tend_change();
    void follow_plan();

    Workbench& bench_;
    CaseRun& run_;
    std::shared_ptr<const reconstruction::Reconstruction> now_;
    std::int64_t of_ = 0, measured_ = 0;  ///< versions of the plan
    analysis::Beside<Verdicts> measuring_;
    std::future<std::filesystem::path> changing_;  ///< writes a file: its end is waited for
    std::filesystem::path changed_;
    WholeChange change_;  ///< being made; null: the run is only to begin with its plan as it is
    /// What the change has to say once it is made; written by its thread.
    std::shared_ptr<const std::vector<std::string>> warnings_ = std::make_shared<std::vector<std::string>>();
    std::int64_t made_of_ = 0;
    std::filesystem::path began_in_;  ///< plan of the run whose nodes have read ...
    std::string began_with_;  ///< ... this reconstruction
    bool is_other_ = false;  ///< the plan has another one by now
    bool was_refused_ = false;
    bool waits_ = false, was_live_ = false;  ///< was_live: the run was there when the change was asked for
    Verdicts verdicts_;
};

/// Puts a thing into a list: in place of the one named `of`, or as another one where `of` is empty. Throws Error when its
/// name is that of yet another one.
template <class Named>
void put_named(std::vector<Named>& all, const std::string& of, Named one) {
    const auto find = [&](const std::string& name) { return std::ranges::find(all, name, &Named::name); };
    if (one.name != of && find(one.name) != all.end())
        throw Error(
            fmt::format("'{}' is there already; choose another name, or click it in the list to change it", one.name));
    if (const auto known = of.empty() ? all.end() : find(of); known != all.end()) *known = std::move(one);
    else all.push_back(std::move(one));
}

}  // namespace tactus::window
