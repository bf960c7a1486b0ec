// SPDX-License-Identifier: Apache-2.0
// tactus segment: separates the fragments of a scan by random walks from painted seeds.
#include "assets/bone/bone.hpp"
#include "assets/bone/import_steps.hpp"
#include "assets/bone/labels.hpp"
#include "assets/file/json.hpp"
#include "assets/file/outputs.hpp"
#include "assets/volume/length_unit.hpp"
#include "assets/volume/write_volume.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/readable.hpp"
#include "tools/analysis/segmentation/segment_files.hpp"
#include "tools/analysis/workers.hpp"
#include "tools/command/bone/scan_options.hpp"
#include "tools/command/options.hpp"
#include "tools/exit_code.hpp"
#include "tools/report/bone/scan_result.hpp"
#include "tools/report/result/printers.hpp"
#include "tools/run/patch_choice.hpp"
#include "tools/run/stop_signals.hpp"
#include "tools/terminal.hpp"
#include "tools/window/paint/paint_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

namespace tactus::command {

namespace {

using file::Json;

struct SegmentChoice {
    analysis::SegmentSettings settings;
    std::filesystem::path seeds, propose, certainty, plan;
    window::PaintViewChoice paint;
    std::vector<std::filesystem::path> out;
    double marrow = 2.0;  // mm
    bool json = false;
};

bool is_bones(const std::filesystem::path& path) { return path.extension() == ".vdb"; }

void check_outputs(const SegmentChoice& choice) {
    const bool paints = !choice.paint.seeds.empty(), proposes = !choice.propose.empty();
    if (choice.out.empty() && !proposes && !paints)
        throw Error("name the result: -o LABELS.nrrd, LABELS.seg.nrrd or BONES.vdb, or --propose SEEDS.json");
    if (proposes && (paints || !choice.seeds.empty() || !choice.out.empty() || !choice.certainty.empty()))
        throw Error("--propose writes seeds only; run segment again with --seeds or --paint");
    if (paints && !choice.seeds.empty())
        throw Error("--paint SEEDS.json continues the seeds in that file; leave out --seeds");
    if (!proposes && !paints && choice.seeds.empty())
        throw Error(
            "give the seeds: --seeds SEEDS.json; --paint SEEDS.json opens a window to paint them, --propose SEEDS.json "
            "writes a first version of them");
    if (!choice.paint.script.empty() && !paints) throw Error("--view-script needs --paint");
    if (!choice.paint.hand.empty()) {
        if (!paints) throw Error("--hand needs --paint");
        run::PatchChoice patch;
        patch.patch = choice.paint.hand.string();
        run::file_of(patch);
    }
    if (!choice.plan.empty() && std::ranges::none_of(choice.out, is_bones))
        throw Error("--plan needs bones to refer to: -o BONES.vdb");
    if (!choice.plan.empty() && std::filesystem::exists(choice.plan))
        throw Error(fmt::format("{}: the file exists already; a plan is never overwritten", choice.plan.string()));
    bone::ImportOptions source;
    source.input = choice.settings.scan;
    for (std::filesystem::path out : choice.out) {
        bone::check_output(source, out);
    }
    for (const auto& out : {choice.certainty, choice.propose})
        if (!out.empty()) bone::check_output(source, out);
    std::vector<std::filesystem::path> all = choice.out;
    all.push_back(choice.certainty);
    all.push_back(choice.propose);
    all.push_back(choice.plan);
    all.push_back(choice.paint.seeds);
    const std::filesystem::path sources[] = {choice.settings.scan, choice.seeds};
    file::check_outputs(sources, all);
}

/// The labels that had strokes when the window was closed.
std::vector<segmentation::SeedLabel> painted(const SegmentChoice& choice) {
    std::vector<segmentation::SeedLabel> labels;
    if (std::filesystem::exists(choice.paint.seeds))
        labels = segmentation::read_seeds(choice.paint.seeds, segmentation::SeedsUse::draft);
    std::erase_if(labels, [](const segmentation::SeedLabel& label) { return label.strokes.empty(); });
    return labels;
}

int segment_bone(const SegmentChoice& given) {
    check_outputs(given);
    SegmentChoice choice = given;
    analysis::SegmentSettings settings = choice.settings;
    settings.marrow = choice.marrow * 1e-3;
    settings.run = analysis::on_threads();
    std::vector<segmentation::SeedLabel> seeds;
    if (!choice.seeds.empty()) seeds = segmentation::read_seeds(choice.seeds);
    const analysis::ScanGraph scan = analysis::scan_graph(settings);
    if (!choice.propose.empty()) {
        seeds = analysis::proposed_seeds(scan);
        segmentation::write_seeds(seeds, choice.propose);
        if (choice.json)
            fmt::print("{}\n", Json{{"file", choice.propose.string()}, {"fragments", seeds.size()}}.dump(2));
        else
            fmt::print("{}: seeds of {} fragments; look at them, correct and name them\n", choice.propose.string(),
                       seeds.size());
        return done;
    }
    if (!choice.paint.seeds.empty()) {
        const window::PaintViewEnd end = window::paint_view(scan, settings, choice.paint, run::stop_on_signals());
        if (!choice.json && !end.hand_summary.empty()) fmt::print("{}", end.hand_summary);
        if (!end.lost.empty()) {
            fmt::print(stderr, "tactus: {}; the last strokes are lost\n", end.lost);
            return output_lost;
        }
        if (!end.hand_failure.empty()) throw Error(end.hand_failure);
        seeds = painted(choice);
        choice.seeds = choice.paint.seeds;
        const bool is_enough = seeds.size() >= 2;
        if (!choice.json && (choice.out.empty() || !is_enough))
            fmt::print("{}: strokes of {} fragment{}{}\n", choice.seeds.string(), seeds.size(),
                       seeds.size() == 1 ? "" : "s", is_enough ? "" : "; a segmentation needs those of two");
        if (choice.out.empty() || run::stop_on_signals()) return done;
        if (!is_enough) return answer_is_no;
    }
    const analysis::SegmentedScan found = analysis::segment_scan(scan, seeds, settings, choice.seeds.string());
    for (const auto& path : choice.out)
        analysis::write_segmented(scan, found, settings, choice.seeds.filename().string(), path);
    if (!choice.plan.empty())
        for (const auto& path : choice.out)
            if (is_bones(path)) analysis::write_plan_of(path, found, choice.plan);
    if (!choice.certainty.empty())
        volume::write_volume(found.certainty, volume::WrittenType::float32, choice.certainty);
    std::vector<std::string> files;
    for (const auto& path : choice.out) files.push_back(path.string());
    const report::Result result = report::segmentation_fields().of({&scan, &found, files});
    say(stdout, choice.json ? report::output_json(result).dump(2) + "\n" : report::text_of(result));
    return done;
}

Action declare_segment(VerbOptions& verb) {
    const auto choice = std::make_shared<SegmentChoice>();
    analysis::SegmentSettings& settings = choice->settings;
    verb.add("scan", settings.scan, "a CT: DICOM folder or zip, NRRD, NIfTI, InVesalius").required();
    verb.add("--seeds", choice->seeds, "brush strokes per fragment (.json); see docs/how-to/segment.md");
    verb.output(
        "--paint", choice->paint.seeds, {{".json"}},
        "open a window to paint the seeds; they are kept in this file (.json) after every stroke, and continued "
        "when it "
        "exists");
    verb.add(
        "--hand", choice->paint.hand,
        "with --paint: run this patch beside the window; what its 'brush' nodes paint becomes strokes, and the labels "
        "follow");
    verb.add("--view-script", choice->paint.script, "with --paint: run the commands in this file in the window");
    verb.add("--view-scale", choice->paint.scale, "with --paint: scale of text and controls (default: the screen's)")
        .range(0.5, 4.0);
    verb.output("-o,--out", choice->out, {{".vdb", ".nrrd"}},
                ".nrrd or .seg.nrrd: a label per fragment; .vdb: a bone per fragment; may be given several times")
        .one_each();
    verb.output("--propose", choice->propose, {{".json"}},
                "write a first version of the seeds (.json) for correction by hand");
    verb.output("--plan", choice->plan, {{".json"}}, "make a plan of the bones in -o BONES.vdb (.plan.json)");
    verb.output("--certainty", choice->certainty, {{".nrrd", ".nii", ".nii.gz"}},
                "write how certain each voxel is (.nrrd): 1 - second largest / largest probability");
    verb.add("--threshold", settings.threshold,
             "value at and above which a voxel is bone, HU (default: the one that info suggests)")
        .unit("HU");
    verb.add("--metal", settings.metal,
             "value at and above which a voxel is metal and takes no part (default: 2500 HU; none for scanner numbers)")
        .unit("HU");
    verb.add("--marrow", choice->marrow,
             "take in marrow behind cortex that is open by less than twice this, mm; 0: none")
        .unit("mm")
        .range(0.0, 20.0)
        .shows_default();
    verb.add("--series", settings.read.series,
             "DICOM: the series to take, by its UID or the end of it; several between commas are joined");
    add_unit(verb, settings.read.unit);
    verb.flag("--json", choice->json, "as JSON");
    return [choice] { return segment_bone(*choice); };
}

}  // namespace

Verb segment_verb() {
    return {.name = "segment",
            .about = "separate the fragments of a CT by random walks from painted seeds",
            .add = declare_segment,
            .schema = [] { return report::schema_of_output({report::segmentation_fields().schema()}); }};
}

}  // namespace tactus::command
