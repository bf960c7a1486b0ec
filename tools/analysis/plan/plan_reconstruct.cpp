// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/plan/plan_reconstruct.hpp"

#include "assets/bone/labels.hpp"
#include "assets/mesh/write_mesh.hpp"
#include "assets/plan/plan_file.hpp"
#include "assets/plan/plan_lock.hpp"
#include "dsp/core/error.hpp"
#include "dsp/reconstruction/bodies.hpp"
#include "dsp/reconstruction/cut.hpp"
#include "tools/analysis/plan/flap_study.hpp"
#include "tools/analysis/plan/plan_case.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <span>
#include <utility>

namespace tactus::analysis {

namespace {

namespace fs = std::filesystem;
using geometry::TriangleSurface;
using reconstruction::CutBy;
using reconstruction::FibulaInputs;
using reconstruction::FibulaPlan;
using reconstruction::Plane;
using reconstruction::RestPiece;

struct Piece {
    std::string name;
    TriangleSurface surface;
    CutBy cut_by = CutBy::none;
};

/// m³. A separate body that is not larger goes with the piece in which it stands; a molar has about 1 cm³. An
/// assumption, not from a source.
constexpr double largest_tooth = 2e-6;

/// Removes the folder unless told to keep it.
struct NewFolder {
    fs::path path;
    bool is_kept = false;

    explicit NewFolder(fs::path folder) : path(std::move(folder)) {
        if (fs::exists(path))
            throw Error(
                fmt::format("{}: the folder exists already; its pieces may belong to another plan", path.string()));
        std::error_code failed;
        if (!fs::create_directories(path, failed))
            throw Error(fmt::format("{}: cannot be made: {}", path.string(), failed.message()));
    }
    ~NewFolder() {
        std::error_code ignored;
        if (!is_kept) fs::remove_all(path, ignored);
    }
    NewFolder(const NewFolder&) = delete;
    NewFolder& operator=(const NewFolder&) = delete;
};

/// Edges that do not belong to two triangles of opposite direction.
std::size_t open_edges(const TriangleSurface& surface) {
    std::map<std::pair<int, int>, int> balance;
    for (const auto& t : surface.triangles)
        for (std::size_t c = 0; c < 3; ++c) {
            const int a = t[c], b = t[(c + 1) % 3];
            balance[std::minmax(a, b)] += a < b ? 1 : -1;
        }
    return static_cast<std::size_t>(std::ranges::count_if(balance, [](const auto& edge) { return edge.second != 0; }));
}

/// A plane of the jaw, its normal along the order of the planes.
Plane jaw_plane(const FibulaInputs& inputs, const FibulaPlan& plan, std::size_t segment, std::size_t end) {
    const reconstruction::FibulaSegment& s = plan.segments[segment];
    Plane plane{inputs.planes[segment + end].origin, s.donor_to_target.rotate(s.donor_plane[end].normal)};
    const Vec3 along = inputs.planes[segment + 1].origin - inputs.planes[segment].origin;
    if (glm::dot(plane.normal, along) < 0.0) plane.normal = -plane.normal;
    return plane;
}

void append(TriangleSurface& to, const TriangleSurface& more) {
    const int first = static_cast<int>(to.vertices.size());
    to.vertices.insert(to.vertices.end(), more.vertices.begin(), more.vertices.end());
    for (const auto& t : more.triangles) to.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

/// m², between the middle of a surface and the nearest vertex of another one.
double square_distance(const TriangleSurface& small, const TriangleSurface& large) {
    Vec3 middle(0.0);
    for (const Vec3& v : small.vertices) middle += v / static_cast<double>(small.vertices.size());
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3& v : large.vertices) least = std::min(least, glm::dot(v - middle, v - middle));
    return least;
}

/// The planes by which the jaw is cut, as of cut_between.
reconstruction::CutPieces cut_jaw(const FibulaInputs& inputs, const FibulaPlan& plan) {
    const Plane first = jaw_plane(inputs, plan, 0, 0);
    Plane last = jaw_plane(inputs, plan, plan.segments.size() - 1, 1);
    switch (inputs.resection) {
        case reconstruction::Resection::between: return reconstruction::cut_between(*inputs.jaw, first, last);
        case reconstruction::Resection::after_first: return reconstruction::cut_between(*inputs.jaw, first, {});
        case reconstruction::Resection::before_last:
            last.normal = -last.normal;
            return reconstruction::cut_between(*inputs.jaw, last, {});
        case reconstruction::Resection::none: break;
    }
    return {{}, {{*inputs.jaw, CutBy::first}}};
}

/// Whether one plane has cut both.
bool have_a_plane(CutBy a, CutBy b) {
    return a == b || (a != CutBy::none && b == CutBy::both) || (a == CutBy::both && b != CutBy::none);
}

void add_jaw(std::vector<Piece>& pieces, const FibulaInputs& inputs, const FibulaPlan& plan) {
    const bool is_cut = inputs.resection != reconstruction::Resection::none;
    if (const std::size_t open = is_cut ? open_edges(*inputs.jaw) : 0; open > 0)
        throw Error(
            fmt::format("the jaw: its mesh is open at {} edges, and pieces of an open mesh enclose nothing; "
                        "close it first",
                        open));
    reconstruction::CutPieces cut;
    try {
        cut = cut_jaw(inputs, plan);
    } catch (const Error& error) {
        const bool misses = error.message().find("misses") != std::string::npos;
        throw Error(
            fmt::format("the jaw: {}{}", error.message(),
                        misses ? "; for a jaw that is resected already, the inputs need \"resection\": \"none\"" : ""));
    }
    std::vector<Piece> kept;
    std::vector<const RestPiece*> loose;
    for (RestPiece& part : cut.rest) {
        // The rest comes by size: the first piece at a plane is the jaw itself, a small one after it is half a tooth.
        const bool is_jaw = part.cut_by != CutBy::none && std::ranges::none_of(kept, [&](const Piece& other) {
                                return have_a_plane(other.cut_by, part.cut_by);
                            });
        if (is_jaw || std::abs(reconstruction::signed_volume(part.surface)) > largest_tooth)
            kept.push_back({fmt::format("jaw-{}", kept.size() + 1), std::move(part.surface), part.cut_by});
        else loose.push_back(&part);
    }
    // Nearest before anything is joined: a tooth must not draw the next one to its piece.
    std::vector<TriangleSurface*> goes_to;
    for (const RestPiece* part : loose) {
        TriangleSurface* nearest = nullptr;
        double least = std::numeric_limits<double>::infinity();
        const auto look = [&](TriangleSurface& other) {
            if (const double away = square_distance(part->surface, other); away < least) least = away, nearest = &other;
        };
        for (Piece& piece : kept)
            if (part->cut_by == CutBy::none || have_a_plane(part->cut_by, piece.cut_by)) look(piece.surface);
        if (part->cut_by == CutBy::none && !cut.between.triangles.empty()) look(cut.between);
        goes_to.push_back(nearest);
    }
    for (std::size_t n = 0; n < loose.size(); ++n) append(*goes_to[n], loose[n]->surface);
    if (!cut.between.triangles.empty()) pieces.push_back({"resected", std::move(cut.between), CutBy::none});
    for (Piece& piece : kept) pieces.push_back(std::move(piece));
}

plan::PlanStep step_that_holds(const reconstruction::ReconstructionInputs& given, const fs::path& folder) {
    reconstruction::Reconstruction all;
    all.inputs = given.inputs;
    all.inputs.donor.reset();
    all.inputs.jaw.reset();
    all.flap = given.flap;
    all.donor = mesh_file(given.donor, folder);
    if (!given.jaw.empty()) all.jaw = mesh_file(given.jaw, folder);
    if (!given.tumour.empty()) all.tumour = mesh_file(given.tumour, folder);
    plan::PlanStep step;
    step.kind = plan::StepKind::reconstruct;
    step.by = "command";
    step.reconstruction = std::make_shared<reconstruction::Reconstruction>(std::move(all));
    return step;
}

/// An empty plan, or the one that is there, at a new alternative that begins as scanned.
plan::CasePlan begun(const fs::path& path, const std::string& alternative) {
    if (alternative.empty()) {
        if (fs::exists(path))
            throw Error(
                fmt::format("{}: the file exists already; a plan is never overwritten. --alternative NAME adds another "
                            "reconstruction to it",
                            path.string()));
        return {};
    }
    plan::CasePlan plan = plan::load_case_plan(path);
    if (std::ranges::find(plan.alternatives, alternative, &plan::PlanAlternative::name) != plan.alternatives.end())
        throw Error(fmt::format("{}: the alternative '{}' exists already", path.string(), alternative));
    plan.alternatives.push_back({alternative, {}});
    plan.current = static_cast<int>(plan.alternatives.size()) - 1;
    return plan;
}

std::vector<Piece> pieces_of(const FibulaInputs& inputs, const FibulaPlan& fibula) {
    std::vector<Piece> pieces;
    if (inputs.jaw) add_jaw(pieces, inputs, fibula);
    const TriangleSurface donor = reconstruction::parts_near_line(
        *inputs.donor, inputs.line_point, glm::normalize(inputs.line_direction), inputs.farthest_from_line);
    for (std::size_t n = 0; n < fibula.segments.size(); ++n) {
        const auto& planes = fibula.segments[n].donor_plane;
        const std::size_t low = inputs.reversed ? 1 : 0;
        try {
            pieces.push_back({fmt::format("segment-{}", n + 1),
                              reconstruction::cut_between(donor, planes[low], planes[1 - low]).between, CutBy::none});
        } catch (const Error& error) {
            throw Error(fmt::format("segment {} of the donor: {}", n + 1, error.message()));
        }
    }
    return pieces;
}

}  // namespace

MadeReconstruction make_reconstruction(const reconstruction::ReconstructionInputs& given, const fs::path& path,
                                       const std::string& alternative) {
    const FibulaInputs& inputs = given.inputs;
    if (!inputs.donor) throw Error("the inputs name no 'donor': its surface is what is cut");
    if (alternative.find_first_of("/\\:") != std::string::npos || alternative.starts_with('.'))
        throw Error(fmt::format("'{}' cannot be the name of an alternative that has a folder", alternative));
    const plan::PlanLock lock(path);
    MadeReconstruction made;
    made.plan = begun(path, alternative);
    made.fibula = reconstruction::plan_fibula(inputs);
    const std::vector<Piece> pieces = pieces_of(inputs, made.fibula);
    const std::string name = path.stem().stem().string(), tail = alternative.empty() ? "" : "-" + alternative;
    const fs::path folder = path.parent_path();
    NewFolder files(folder / (name + tail + "-pieces"));
    plan::CasePlan& plan = made.plan;
    if (alternative.empty()) plan.title = name;
    plan::PlanStep whole = step_that_holds(given, folder);
    for (const Piece& piece : pieces) {
        const fs::path file = files.path / (piece.name + ".stl");
        mesh::write_mesh(std::vector<mesh::ColouredSurface>{{piece.surface, {}}}, file);
        whole.fragments.push_back(static_cast<int>(plan.fragments.size()));
        plan::add_fragment(plan, piece.name + tail, file, folder,
                           bone::label_colour(static_cast<int>(whole.fragments.size())));
        load_fragment(plan.fragments.back(), folder);
    }
    const std::vector<int> numbers = whole.fragments;
    whole.time = plan::time_of_day();
    plan::add_step(plan, std::move(whole));
    const auto change = [&plan](const plan::PlanCommand& command) {
        using Outcome = plan::PlanHistory::Outcome;
        const Outcome outcome = plan::change(plan, command, {.by = "command", .time = plan::time_of_day()});
        if (outcome != Outcome::done && outcome != Outcome::unchanged) throw Error(std::string(plan::text_of(outcome)));
    };
    if (inputs.jaw && inputs.resection != reconstruction::Resection::none) {
        change(plan::HideFragments{plan::set_of(std::span(numbers).first(1))});
    }
    const std::size_t first = numbers.size() - made.fibula.segments.size();
    for (std::size_t n = 0; n < made.fibula.segments.size(); ++n)
        change(plan::PlaceFragment{numbers[first + n], made.fibula.segments[n].donor_to_target});
    plan::save_case_plan(plan, path);
    files.is_kept = true;
    return made;
}

}  // namespace tactus::analysis
