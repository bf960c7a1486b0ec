// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/training/score.hpp"

#include "assets/bone/content_hash.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/table/number_table.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/training/attempt_row.hpp"
#include "tools/run/replayed_take.hpp"
#include "tools/run/results.hpp"
#include "tools/run/scratch_folder.hpp"
#include "tools/run/summary.hpp"
#include "tools/run/task_summary.hpp"
#include "tools/run/training_session.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <thread>

namespace tactus::analysis {

namespace fs = std::filesystem;

namespace {

/// The bone that was cut: the one of the run that has the samples of the task's.
bone::Bone bone_after(const fs::path& folder, const bone::Bone& before, bool refined) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.path().extension() == ".vdb") files.push_back(entry.path());
    std::ranges::sort(files);
    if (files.empty()) throw Error(fmt::format("{}: the run has written no bone", folder.string()));
    for (const fs::path& file : files) {
        bone::Bone bone = bone::load_bone(file);
        const volume::Grid &a = before.distance, &b = bone.distance;
        if (a.size == b.size && a.origin == b.origin && a.spacing == b.spacing) return bone;
    }
    if (refined)
        throw Error(
            fmt::format("{}: the bone was too coarse for the kerf and was resampled around the site, so its cut "
                        "cannot be compared; import the task's bone with a finer --spacing and cut again",
                        folder.string()));
    throw Error(fmt::format("{}: the run has no bone on the grid of the task's", folder.string()));
}

/// By content, not by name: the bone that the run began with, or a file of the same name that holds another one.
void check_same_bone(const run::TaskSummary& said, const ScoredRun& run, const fs::path& folder) {
    const std::string wanted = bone::content_hash(run.before);
    if (std::ranges::find(said.bones, wanted) != said.bones.end()) return;
    if (said.bones.empty())
        throw Error(
            fmt::format("{}: the run does not say which bone it cut; score its take, or cut again", folder.string()));
    throw Error(fmt::format("{}: the run cut another bone than the task's: {}, not {} of {}", folder.string(),
                            fmt::join(said.bones, ", "), wanted, run.task.bone.string()));
}

struct Record {
    std::vector<training::AttemptSample> samples;
    std::optional<double> heat;
    std::vector<double> heats;  ///< s, at each sample; below 0: unknown
    bool has_removed = false;
};

Record record_of(const fs::path& file) {
    const table::NumberTable table = table::load_number_table(file);
    std::vector<std::vector<double>> columns;
    for (const std::string_view name : training::attempt_column_names) columns.push_back(table.numbers(name));
    const std::vector<double> times = table.numbers("t_s");
    Record record;
    record.samples.reserve(times.size());
    for (std::size_t n = 0; n < times.size(); ++n) {
        training::AttemptSample s;
        s.time = times[n];
        s.pose.position = {columns[0][n], columns[1][n], columns[2][n]};
        s.pose.orientation = Quat(columns[3][n], columns[4][n], columns[5][n], columns[6][n]);
        s.force = {columns[7][n], columns[8][n], columns[9][n]};
        s.contact = columns[10][n] > 0.5;
        if (!is_valid(s.pose) || !is_finite(s.force) || (n > 0 && !(s.time > times[n - 1])))
            throw Error({file.string(), table.lines[n], 1}, "this row is no sample of an attempt");
        s.pose.orientation = glm::normalize(s.pose.orientation);
        record.samples.push_back(s);
    }
    if (record.samples.empty()) throw Error(fmt::format("{}: has no samples", file.string()));
    record.heats = columns[12];
    // Below 0: no wire said.
    if (columns[12].back() >= 0.0) record.heat = columns[12].back();
    return record;
}

/// Repeats a take and writes its results.
void repeat_take(const fs::path& folder, const fs::path& out) {
    take::Take take = take::Take::load(folder);
    if (const std::vector<std::string> changed = take.changed_assets(); !changed.empty())
        throw Error(fmt::format("{}; the take cannot be repeated, so it cannot be scored", changed.front()));
    take.drop_unreadable_streams();
    compile::AssetCache assets;
    run::EngineOptions options;
    options.seconds = take.about.seconds;
    options.folder = out;
    run::ReplayedTake repeated(take, options, assets);
    run::Engine& engine = repeated.engine();
    engine.render(static_cast<int>(std::max(1u, std::thread::hardware_concurrency())), [](double) {});
    engine.complete();
    const Report report = engine.report();
    const run::WrittenFiles written = run::write_results(report, out, false);
    std::vector<std::string> losses = engine.losses();
    losses.insert(losses.end(), written.losses.begin(), written.losses.end());
    if (!losses.empty()) throw Error(losses.front());
    file::write_whole_file(out / "summary.json",
                           run::summary_json(engine, report, engine.progress_seconds(), false, written.names, losses));
}

training::Task task_of(const run::TaskSummary& said, const fs::path& instead, const fs::path& folder) {
    if (!instead.empty()) return training::load_task(instead);
    const fs::path file = said.file;
    if (!fs::exists(file))
        throw Error(fmt::format("{}: the task {} is gone; name it with --task", folder.string(), file.string()));
    training::Task task = training::load_task(file);
    if (fmt::format("{:016x}", task.hash) != said.hash)
        throw Error(fmt::format("{}: the task {} has changed since; score with --task to use it as it is now",
                                folder.string(), file.string()));
    return task;
}

std::vector<SparedScore> spared_of(const ScoredRun& run) {
    std::vector<SparedScore> all;
    for (const training::SparedStructure& structure : run.task.spared) {
        training::Injury injury(structure, run.task.blade);
        for (const training::AttemptSample& s : run.samples) injury.move_to(s.pose);
        all.push_back({structure.name, injury.injured_m3() * 1e9, std::max(0.0, injury.closest()) * 1e3});
    }
    return all;
}

/// How long each warning stood, with the forces on the hand as recorded.
std::array<double, training::warning_count> warning_times(const training::Task& task, const Record& record) {
    std::array<double, training::warning_count> times{};
    const auto& samples = record.samples;
    std::optional<double> touched;
    for (std::size_t n = 0; n < samples.size(); ++n) {
        const training::AttemptSample& s = samples[n];
        if (s.contact && !touched) touched = s.time;
        training::AttemptState now;
        const training::PlannedCut& cut = task.cuts[training::nearest_cut(task.cuts, s.pose)];
        now.deviation = training::deviation_of(cut, task.blade, s.pose);
        for (const training::SparedStructure& spared : task.spared)
            now.margin_left =
                std::min(now.margin_left, training::clearance_of(spared, task.blade, s.pose) - spared.margin);
        now.hand_N = glm::length(s.force);
        now.elapsed_s = touched ? s.time - *touched : 0.0;
        now.heat_s = record.heats[n];
        const auto stands = training::warnings_of(task, cut, now);
        const double step = n + 1 < samples.size() ? samples[n + 1].time - s.time
                            : n > 0                ? s.time - samples[n - 1].time
                                                   : 0.0;
        for (std::size_t w = 0; w < times.size(); ++w)
            if (stands[w]) times[w] += step;
    }
    return times;
}

using Stretches = std::vector<std::span<const training::AttemptSample>>;

/// The stretches of a run in which the blade was at each cut, without gaps.
std::vector<Stretches> by_cut(const ScoredRun& run) {
    std::vector<Stretches> stretches(run.task.cuts.size());
    const std::span<const training::AttemptSample> all = run.samples;
    for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end) {
        const std::size_t cut = training::nearest_cut(run.task.cuts, all[begin].pose);
        while (end < all.size() && training::nearest_cut(run.task.cuts, all[end].pose) == cut) ++end;
        stretches[cut].push_back(all.subspan(begin, end - begin));
    }
    return stretches;
}

CutScore score_cut(ScoredRun& run, const training::PlannedCut& cut, const training::CutBone& bone,
                   const Stretches& stretches) {
    const training::BladeSize& blade = run.task.blade;
    CutScore score;
    score.name = cut.name;
    const training::CutVolumes volumes = training::cut_volumes(bone, cut, blade.kerf);
    score.over_mm3 = volumes.over_m3 * 1e9;
    score.under_mm3 = volumes.under_m3 * 1e9;
    run.removed_mm3 += volumes.removed_m3 * 1e9;
    const auto plane = training::fit_cut_plane(bone, cut, blade.kerf);
    run.planes.push_back(plane);
    run.severances.emplace_back();
    if (!plane) return score;
    score.rms_mm = plane->rms * 1e3;
    score.max_mm = plane->max * 1e3;
    if (plane->angle) score.angle_deg = *plane->angle / degree;
    run.severances.back() = training::severance_of(bone, cut, *plane, 0.5 * (blade.length + blade.stroke));
    if (!run.severances.back().severed) return score;
    for (const auto& stretch : stretches)
        if (const auto through = training::breakthrough_of(stretch, cut, blade, run.severances.back())) {
            score.breakthrough_mm = through->depth * 1e3;
            score.breakthrough_mm_per_s = through->speed * 1e3;
            break;
        }
    return score;
}

/// Every cut by itself, and all of them together.
void score_cuts(ScoredRun& run) {
    const std::vector<training::PlannedCut>& cuts = run.task.cuts;
    const training::CutBone bone{run.before.distance, run.after.distance};
    const auto stretches = by_cut(run);
    Score& all = run.score;
    const auto greatest = [](std::optional<double>& to, const std::optional<double>& one) {
        if (one) to = std::max(to.value_or(*one), *one);
    };
    double squares = 0.0, points = 0.0, jerk = 0.0, jerks = 0.0;
    for (std::size_t n = 0; n < cuts.size(); ++n) {
        const volume::Grid after = training::after_one_cut(bone, cuts, n);
        const CutScore one = score_cut(run, cuts[n], {run.before.distance, after}, stretches[n]);
        all.over_mm3 += one.over_mm3;
        all.under_mm3 += one.under_mm3;
        greatest(all.max_mm, one.max_mm);
        greatest(all.angle_deg, one.angle_deg);
        greatest(all.breakthrough_mm, one.breakthrough_mm);
        greatest(all.breakthrough_mm_per_s, one.breakthrough_mm_per_s);
        if (one.rms_mm) {
            const auto count = static_cast<double>(run.planes[n]->points.size());
            squares += count * *one.rms_mm * *one.rms_mm;
            points += count;
        }
        all.cuts.push_back(one);
        if (cuts.size() == 1) continue;
        for (const auto& stretch : stretches[n]) {
            const training::MotionMeasures motion =
                training::motion_of(stretch, cuts[n], std::numeric_limits<double>::infinity());
            all.strokes += motion.strokes;
            // A longer stretch counts for more.
            if (motion.jerk) jerk += motion.contact * *motion.jerk, jerks += motion.contact;
        }
    }
    if (points > 0.0) all.rms_mm = cuts.size() == 1 ? all.cuts.front().rms_mm : std::sqrt(squares / points);
    if (jerks > 0.0) all.jerk = jerk / jerks;
}

/// A folder of sessions, DIR of 'tactus session' or DIR/PSEUDONYM, is none itself.
void refuse_many_sessions(const fs::path& folder) {
    if (!fs::is_directory(folder) || fs::exists(folder / "summary.json") || fs::exists(folder / "take.json")) return;
    std::vector<std::string> found;
    for (auto at = fs::recursive_directory_iterator(folder); at != fs::recursive_directory_iterator(); ++at) {
        if (at.depth() >= 1) at.disable_recursion_pending();
        if (at->is_directory() && run::is_training_session(at->path())) found.push_back(at->path().string());
    }
    if (found.empty()) return;
    std::ranges::sort(found);
    throw Error(fmt::format("{}: holds sessions; name those to score: {}", folder.string(), fmt::join(found, " ")));
}

}  // namespace

std::vector<fs::path> attempts_in(const fs::path& folder) {
    if (!run::is_training_session(folder)) {
        refuse_many_sessions(folder);
        return {folder};
    }
    std::vector<fs::path> all = run::completed_attempts(folder);
    if (all.empty()) throw Error(fmt::format("{}: no attempt of this session was completed", folder.string()));
    return all;
}

ScoredRun score_run(const fs::path& folder, const fs::path& task) {
    if (!fs::is_directory(folder)) throw Error(fmt::format("{}: there is no such folder", folder.string()));
    if (fs::exists(folder / "run" / "summary.json")) {
        ScoredRun run = score_run(folder / "run", task);
        run.name = folder.string();
        run.trainee = run::trainee_of_attempt(folder);
        return run;
    }
    if (fs::exists(folder / "take.json")) {
        const run::ScratchFolder scratch;
        repeat_take(folder, scratch.path());
        ScoredRun run = score_run(scratch.path(), task);
        run.name = folder.string();
        return run;
    }
    const run::TaskSummary said = run::read_task_summary(folder);
    ScoredRun run;
    run.name = folder.string();
    run.task = task_of(said, task, folder);
    run.before = bone::load_bone(run.task.bone);
    check_same_bone(said, run, folder);
    run.after = bone_after(folder, run.before, said.refined);
    const std::string& record_name = said.record;
    if (record_name.empty() || fs::path(record_name).has_parent_path())
        throw Error(fmt::format("{}: the run has no record of its attempt", folder.string()));
    Record record = record_of(folder / record_name);
    run.score.warnings_s = warning_times(run.task, record);
    run.samples = std::move(record.samples);
    run.score.device_scale = said.device_scale;
    run.score.limited = said.limited;
    for (training::AttemptSample& s : run.samples) s.force /= said.device_scale;

    Score& score = run.score;
    score_cuts(run);
    score.spared = spared_of(run);
    const training::MotionMeasures motion = training::motion_of(
        run.samples, run.task.cuts.front(), run.task.limits.force.value_or(std::numeric_limits<double>::infinity()));
    score.mean_N = motion.mean_force;
    score.contact_s = motion.contact;
    score.over_limit_Ns = motion.over_limit;
    if (said.has_force && motion.contact > 0.0) score.shown_share = 1.0 - motion.without_force / motion.contact;
    if (run.task.cuts.size() == 1) {
        score.jerk = motion.jerk;
        score.strokes = motion.strokes;
    }
    score.seconds = motion.end - motion.begin;
    score.path_mm = motion.path * 1e3;
    score.heat_s = record.heat;
    run.max_N = motion.max_force;
    return run;
}

}  // namespace tactus::analysis
