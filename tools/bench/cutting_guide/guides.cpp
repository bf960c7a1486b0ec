// SPDX-License-Identifier: Apache-2.0
// Random cutting guides, measured from their meshes alone, with admesh as a second opinion.
#include "assets/file/json.hpp"
#include "assets/mesh/mesh.hpp"
#include "assets/mesh/write_mesh.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/processor_time.hpp"
#include "tools/bench/bench.hpp"
#include "tools/bench/cutting_guide/guide_cases.hpp"
#include "tools/run/scratch_folder.hpp"

#include <fmt/format.h>

#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tactus::bench {

namespace {

using file::Json;

struct GuidesChoice {
    int first = 0, count = 12;
    double voxel = 0.5;  // mm
    std::vector<std::filesystem::path> jaws;
    std::filesystem::path keep;
    bool json = false;
};

/// Guides of one bone.
struct Tally {
    int drawn = 0, made = 0, flawed = 0, refused = 0, cannot = 0;
    int slots = 0, ledges = 0;
    double offset = 0.0, angle = 0.0, width = 0.0;  // worst, m and rad
    double thinnest = infinity, nearest = infinity;  // m
    std::vector<double> seconds;  // processor time
    std::map<std::string, int> reasons;  // of refusals and of what could not be made
};

/// The number that admesh prints after `what`, or -1.
double number_after(const std::string& text, const std::string& what) {
    const auto at = text.find(what);
    if (at == std::string::npos) return -1.0;
    const auto colon = text.find(':', at);
    return colon == std::string::npos ? -1.0 : std::strtod(text.c_str() + colon + 1, nullptr);
}

/// What admesh finds wrong with an STL file; none: it is not installed.
std::optional<std::string> flaws_by_admesh(const std::filesystem::path& stl) {
    const std::filesystem::path out = stl.parent_path() / "admesh.txt";
    const int status = std::system(fmt::format("admesh '{}' >'{}' 2>/dev/null", stl.string(), out.string()).c_str());
    // A shell's code for a program that it does not find.
    if (WIFEXITED(status) && WEXITSTATUS(status) == 127) return {};
    if (status != 0) return "admesh: did not end well; ";
    std::ifstream stream(out);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    std::string flaws;
    for (const auto& [what, wanted] :
         {std::pair{"Number of parts", 1.0}, std::pair{"Degenerate facets", 0.0}, std::pair{"Facets reversed", 0.0},
          std::pair{"Backwards edges", 0.0}, std::pair{"Total disconnected facets", 0.0}})
        if (const double found = number_after(text, what); found != wanted)
            flaws += fmt::format("admesh: {} {}; ", what, found);
    return flaws;
}

/// A refusal without its numbers and places, for counting.
std::string kind_of(std::string reason) {
    std::string kind;
    for (std::size_t n = 0; n < reason.size(); ++n) {
        if (std::isdigit(static_cast<unsigned char>(reason[n])) != 0) {
            while (n + 1 < reason.size() &&
                   (std::isdigit(static_cast<unsigned char>(reason[n + 1])) != 0 || reason[n + 1] == '.'))
                ++n;
            kind += 'N';
        } else {
            kind += reason[n];
        }
    }
    if (const auto place = kind.find(", at "); place != std::string::npos) kind.resize(place);
    if (const auto advice = kind.find(": choose"); advice != std::string::npos) kind.resize(advice);
    return kind;
}

/// What is wrong with a guide that was made, apart from what a plan can ask for in vain.
std::string flaws_of(const analysis::PlannedGuide& guide, Tally& tally, const std::filesystem::path& stl) {
    std::string flaws;
    if (!guide.topology.is_watertight()) flaws += "not closed; ";
    if (!(guide.volume > 0.0)) flaws += "inside out; ";
    if (guide.intersections > 0) flaws += fmt::format("{} self-intersections; ", guide.intersections);
    for (std::size_t n = 0; n < guide.refits.size(); ++n) {
        const cutting_guide::SlotFit& fit = guide.refits[n];
        const cutting_guide::MadeSlot& slot = guide.made.slots[n];
        const double width = fit.width > 0.0 ? std::abs(fit.width - slot.width) : 0.0;
        if (std::abs(fit.offset) > 0.05 * mm || fit.angle > 0.1 * degree || width > 0.05 * mm)
            flaws += fmt::format("slot {} off by {:.3f} mm, {:.3f}°, {:.3f} mm wide; ", slot.cut.letter,
                                 fit.offset / mm, fit.angle / degree, fit.width / mm);
        tally.offset = std::max(tally.offset, std::abs(fit.offset)), tally.angle = std::max(tally.angle, fit.angle);
        tally.width = std::max(tally.width, width);
        ++tally.slots, tally.ledges += slot.sides == cutting_guide::Sides::one;
    }
    if (guide.topology.components != 1) return flaws;
    const std::array written{mesh::ColouredSurface{guide.made.surface, Vec3(0.5)}};
    mesh::write_mesh(written, stl);
    return flaws + flaws_by_admesh(stl).value_or("");
}

void count_one(std::uint64_t number, const NamedBone& jaw, bool for_jaw, const GuidesChoice& choice,
               const std::filesystem::path& stl, Tally& tally) {
    ++tally.drawn;
    const RandomGuide drawn = random_guide(number, jaw.surface, for_jaw, choice.voxel * mm);
    const double before = process_seconds();
    const auto keep = [&](const analysis::PlannedGuide& guide) {
        if (choice.keep.empty()) return;
        std::filesystem::create_directories(choice.keep);
        mesh::write_mesh(std::array{mesh::ColouredSurface{guide.made.surface, Vec3(0.35, 0.62, 0.72)},
                                    mesh::ColouredSurface{guide.design.bone, Vec3(0.9, 0.86, 0.76)}},
                         choice.keep / fmt::format("guide-{}.ply", number));
    };
    const auto refused = [&](int& count, const Error& error) {
        ++count, ++tally.reasons[kind_of(error.what())];
        if (!choice.json) fmt::print("{}: {}\n", number, error.what());
    };
    try {
        const analysis::FlapStudy study(drawn.inputs);
        const analysis::PlannedGuide guide = analysis::measured_guide(study, "", drawn.choice);
        tally.seconds.push_back(process_seconds() - before);
        if (const std::string flaws = flaws_of(guide, tally, stl); !flaws.empty()) {
            ++tally.flawed;
            fmt::print(stderr, "{}: {}\n", number, flaws);
            keep(guide);
            return;
        }
        try {
            analysis::refuse_guide(guide);
        } catch (const Error& error) {
            refused(tally.refused, error);
            keep(guide);
            return;
        }
        ++tally.made;
        if (guide.made.wall) tally.thinnest = std::min(tally.thinnest, guide.made.wall->thickness);
        tally.nearest = std::min(tally.nearest, guide.seat.min_distance - guide.design.settings.offset);
    } catch (const Error& error) {
        refused(tally.cannot, error);
    }
}

int run(const GuidesChoice& choice) {
    std::vector<NamedBone> jaws = bundled_jaws();
    for (const std::filesystem::path& file : choice.jaws) {
        jaws.push_back({file.filename().string(), mesh::load_mesh(file, mm)});
    }
    const run::ScratchFolder folder;
    const bool has_admesh = std::system("command -v admesh >/dev/null 2>&1") == 0;
    // Of each jaw its own guide, and the fibula's for its plan, in turn.
    std::map<std::string, Tally> tallies;
    for (int n = choice.first; n < choice.first + choice.count; ++n) {
        const auto kind = static_cast<std::size_t>(n) % (jaws.size() + 1);
        const bool for_jaw = kind < jaws.size();
        const NamedBone& jaw = jaws[for_jaw ? kind : 0];
        count_one(static_cast<std::uint64_t>(n), jaw, for_jaw, choice, folder.path() / "guide.stl",
                  tallies[for_jaw ? jaw.name : "fibula"]);
    }
    Json rows = Json::array();
    int flawed = 0;
    for (auto& [name, t] : tallies) {
        flawed += t.flawed;
        std::ranges::sort(t.seconds);
        const double median = t.seconds.empty() ? 0.0 : t.seconds[t.seconds.size() / 2];
        if (choice.json) {
            rows.push_back({{"bone", name},
                            {"guides", t.drawn},
                            {"made", t.made},
                            {"flawed", t.flawed},
                            {"refused", t.refused},
                            {"cannot_be_made", t.cannot},
                            {"slots", t.slots},
                            {"ledges", t.ledges},
                            {"worst_offset_mm", t.offset / mm},
                            {"worst_angle_deg", t.angle / degree},
                            {"worst_width_mm", t.width / mm},
                            {"thinnest_wall_mm", std::isfinite(t.thinnest) ? Json(t.thinnest / mm) : Json(nullptr)},
                            {"median_seconds", median},
                            {"reasons", t.reasons}});
            continue;
        }
        fmt::print("{}: {} guides, {} made, {} flawed, {} refused by a check, {} cannot be made\n", name, t.drawn,
                   t.made, t.flawed, t.refused, t.cannot);
        fmt::print("  {} slots ({} ledges): worst {:.4f} mm and {:.4f}° off the plan, width {:.4f} mm\n", t.slots,
                   t.ledges, t.offset / mm, t.angle / degree, t.width / mm);
        fmt::print("  thinnest wall of a guide that was made {:.2f} mm; {:.1f} s of processor time each\n",
                   t.thinnest / mm, median);
        for (const auto& [reason, count] : t.reasons) fmt::print("  {:4}: {}\n", count, reason);
    }
    if (choice.json)
        fmt::print("{}\n", Json{{"version", 1}, {"admesh", has_admesh}, {"flawed", flawed}, {"rows", rows}}.dump(2));
    else if (!has_admesh) fmt::print("admesh is not installed: nothing was checked by it\n");
    return flawed == 0 ? done : answer_is_no;
}

}  // namespace

Verb guides_verb() {
    return {"guides", "random cutting guides: flaws of their meshes, slots off the plan, refusals",
            [](VerbOptions& verb) -> Action {
                const auto choice = std::make_shared<GuidesChoice>();
                verb.add("--first", choice->first, "number of the first guide").shows_default().range(0, 1'000'000);
                verb.add("--count", choice->count, "number of guides, of each bone in turn")
                    .shows_default()
                    .range(1, 100'000);
                verb.add("--voxel", choice->voxel, "mm of the grid behind the mesh").shows_default().range(0.1, 1.0);
                verb.add("--jaw", choice->jaws, "mesh of another jaw, mm, LPS");
                verb.add("--keep", choice->keep,
                         "folder for the meshes of flawed and refused guides, with their bones");
                verb.flag("--json", choice->json, "as JSON");
                return [choice] { return run(*choice); };
            }};
}

}  // namespace tactus::bench
