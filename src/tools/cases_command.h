#pragma once

#include <string>

#include "casepush/cases/case_base.h"
#include "command.h"

namespace casepush {

/// Adds a subcommand of `casepush cases` with --case-base and --json, which go to the arguments.
/// `Arguments` is a struct with members `case_base` and `json`.
template <typename Arguments>
CLI::App* addCasesSubcommand(CLI::App& cases, Run& run, const std::string& name,
                             const std::string& description, Arguments arguments,
                             int (*action)(const typename Arguments::element_type&)) {
  CLI::App* command = cases.add_subcommand(name, description);
  command->add_option("--case-base", arguments->case_base, "SQLite file")
      ->required()
      ->check(notEmpty());
  command->add_flag("--json", arguments->json, "Print one JSON object on stdout");
  command->callback(
      [arguments, action, &run] { run = [arguments, action] { return action(*arguments); }; });
  return command;
}

/// Adds what is known of a context.
void addContext(const PushContext& context, nlohmann::ordered_json* json);

/// undo, copy, remove, prune, merge and transfer.
void addCasesEditCommands(CLI::App& cases, Run& run);

/// calibrate and dump.
void addCasesShowCommands(CLI::App& cases, Run& run);

}  // namespace casepush
