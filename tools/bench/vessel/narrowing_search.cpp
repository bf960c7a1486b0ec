// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/vessel/narrowing_search.hpp"

#include "dsp/core/random.hpp"
#include "dsp/simulate/vessel_cases.hpp"
#include "dsp/vessel/track_warnings.hpp"
#include "dsp/vessel/tracker.hpp"
#include "tools/analysis/workers.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace tactus::bench {

using file::Json;

namespace {

struct Draw {
    simulate::TrueStenosis truth;
    double noise = 0.0;
};

Draw drawn(std::uint64_t index) {
    const Random random{9000};
    std::uint64_t n = 16 * index;
    const auto number = [&](double low, double high) { return low + (high - low) * random.uniform(n++); };
    Draw draw;
    constexpr double longest = 30.0;  // voxels; the vessel goes on for as many on either side
    draw.truth.radius = number(1.5, 6.0);
    draw.truth.length = number(1.5, std::min(8.0, longest / draw.truth.radius));
    draw.truth.percent = number(0.0, 97.0);
    draw.noise = number(0.05, 0.4);
    using Shape = simulate::TrueStenosis::Shape;
    draw.truth.shape = number(0.0, 1.0) < 0.5 ? Shape::cosine : Shape::flat;
    draw.truth.aside = number(0.0, 1.0) < 0.5 ? 0.0 : number(0.0, 1.0);
    const Vec3 direction = glm::normalize(Vec3(number(0.0, 1.0), number(0.0, 1.0), number(0.0, 1.0)) + 1e-3);
    if (direction.x <= 0.9) draw.truth.direction = direction;
    return draw;
}

struct Outcome {
    enum { found, ended, lost, none } what = none;
    double percent = 0.0, error = 0.0;
    bool is_uncertain = false;
    bool is_said = false;  ///< a warning stands where the track ends
    vessel::End end = vessel::End::contrast;  ///< there
    double length = 0.0;  ///< of the branch that ends, in radii of the phantom
};

Outcome outcome_of(const Draw& draw, std::uint64_t index) {
    const simulate::VesselCase one = simulate::stenosis_case(draw.truth, 7000 + index, draw.noise);
    const vessel::Track track = vessel::follow(one.scan, one.seed).track;
    Outcome out;
    if (track.branches.empty()) return out;
    const vessel::Branch& branch = track.branches.front();
    const std::vector<Vec3>& line = one.lines.front();
    const Vec3 middle = line[line.size() * 6 / 10], along = glm::normalize(line.back() - line.front());
    bool passes = false;
    for (const vessel::Node& node : branch.nodes)
        passes = passes || glm::dot(node.position - middle, along) > 0.5 * draw.truth.length * one.radius;
    if (!passes) {
        out.what = Outcome::ended;
        const bool is_at_end =
            glm::length(branch.nodes.back().position - middle) < glm::length(branch.nodes.front().position - middle);
        out.end = is_at_end ? branch.end : branch.start;
        out.length = branch.length() / one.radius;
        for (const vessel::TrackWarning& warning : vessel::warnings_of(track))
            out.is_said =
                out.is_said || (warning.branch == 0 && glm::length(branch.nodes[warning.node].position - middle) <
                                                           (0.5 * draw.truth.length + 3.0) * one.radius);
    } else if (branch.stenosis) {
        out.what = branch.lost().empty() ? Outcome::found : Outcome::lost;
        out.percent = branch.stenosis->percent;
        out.error = branch.stenosis->error_percent;
        out.is_uncertain = branch.stenosis->is_uncertain;
    }
    return out;
}

}  // namespace

Json narrowing_search(int draws) {
    std::vector<Outcome> outcomes(static_cast<std::size_t>(draws));
    analysis::on_threads()(draws, [&](int n) {
        const auto index = static_cast<std::uint64_t>(n);
        outcomes[index] = outcome_of(drawn(index), index);
    });
    int ended = 0, said = 0, ended_below_80 = 0, none = 0, uncertain = 0, off_by_10 = 0, measured = 0;
    Json wrong = Json::array(), unsaid = Json::array();
    for (std::size_t n = 0; n < outcomes.size(); ++n) {
        const Outcome& out = outcomes[n];
        ended += out.what == Outcome::ended;
        said += out.what == Outcome::ended && out.is_said;
        ended_below_80 += out.what == Outcome::ended && drawn(n).truth.percent < 80.0;
        none += out.what == Outcome::none;
        if (out.what == Outcome::ended && !out.is_said) {
            const Draw draw = drawn(n);
            unsaid.push_back({{"draw", n},
                              {"radius_voxels", draw.truth.radius},
                              {"length_radii", draw.truth.length},
                              {"percent", draw.truth.percent},
                              {"noise", draw.noise},
                              {"end", std::string(vessel::reason_of(out.end))},
                              {"branch_radii", out.length}});
        }
        if (out.what == Outcome::ended || out.what == Outcome::none) continue;
        uncertain += out.is_uncertain;
        if (out.is_uncertain) continue;
        ++measured;
        const Draw draw = drawn(n);
        const double off = std::abs(out.percent - draw.truth.percent);
        off_by_10 += off > 10.0;
        if (off <= 15.0) continue;
        const Vec3 direction = draw.truth.direction.value_or(Vec3(0.0));
        wrong.push_back({{"draw", n},
                         {"radius_voxels", draw.truth.radius},
                         {"length_radii", draw.truth.length},
                         {"percent", draw.truth.percent},
                         {"noise", draw.noise},
                         {"flat", draw.truth.shape == simulate::TrueStenosis::Shape::flat},
                         {"aside", draw.truth.aside},
                         {"direction", {direction.x, direction.y, direction.z}},
                         {"read_percent", out.percent},
                         {"error_percent", out.error},
                         {"lost", out.what == Outcome::lost}});
    }
    return {{"case", "search"},
            {"draws", draws},
            {"not_followed", none},
            {"end_at_it", ended},
            {"end_with_warning", said},
            {"end_without", unsaid},
            {"end_below_80_percent", ended_below_80},
            {"uncertain", uncertain},
            {"certain", measured},
            {"off_by_10", off_by_10},
            {"off_by_15", wrong.size()},
            {"wrong", wrong}};
}

void print_search(const Json& row) {
    fmt::print(
        "search: {} narrowings: {} certain, of these {} off by more than 10 points and {} by more than 15; {} called "
        "uncertain; {} tracks end at it, {} with a warning, {} below 80 %; {} vessels not followed\n",
        row["draws"].get<int>(), row["certain"].get<int>(), row["off_by_10"].get<int>(), row["off_by_15"].get<int>(),
        row["uncertain"].get<int>(), row["end_at_it"].get<int>(), row["end_with_warning"].get<int>(),
        row["end_below_80_percent"].get<int>(), row["not_followed"].get<int>());
    for (const Json& one : row["end_without"])
        fmt::print(
            "  draw {}: R {:.1f} voxels, {:.0f} % over {:.1f} R, noise {:.2f}: ends without a warning after {:.0f} R, "
            "where {}\n",
            one["draw"].get<int>(), one["radius_voxels"].get<double>(), one["percent"].get<double>(),
            one["length_radii"].get<double>(), one["noise"].get<double>(), one["branch_radii"].get<double>(),
            one["end"].as_text());
    for (const Json& one : row["wrong"])
        fmt::print(
            "  draw {}: R {:.1f} voxels, {:.0f} % over {:.1f} R{}, aside {:.1f}, noise {:.2f}: read {:.0f} ± {:.0f} "
            "%{}\n",
            one["draw"].get<int>(), one["radius_voxels"].get<double>(), one["percent"].get<double>(),
            one["length_radii"].get<double>(), one["flat"].get<bool>() ? ", flat" : "", one["aside"].get<double>(),
            one["noise"].get<double>(), one["read_percent"].get<double>(), one["error_percent"].get<double>(),
            one["lost"].get<bool>() ? ", beside a lost stretch" : "");
}

}  // namespace tactus::bench
