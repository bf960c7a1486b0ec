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

    SnapChoice& snap = choices.snap;
    CLI::App* snap_app = app.add_subcommand("snap", "where a fragment fits another, and how sure that is");
    snap_app->add_option("moving", snap.moving, "the fragment that is to move: bone file or closed mesh")->required();
    snap_app->add_option("fixed", snap.fixed, "the one that stands")->required();
    snap_app
        ->add_option("--paint", snap.paint,
                     "auto: what the bone files have painted, or else a proposal; or a JSON file of brush strokes")
        ->capture_default_str();
    snap_app->add_option("--start", snap.start, "X,Y,Z,QW,QX,QY,QZ in mm: where the moving one is (default: as filed)");
    snap_app->add_option("--mode", snap.mode, "thesis and extended start from there, global from anywhere")
        ->check(CLI::IsMember({"thesis", "extended", "global"}))
        ->capture_default_str();
    snap_app->add_flag("--json", snap.json, "as JSON");
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
    verb->add_option("--case", choice.cases, "clean, chipped25, chipped30, spilled, both, fine or live (default: all)")
        ->delimiter(',');
    verb->add_option("--bone", choice.bone, "what is broken (default: the bundled jaw)");
    verb->add_flag("--pushed", choice.pushed, "starts are moved apart until bone does not lie in bone");
    verb->add_flag("--json", choice.json, "as JSON");
}

}  // namespace tactus
