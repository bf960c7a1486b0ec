// SPDX-License-Identifier: Apache-2.0
#include "tools/window/plan/flap_run.hpp"

#include "assets/file/json.hpp"
#include "assets/plan/plan_file.hpp"
#include "dsp/reconstruction/plate_line.hpp"
#include "tools/analysis/cutting_guide/kept_guide.hpp"
#include "tools/analysis/leaving.hpp"
#include "tools/analysis/plan/case_warnings.hpp"
#include "tools/analysis/plan/flap_study.hpp"
#include "tools/analysis/plan/flap_words.hpp"
#include "tools/analysis/plan/paddle_study.hpp"
#include "tools/analysis/plan/target_deviation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <system_error>
#include <utility>

namespace tactus::window {

namespace fs = std::filesystem;

namespace {

template <class T>
bool is_ready(const std::future<T>& work) {
    return work.valid() && work.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

FlapRun::Verdicts verdicts_of(const plan::CasePlan& plan, const fs::path& folder) {
    analysis::FlapStudy study(plan, plan::state_of(plan), folder);
    const reconstruction::FlapMeasures measures = study.measures();
    FlapRun::Verdicts verdicts;
    for (const reconstruction::SiteReach& reach : measures.reaches)
        verdicts.lines.push_back(analysis::reach_words(reach));
    std::vector<reconstruction::Clearance> near = measures.clearances;
    std::ranges::sort(near, {}, &reconstruction::Clearance::distance);
    for (const reconstruction::Clearance& c : near)
        verdicts.lines.push_back(fmt::format("{} to {}: {:.2f} mm", c.object, c.other, c.distance * 1e3));
    if (measures.tumour_margin)
        verdicts.lines.push_back(fmt::format("tumour to the nearest cut: {:.1f} mm", *measures.tumour_margin * 1e3));
    for (const analysis::NamedDeviation& one : analysis::deviation_from_target(plan, folder))
        verdicts.lines.push_back(analysis::deviation_words(one));
    for (const analysis::CaseWarning& warning : analysis::case_warnings(plan, folder).all)
        verdicts.warnings.push_back(warning.text);
    return verdicts;
}

}  // namespace

void FlapRun::tend(bool measures) {
    tend_change();
    if (measuring_.is_ready()) {
        try {
            Verdicts verdicts = measuring_.take();
            if (measured_ == of_) verdicts_ = std::move(verdicts);
        } catch (const std::exception& error) {
            verdicts_ = {};
            bench_.tell(error.what(), true);
        }
    }
    if (!run_.plan()) {
        now_.reset();
        of_ = measured_ = 0;
        return;
    }
    if (of_ != run_.version()) {
        of_ = run_.version();
        now_ = plan::state_of(*run_.plan()).reconstruction;
        verdicts_ = {};
        follow_plan();
    }
    // Nodes read the reconstruction when a run begins: a tumour's margin is a wall, a site holds a vessel's end.
    if (is_other_ && run_.is_live() && !run_.is_holding() && !is_changing()) {
        is_other_ = false;
        begin(nullptr);
    }
    if (!measures || measured_ == of_ || measuring_.is_busy()) return;
    measured_ = of_;
    if (now_)
        measuring_.begin(analysis::Lane::studies,
                         analysis::leaving([plan = *run_.plan(), folder = run_.file().parent_path()] {
                             return verdicts_of(plan, folder);
                         }));
}

/// Undo, redo and another alternative change the reconstruction within a run.
void FlapRun::follow_plan() {
    const std::string text = now_ ? reconstruction::json_of(*now_).dump() : std::string();
    if (std::exchange(began_in_, run_.file()) != run_.file()) began_with_ = text;
    is_other_ = text != began_with_;
}

void FlapRun::tend_change() {
    if (is_ready(changing_)) {
        try {
            changed_ = changing_.get();
            for (const std::string& warning : *warnings_) bench_.tell(warning, false);
        } catch (const std::exception& error) {
            bench_.tell(error.what(), true);
            was_refused_ = true;
        }
    }
    if (!waits_ || changing_.valid() || !run_.plan() || !run_.is_settled()) return;
    waits_ = false;
    make();
}

bool FlapRun::begin(WholeChange change) {
    if (!run_.plan() || is_changing() || !run_.may_begin_again()) return false;
    change_ = std::move(change);
    warnings_ = std::make_shared<std::vector<std::string>>();
    waits_ = true;
    was_live_ = run_.is_live();
    tend_change();
    return true;
}

void FlapRun::make() {
    made_of_ = run_.version();
    changing_ =
        std::async(std::launch::async, [plan = *run_.plan(), folder = run_.file().parent_path(), change = change_] {
            const fs::path file = free_plan(folder);
            plan::save_case_plan(plan, file);
            try {
                if (change) analysis::change_reconstruction(file, change);
            } catch (...) {
                std::error_code none;
                fs::remove(file, none);
                throw;
            }
            return file;
        });
}

bool FlapRun::change(Change change) {
    return begin(
        [change = std::move(change)](reconstruction::Reconstruction& all, const plan::CasePlan&) { change(all); });
}

bool FlapRun::lay_plate(const PlateChoice& choice) {
    return begin(
        [choice, folder = run_.file().parent_path()](reconstruction::Reconstruction& all, const plan::CasePlan& plan) {
            const analysis::FlapStudy study(plan, plan::state_of(plan), folder);
            reconstruction::PlateSettings settings;
            settings.screws_per_segment = choice.screws_per_segment;
            settings.screw_length = choice.screw_length;
            settings.height = choice.height;
        // What nobody is asked for stays as it is.
            for (const reconstruction::Plate& known : all.flap.plates)
                if (known.name == choice.of) {
                    settings.width = known.width;
                    settings.thickness = known.thickness;
                    if (!known.screws.empty()) settings.screw_diameter = known.screws.front().diameter;
                }
            reconstruction::Plate made = reconstruction::plate_on(study.inputs(), study.fibula(), settings);
            made.name = choice.name;
            put_named(all.flap.plates, choice.of, std::move(made));
        });
}

bool FlapRun::make_guide(reconstruction::KeptGuide guide, const std::string& of) {
    const auto warnings = std::make_shared<std::vector<std::string>>();
    const bool begins = begin([guide, of, warnings, folder = run_.file().parent_path()](
                                  reconstruction::Reconstruction& all, const plan::CasePlan& plan) {
        for (const reconstruction::KeptGuide& known : all.guides)
            if (known.name == guide.name && guide.name != of)
                throw Error(
                    fmt::format("there is a guide '{}' already: choose another name, or click it in the list "
                                "to make it again",
                                guide.name));
        reconstruction::KeptGuide made = guide;
        *warnings = analysis::make_kept_guide(made, plan, folder);
        put_named(all.guides, of, std::move(made));
    });
    if (begins) warnings_ = warnings;
    return begins;
}

bool FlapRun::lay_paddle(const PaddleChoice& choice) {
    return begin(
        [choice, folder = run_.file().parent_path()](reconstruction::Reconstruction& all, const plan::CasePlan& plan) {
            reconstruction::SkinPaddle paddle = all.flap.paddle.value_or(reconstruction::SkinPaddle{});
            if (choice.at) {
                paddle.at = *choice.at;
            } else {
                const analysis::FlapStudy study(plan, plan::state_of(plan), folder);
                paddle.at = analysis::default_paddle_place(study.inputs(), study.fibula(), study.flap());
            }
            paddle.length = choice.length, paddle.width = choice.width;
            (void)skin::paddle_in_leg(paddle, all.inputs);
            all.flap.paddle = paddle;
        });
}

bool FlapRun::remove_paddle() {
    return change([](reconstruction::Reconstruction& all) {
        if (!all.flap.paddle) throw Error("the plan has no skin paddle to remove");
        all.flap.paddle.reset();
    });
}

fs::path FlapRun::take_changed() {
    if (changed_.empty() || !run_.is_settled()) return {};
    fs::path made = std::exchange(changed_, {});
    const bool has_ended = was_live_ && !run_.is_live();
    if (!has_ended && run_.plan() && run_.version() == made_of_) return made;
    std::error_code none;
    fs::remove(made, none);
    if (!has_ended) waits_ = true;
    else if (change_)
        bench_.tell("the run has ended, and does not begin again with the change: make it once more", true);
    return {};
}

}  // namespace tactus::window
