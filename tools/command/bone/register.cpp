// SPDX-License-Identifier: Apache-2.0
// tactus register: registers a surface to another one of the same shape, as a whole or by parts.
#include "tools/analysis/bone/registration.hpp"
#include "tools/command/result_options.hpp"
#include "tools/exit_code.hpp"
#include "tools/report/bone/fit_result.hpp"
#include "tools/report/result/printers.hpp"

#include <memory>

namespace tactus::command {

namespace {

struct RegisterChoice {
    analysis::RegisterSettings settings;
    double away = 1.5, gap = 3.0, margin = 2.0;  // mm
    ResultChoice result;
};

int register_surfaces(const RegisterChoice& choice) {
    check_result_files(choice.result, {choice.settings.moving, choice.settings.fixed});
    analysis::RegisterSettings settings = choice.settings;
    settings.away = choice.away * 1e-3;
    settings.gap = choice.gap * 1e-3;
    settings.margin = choice.margin * 1e-3;
    const analysis::RegisteredSurface found = analysis::register_files(settings);
    const bool is_fit = !found.judged || found.judged->verdict == fit::RegistrationVerdict::fit;
    write_result(report::registration_fields().of({&found, settings.region}), choice.result);
    return is_fit ? done : answer_is_no;
}

Action declare_register(VerbOptions& verb) {
    const auto choice = std::make_shared<RegisterChoice>();
    analysis::RegisterSettings& settings = choice->settings;
    verb.add("moving", settings.moving, "bone file or mesh, which need not be closed").required();
    verb.add("fixed", settings.fixed, "bone file or mesh to register to").required();
    verb.flag("--mirror", settings.mirror, "the moving surface is from the other side of the body");
    verb.flag("--anywhere", settings.anywhere,
              "the position in the files means nothing (default: of poses that fit equally well, the nearest to it is "
              "taken)");
    verb.flag("--region", settings.region,
              "also find a part that is displaced against the rest, and register it separately");
    verb.add("--away", choice->away, "distance above which a point counts as displaced, mm")
        .unit("mm")
        .shows_default()
        .range(0.01, 100.0);
    verb.add("--gap", choice->gap, "greatest gap between points of a region, mm")
        .unit("mm")
        .shows_default()
        .range(0.1, 100.0);
    verb.add("--margin", choice->margin, "margin added to a region, mm").unit("mm").shows_default().range(0.0, 100.0);
    add_result_options(verb, choice->result, ResultFigure::none);
    return [choice] { return register_surfaces(*choice); };
}

}  // namespace

Verb register_verb() {
    return {.name = "register",
            .about = "register a surface to another one of the same shape",
            .add = declare_register,
            .schema = [] { return report::schema_of_output({report::registration_fields().schema()}); }};
}

}  // namespace tactus::command
