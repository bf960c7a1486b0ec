// SPDX-License-Identifier: Apache-2.0
// tactus fracture-surface: proposes the fracture surface of a fragment and applies manual corrections.
#include "tools/analysis/bone/fracture_surface.hpp"
#include "assets/plan/paint_file.hpp"
#include "dsp/core/error.hpp"
#include "tools/command/options.hpp"
#include "tools/command/result_options.hpp"
#include "tools/exit_code.hpp"
#include "tools/report/bone/fracture_surface_result.hpp"
#include "tools/report/result/printers.hpp"
#include "tools/terminal.hpp"

#include <fmt/format.h>

#include <memory>

namespace tactus::command {

namespace {

struct FractureSurfaceChoice {
    analysis::FractureSurfaceSettings settings;
    ResultChoice result;
    double reach = 10.0;             // mm
    std::optional<double> min_area;  // mm²
};

int fracture_surface(const FractureSurfaceChoice& choice) {
    analysis::FractureSurfaceSettings settings = choice.settings;
    for (const std::filesystem::path& other : settings.facing)
        if (bone::name_one_bone(settings.bone, other))
            throw Error(
                fmt::format("{}: a fragment cannot face itself; name another one with --facing", other.string()));
    check_result_files(choice.result, {settings.bone});
    const std::vector<std::filesystem::path> painted = choice.result.products();
    if (painted.size() > 1)
        throw Error(fmt::format("{}: the paint is written to one file, and {} is another", painted[1].string(),
                                painted[0].string()));
    const std::filesystem::path out = painted.empty() ? std::filesystem::path() : painted.front();
    settings.reach = choice.reach * 1e-3;
    if (choice.min_area) settings.min_area = *choice.min_area * 1e-6;
    settings.whole = out.extension() == ".vdb";
    const analysis::FractureSurface found = analysis::propose_fracture_surface(settings);
    if (!found.note.empty()) say(stderr, fmt::format("note: {}\n", found.note));
    report::ProposedSurface proposed{&settings, &found, {}, out};
    if (out.extension() == ".json")
        proposed.faces = plan::write_paint_file(found.bone.points, settings.bone.string(), out);
    else {
        proposed.faces = plan::painted_faces(found.bone.points);
        if (settings.whole) bone::save_bone(found.bone, out);
    }
    write_result(report::proposed_surface_fields().of(proposed), choice.result);
    return proposed.faces.empty() || proposed.is_doubtful() ? answer_is_no : done;
}

Action declare_fracture_surface(VerbOptions& verb) {
    const auto choice = std::make_shared<FractureSurfaceChoice>();
    analysis::FractureSurfaceSettings& settings = choice->settings;
    verb.add("bone", settings.bone, "bone file or closed mesh").required();
    add_result_options(verb, choice->result, ResultFigure::none,
                       {{".json", ".vdb"}, "the paint, as brush strokes for correction by hand, or in the bone"});
    verb.add("--paint", settings.paint, "use this file of strokes instead of the proposal");
    verb.flag("--correct", settings.correct, "apply the strokes of --paint on top of the proposal");
    verb.add("--facing", settings.facing,
             "another fragment of the same scan: propose the surface that faces it, also when it is smooth; once per "
             "neighbour")
        .one_each();
    const Option intact = verb.add(
        "--intact", settings.intact,
        "the unbroken bone, in any position: propose the surface inside of it; with --facing only near that fragment");
    verb.flag("--mirror", settings.mirror, "mirror the unbroken bone: it is from the other side of the body")
        .needs(intact);
    verb.add("--main", settings.main,
             "the fragment of the same scan to which the unbroken bone is registered first (default: this one)")
        .needs(intact);
    verb.add("--reach", choice->reach, "greatest distance to --facing or --intact, mm")
        .unit("mm")
        .shows_default()
        .range(0.1, 100.0);
    verb.flag("--keep", settings.keep,
              "keep the paint in the bone file; what --facing or --intact propose is added to it");
    verb.add("--roughness", settings.roughness,
             "roughness above which a point counts as broken: mean of 1 - cos of normals")
        .shows_default()
        .range(0.0, 1.0);
    verb.add("--least-area", choice->min_area, "smallest patch, mm² (default: 20, with --intact 50)")
        .unit("mm^2")
        .range(0.0, 1e5);
    return [choice] { return fracture_surface(*choice); };
}

}  // namespace

Verb fracture_surface_verb() {
    return {
        .name = "fracture-surface",
        .about = "propose the fracture surface of a fragment; 1: none found, or the unbroken bone does not lie on it",
        .add = declare_fracture_surface,
        .schema = [] { return report::schema_of_output({report::proposed_surface_fields().schema()}); }};
}

}  // namespace tactus::command
