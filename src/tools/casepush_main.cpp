#include <csignal>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include "casepush/common/input_error.h"
#include "command.h"

namespace {

int fail(const std::string& message, bool json) {
  if (json) {
    casepush::printResult({{"success", false}, {"error", message}}, true);
  }
  std::cerr << "casepush: error: " << message << std::endl;
  return casepush::kExitBadInput;
}

bool wantsJson(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "--json") {
      return true;
    }
  }
  return false;
}

/// The command as it was typed, as far as it is known: "casepush cases list".
std::string commandOf(const CLI::App& app) {
  const std::vector<const CLI::App*> chosen =
      app.get_subcommands([](const CLI::App* each) { return each->parsed(); });
  return app.get_name() + (chosen.empty() ? "" : " " + commandOf(*chosen.front()));
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "casepush: learns how wheeled furniture moves when pushed, plans pushes and executes them.\n"
      "Runs the behaviours of the ROS nodes in the bundled simulator, without ROS.\n"
      "Exit code: 0 success, 1 the task failed, 2 usage or bad input.");
  app.name("casepush");
  app.require_subcommand(1);
  casepush::Run run;
  casepush::addLearnCommand(app, run);
  casepush::addPlanCommand(app, run);
  casepush::addPushCommand(app, run);
  casepush::addRearrangeCommand(app, run);
  casepush::addCasesCommand(app, run);
  casepush::addWorldCommand(app, run);
  casepush::addMapCommand(app, run);
  casepush::addBenchCommand(app, run);
  casepush::addExperimentCommand(app, run);
  const bool json = wantsJson(argc, argv);
  // A file that may not grow any more (ulimit -f) is told of like a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    app.parse(argc, argv);
    return run();
  } catch (const CLI::CallForHelp& help) {
    return app.exit(help);
  } catch (const CLI::CallForAllHelp& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    const std::vector<std::string> unknown = app.remaining(true);
    const std::string what = unknown.empty() ? error.what() : "unknown argument " + unknown.front();
    return fail(what + "; see " + commandOf(app) + " --help", json);
  } catch (const casepush::InputError& error) {
    return fail(error.what(), json);
  } catch (const std::exception& error) {
    return fail(std::string("unexpected: ") + error.what(), json);
  }
}
