// SPDX-License-Identifier: Apache-2.0
#include "tools/snap_options.hpp"

#include <CLI/CLI.hpp>

namespace tactus {

void add_snap_verbs(CLI::App& app, SnapChoices& choices) {
    FractureChoice& fracture = choices.fracture;
    CLI::App* verb = app.add_subcommand("fracture", "break a bone into pieces and scan them, with the truth beside");
    verb->add_option("bone", fracture.bone, "bone file, or anything that import reads")->required();
    verb->add_option("-o,--out", fracture.out, "folder for the fragments and truth.json")->required();
    verb->add_option("--pieces", fracture.pieces, "how many")->capture_default_str()->check(CLI::Range(2, 200));
    verb->add_option("--seed", fracture.seed, "another seed, another fracture")->capture_default_str();
    verb->add_option("--chips", fracture.chips, "share of each fracture that is chipped off one side, %")
        ->check(CLI::Range(0.0, 90.0));
    verb->add_option("--kerf", fracture.kerf, "bone lost all along the fractures, mm")->check(CLI::Range(0.0, 5.0));
    verb->add_option("--missing", fracture.missing, "so many of the smallest pieces are lost")
        ->check(CLI::Range(0, 198));
    verb->add_option("--roughness", fracture.roughness, "root mean square relief, mm")
        ->capture_default_str()
        ->check(CLI::Range(0.0, 5.0));
    verb->add_option("--voxel", fracture.voxel, "of the scan, mm")->capture_default_str()->check(CLI::Range(0.1, 3.0));
    verb->add_option("--blur", fracture.blur, "of the scan, standard deviation, mm")
        ->capture_default_str()
        ->check(CLI::Range(0.0, 3.0));
    verb->add_option("--noise", fracture.noise, "of the scan, standard deviation, % of bone's contrast")
        ->capture_default_str()
        ->check(CLI::Range(0.0, 20.0));
    verb->add_option("--spread", fracture.spread, "how far fragments are moved, mm")
        ->capture_default_str()
        ->check(CLI::Range(0.0, 1000.0));
    verb->add_option("--turn", fracture.turn, "how far fragments are turned, degrees")
        ->capture_default_str()
        ->check(CLI::Range(0.0, 180.0));
    verb->add_option("--points", fracture.spacing, "spacing of the surface points, mm")
        ->capture_default_str()
        ->check(CLI::Range(0.1, 5.0));
    verb->add_flag("--json", fracture.json, "print truth.json as well");

    FractureSurfaceChoice& surface = choices.surface;
    CLI::App* surface_app = app.add_subcommand("fracture-surface", "propose where a fragment is broken; 1: nowhere");
    surface_app->add_option("bone", surface.bone, "bone file or closed mesh")->required();
    surface_app
        ->add_option("-o,--out", surface.out,
                     ".json: strokes of a brush, to be corrected by hand; .vdb: the bone with its paint")
        ->required();
    surface_app->add_option("--paint", surface.paint, "use this file of strokes instead of the proposal");
    surface_app->add_flag("--correct", surface.correct, "use its strokes on top of the proposal");
    surface_app->add_option("--facing", surface.facing,
                            "another fragment of the same scan: what faces it is proposed, however smooth");
    CLI::Option* intact = surface_app->add_option("--intact", surface.intact,
                                                  "the unbroken bone, wherever it lies: what lies inside of it is "
                                                  "proposed; with --facing only what is near that");
    surface_app->add_flag("--mirror", surface.mirror, "that is the other side of the body")->needs(intact);
    surface_app
        ->add_option("--main", surface.main,
                     "the fragment of the same scan that the unbroken bone is laid on first (default: this one)")
        ->needs(intact);
    surface_app->add_option("--reach", surface.reach, "how far that may be, mm")
        ->capture_default_str()
        ->check(CLI::Range(0.1, 100.0));
    surface_app->add_flag("--keep", surface.keep,
                          "start from the paint that the bone file has; without any, from the proposal");
    surface_app
        ->add_option("--roughness", surface.roughness, "from which on a place is broken: mean of 1 - cos of normals")
        ->capture_default_str()
        ->check(CLI::Range(0.0, 1.0));
    surface_app
        ->add_option("--least-area", surface.least_area,
                     "smaller patches are left out, mm² (default: 20, with --intact 50)")
        ->check(CLI::Range(0.0, 1e5));
    surface_app->add_flag("--json", surface.json, "as JSON");

    SnapChoice& snap = choices.snap;
    CLI::App* snap_app = app.add_subcommand("snap", "where a fragment fits another, and how sure that is");
    snap_app->add_option("moving", snap.moving, "the fragment that is to move: bone file or closed mesh")->required();
    snap_app->add_option("fixed", snap.fixed, "the one that stands")->required();
    snap_app
        ->add_option(
            "--paint", snap.paint,
            "auto: what the bone files have painted, or else a proposal; or a JSON file of brush strokes, or two of "
            "'fracture-surface': MOVING.json,FIXED.json")
        ->capture_default_str();
    snap_app->add_option("--start", snap.start, "X,Y,Z,QW,QX,QY,QZ in mm: where the moving one is (default: as filed)");
    snap_app->add_option("--mode", snap.mode, "thesis and extended start from there, global from anywhere")
        ->check(CLI::IsMember({"thesis", "extended", "global"}))
        ->capture_default_str();
    snap_app->add_flag("--json", snap.json, "as JSON");

    RegisterChoice& registration = choices.registration;
    CLI::App* register_app = app.add_subcommand("register", "lay a surface on another one of the same shape");
    register_app->add_option("moving", registration.moving, "bone file or mesh, which need not be closed")->required();
    register_app->add_option("fixed", registration.fixed, "what it is laid on")->required();
    register_app->add_flag("--mirror", registration.mirror, "the moving one is of the other side of the body");
    register_app->add_flag("--anywhere", registration.anywhere, "from any position (default: from where they lie)");
    register_app->add_flag("--region", registration.region,
                           "also find the part that lies elsewhere than the rest, and lay it on its place by itself");
    register_app->add_option("--away", registration.away, "from which distance on a point lies elsewhere, mm")
        ->capture_default_str()
        ->check(CLI::Range(0.01, 100.0));
    register_app->add_option("--gap", registration.gap, "points of a region are no farther apart, mm")
        ->capture_default_str()
        ->check(CLI::Range(0.1, 100.0));
    register_app->add_option("--margin", registration.margin, "by which a region is grown, mm")
        ->capture_default_str()
        ->check(CLI::Range(0.0, 100.0));
    register_app->add_flag("--json", registration.json, "as JSON");
}

void add_snap_bench(CLI::App& bench, SnapBenchChoice& choice) {
    CLI::App* verb = bench.add_subcommand("snap", "success of snap-to-fit on simulated fractures, beside ICP");
    verb->add_option("--seed", choice.seed, "of the first fracture")->capture_default_str();
    verb->add_option("--seeds", choice.seeds, "so many fractures of each kind")
        ->capture_default_str()
        ->check(CLI::Range(1, 10'000));
    verb->add_option("--trials", choice.trials, "starts for each fracture and distance")
        ->capture_default_str()
        ->check(CLI::Range(1, 1000));
    verb->add_option("--case", choice.cases,
                     "clean, chipped25, chipped30, spilled, both, fine or live (default: all of these); twelve, "
                     "twelve-kerf, twelve-missing: a jaw in twelve pieces, by the matcher")
        ->delimiter(',');
    verb->add_option("--method", choice.methods, "extended, global, thesis, icp_point, icp_plane, gicp (default: all)")
        ->delimiter(',')
        ->check(CLI::IsMember({"extended", "global", "thesis", "icp_point", "icp_plane", "gicp"}));
    verb->add_option("--bone", choice.bone, "what is broken (default: the bundled jaw)");
    verb->add_flag("--pushed", choice.pushed, "starts are moved apart until bone does not lie in bone");
    verb->add_flag("--json", choice.json, "as JSON");
}

}  // namespace tactus
