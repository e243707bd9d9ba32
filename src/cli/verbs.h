#pragma once
// The verbs of the program: each adds its subcommand and, when it was called, runs. What it returns is the
// exit code; WorldError and UsageError are caught in main.

#include <functional>

namespace CLI {
class App;
}

namespace gnomon {

// Called once the command line is parsed.
using Run = std::function<int()>;

// The command line as it was typed, for reports.
void setCommandLine(int argc, char** argv);

Run addCompareVerb(CLI::App& app);
Run addRenderVerb(CLI::App& app);
Run addReportVerb(CLI::App& app);
Run addVsvVerb(CLI::App& app);
Run addFogVerb(CLI::App& app);
Run addSceneVerb(CLI::App& app);
Run addInfoVerb(CLI::App& app);
Run addBenchVerb(CLI::App& app);
Run addReproduceVerb(CLI::App& app);

}  // namespace gnomon
