// SPDX-License-Identifier: Apache-2.0
// Where a fragment of a plan fits: searched beside the window. No user interface.
#pragma once

#include "assets/plan/plan_command.hpp"
#include "dsp/fit/arrangement/arrangement.hpp"
#include "tools/analysis/beside.hpp"
#include "tools/analysis/plan/plan_matching.hpp"

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tactus::window {

/// A pose at which faces of a fragment fit, more or less, those of another one.
struct FitCandidate {
    plan::SettleFragment step;  ///< that puts the fragment there
    fit::FitVerdict verdict = fit::FitVerdict::no_match;
    std::string words;  ///< verdict and numbers, and why it is not certain
    bool fits() const { return verdict == fit::FitVerdict::fit; }
    /// A pose that a person may choose, although nothing vouches for it.
    bool is_possible() const { return fits() || verdict == fit::FitVerdict::uncertain; }
};

class FragmentFits {
public:
    struct Found {
        int fragment = -1;
        std::shared_ptr<const plan::CasePlan> plan;  ///< in which it was searched
        std::vector<FitCandidate> candidates;  ///< the best one first, each with another partner or at another place
        std::string reason;  ///< why there is no candidate
    };

    /// Searches from where the fragment is, then from anywhere, and beside every other fragment. Paths in the plan are
    /// absolute.
    void search(const std::shared_ptr<const plan::CasePlan>& plan, int fragment);
    bool is_searching() const { return searching_.is_busy(); }
    /// Fraction of the search that is done, 0 to 1.
    double progress() const { return shared_->progress.load(); }
    void cancel() { searching_.let_go(); }
    /// The result, once.
    std::optional<Found> take();

    /// Looks for a fit near to where a fragment is now: for one that is being dragged. Ignored while the last call still
    /// looks.
    void look_near(const std::shared_ptr<const plan::CasePlan>& plan, const fit::Arrangement& now, int fragment);
    /// The fit that was found last for this fragment; null: none. Becomes invalid with `forget_near`.
    const FitCandidate* near(int fragment);
    void forget_near();
    /// The last error of `look_near`, once; empty: none.
    std::string take_problem() { return std::exchange(problem_, {}); }

private:
    /// Fragments and matcher of the last plan, on the thread that searches: making them takes longer than a search.
    struct Shared {
        std::unique_ptr<analysis::PlanMatching> matching;
        std::string files;
        std::atomic<double> progress{0.0};
        analysis::PlanMatching& of(const plan::CasePlan& plan);
    };

    std::shared_ptr<Shared> shared_ = std::make_shared<Shared>();
    analysis::Beside<Found> searching_;
    analysis::Beside<std::optional<FitCandidate>> looking_;
    std::optional<FitCandidate> near_;
    std::string problem_;
};

}  // namespace tactus::window
