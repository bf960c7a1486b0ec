// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/error.hpp"
#include "dsp/core/units.hpp"
#include "tools/analysis_options.hpp"
#include "tools/bone_options.hpp"
#include "tools/command/patch_options.hpp"
#include "tools/plan_options.hpp"
#include "tools/snap_options.hpp"
#include "tools/sound_options.hpp"
#include "tools/verbs.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cstdio>
#include <exception>
#include <new>

namespace tactus {

namespace {

/// Of pictures and of the window; they need `what`.
void add_sight_options(CLI::App& verb, SightChoice& choice, CLI::Option* what) {
    const auto add = [&](const char* name, auto& value, const char* about) {
        CLI::Option* option = verb.add_option(name, value, about);
        if (what) option->needs(what);
        return option;
    };
    add("--stereo", choice.stereo, "mono, side-by-side, anaglyph; windows: quad-buffer as well")->capture_default_str();
    add("--head", choice.head, "a pose output that is the viewer's head; without --rig before a screen 0.3 m high");
    add("--rig", choice.rig,
        "where screens, mirror and device stand, as 'calibrate' writes it: what is seen is where it is felt");
    add("--offset", choice.offset, "of what is seen against what is felt: none, study (0.3 m), \"X mm, Y mm, Z mm\"");
}

void add_view_options(CLI::App& verb, ViewChoice& choice) {
    verb.add_option("--view-script", choice.script, "do in the window what the lines of this file say");
    verb.add_option("--reference", choice.reference, "sound file whose spectrum stands beneath the signals'");
    add_sight_options(verb, choice.sight, nullptr);
    verb.add_option("--view-scale", choice.scale, "size of letters and controls (default: as the screen says)")
        ->check(CLI::Range(0.5, 4.0));
}

void add_calibrate(CLI::App& app, CalibrateChoice& choice) {
    CLI::App* verb = app.add_subcommand(
        "calibrate", "find where screens, mirror and device stand, by touching them with the device: a file for --rig");
    verb->add_option("-o,--out", choice.out, "the rig, TOML")->required();
    auto* device =
        verb->add_option("--device", choice.device, "driver of the device that touches; 'devices' lists them");
    verb->add_option("--touches", choice.touches, "a CSV of touches instead of a device")->excludes(device);
    verb->add_option("--option", choice.device_options, "of the device's driver: NAME=VALUE")->allow_extra_args(false);
    verb->add_option("--tip", choice.tip, "what touches, in the frame of the handle")->capture_default_str();
    verb->add_option("--screen", choice.screens, "a screen whose marks are touched; more than once: several")
        ->allow_extra_args(false);
    verb->add_option("--image", choice.images, "a screen whose marks are touched where the mirror shows them")
        ->allow_extra_args(false);
    verb->add_flag("--mirror", choice.mirror, "touch the mirror as well");
    verb->add_option("--places", choice.places,
                     "CSV (x_mm, y_mm, z_mm) of places that are known in the viewer's world");
    verb->add_option("--tracker", choice.tracker, "driver that tells where the tip is in the viewer's world, instead");
    verb->add_option("--tracker-option", choice.tracker_options, "of that driver: NAME=VALUE")->allow_extra_args(false);
    verb->add_option("--grid", choice.grid, "marks along each side of a screen")
        ->capture_default_str()
        ->check(CLI::Range(2, 9));
    verb->add_option("--points", choice.points, "touches of the mirror, and of the workspace with a tracker")
        ->capture_default_str()
        ->check(CLI::Range(4, 100));
    verb->add_option("--show", choice.show, "show the marks on this monitor, from 1")->check(CLI::Range(1, 64));
    verb->add_flag("--affine", choice.affine, "take up scales and skews of the device");
    verb->add_option("--tolerance", choice.tolerance, "a touch farther off what the others say is refused")
        ->capture_default_str();
    verb->add_option("--base", choice.base, "a rig that stays as it is where nothing is touched");
    verb->add_option("--keep", choice.keep, "write the touches as CSV, for --touches");
    verb->add_flag("--json", choice.json, "as JSON");
    verb->callback([&choice] {
        if (choice.device.empty() == choice.touches.empty())
            throw Error("say what touches: --device DRIVER, or --touches FILE");
    });
}

void add_frame_options(CLI::App& app, FrameChoice& choice) {
    auto* frames =
        app.add_option("--frames", choice.frames, "pictures of the scene, evenly over the time: frame_0001.png, ...")
            ->check(CLI::Range(1, 100000));
    const auto add = [&](const char* name, std::string& value, const char* about) {
        app.add_option(name, value, about)->capture_default_str()->needs(frames);
    };
    add("--view-from", choice.view_from, "front, back, left, right, top, bottom or iso");
    add("--size", choice.size, "of the pictures, WIDTHxHEIGHT");
    add("--clip", choice.clip, "take away what is above along an axis: x, -y, \"z=12 mm\"");
    add_sight_options(app, choice.sight, frames);
}

}  // namespace

int command_line(int argc, char** argv) {
    CLI::App app{"Tactus: patches of nodes for haptics, from 60 Hz to audio rate", "tactus"};
    app.require_subcommand(1);

    RenderChoice render;
    CLI::App* render_app = app.add_subcommand("render", "run a patch on a virtual clock, as fast as it goes");
    add_patch_options(*render_app, render);
    render_app->add_option("--seconds", render.seconds, "logical time to render, s")
        ->capture_default_str()
        ->check(CLI::Range(1e-3, 1e6));
    render_app->add_option("--out", render.out, "folder for what comes out")->required();
    render_app->add_option("--threads", render.threads, "threads, 0: one per core")->check(CLI::Range(0, 64));
    render_app->add_option("--block", render.block, "most samples per call, or 'random'; the output is the same");
    render_app->add_option("--log", render.log, "repeat the timing decisions of a live run");
    render_app->add_option("--record", render.record, "keep the run as a take, a folder that 'replay' repeats");
    add_frame_options(*render_app, render.frames);
    render_app->add_flag("--json", render.json, "print the summary");

    RigChoice rig;
    CLI::App* rig_app = app.add_subcommand(
        "rig", "how faithfully a gripper renders objects: motors, objects, rates and amplitudes on a test rig");
    add_patch_options(*rig_app, rig);
    rig_app->get_option("patch")->description(
        "patch with a gripper on a rig, such as gripper-wqsm, or a CSV of a real one");
    rig_app->add_option("--matrix", rig.matrix, "TOML: what is tried (default: the matrix of the thesis)");
    rig_app->add_option("--out", rig.out, "folder for report.html, rig.json and rig.csv")->required();
    rig_app->add_option("--threads", rig.threads, "threads, 0: one per core")->check(CLI::Range(0, 64));
    rig_app->add_flag("--series", rig.keep_series, "also write every sample, series.csv, which 'rig' reads as well");
    rig_app->add_flag("--json", rig.json, "print the answer as JSON");

    RunChoice run;
    CLI::App* run_app = app.add_subcommand("run", "run a patch in real time, until Ctrl-C or --seconds");
    add_patch_options(*run_app, run);
    run_app->add_option("--seconds", run.seconds, "stop after so much logical time, s")->check(CLI::Range(1e-3, 1e6));
    run_app->add_option("--dilate", run.dilate, "real seconds per logical second")->check(CLI::Range(0.01, 1000.0));
    run_app->add_option(
        "--audio", run.audio,
        "where sound goes: part of a card's name, default, file or none (else: a card if there is one)");
    run_app->add_option("--audio-margin", run.audio_margin, "sound that waits for the card when a thread is late, ms")
        ->capture_default_str()
        ->check(CLI::Range(1.0, 2000.0));
    run_app->add_option("--out", run.out, "folder for what comes out (default: PATCH-run)");
    run_app->add_option("--log", run.log, "write what timing decided, for 'render --log'");
    run_app->add_option("--record", run.record, "keep the run as a take, a folder that 'replay' repeats");
    run_app->add_flag("--json", run.json, "print the summary as JSON and nothing else");

    CLI::Option* view_flag = run_app->add_flag("--view", run.view.wanted,
                                               "open a window: the patch, its values, the scene; edits run at once");
    run_app->add_flag("--keep-running", run.view.keep_running, "closing the window leaves the run alive")
        ->needs(view_flag);
    add_view_options(*run_app, run.view);
    run_app->add_flag("!--no-edits", run.edits, "neither watch the patch file nor listen to 'set'");

    SetChoice set;
    CLI::App* set_app = app.add_subcommand("set", "change a parameter of a patch that runs");
    set_app->add_option("setting", set.settings, "NODE.PARAM=VALUE, as in blade.stiffness=\"0.8 N/mm\"")->required();
    set_app->add_option("--process", set.process, "number of the run's process, when there are several");

    ReplayChoice replay;
    CLI::App* replay_app = app.add_subcommand("replay", "repeat a take and compare every value, bit by bit");
    replay_app->add_option("take", replay.take, "folder that --record made")->required();
    replay_app->add_flag("--anyway", replay.anyway, "although assets have changed since");
    replay_app->add_flag("--json", replay.json, "as JSON");

    TakeViewChoice take_view;
    CLI::App* view_app = app.add_subcommand("view", "open a window on a take: its values and bones at any instant");
    view_app->add_option("take", take_view.take, "folder that --record made")->required();
    add_view_options(*view_app, take_view.view);

    PatchChoice check;
    CLI::App* check_app = app.add_subcommand("check", "find errors; list groups and latencies");
    add_patch_options(*check_app, check);
    check_app->add_flag("--json", check.json, "as JSON");

    PatchChoice draw;
    std::filesystem::path drawing;
    CLI::App* draw_app = app.add_subcommand("draw", "draw the graph as SVG");
    add_patch_options(*draw_app, draw);
    draw_app->add_option("-o,--out", drawing, "file (default: standard output)");

    std::string type;
    bool nodes_json = false, devices_json = false;
    CLI::App* nodes_app = app.add_subcommand("nodes", "the node types: ports, parameters, units, ranges");
    nodes_app->add_option("type", type, "only this type");
    nodes_app->add_flag("--json", nodes_json, "as JSON");
    CLI::App* devices_app = app.add_subcommand("devices", "haptic drivers and sound outputs of this machine");
    devices_app->add_flag("--json", devices_json, "as JSON");

    CalibrateChoice calibrate;
    add_calibrate(app, calibrate);
    BoneChoices bones;
    add_bone_verbs(app, bones);
    SoundChoices sounds;
    add_sound_verbs(app, sounds);
    AnalysisChoices analysis;
    add_analysis_verbs(app, analysis);
    SnapChoices fitting;
    add_snap_verbs(app, fitting);
    PlanChoice plan;
    add_plan_verbs(app, plan);

    BenchChoice bench;
    CLI::App* bench_app =
        app.add_subcommand("bench", "figures of this machine, beside other programs where they are installed");
    bench_app->require_subcommand(1);
    CLI::App* bench_engine_app =
        bench_app->add_subcommand("engine", "time of a node in a chain, beside Pure Data and scsynth; compile time");
    bench_engine_app->add_option("--rounds", bench.rounds, "the best of so many counts")
        ->capture_default_str()
        ->check(CLI::Range(1, 1000));
    bench_engine_app->add_flag("--json", bench.json, "as JSON");

    CLI::App* bench_contact_app =
        bench_app->add_subcommand("contact", "time of a pointshell's point against a voxmap, beside OpenVDB");
    bench_contact_app->add_option("--rounds", bench.rounds, "more rounds, steadier figures")
        ->capture_default_str()
        ->check(CLI::Range(1, 1000));
    bench_contact_app->add_flag("--json", bench.json, "as JSON");
    CLI::App* bench_view_app =
        bench_app->add_subcommand("view", "time to remesh what a cut changed of a bone, beside OpenVDB's volumeToMesh");
    bench_view_app->add_option("--rounds", bench.rounds, "more rounds, steadier figures")
        ->capture_default_str()
        ->check(CLI::Range(1, 100));
    bench_view_app->add_flag("--json", bench.json, "as JSON");
    ScrubBenchChoice bench_scrub;
    CLI::App* bench_scrub_app =
        bench_app->add_subcommand("scrub", "time to jump to any instant of a take, its bones and bodies included");
    bench_scrub_app->add_option("take", bench_scrub.take, "folder that --record made")->required();
    bench_scrub_app->add_option("--jumps", bench_scrub.jumps, "how many")
        ->capture_default_str()
        ->check(CLI::Range(1, 100'000));
    bench_scrub_app->add_flag("--json", bench_scrub.json, "as JSON");
    SnapBenchChoice bench_snap;
    add_snap_bench(*bench_app, bench_snap);

    try {
        app.parse(argc, argv);
        if (*render_app) return render_verb(render);
        if (*rig_app) return rig_verb(rig);
        if (*run_app) return run_verb(run);
        if (*set_app) return set_verb(set);
        if (*replay_app) return replay_verb(replay);
        if (*view_app) return view_verb(take_view);
        if (*check_app) return check_verb(check);
        if (*draw_app) return draw_verb(draw, drawing);
        if (*nodes_app) return nodes_verb(type, nodes_json);
        if (*bench_engine_app) return bench_engine_verb(bench);
        if (*bench_contact_app) return bench_contact_verb(bench);
        if (*bench_view_app) return bench_view_verb(bench);
        if (*bench_scrub_app) return bench_scrub_verb(bench_scrub);
        if (bench_app->got_subcommand("snap")) return bench_snap_verb(bench_snap);
        if (app.got_subcommand("calibrate")) return calibrate_verb(calibrate);
        if (*devices_app) return devices_verb(devices_json);
        if (app.got_subcommand("spectrum")) return spectrum_verb(analysis.spectrum);
        if (app.got_subcommand("orders")) return orders_verb(analysis.orders);
        if (app.got_subcommand("exposure")) return exposure_verb(analysis.exposure);
        if (app.got_subcommand("compare")) return compare_verb(sounds.compare);
        if (app.got_subcommand("validate")) return validate_verb(sounds.validate);
        if (app.got_subcommand("measure")) return measure_verb(sounds.measure);
        if (app.got_subcommand("equalise")) return equalise_verb(sounds.equalise);
        if (app.got_subcommand("fracture")) return fracture_verb(fitting.fracture);
        if (app.got_subcommand("fracture-surface")) return fracture_surface_verb(fitting.surface);
        if (app.got_subcommand("register")) return register_verb(fitting.registration);
        if (app.got_subcommand("snap")) return snap_verb(fitting.snap);
        if (app.got_subcommand("plan")) return plan_verb(app, plan);
        if (app.got_subcommand("info")) return info_verb(bones.info);
        if (app.got_subcommand("export")) return export_verb(bones.surface);
        return import_verb(bones.import);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? done : bad_input;
    } catch (const std::bad_alloc&) {
        fmt::print(stderr, "tactus: not enough memory\n");
    } catch (const std::exception& error) {
        fmt::print(stderr, "tactus: {}\n", error.what());
    }
    return bad_input;
}

}  // namespace tactus
