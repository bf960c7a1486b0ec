// SPDX-License-Identifier: Apache-2.0
// tactus flap: a synthetic case of a jaw that is reconstructed with a fibula, as files that a user could have.
#include "assets/library/flap_case.hpp"
#include "assets/mesh/mesh.hpp"
#include "dsp/core/error.hpp"
#include "tools/command/options.hpp"
#include "tools/exit_code.hpp"
#include "tools/run/load_plan.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <vector>

namespace tactus::command {

namespace {

using reconstruction::Leg;

struct FlapChoice {
    std::filesystem::path out, fibula;
    std::vector<std::filesystem::path> between;
    std::string leg = "left", fibula_leg = "left";
    std::uint64_t seed = 1;
};

/// m.
geometry::TriangleSurface surface_of(const std::filesystem::path& path) {
    mesh::MeshOrigin origin;
    geometry::TriangleSurface surface = mesh::load_mesh(path, 1.0, &origin);
    for (Vec3& v : surface.vertices) v *= origin.unit.value_or(1e-3);
    return surface;
}

Leg leg_of(const std::string& word) { return word == "left" ? Leg::left : Leg::right; }

int flap(const FlapChoice& choice) {
    if (const auto inputs = choice.out / "INPUTS.json"; std::filesystem::exists(inputs))
        throw Error(fmt::format("{}: exists already, and may have been changed; name another folder", inputs.string()));
    library::FlapOptions options;
    if (!choice.fibula.empty()) options.fibula = surface_of(choice.fibula);
    for (const std::filesystem::path& muscle : choice.between) options.between.push_back(surface_of(muscle));
    options.fibula_leg = leg_of(choice.fibula_leg);
    options.leg = leg_of(choice.leg);
    options.seed = choice.seed;
    library::FlapCase made;
    try {
        made = library::make_flap(options);
    } catch (const Error& error) {
        if (choice.fibula.empty()) throw;
        throw Error(fmt::format("{}: {}", choice.fibula.string(), error.message()));
    }
    // The folder is made after the case, so that a failure leaves no folder.
    run::make_output_folder(choice.out);
    library::write_flap(made, choice.out);
    fmt::print("{}: jaw, {} fibula, artery of {:.0f} mm with {} perforators, vein, {} recipient sites\n",
               (choice.out / "INPUTS.json").string(), choice.leg, made.artery.branches[0].length() * 1e3,
               made.perforators.size(), made.sites.size());
    for (const std::string& note : made.notes) fmt::print("{}\n", note);
    return done;
}

Action declare_flap(VerbOptions& verb) {
    const auto choice = std::make_shared<FlapChoice>();
    verb.output("-o,--out", choice->out, OutputFormat::folder(), "folder for the files").required();
    verb.add("--leg", choice->leg, "leg that the fibula is taken from").shows_default().one_of({"left", "right"});
    verb.add("--fibula", choice->fibula, "a person's fibula in place of a generated one (.stl, .ply, .obj, mm, LPS)");
    verb.add("--fibula-leg", choice->fibula_leg, "leg of --fibula; mirrored when it is not --leg")
        .shows_default()
        .one_of({"left", "right"});
    verb.add("--between", choice->between,
             "the muscles beside --fibula between which its vessels run: tibialis posterior and flexor hallucis longus")
        .count(2);
    verb.add("--seed", choice->seed, "seed of the perforators' places").shows_default();
    return [choice] { return flap(*choice); };
}

}  // namespace

Verb flap_verb() {
    return {"flap", "make a synthetic case for 'plan reconstruct': jaw, fibula, vessels, recipient sites",
            declare_flap};
}

}  // namespace tactus::command
