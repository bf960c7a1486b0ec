// SPDX-License-Identifier: Apache-2.0
#include "tools/picture/report/plan_page.hpp"

#include "assets/mesh/mesh.hpp"
#include "dsp/core/error.hpp"
#include "dsp/fit/fragment_matcher.hpp"
#include "dsp/fit/gap.hpp"
#include "dsp/fit/mutual_gap.hpp"
#include "dsp/fit/overlap.hpp"
#include "dsp/geometry/iso_surface.hpp"
#include "tools/counted.hpp"
#include "tools/picture/flap/flap_scene.hpp"
#include "tools/picture/report/html_report.hpp"
#include "tools/picture/report/plan_picture.hpp"
#include "tools/picture/scene/surface_map.hpp"
#include "tools/study/bones/fragment_file.hpp"
#include "tools/study/bones/surface_file.hpp"
#include "tools/study/planning/plan_overlaps.hpp"
#include "tools/study/planning/plan_vessels.hpp"
#include "tools/study/planning/plan_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>

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
    std::vector<study::VesselClearance> vessels;

    const std::string& name(std::size_t n) const { return plan.fragments[n].name; }
    Pose pose(std::size_t n) const { return state.arrangement.pose(static_cast<int>(n)); }
    bool is_shown(std::size_t n) const { return !state.arrangement.is_hidden(static_cast<int>(n)); }
};

const Vec3& colour_of(const reconstruct::FlapVessel& vessel) {
    return vessel.kind == reconstruct::VesselKind::artery ? artery_colour : vein_colour;
}

std::vector<display::PictureMesh> scene_of(const Case& c, const cases::PlanState& state) {
    std::vector<display::PictureMesh> meshes;
    for (std::size_t n = 0; n < c.meshes.size(); ++n)
        if (c.is_shown(n))
            meshes.push_back(
                placed(c.meshes[n], state.arrangement.pose(static_cast<int>(n)), c.plan.fragments[n].colour));
    for (const study::VesselClearance& v : c.vessels)
        meshes.push_back(tube_mesh(v.vessel->points, v.vessel->radius, colour_of(*v.vessel)));
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
    for (const study::VesselClearance& v : c.vessels)
        labels.push_back({v.vessel->name, v.vessel->points[v.vessel->points.size() / 2], colour_of(*v.vessel)});
    return labels;
}

void add_pictures(const Case& c, std::vector<ReportBlock>& out) {
    const cases::PlanState before = cases::state_of(c.plan, -1);
    const std::vector<display::PictureMesh> scanned = scene_of(c, before), planned = scene_of(c, c.state);
    const std::vector<PictureLabel> there = labels_of(c, before), here = labels_of(c, c.state);
    out.emplace_back(Heading{"Pictures"});
    if (planned.empty()) {
        out.emplace_back(Paragraph{"All fragments are hidden."});
        return;
    }
    out.emplace_back(
        Paragraph{"R, L, A, P, S, I: towards the right, left, front, back, head and feet of the patient. The scale "
                  "holds at the middle of the scene."});
    out.emplace_back(
        PictureGrid{{labelled_picture(scanned, Vec3(0.25, 1.0, -0.35), "As scanned, from the front", there),
                     labelled_picture(planned, Vec3(0.25, 1.0, -0.35), "As planned, from the front", here),
                     labelled_picture(planned, Vec3(-0.35, -1.0, -0.3), "As planned, from behind", here),
                     labelled_picture(planned, Vec3(0.1, 0.3, -1.0), "As planned, from above", here)}});
}

/// A bar of the colours from share 0 to 1.
template <class Colour>
Drawing legend(const Colour& colour, const std::string& least, const std::string& most, const std::string& caption) {
    constexpr double left = 190.0, width = 180.0;
    constexpr int steps = 90;
    display::Figure figure(560.0, 26.0);
    for (int n = 0; n < steps; ++n) {
        const Vec3 c = 255.0 * colour((n + 0.5) / steps);
        figure.rectangle(
            left + n * width / steps, 6.0, width / steps + 0.5, 14.0,
            {static_cast<std::uint8_t>(c.x), static_cast<std::uint8_t>(c.y), static_cast<std::uint8_t>(c.z), 1.0});
    }
    figure.text({left - 8.0, 17.0}, least, 12.0, {}, display::TextAnchor::end);
    figure.text({left + width + 8.0, 17.0}, most, 12.0);
    return {std::move(figure), caption};
}

Drawing gap_legend() {
    return legend([](double share) { return gap_colour(share * 1.5e-3 - 0.5e-3); }, "overlap of 0.5 mm or more",
                  "gap of 1 mm or more", "White: contact; grey: no neighbour within 3 mm");
}

/// Pose of each fragment, as in the exported files.
ReportTable places(const Case& c) {
    ReportTable table{{"fragment", "t, mm", "R"}, {}};
    for (std::size_t n = 0; n < c.fragments.size(); ++n) {
        const auto [t, q] = study::numbers_of(c.pose(n));
        table.rows.push_back({c.name(n), fmt::format("{:.3f} {:.3f} {:.3f}", t[0], t[1], t[2]),
                              fmt::format("{:.6f} {:.6f} {:.6f} {:.6f}", q[0], q[1], q[2], q[3])});
    }
    return table;
}

/// Groups, lock and hidden state of a fragment in words.
std::string marks_of(const Case& c, int number) {
    const fit::Arrangement& a = c.state.arrangement;
    std::vector<std::string> marks;
    for (int g = a.group_of(number); g != fit::Arrangement::none; g = a.parent_of(g))
        marks.push_back("in " + c.state.group_names[static_cast<std::size_t>(g)]);
    if (a.is_locked(number)) marks.emplace_back("locked");
    if (a.is_hidden(number)) marks.emplace_back("hidden");
    return fmt::format("{}", fmt::join(marks, ", "));
}

ReportTable fragments_table(const Case& c) {
    ReportTable table{{"fragment", "moved, mm", "turned, °", "fitted to", "verdict", "score", "margin", "rms, mm",
                       "fitted area, mm²", "from the healthy side, mm", "marks"},
                      {}};
    for (std::size_t n = 0; n < c.fragments.size(); ++n) {
        const int number = static_cast<int>(n);
        const Vec3 middle = middle_of(c, n);
        std::vector<std::string> row{c.name(n),
                                     fmt::format("{:.2f}", 1e3 * glm::length(c.pose(n).apply(middle) - middle)),
                                     fmt::format("{:.2f}", study::angle_deg(c.pose(n)))};
        const auto& fit = c.state.fits[n];
        const bool is_void = fit && !c.state.holds(number);
        if (!fit) row.insert(row.end(), {"–", "–", "–", "–", "–", "–"});
        else if (is_void) row.insert(row.end(), {fit->partner, study::fit_words(c.state, number), "–", "–", "–", "–"});
        else
            row.insert(row.end(), {fit->partner, fit->verdict, fmt::format("{:.2f}", fit->score),
                                   fmt::format("{:.2f}", fit->margin), fmt::format("{:.3f}", fit->rms * 1e3),
                                   // Plans of earlier versions do not contain it.
                                   fit->overlap > 0.0 ? fmt::format("{:.0f}", fit->overlap * 1e6) : "–"});
        row.push_back(c.to_healthy[n] ? fmt::format("{:.2f}", *c.to_healthy[n] * 1e3) : "–");
        row.push_back(marks_of(c, number));
        table.rows.push_back(std::move(row));
        table.marks.push_back(c.plan.fragments[n].colour);
        table.warnings.push_back(is_void);
    }
    return table;
}

void add_vessels(const Case& c, std::vector<ReportBlock>& out) {
    if (c.vessels.empty()) return;
    ReportTable table{{"vessel", "kind", "length, mm", "radius, mm", "nearest as scanned", "gap, mm",
                       "nearest as planned", "gap as planned, mm"},
                      {}};
    for (const study::VesselClearance& v : c.vessels) {
        std::vector<std::string> row{v.vessel->name, std::string(reconstruct::name_of(v.vessel->kind)),
                                     fmt::format("{:.1f}", study::length_of(*v.vessel) * 1e3),
                                     fmt::format("{:.2f}", v.vessel->radius * 1e3)};
        for (const auto& nearest : {v.scanned, v.planned}) {
            const bool is_none = nearest.fragment < 0;
            row.push_back(is_none ? "–" : c.name(static_cast<std::size_t>(nearest.fragment)));
            row.push_back(is_none ? "–" : fmt::format("{:.1f}", nearest.gap * 1e3));
        }
        table.rows.push_back(std::move(row));
        table.marks.push_back(colour_of(*v.vessel));
        table.warnings.push_back(v.planned.fragment >= 0 && v.planned.gap < 0.0);
    }
    out.emplace_back(Heading{"Vessels"});
    out.emplace_back(
        Paragraph{"They stay where they were scanned. The gap is from the vessel's wall to the surface of "
                  "the nearest fragment; below 0 bone lies in the vessel."});
    out.emplace_back(std::move(table));
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

/// A fragment coloured by the distance to the other one, seen from the other one; none when nothing faces it.
std::optional<LabelledPicture> gap_map(const Case& c, std::size_t i, std::size_t j) {
    display::PictureMesh mesh = placed(c.meshes[i], c.pose(i), Vec3(0.0));
    const std::vector<float> gaps = vertex_gaps(c, i, j);
    Vec3 towards(0.0);
    for (std::size_t v = 0; v < gaps.size(); ++v) {
        const Vec3 colour = gap_colour(static_cast<double>(gaps[v]));
        for (int axis = 0; axis < 3; ++axis)
            mesh.colours[3 * v + static_cast<std::size_t>(axis)] = static_cast<float>(colour[axis]);
        if (std::isfinite(gaps[v])) towards += c.pose(i).rotate(c.meshes[i].normals[v]);
    }
    if (!(glm::length(towards) > 0.0)) return std::nullopt;
    const Vec3 direction = -glm::normalize(towards);
    const Vec3 tilted = std::abs(direction.z) > 0.95 ? glm::normalize(direction + Vec3(0.3, 0.0, 0.0)) : direction;
    return labelled_picture({mesh}, tilted, fmt::format("{}, seen from {}", c.name(i), c.name(j)));
}

/// All fragments as planned, coloured by their distance from the healthy side.
void add_mirror_maps(const Case& c, const fit::RegistrationTarget& healthy, std::vector<ReportBlock>& out) {
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
    out.emplace_back(Heading{"Distance from the healthy side"});
    out.emplace_back(legend([](double share) { return map_colour(share * range, range); }, "0 mm",
                            fmt::format("{:g} mm or more", range * 1e3), "Distance from the mirrored healthy side"));
    out.emplace_back(PictureGrid{{labelled_picture(meshes, Vec3(0.25, 1.0, -0.35), "from the front"),
                                  labelled_picture(meshes, Vec3(-0.35, -1.0, -0.3), "from behind")}});
}

struct Gaps {
    ReportTable table{{"fragment", "and", "facing, mm²", "touching, mm²", "median gap, mm", "95 %, mm", "deepest, mm",
                       "overlap, mm³"},
                      {}};
    PictureGrid maps;
    std::vector<std::string> warnings;  ///< of fragments that lie in each other
};

Gaps gaps(const Case& c) {
    constexpr double much = 5e-9;  // m³
    Gaps found;
    for (std::size_t i = 0; i < c.fragments.size(); ++i)
        for (std::size_t j = i + 1; j < c.fragments.size(); ++j) {
            if (!c.is_shown(i) || !c.is_shown(j)) continue;
            const fit::PlacedBone a = study::placed_bone(c.fragments[i], c.pose(i)),
                                  b = study::placed_bone(c.fragments[j], c.pose(j));
            const fit::MutualGap gap = fit::mutual_gap(a, b);
            const double overlap =
                fit::overlap_volume(c.fragments[i].bone.distance, c.pose(i), c.fragments[j].map, c.pose(j));
            if (overlap > much && fit::lie_in_each_other(a, b, fit::MatcherSettings{}.fit.most_penetration))
                found.warnings.push_back(fmt::format("'{}' and '{}' lie in each other with {:.0f} mm³", c.name(i),
                                                     c.name(j), overlap * 1e9));
            if (!(gap.facing > 5e-6)) continue;
            found.table.rows.push_back(
                {c.name(i), c.name(j), fmt::format("{:.0f}", gap.facing * 1e6),
                 fmt::format("{:.0f}", gap.contact * 1e6), fmt::format("{:.2f}", study::shown_mm(gap.median * 1e3)),
                 fmt::format("{:.2f}", study::shown_mm(gap.p95 * 1e3)), fmt::format("{:.2f}", gap.deepest * 1e3),
                 fmt::format("{:.1f}", overlap * 1e9)});
            if (!(gap.facing > 20e-6)) continue;
            if (auto map = gap_map(c, i, j)) found.maps.pictures.push_back(*std::move(map));
        }
    return found;
}

void add_gaps(const Gaps& found, std::vector<ReportBlock>& out) {
    out.emplace_back(Heading{"Gaps and overlaps"});
    if (found.table.rows.empty()) {
        out.emplace_back(Paragraph{"No two fragments face each other within 3 mm."});
        return;
    }
    out.emplace_back(found.table);
    if (found.maps.pictures.empty()) return;
    out.emplace_back(gap_legend());
    out.emplace_back(found.maps);
}

void add_steps(const Case& c, std::vector<ReportBlock>& out) {
    ReportTable table{{"step", "time", "by", "what"}, {}};
    for (const int n : fit::steps_to(c.plan.before(), c.plan.place().head)) {
        const cases::PlanStep& step = c.plan.steps[static_cast<std::size_t>(n)];
        std::string what(cases::name_of(step.kind));
        for (const int f : step.fragments) what += " " + c.name(static_cast<std::size_t>(f));
        if (!step.group.empty()) what += fmt::format(" as '{}'", step.group);
        if (step.painted) what += " as in " + step.painted->file;
        if (step.vessels)
            for (const reconstruct::FlapVessel& vessel : *step.vessels) what += " " + vessel.name;
        if (step.mirror)
            what += fmt::format(" {}, {:.2f} mm median residual", step.mirror->file, step.mirror->residual * 1e3);
        if (step.fit)
            what += fmt::format(", {} to {}, {:.0f} mm² in contact, {:.3f} mm rms, gap {:.2f} mm, {:.2f} mm deep",
                                step.fit->verdict, step.fit->partner, step.fit->overlap * 1e6, step.fit->rms * 1e3,
                                study::shown_mm(step.fit->gap * 1e3), step.fit->penetration * 1e3);
        table.rows.push_back({fmt::format("{}", table.rows.size() + 1),
                              step.run_second ? fmt::format("{:.3f} s", *step.run_second) : step.time, step.by, what});
    }
    out.emplace_back(Heading{"Order of steps"});
    if (table.rows.empty()) out.emplace_back(Paragraph{"There are no steps."});
    else out.emplace_back(std::move(table));
}

ReportList alternatives(const cases::CasePlan& plan) {
    ReportList list;
    for (const cases::PlanAlternative& a : plan.alternatives)
        list.items.push_back(
            fmt::format("{}: {}", a.name, counted(fit::steps_to(plan.before(), a.place.head).size(), "step")));
    return list;
}

/// What a reader must know before anything else.
void add_warnings(const Case& c, const std::vector<std::string>& overlaps, std::vector<ReportBlock>& out) {
    ReportList all{{}, true};
    // The pieces of a reconstruction lie where its planes say, not where surfaces fit.
    if (!c.state.reconstruction && !study::is_in_one_part(c.state))
        all.items.emplace_back("The fragments are not all connected by fits that hold.");
    for (std::size_t n = 0; n < c.fragments.size(); ++n)
        if (c.state.fits[n] && !c.state.holds(static_cast<int>(n)))
            all.items.push_back(c.name(n) + ": " + study::fit_words(c.state, static_cast<int>(n)));
    all.items.insert(all.items.end(), overlaps.begin(), overlaps.end());
    for (const study::VesselClearance& v : c.vessels)
        if (v.planned.fragment >= 0 && v.planned.gap < 0.0)
            all.items.push_back(fmt::format("'{}' reaches {:.1f} mm into the vessel '{}'",
                                            c.name(static_cast<std::size_t>(v.planned.fragment)), -v.planned.gap * 1e3,
                                            v.vessel->name));
    if (all.items.empty()) return;
    out.emplace_back(Heading{"Warnings", true});
    out.emplace_back(std::move(all));
}

/// Which fragments are connected by fits.
void add_connections(const Case& c, std::vector<ReportBlock>& out) {
    ReportList list{study::connection_words(c.plan, c.state)};
    if (c.state.reconstruction || list.items.empty()) return;
    out.emplace_back(Heading{"Connections"});
    out.emplace_back(std::move(list));
}

void add_mirror(const Case& c, std::vector<ReportBlock>& out) {
    if (!c.state.mirror) return;
    out.emplace_back(Heading{"Mirror of the healthy side"});
    out.emplace_back(
        Paragraph{fmt::format("{}: median distance {:.2f} mm. This residual includes the asymmetry of the body; there "
                              "is no ground truth to compare with.",
                              c.state.mirror->file, c.state.mirror->residual * 1e3)});
}

}  // namespace

std::vector<ReportBlock> plan_blocks(const cases::CasePlan& plan, std::vector<study::CaseFragment> fragments,
                                     std::vector<std::optional<double>> to_healthy,
                                     const fit::RegistrationTarget* healthy, std::vector<ReportBlock> first) {
    Case c;
    c.plan = plan;
    c.state = cases::state_of(c.plan);
    c.fragments = std::move(fragments);
    c.to_healthy = std::move(to_healthy);
    c.to_healthy.resize(c.fragments.size());
    c.vessels = study::vessel_clearances(c.state, c.fragments);
    for (const study::CaseFragment& fragment : c.fragments)
        c.meshes.push_back(mesh::surface_of(fragment.bone.distance));
    std::vector<ReportBlock> out, pictures;
    Gaps found;
    try {
        found = gaps(c);
        add_pictures(c, pictures);
        if (healthy) add_mirror_maps(c, *healthy, pictures);
    } catch (const Error& error) {
        throw Error(fmt::format("the pictures cannot be made: {}", error.what()));
    }
    out.emplace_back(Paragraph{fmt::format("Alternative '{}', {}. Research use; not a medical device.",
                                           c.plan.alternatives[static_cast<std::size_t>(c.plan.current)].name,
                                           counted(c.fragments.size(), "fragment"))});
    std::ranges::move(first, std::back_inserter(out));
    add_warnings(c, found.warnings, out);
    add_connections(c, out);
    out.emplace_back(Heading{"Fragments"});
    out.emplace_back(fragments_table(c));
    add_vessels(c, out);
    add_mirror(c, out);
    std::ranges::move(pictures, std::back_inserter(out));
    add_gaps(found, out);
    out.emplace_back(Heading{"Poses"});
    out.emplace_back(Paragraph{"p_plan = R p_scan + t, LPS, mm; R as a unit quaternion w x y z."});
    out.emplace_back(places(c));
    add_steps(c, out);
    out.emplace_back(Heading{"Alternatives"});
    out.emplace_back(alternatives(c.plan));
    return out;
}

std::string plan_page(const cases::CasePlan& plan, std::vector<study::CaseFragment> fragments,
                      std::vector<std::optional<double>> to_healthy, const fit::RegistrationTarget* healthy) {
    return html::page(plan.title,
                      html_of(plan_blocks(plan, std::move(fragments), std::move(to_healthy), healthy), "plan"));
}

}  // namespace tactus::picture
