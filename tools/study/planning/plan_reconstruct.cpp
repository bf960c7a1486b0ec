// SPDX-License-Identifier: Apache-2.0
#include "tools/study/planning/plan_reconstruct.hpp"

#include "assets/bone/labels.hpp"
#include "assets/cases/plan_file.hpp"
#include "assets/cases/plan_lock.hpp"
#include "assets/mesh/write_mesh.hpp"
#include "dsp/core/error.hpp"
#include "dsp/reconstruct/cut.hpp"
#include "tools/study/planning/plan_case.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <utility>

namespace tactus::study {

namespace {

namespace fs = std::filesystem;
using geometry::TriangleSurface;
using reconstruct::FibulaInputs;
using reconstruct::FibulaPlan;
using reconstruct::Plane;

struct Piece {
    std::string name;
    TriangleSurface surface;
};

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

/// A plane of the jaw, its normal along the order of the planes.
Plane jaw_plane(const FibulaInputs& inputs, const FibulaPlan& plan, std::size_t segment, std::size_t end) {
    const reconstruct::FibulaSegment& s = plan.segments[segment];
    Plane plane{inputs.planes[segment + end].origin, s.donor_to_target.rotate(s.donor_plane[end].normal)};
    const Vec3 along = inputs.planes[segment + 1].origin - inputs.planes[segment].origin;
    if (glm::dot(plane.normal, along) < 0.0) plane.normal = -plane.normal;
    return plane;
}

void add_jaw(std::vector<Piece>& pieces, const FibulaInputs& inputs, const FibulaPlan& plan) {
    reconstruct::CutPieces cut;
    try {
        cut = reconstruct::cut_between(*inputs.jaw, jaw_plane(inputs, plan, 0, 0),
                                       jaw_plane(inputs, plan, plan.segments.size() - 1, 1));
    } catch (const Error& error) {
        throw Error(fmt::format("the jaw: {}", error.message()));
    }
    pieces.push_back({"resected", std::move(cut.between)});
    std::vector<Piece> kept;
    for (TriangleSurface& part : cut.rest) {
        if (kept.empty() || 100 * part.triangles.size() >= kept[0].surface.triangles.size()) {
            kept.push_back({fmt::format("jaw-{}", kept.size() + 1), std::move(part)});
            continue;
        }
        TriangleSurface& largest = kept[0].surface;
        const int first = static_cast<int>(largest.vertices.size());
        largest.vertices.insert(largest.vertices.end(), part.vertices.begin(), part.vertices.end());
        for (const auto& t : part.triangles) largest.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
    for (Piece& piece : kept) pieces.push_back(std::move(piece));
}

}  // namespace

Reconstruction make_reconstruction(const FibulaInputs& inputs, const fs::path& path) {
    if (!inputs.donor) throw Error("the inputs name no 'donor': its surface is what is cut");
    if (fs::exists(path))
        throw Error(fmt::format("{}: the file exists already; a plan is never overwritten", path.string()));
    const cases::PlanLock lock(path);
    Reconstruction made;
    made.fibula = reconstruct::plan_fibula(inputs);
    std::vector<Piece> pieces;
    if (inputs.jaw) add_jaw(pieces, inputs, made.fibula);
    const std::size_t jaw_pieces = pieces.size();
    const TriangleSurface donor = reconstruct::parts_near_line(
        *inputs.donor, inputs.line_point, glm::normalize(inputs.line_direction), inputs.farthest_from_line);
    for (std::size_t n = 0; n < made.fibula.segments.size(); ++n) {
        const auto& planes = made.fibula.segments[n].donor_plane;
        const std::size_t low = inputs.reversed ? 1 : 0;
        try {
            pieces.push_back({fmt::format("segment-{}", n + 1),
                              reconstruct::cut_between(donor, planes[low], planes[1 - low]).between});
        } catch (const Error& error) {
            throw Error(fmt::format("segment {} of the donor: {}", n + 1, error.message()));
        }
    }
    const std::string name = path.stem().stem().string();
    const fs::path folder = path.parent_path();
    NewFolder files(folder / (name + "-pieces"));
    cases::CasePlan& plan = made.plan;
    plan.title = name;
    for (const Piece& piece : pieces) {
        const fs::path file = files.path / (piece.name + ".stl");
        mesh::write_mesh(std::vector<mesh::ColouredSurface>{{piece.surface, {}}}, file);
        cases::add_fragment(plan, piece.name, file, folder,
                            bone::label_colour(static_cast<int>(plan.fragments.size()) + 1));
        load_fragment(plan.fragments.back(), folder);
    }
    const auto add = [&plan](cases::PlanStep step) {
        step.time = cases::time_of_day();
        cases::add_step(plan, std::move(step));
    };
    if (inputs.jaw) {
        cases::PlanStep hide;
        hide.kind = cases::StepKind::hide;
        hide.by = "command";
        hide.fragments = {0};
        add(hide);
    }
    for (std::size_t n = 0; n < made.fibula.segments.size(); ++n)
        add(cases::placing(plan, static_cast<int>(jaw_pieces + n), made.fibula.segments[n].donor_to_target, "command"));
    cases::save_case_plan(plan, path);
    files.is_kept = true;
    return made;
}

}  // namespace tactus::study
