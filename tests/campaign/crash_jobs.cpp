// SPDX-License-Identifier: Apache-2.0
#include "tests/campaign/crash_jobs.hpp"

#include "assets/file/whole_file.hpp"
#include "tests/campaign/limited_run.hpp"
#include "tests/campaign/other_bone.hpp"
#include "tests/fuzz/seeds.hpp"
#include "tests/support/recording_patch.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace tactus::campaign {

namespace {

namespace fs = std::filesystem;

void make(std::vector<std::string> words, const fs::path& folder) {
    words.insert(words.begin(), tried_command());
    const RunEnd end = run_limited(words, folder);
    if (end.code != 0) throw std::runtime_error(fmt::format("'{}' made no earlier work: {}", words[1], end.fault));
}

/// A ball of 400 to 1400 HU, big enough that its import takes a while.
void make_ct(const fs::path& file) {
    constexpr int size = 120;
    std::string bytes = fmt::format(
        "NRRD0005\ntype: short\ndimension: 3\nspace: left-posterior-superior\nspace units: \"mm\" \"mm\" \"mm\"\n"
        "sizes: {0} {0} {0}\n"
        "space directions: (0.4,0,0) (0,0.4,0) (0,0,0.4)\nspace origin: (0,0,0)\nendian: little\nencoding: raw\n\n",
        size);
    for (int z = 0; z < size; ++z)
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) {
                const int dx = x - size / 2, dy = y - size / 2, dz = z - size / 2, from = dx * dx + dy * dy + dz * dz;
                const int value = from < size * size / 9 ? 1400 - from / 2 : -1000;
                bytes += static_cast<char>(value & 0xff);
                bytes += static_cast<char>((value >> 8) & 0xff);
            }
    file::write_whole_file(file, bytes);
}

}  // namespace

void make_earlier_work(const fs::path& folder) {
    file::write_whole_file(folder / "p.toml", test::recording_patch);
    file::write_whole_file(
        folder / "window.script",
        "until 0.1\nset half.number 0.25\nframes 3\nrecord\nuntil 0.4\nset tone.frequency \"200 Hz\"\n"
        "until 0.7\nclose\n");
    make({"render", "p.toml", "--seconds", "0.2", "--out", "old", "--record", "old-take"}, folder);
    make_ct(folder / "ct.nrrd");
    make({"import", "ct.nrrd", "-o", "bone.vdb"}, folder);
    write_seeds(folder / "seeds");
    fs::copy_file(folder / "seeds/assets_stl/closed.stl", folder / "a.stl");
    write_other_bone(folder / "b.obj");
    fs::remove_all(folder / "seeds");
    make({"plan", "new", "case.plan.json", "a.stl", "b.obj"}, folder);
    make({"plan", "move", "case.plan.json", "a", "--pose", "1,2,3,1,0,0,0"}, folder);
    make({"flap", "-o", "flap"}, folder);
    make({"plan", "reconstruct", "jaw.plan.json", "flap/INPUTS.json"}, folder);
}

std::vector<Job> crash_jobs(bool has_display) {
    std::vector<Job> jobs{
        {.name = "run",
         .script = "exec $T run p.toml --audio none --seconds 1 --out new$N --record take\n",
         .ends_in_order = true},
        {.name = "render",
         .script = "exec $T render p.toml --seconds 8 --out new --record take$N\n",
         .ends_in_order = true},
        {.name = "import", .script = "exec $T import ct.nrrd -o bone.vdb\n", .may_change = {"bone.vdb"}},
        {.name = "plan",
         .script = "for n in 1 2 3 4 5 6; do $T plan move case.plan.json b --pose $n,0,0,1,0,0,0 || exit; "
                   "$T plan lock case.plan.json a || exit; $T plan undo case.plan.json || exit; done\n",
         .may_change = {"case.plan.json"}},
        {.name = "reconstruction",
         .script = "for n in 1 2 3; do $T plan plate jaw.plan.json chin --screws $n || exit; "
                   "$T plan implant jaw.plan.json molar --at $n -38 6 --axis 0 0 -1 || exit; "
                   "$T plan site jaw.plan.json 'lingual artery' --at $n 0 -40 || exit; "
                   "$T plan vessel jaw.plan.json artery --remove || exit; "
                   "$T plan site jaw.plan.json 'facial vein' --file flap/vein.csv --along $n || exit; "
                   "$T plan limits jaw.plan.json --clearance $n || exit; "
                   "$T plan margin jaw.plan.json --margin $n || exit; $T plan undo jaw.plan.json --steps 7 || exit; "
                   "done; exec $T plan reconstruct jaw.plan.json flap/INPUTS.json --alternative new$N\n",
         .may_change = {"jaw.plan.json"}}};
    if (has_display)
        jobs.push_back({.name = "view",
                        .script = "exec $T run p.toml --view --view-script window.script --audio none --out new$N\n",
                        .ends_in_order = true});
    return jobs;
}

}  // namespace tactus::campaign
