// SPDX-License-Identifier: Apache-2.0
// Random walks on real fractures, beside scikit-image, and their cost.
#include "assets/file/json.hpp"
#include "dsp/core/processor_time.hpp"
#include "dsp/segmentation/random_walk.hpp"
#include "dsp/segmentation/uncertain.hpp"
#include "dsp/segmentation/watershed.hpp"
#include "tools/analysis/workers.hpp"
#include "tools/bench/bench.hpp"
#include "tools/bench/segmentation/formats.hpp"
#include "tools/bench/segmentation/seeded_case.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <string>

namespace tactus::bench {

namespace {

using file::Json;

struct SegmentChoice {
    std::filesystem::path data, peer_cache;
    std::vector<std::string> cases{"sacrum003", "hip003", "hip001"};
    int seedings = 20, dabs = 6, peers = 3;
    bool no_costs = false, no_formats = false, only_formats = false, json = false;
};

/// Mean and half the 95 % interval by Student's t.
struct Interval {
    double mean = 0.0, half = 0.0;
};
Interval interval_of(const std::vector<double>& values) {
    const auto n = static_cast<double>(values.size());
    Interval out;
    for (const double v : values) out.mean += v / n;
    double square = 0.0;
    for (const double v : values) square += (v - out.mean) * (v - out.mean);
    // 97.5 % quantile of Student's t; Cornish and Fisher's expansion, 0.01 off at 5 values.
    const double z = 1.959964, f = n - 1.0;
    const double t =
        z + (z * z * z + z) / (4.0 * f) + (5.0 * std::pow(z, 5) + 16.0 * z * z * z + 3.0 * z) / (96.0 * f * f);
    if (values.size() > 1) out.half = t * std::sqrt(square / f / n);
    return out;
}

struct SeriesResult {
    std::vector<double> dice, three_dabs, first_seconds, dab_seconds, peer_dice, difference, peer_seconds;
    std::vector<double> one_dab, two_dabs;
    std::vector<double> preview, preview_seconds;  ///< by a watershed
    std::vector<double> corrected;    ///< after three dabs on the largest error
    std::vector<double> dabs_needed;  ///< on the largest error, for 0.97; of those that reach it within 20
};

/// A dab at the deepest voxel of the largest region whose certainty is low, or which is wrong. False: there is none.
bool dab_largest(const SeededCase& real, const std::vector<float>& certain, std::vector<std::uint8_t>& seed) {
    const auto regions = segmentation::uncertain_regions(real.graph, certain);
    if (regions.empty()) return false;
    const auto& at = regions.front().deepest;
    add_dab(real, static_cast<std::size_t>(real.node_of_voxel[real.grid.index(at[0], at[1], at[2])]), seed);
    return true;
}

std::vector<float> zero_where_wrong(const SeededCase& real, const std::vector<std::uint8_t>& label) {
    std::vector<float> out(label.size());
    for (std::size_t n = 0; n < out.size(); ++n) out[n] = label[n] == real.truth[n] ? 1.0f : 0.0f;
    return out;
}

/// One series of seedings: fixed ones have seeds 1 and on, unseen ones 1001 and on.
SeriesResult run_series(const SeededCase& real, std::uint64_t first, const SegmentChoice& choice) {
    constexpr int max_dabs = 20;
    SeriesResult out;
    const auto seeds_of = [&](int n) {
        return painted_seeds(real, choice.dabs, Random{first + static_cast<std::uint64_t>(n)});
    };
    std::vector<std::vector<std::uint8_t>> compared;
    for (int n = 0; n < std::min(choice.peers, choice.seedings); ++n) compared.push_back(seeds_of(n));
    std::vector<PeerLabels> peers;
    if (!compared.empty()) peers = peer_labels(real, compared, choice.peer_cache);
    for (int n = 0; n < choice.seedings; ++n) {
        std::vector<std::uint8_t> seed = seeds_of(n);
        double begin = process_seconds();
        segmentation::Walks walks = segmentation::random_walks(graph_of_seeds(real, seed), seed, real.labels);
        out.first_seconds.push_back(process_seconds() - begin);
        double dice = mean_dice(real, segmentation::labels_of(walks));
        out.dice.push_back(dice);
        begin = process_seconds();
        const std::vector<std::uint8_t> preview = segmentation::watershed(graph_of_seeds(real, seed), seed);
        out.preview_seconds.push_back(process_seconds() - begin);
        out.preview.push_back(mean_dice(real, preview));
        if (n < std::ssize(peers)) {
            const PeerLabels& peer = peers[static_cast<std::size_t>(n)];
            out.peer_dice.push_back(mean_dice(real, peer.label));
            out.difference.push_back(dice - out.peer_dice.back());
            out.peer_seconds.push_back(peer.seconds);
        }
        // One user looks where the result is uncertain, another one sees the largest error.
        const segmentation::Walks first_walks = walks;
        auto looked = seed;
        for (int dab = 1; dab <= 3; ++dab) {
            if (dab_largest(real, segmentation::certainty_of(walks), looked)) {
                begin = process_seconds();
                walks = segmentation::random_walks(graph_of_seeds(real, looked), looked, real.labels, {}, &walks);
                out.dab_seconds.push_back(process_seconds() - begin);
            }
            (dab == 1   ? out.one_dab
             : dab == 2 ? out.two_dabs
                        : out.three_dabs)
                .push_back(mean_dice(real, segmentation::labels_of(walks)));
        }
        walks = first_walks;
        int reached = dice >= 0.97 ? 0 : -1;
        for (int dab = 1; dab <= max_dabs && (dab <= 3 || reached < 0); ++dab) {
            if (!dab_largest(real, zero_where_wrong(real, segmentation::labels_of(walks)), seed)) break;
            walks = segmentation::random_walks(graph_of_seeds(real, seed), seed, real.labels, {}, &walks);
            dice = mean_dice(real, segmentation::labels_of(walks));
            if (dab == 3) out.corrected.push_back(dice);
            if (reached < 0 && dice >= 0.97) reached = dab;
        }
        if (reached >= 0) out.dabs_needed.push_back(reached);
    }
    return out;
}

/// scikit-image beside ours on the same seeds.
Json peer_report(const SeriesResult& r, bool quiet) {
    const Interval peer = interval_of(r.peer_dice), difference = interval_of(r.difference),
                   seconds = interval_of(r.peer_seconds), ours = interval_of(r.first_seconds);
    if (!quiet)
        fmt::print(
            "           scikit-image on {} of them: Dice {:.4f}, ours better by {:.4f} ± {:.4f}; {:.2f} s, {:.0f} "
            "times ours\n",
            r.difference.size(), peer.mean, difference.mean, difference.half, seconds.mean, seconds.mean / ours.mean);
    return {{"seedings", r.difference.size()}, {"dice", peer.mean},
            {"difference", difference.mean},   {"difference_half_interval", difference.half},
            {"seconds", seconds.mean},         {"times_faster", seconds.mean / ours.mean}};
}

Json report(const SeededCase& real, const char* series, const SeriesResult& r, bool quiet) {
    const Interval dice = interval_of(r.dice), one = interval_of(r.one_dab), two = interval_of(r.two_dabs),
                   three = interval_of(r.three_dabs), corrected = interval_of(r.corrected),
                   first = interval_of(r.first_seconds), dab = interval_of(r.dab_seconds);
    Json row{{"case", real.name},
             {"series", series},
             {"nodes", real.graph.nodes()},
             {"labels", real.labels},
             {"seedings", r.dice.size()},
             {"dice", dice.mean},
             {"dice_half_interval", dice.half},
             {"dice_after_dabs", {one.mean, two.mean, three.mean}},
             {"dice_after_three_corrections", corrected.mean},
             {"reach_0_97", r.dabs_needed.size()},
             {"dabs_for_0_97", r.dabs_needed.empty() ? Json() : Json(interval_of(r.dabs_needed).mean)},
             {"dice_of_preview", interval_of(r.preview).mean},
             {"preview_s", interval_of(r.preview_seconds).mean},
             {"first_s", first.mean},
             {"dab_s", dab.mean}};
    if (!quiet)
        fmt::print(
            "{:<10} {:<6} {} nodes, {} seedings: Dice {:.4f} ± {:.4f}\n"
            "           after 1, 2, 3 dabs where it is uncertain {:.4f}, {:.4f}, {:.4f}; after 3 on the largest error "
            "{:.4f}; 0.97 reached by {}, with {:.1f} dabs\n"
            "           first solve {:.3f} s, after a dab {:.3f} s of processor time\n",
            real.name, series, real.graph.nodes(), r.dice.size(), dice.mean, dice.half, one.mean, two.mean, three.mean,
            corrected.mean, r.dabs_needed.size(), r.dabs_needed.empty() ? 0.0 : interval_of(r.dabs_needed).mean,
            first.mean, dab.mean);
    if (!quiet)
        fmt::print("           preview by a watershed: Dice {:.4f}, {:.3f} s\n", interval_of(r.preview).mean,
                   interval_of(r.preview_seconds).mean);
    if (r.difference.empty()) return row;
    row["peer"] = peer_report(r, quiet);
    return row;
}

void print_formats(const Json& row) {
    fmt::print(
        "{:<10} labels that differ: uint16 {:.2g}, float {:.2g} (of int16); HU / 1000 {:.2g}, 8 bits {:.2g} (of HU)\n",
        row["case"].as_text(), row["uint16"].get<double>(), row["float"].get<double>(),
        row["hu_over_1000"].get<double>(), row["eight_bits"].get<double>());
}

/// Most memory that the process has held since the last call, bytes; 0 where the system does not tell.
double max_memory_since() {
    double most = 0.0;
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with("VmHWM:")) most = 1024.0 * std::strtod(line.c_str() + 6, nullptr);
    std::ofstream("/proc/self/clear_refs") << "5";  // begins anew
    return most;
}

/// A block of bone with noise and dark planes between ten fragments along x.
Json cost_row(int edge, int labels, bool quiet) {
    volume::Grid grid{{edge, edge, edge}, Vec3(0.0), Vec3(1e-3), {}};
    grid.values.resize(grid.count());
    const int width = std::max(2, edge / labels);
    std::vector<std::uint8_t> inside(grid.count(), 1);
    for (std::size_t v = 0; v < grid.values.size(); ++v) {
        const int i = static_cast<int>(v % static_cast<std::size_t>(edge));
        const bool gap = i % width == width - 1 && i / width + 1 < labels;
        grid.values[v] = static_cast<float>((gap ? 300.0 : 700.0) + 60.0 * Random{1}.normal(v));
    }
    const segmentation::VoxelGraph graph = segmentation::make_voxel_graph(grid, inside, {640.0, 120.0, 1e-4});
    std::vector<std::uint8_t> seed(graph.nodes(), 0);
    for (int l = 0; l < labels; ++l)
        seed[grid.index(std::min(edge - 1, l * width + width / 2), (l * 37) % edge, (l * 53) % edge)] =
            static_cast<std::uint8_t>(l + 1);
    timespec wall{}, done_at{};
    max_memory_since();
    clock_gettime(CLOCK_MONOTONIC, &wall);
    const double begin = process_seconds();
    const segmentation::Walks walks =
        segmentation::random_walks(graph, seed, labels, {}, nullptr, analysis::on_threads());
    const double seconds = process_seconds() - begin, memory = max_memory_since();
    clock_gettime(CLOCK_MONOTONIC, &done_at);
    const double elapsed =
        static_cast<double>(done_at.tv_sec - wall.tv_sec) + 1e-9 * static_cast<double>(done_at.tv_nsec - wall.tv_nsec);
    const double each = 1e9 * seconds / static_cast<double>(graph.nodes()) / (labels - 1);
    if (!quiet)
        fmt::print(
            "{} unknowns, {} labels: {:.2f} s of processor time, {:.2f} s on the clock, {} iterations, residual "
            "{:.1e}; {:.0f} ns per unknown and system; {:.2f} GB\n",
            graph.nodes(), labels, seconds, elapsed, walks.iterations, walks.residual, each, 1e-9 * memory);
    return {{"unknowns", graph.nodes()},
            {"labels", labels},
            {"cpu_s", seconds},
            {"elapsed_s", elapsed},
            {"iterations", walks.iterations},
            {"residual", walks.residual},
            {"ns_per_unknown", each},
            {"max_memory_bytes", memory}};
}

}  // namespace

int bench_segment(const SegmentChoice& choice) {
    Json rows = Json::array(), formats = Json::array(), costs = Json::array(), peers = Json::array();
    for (const std::string& name : choice.cases) {
        const auto real = seeded_case(choice.data, name);
        if (!real) {
            fmt::print(stderr, "{}: skipped: no {}/fragments/{}_ct.nrrd with labels\n", name, choice.data.string(),
                       name);
            continue;
        }
        if (!choice.no_formats) {
            formats.push_back(format_row(*real, choice.dabs));
            if (!choice.json) print_formats(formats.back());
        }
        if (choice.only_formats) continue;
        SeriesResult fixed = run_series(*real, 1, choice);
        rows.push_back(report(*real, "fixed", fixed, choice.json));
        const SeriesResult unseen = run_series(*real, 1001, choice);
        rows.push_back(report(*real, "unseen", unseen, choice.json));
        if (fixed.difference.empty()) continue;
        const auto append = [](std::vector<double>& to, const std::vector<double>& from) {
            to.insert(to.end(), from.begin(), from.end());
        };
        append(fixed.peer_dice, unseen.peer_dice);
        append(fixed.difference, unseen.difference);
        append(fixed.peer_seconds, unseen.peer_seconds);
        append(fixed.first_seconds, unseen.first_seconds);
        if (!choice.json) fmt::print("{:<10} fixed and unseen together:\n", real->name);
        peers.push_back(peer_report(fixed, choice.json));
        peers.back()["case"] = real->name;
    }
    if (!choice.no_costs && !choice.only_formats) {
        for (const int edge : {46, 74, 100, 126, 159}) costs.push_back(cost_row(edge, 2, choice.json));
        costs.push_back(cost_row(126, 10, choice.json));
    }
    if (choice.json)
        fmt::print(
            "{}\n",
            Json{{"version", 1}, {"cases", rows}, {"peers", peers}, {"formats", formats}, {"costs", costs}}.dump(2));
    return done;
}

Verb segment_verb() {
    return {"segment", "fragments by random walks on real fractures, beside scikit-image; cost by size",
            [](VerbOptions& verb) -> Action {
                const auto choice = std::make_shared<SegmentChoice>();
                if (const char* folder = std::getenv("TACTUS_SHARED_DATA")) choice->data = folder;
                verb.add("--data", choice->data, "folder with fragments/NAME_ct.nrrd (default: TACTUS_SHARED_DATA)");
                verb.add("--case", choice->cases, "only these: sacrum003, hip003, hip001; separated by commas")
                    .separated_by(',');
                verb.add("--seedings", choice->seedings, "of each series").shows_default().range(2, 1000);
                verb.add("--dabs", choice->dabs, "per label").shows_default().range(1, 100);
                verb.add("--peers", choice->peers, "seedings of each series that scikit-image does, too")
                    .shows_default()
                    .range(0, 1000);
                verb.add("--peer-cache", choice->peer_cache, "folder that keeps the labels of scikit-image");
                verb.flag("--no-costs", choice->no_costs, "leave out the cost by size");
                verb.flag("--no-formats", choice->no_formats, "leave out the labels of files of several types");
                verb.flag("--only-formats", choice->only_formats,
                          "only the labels of one scan as files of several types");
                verb.flag("--json", choice->json, "as JSON");
                return [choice] { return bench_segment(*choice); };
            }};
}

}  // namespace tactus::bench
