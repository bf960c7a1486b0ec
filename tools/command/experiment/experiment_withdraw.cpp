// SPDX-License-Identifier: Apache-2.0
// tactus experiment withdraw: deletes a subject.
#include "tools/analysis/experiment/experiment_folder.hpp"
#include "tools/command/options.hpp"
#include "tools/exit_code.hpp"
#include "tools/terminal.hpp"

#include <fmt/format.h>

#include <memory>

namespace tactus::command {

namespace {

struct WithdrawChoice {
    std::filesystem::path folder;
    std::string subject;
};

Action declare_experiment_withdraw(VerbOptions& verb) {
    const auto choice = std::make_shared<WithdrawChoice>();
    verb.add("folder", choice->folder, "folder of the experiment's data").required();
    verb.add("--subject", choice->subject, "pseudonym of the subject").required();
    return [choice] {
        analysis::ExperimentFolder folder(choice->folder);
        folder.withdraw(choice->subject);
        say(stdout,
            fmt::format("{} was deleted; the next new subject inherits the order. Delete copies and results that "
                        "you made of the data, too.\n",
                        choice->subject));
        return static_cast<int>(done);
    };
}

}  // namespace

Verb experiment_withdraw_verb() {
    return {"withdraw", "delete all data of a subject who withdraws", declare_experiment_withdraw};
}

}  // namespace tactus::command
