// SPDX-License-Identifier: Apache-2.0
#include "tools/picture/report/plan_page.hpp"

#include "assets/mesh/mesh.hpp"
#include "dsp/core/error.hpp"
#include "dsp/fit/fragment_matcher.hpp"
#include "dsp/fit/gap.hpp"
#include "dsp/fit/overlap.hpp"
#include "dsp/geometry/iso_surface.hpp"
#include "tools/counted.hpp"
#include "tools/picture/report/html_report.hpp"
#include "tools/picture/report/plan_picture.hpp"
#include "tools/picture/scene/surface_map.hpp"
#include "tools/study/bones/fragment_file.hpp"
#include "tools/study/bones/surface_file.hpp"
#include "tools/study/planning/plan_overlaps.hpp"
#include "tools/study/planning/plan_words.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tactus::picture {

namespace {

display::PictureMesh placed(const mesh::Mesh& mesh, const Pose& pose, const Vec3& colour) {
    display::PictureMesh picture;
    for (std::size_t n = 0; n < mesh.vertices.size(); ++n) {
        const Vec3 v = pose.apply(mesh.vertices[n]), d = pose.rotate(mesh.normals[n]);
        for (int axis = 0; axis < 3; ++axis) {
            picture.positions.push_back(static_cast<float>(v[axis]));
            picture.normals.push_back(static_cast<float>(d[axis]));
            picture.colours.push_back(static_cast<float>(colour[axis]));
        }
    }
    for (const auto& triangle : mesh.triangles)
        for (const auto corner : triangle) picture.triangles.push_back(static_cast<std::uint32_t>(corner));
    return picture;
}

/// Colour map of the gap: blue for overlap, white for contact, red for a gap of 1 mm, grey for no neighbour.
Vec3 gap_colour(double distance) {
    if (!std::isfinite(distance)) return Vec3(0.62);
    const double t = std::clamp(distance / 1e-3, -0.5, 1.0);
    return t < 0.0 ? glm::mix(Vec3(0.97), Vec3(0.10, 0.30, 0.85), -2.0 * t)
                   : glm::mix(Vec3(0.97), Vec3(0.80, 0.10, 0.10), t);
}

struct Case {
    cases::CasePlan plan;
    cases::PlanState state{fit::Arrangement(0), {}, {}, std::nullopt};
    std::vector<study::CaseFragment> fragments;
    std::vector<mesh::Mesh> meshes;
    std::vector<std::optional<double>> to_healthy;

    const std::string& name(std::size_t n) const { return plan.fragments[n].name; }
    Pose pose(std::size_t n) const { return state.arrangement.pose(static_cast<int>(n)); }
    bool is_shown(std::size_t n) const { return !state.arrangement.is_hidden(static_cast<int>(n)); }
};

std::vector<display::PictureMesh> scene_of(const Case& c, const cases::PlanState& state) {
    std::vector<display::PictureMesh> meshes;
    for (std::size_t n = 0; n < c.meshes.size(); ++n)
        if (c.is_shown(n))
            meshes.push_back(
                placed(c.meshes[n], state.arrangement.pose(static_cast<int>(n)), c.plan.fragments[n].colour));
    return meshes;
}

Vec3 middle_of(const Case& c, std::size_t n) {
    Vec3 middle(0.0);
    const auto& points = c.fragments[n].bone.points;
    for (const contact::SurfacePoint& p : points) middle += p.position / static_cast<double>(points.size());
    return middle;
}

std::vector<PictureLabel> labels_of(const Case& c, const cases::PlanState& state) {
    std::vector<PictureLabel> labels;
    for (std::size_t n = 0; n < c.meshes.size(); ++n)
        if (c.is_shown(n))
            labels.push_back({c.name(n), state.arrangement.pose(static_cast<int>(n)).apply(middle_of(c, n)),
                              c.plan.fragments[n].colour});
    return labels;
}

std::string pictures(const Case& c) {
    const cases::PlanState before = cases::state_of(c.plan, -1);
    const std::vector<display::PictureMesh> scanned = scene_of(c, before), planned = scene_of(c, c.state);
    const std::vector<PictureLabel> there = labels_of(c, before), here = labels_of(c, c.state);
    return "<h2>Pictures</h2>\n<p class=\"small\">R, L, A, P, S, I: towards the right, left, front, back, head and "
           "feet of the patient. The scale holds at the middle of the scene.</p>\n<div class=\"two\">\n" +
           plan_picture(scanned, Vec3(0.25, 1.0, -0.35), "As scanned, from the front", there) +
           plan_picture(planned, Vec3(0.25, 1.0, -0.35), "As planned, from the front", here) +
           plan_picture(planned, Vec3(-0.35, -1.0, -0.3), "As planned, from behind", here) +
           plan_picture(planned, Vec3(0.1, 0.3, -1.0), "As planned, from above", here) + "</div>\n";
}

/// Legend of the colour maps.
std::string gap_legend() {
    std::string stops;
    for (int n = -2; n <= 4; ++n) {
        const Vec3 c = 255.0 * gap_colour(0.25e-3 * n);
        stops += fmt::format(",rgb({:.0f},{:.0f},{:.0f})", c.x, c.y, c.z);
    }
    return fmt::format(
        "<p class=\"small\">overlap of 0.5 mm or more <span style=\"display:inline-block;width:12rem;height:.8rem;"
        "background:linear-gradient(90deg{})\"></span> gap of 1 mm or more; white: contact; grey: no neighbour"
        "</p>\n",
        stops);
}

/// Pose of each fragment, as in the exported files.
std::string places(const Case& c) {
    std::string out =
        "<h2>Poses</h2>\n<p>p_plan = R p_scan + t, LPS, mm; R as a unit quaternion w x y z.</p>\n<table><tr><th>"
        "fragment</th><th>t, mm</th><th>R</th></tr>\n";
    for (std::size_t n = 0; n < c.fragments.size(); ++n) {
        const auto [t, q] = study::numbers_of(c.pose(n));
        out += fmt::format("<tr><td>{}</td><td>{:.3f} {:.3f} {:.3f}</td><td>{:.6f} {:.6f} {:.6f} {:.6f}</td></tr>\n",
                           html::escaped(c.name(n)), t[0], t[1], t[2], q[0], q[1], q[2], q[3]);
    }
    return out + "</table>\n";
}

std::string fragments_table(const Case& c) {
    std::string out =
        "<h2>Fragments</h2>\n<table><tr><th>fragment</th><th class=\"n\">moved, mm</th><th class=\"n\">turned, °</th>"
        "<th>fitted to</th><th>verdict</th><th class=\"n\">score</th><th class=\"n\">margin</th><th class=\"n\">rms, mm"
        "</th><th class=\"n\">fitted area, mm²</th><th class=\"n\">from the healthy side, mm</th><th>marks</th></tr>\n";
    for (std::size_t n = 0; n < c.fragments.size(); ++n) {
        const Vec3 middle = middle_of(c, n);
        const Vec3& colour = c.plan.fragments[n].colour;
        out += fmt::format(
            "<tr><td><span style=\"background:rgb({:.0f},{:.0f},{:.0f})\">&emsp;</span> {}</td><td class=\"n\">{:.2f}"
            "</td><td class=\"n\">{:.2f}</td>",
            colour.x * 255, colour.y * 255, colour.z * 255, html::escaped(c.name(n)),
            1e3 * glm::length(c.pose(n).apply(middle) - middle), study::angle_deg(c.pose(n)));
        if (const auto& fit = c.state.fits[n]; fit && !c.state.holds(static_cast<int>(n)))
            out += fmt::format("<td>{}</td><td class=\"fail\" colspan=\"5\">{}</td>", html::escaped(fit->partner),
                               html::escaped(study::fit_words(c.state, static_cast<int>(n))));
        else if (fit)
            out += fmt::format(
                "<td>{}</td><td class=\"{}\">{}</td><td class=\"n\">{:.2f}</td><td class=\"n\">{:.2f}</td><td "
                "class=\"n\">{:.3f}</td><td class=\"n\">{}</td>",
                html::escaped(fit->partner), fit->verdict == "fit" ? "pass" : "fail", html::escaped(fit->verdict),
                fit->score, fit->margin, fit->rms * 1e3,
                // Plans of earlier versions do not contain it.
                fit->overlap > 0.0 ? fmt::format("{:.0f}", fit->overlap * 1e6) : "–");
        else out += "<td>–</td><td>–</td><td></td><td></td><td></td><td></td>";
        out += "<td class=\"n\">" + (c.to_healthy[n] ? fmt::format("{:.2f}", *c.to_healthy[n] * 1e3) : "–") + "</td>";
        const int number = static_cast<int>(n);
        std::string marks;
        for (int g = c.state.arrangement.group_of(number); g != fit::Arrangement::none;
             g = c.state.arrangement.parent_of(g))
            marks += (marks.empty() ? "in " : ", in ") + c.state.group_names[static_cast<std::size_t>(g)];
        if (c.state.arrangement.is_locked(number)) marks += " locked";
        if (c.state.arrangement.is_hidden(number)) marks += " hidden";
        out += "<td>" + html::escaped(marks) + "</td></tr>\n";
    }
    return out + "</table>\n";
}

/// Distances of the vertices of a fragment from the other one, each by its own normal: the two sides of thin bone do
/// not mix. A vertex unlike most of those around it takes their middle value.
std::vector<float> vertex_gaps(const Case& c, std::size_t i, std::size_t j) {
    const mesh::Mesh& mesh = c.meshes[i];
    std::vector<contact::SurfacePoint> vertices(mesh.vertices.size());
    for (std::size_t v = 0; v < vertices.size(); ++v)
        vertices[v].position = mesh.vertices[v], vertices[v].normal = mesh.normals[v];
    std::vector<float> gaps = fit::gap_between(vertices, c.pose(i), c.fragments[j].map, c.pose(j)).distance;
    std::vector<std::vector<std::size_t>> around(gaps.size());
    for (const auto& triangle : mesh.triangles)
        for (std::size_t corner = 0; corner < 3; ++corner)
            around[static_cast<std::size_t>(triangle[corner])].push_back(
                static_cast<std::size_t>(triangle[(corner + 1) % 3]));
    std::vector<float> near;
    for (int pass = 0; pass < 3; ++pass) {
        const std::vector<float> before = gaps;
        for (std::size_t v = 0; v < gaps.size(); ++v) {
            if (around[v].size() < 3) continue;
            near.clear();
            for (const std::size_t n : around[v]) near.push_back(before[n]);
            std::ranges::sort(near);
            const float middle = near[near.size() / 2];
            if (std::isfinite(middle) != std::isfinite(before[v])) gaps[v] = middle;
        }
    }
    return gaps;
}

/// A fragment coloured by the distance to the other one, seen from the other one.
std::string gap_map(const Case& c, std::size_t i, std::size_t j, const fit::SurfaceGap& gap) {
    const auto& points = c.fragments[i].bone.points;
    display::PictureMesh mesh = placed(c.meshes[i], c.pose(i), Vec3(0.0));
    const std::vector<float> gaps = vertex_gaps(c, i, j);
    for (std::size_t v = 0; v < gaps.size(); ++v) {
        const Vec3 colour = gap_colour(static_cast<double>(gaps[v]));
        for (int axis = 0; axis < 3; ++axis)
            mesh.colours[3 * v + static_cast<std::size_t>(axis)] = static_cast<float>(colour[axis]);
    }
    Vec3 towards(0.0);
    for (std::size_t n = 0; n < points.size(); ++n)
        if (std::isfinite(gap.distance[n])) towards += points[n].area * c.pose(i).rotate(points[n].normal);
    if (!(glm::length(towards) > 0.0)) return "";
    const Vec3 direction = -glm::normalize(towards);
    const Vec3 tilted = std::abs(direction.z) > 0.95 ? glm::normalize(direction + Vec3(0.3, 0.0, 0.0)) : direction;
    return plan_picture({mesh}, tilted, fmt::format("{}, seen from {}", c.name(i), c.name(j)));
}

std::string css_colour(const Vec3& colour) {
    const Vec3 c = 255.0 * colour;
    return fmt::format("rgb({:.0f},{:.0f},{:.0f})", c.x, c.y, c.z);
}

/// All fragments as planned, coloured by their distance from the healthy side.
std::string mirror_maps(const Case& c, const fit::RegistrationTarget& healthy) {
    constexpr double range = 3e-3;  // m, of the fullest colour
    std::vector<display::PictureMesh> meshes;
    for (std::size_t n = 0; n < c.meshes.size(); ++n) {
        if (!c.is_shown(n)) continue;
        meshes.push_back(placed(c.meshes[n], c.pose(n), Vec3(0.0)));
        std::vector<float>& colours = meshes.back().colours;
        for (std::size_t v = 0; v < c.meshes[n].vertices.size(); ++v) {
            const Vec3 colour = map_colour(healthy.distance(c.pose(n).apply(c.meshes[n].vertices[v])), range);
            for (int axis = 0; axis < 3; ++axis)
                colours[3 * v + static_cast<std::size_t>(axis)] = static_cast<float>(colour[axis]);
        }
    }
    return fmt::format(
               "<h2>Distance from the healthy side</h2>\n<p class=\"small\">0 mm <span "
               "style=\"display:inline-block;width:12rem;height:.8rem;background:linear-gradient(90deg,{},{})\"></"
               "span> "
               "{:g} mm or more, from the mirrored healthy side</p>\n<div class=\"two\">\n",
               css_colour(map_colour(0.0, range)), css_colour(map_colour(range, range)), range * 1e3) +
           plan_picture(meshes, Vec3(0.25, 1.0, -0.35), "Distance from the healthy side, from the front") +
           plan_picture(meshes, Vec3(-0.35, -1.0, -0.3), "Distance from the healthy side, from behind") + "</div>\n";
}

struct Gaps {
    std::string html;
    std::vector<std::string> warnings;  ///< of fragments that lie in each other
};

Gaps gaps(const Case& c) {
    constexpr double much = 5e-9;  // m³
    Gaps found;
    std::string rows, maps;
    for (std::size_t i = 0; i < c.fragments.size(); ++i)
        for (std::size_t j = i + 1; j < c.fragments.size(); ++j) {
            if (!c.is_shown(i) || !c.is_shown(j)) continue;
            const fit::SurfaceGap gap =
                fit::gap_between(c.fragments[i].bone.points, c.pose(i), c.fragments[j].map, c.pose(j));
            const double overlap =
                fit::overlap_volume(c.fragments[i].bone.distance, c.pose(i), c.fragments[j].map, c.pose(j));
            if (overlap > much &&
                fit::lie_in_each_other({c.fragments[i].bone.points, &c.fragments[i].map, c.pose(i), c.pose(i)},
                                       {c.fragments[j].bone.points, &c.fragments[j].map, c.pose(j), c.pose(j)},
                                       fit::MatcherSettings{}.fit.most_penetration))
                found.warnings.push_back(fmt::format("'{}' and '{}' lie in each other with {:.0f} mm³", c.name(i),
                                                     c.name(j), overlap * 1e9));
            if (!(gap.facing_area > 5e-6)) continue;
            rows += fmt::format(
                "<tr><td>{}</td><td>{}</td><td class=\"n\">{:.0f}</td><td class=\"n\">{:.0f}</td><td "
                "class=\"n\">{:.2f}</td><td class=\"n\">{:.2f}</td><td class=\"n\">{:.2f}</td><td class=\"n\">{:.1f}"
                "</td></tr>\n",
                html::escaped(c.name(i)), html::escaped(c.name(j)), gap.facing_area * 1e6, gap.contact_area * 1e6,
                study::shown_mm(gap.median * 1e3), study::shown_mm(gap.p95 * 1e3),
                study::deepest_between(c.fragments[i], c.pose(i), c.fragments[j], c.pose(j)) * 1e3, overlap * 1e9);
            if (gap.facing_area > 20e-6) maps += gap_map(c, i, j, gap);
        }
    if (rows.empty()) {
        found.html = "<h2>Gaps and overlaps</h2>\n<p>No two fragments face each other within 3 mm.</p>\n";
        return found;
    }
    found.html =
        "<h2>Gaps and overlaps</h2>\n<table><tr><th>fragment</th><th>and</th><th class=\"n\">facing, mm²</th><th "
        "class=\"n\">touching, mm²</th><th class=\"n\">median gap, mm</th><th class=\"n\">95 %, mm</th><th "
        "class=\"n\">deepest, mm</th><th class=\"n\">overlap, mm³</th></tr>\n" +
        rows + "</table>\n" + gap_legend() + "<div class=\"two\">\n" + maps + "</div>\n";
    return found;
}

std::string steps(const Case& c) {
    std::string out =
        "<h2>Order of steps</h2>\n<table><tr><th class=\"n\">step</th><th>time</th><th>by</th><th>what</th></tr>\n";
    std::size_t count = 0;
    for (const int n : fit::steps_to(c.plan.before(), c.plan.place().head)) {
        const cases::PlanStep& step = c.plan.steps[static_cast<std::size_t>(n)];
        std::string what(cases::name_of(step.kind));
        for (const int f : step.fragments) what += " " + c.name(static_cast<std::size_t>(f));
        if (!step.group.empty()) what += fmt::format(" as '{}'", step.group);
        if (step.mirror)
            what += fmt::format(" {}, {:.2f} mm median residual", step.mirror->file, step.mirror->residual * 1e3);
        if (step.fit)
            what += fmt::format(", {} to {}, {:.0f} mm² in contact, {:.3f} mm rms, gap {:.2f} mm, {:.2f} mm deep",
                                step.fit->verdict, step.fit->partner, step.fit->overlap * 1e6, step.fit->rms * 1e3,
                                study::shown_mm(step.fit->gap * 1e3), step.fit->penetration * 1e3);
        const std::string time = step.run_second ? fmt::format("{:.3f} s", *step.run_second) : step.time;
        out += fmt::format("<tr><td class=\"n\">{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n", ++count,
                           html::escaped(time), html::escaped(step.by), html::escaped(what));
    }
    return count == 0 ? "<h2>Order of steps</h2>\n<p>There are no steps.</p>\n" : out + "</table>\n";
}

std::string alternatives(const cases::CasePlan& plan) {
    std::string out = "<h2>Alternatives</h2>\n<ul>\n";
    for (const cases::PlanAlternative& a : plan.alternatives)
        out += fmt::format("<li>{}: {}</li>\n", html::escaped(a.name),
                           counted(fit::steps_to(plan.before(), a.place.head).size(), "step"));
    return out + "</ul>\n";
}

std::string list_of(const std::vector<std::string>& lines) {
    std::string out = "<ul>\n";
    for (const std::string& line : lines) out += "<li>" + html::escaped(line) + "</li>\n";
    return out + "</ul>\n";
}

/// What a reader must know before anything else.
std::string warnings(const Case& c, const std::vector<std::string>& overlaps) {
    std::vector<std::string> all;
    if (!study::is_in_one_part(c.state)) all.emplace_back("The fragments are not all connected by fits that hold.");
    for (std::size_t n = 0; n < c.fragments.size(); ++n)
        if (c.state.fits[n] && !c.state.holds(static_cast<int>(n)))
            all.push_back(c.name(n) + ": " + study::fit_words(c.state, static_cast<int>(n)));
    all.insert(all.end(), overlaps.begin(), overlaps.end());
    if (all.empty()) return "";
    return "<div class=\"fail\"><h2>Warnings</h2>\n" + list_of(all) + "</div>\n";
}

/// Which fragments are connected by fits.
std::string connections(const Case& c) {
    const std::vector<std::string> lines = study::connection_words(c.plan, c.state);
    return lines.empty() ? "" : "<h2>Connections</h2>\n" + list_of(lines);
}

std::string mirror(const Case& c) {
    if (!c.state.mirror) return "";
    return fmt::format(
        "<h2>Mirror of the healthy side</h2>\n<p>{}: median distance {:.2f} mm. This residual includes the asymmetry "
        "of the body; there is no ground truth to compare with.</p>\n",
        html::escaped(c.state.mirror->file), c.state.mirror->residual * 1e3);
}

}  // namespace

std::string plan_page(const cases::CasePlan& plan, std::vector<study::CaseFragment> fragments,
                      std::vector<std::optional<double>> to_healthy, const std::string& first,
                      const fit::RegistrationTarget* healthy) {
    Case c;
    c.plan = plan;
    c.state = cases::state_of(c.plan);
    c.fragments = std::move(fragments);
    c.to_healthy = std::move(to_healthy);
    c.to_healthy.resize(c.fragments.size());
    for (const study::CaseFragment& fragment : c.fragments)
        c.meshes.push_back(mesh::surface_of(fragment.bone.distance));
    std::string pages;
    std::vector<std::string> overlaps;
    try {
        Gaps found = gaps(c);
        pages = pictures(c) + found.html + (healthy ? mirror_maps(c, *healthy) : "");
        overlaps = std::move(found.warnings);
    } catch (const Error& error) {
        throw Error(fmt::format("the pictures cannot be made: {}", error.what()));
    }
    const std::string body =
        fmt::format("<p>Alternative '{}', {}. Research use; not a medical device.</p>\n",
                    html::escaped(c.plan.alternatives[static_cast<std::size_t>(c.plan.current)].name),
                    counted(c.fragments.size(), "fragment")) +
        first + warnings(c, overlaps) + connections(c) + fragments_table(c) + mirror(c) + pages + places(c) + steps(c) +
        alternatives(c.plan);
    return html::page(c.plan.title, body);
}

}  // namespace tactus::picture
